#include "cambium/observer/parametric.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <string>

#include "../support/maps.hpp"
#include "../support/parameter_rows.hpp"
#include "cambium/behavior/behavior_set.hpp"
#include "cambium/behavior/open_loop/constant_acceleration.hpp"
#include "cambium/core/error.hpp"
#include "cambium/observer/delayed.hpp"
#include "cambium/dynamics/single_track.hpp"
#include "cambium/execution/interpolate.hpp"
#include "cambium/observer/occluded.hpp"
#include "cambium/world/world.hpp"

namespace cb = cambium;

namespace {

cb::ObservationNoise const noise{.mean_along = 0.5,
                                 .mean_speed = -1.0,
                                 .along = 2.0,
                                 .across = 0.5,
                                 .heading = 0.1,
                                 .speed = 1.5,
                                 .along_across = 0.3,
                                 .along_speed = 0.8,
                                 .across_heading = -0.6,
                                 .heading_speed = 0.1};

using Vector = std::array<double, 4>;

/// Error of a look at an agent that heads north-west: along, across, heading, speed.
Vector error_of(cb::ParametricObserver const& observer, bool own, cb::RandomStream const& random) {
  cb::State const truth{1.0, 10.0, 20.0, 2.356194490192345, 12.0};
  auto const seen = observer.observe(truth, own, random);
  double const dx = seen.x - truth.x, dy = seen.y - truth.y, c = std::cos(truth.heading), s = std::sin(truth.heading);
  CHECK(seen.time == truth.time);
  return {c * dx + s * dy, -s * dx + c * dy, seen.heading - truth.heading, seen.speed - truth.speed};
}

struct Moments {
  Vector mean{};
  std::array<Vector, 4> covariance{};
};

Moments moments_of(cb::ParametricObserver const& observer, bool own, std::uint32_t step) {
  constexpr std::uint32_t count = 100'000;
  Moments m;
  for (std::uint32_t i = 0; i < count; ++i) {
    auto const e = error_of(observer, own, cb::RandomStream(5, i, step, 7));
    for (std::size_t a = 0; a < 4; ++a) {
      m.mean[a] += e[a] / count;
      for (std::size_t b = 0; b < 4; ++b) m.covariance[a][b] += e[a] * e[b] / count;
    }
  }
  for (std::size_t a = 0; a < 4; ++a)
    for (std::size_t b = 0; b < 4; ++b) m.covariance[a][b] -= m.mean[a] * m.mean[b];
  return m;
}

/// As asked for, to five standard errors.
void check_moments(Moments const& m) {
  Vector const deviation{2.0, 0.5, 0.1, 1.5}, mean{0.5, 0.0, 0.0, -1.0};
  std::array<Vector, 4> const correlation{{{1, 0.3, 0, 0.8}, {0.3, 1, -0.6, 0}, {0, -0.6, 1, 0.1}, {0.8, 0, 0.1, 1}}};
  for (std::size_t a = 0; a < 4; ++a) {
    CAPTURE(a);
    CHECK(std::abs(m.mean[a] - mean[a]) < 5 * deviation[a] / std::sqrt(1e5));
    for (std::size_t b = 0; b < 4; ++b) {
      CAPTURE(b);
      double const scale = deviation[a] * deviation[b], rho = correlation[a][b];
      CHECK(std::abs(m.covariance[a][b] - rho * scale) < 5 * scale * std::sqrt((1 + rho * rho) / 1e5));
    }
  }
}

}  // namespace

TEST_CASE("noise has the means, deviations and correlations asked for, along and across the heading") {
  check_moments(moments_of({.others = noise}, false, 3));
  check_moments(moments_of({.own = noise}, true, 3));
}

TEST_CASE("noise that lasts has the same moments at every step on the way to new errors") {
  for (std::uint32_t const step : {20u, 21u, 24u})
    check_moments(moments_of({.others = noise, .lasting = 5}, false, step));
}

TEST_CASE("errors about itself and about others are apart") {
  cb::State const truth{0, 1, 2, 3, 4};
  cb::RandomStream const random(1, 2, 3);
  CHECK(cb::ParametricObserver{.others = noise}.observe(truth, true, random) == truth);
  CHECK(cb::ParametricObserver{.own = noise}.observe(truth, false, random) == truth);
  CHECK(cb::ParametricObserver{}.observe(truth, false, random) == truth);
}

TEST_CASE("lasting errors of two steps are correlated by the cosine of the angle between them") {
  cb::ParametricObserver const observer{.others = {.along = 1.0}, .lasting = 10};
  auto const correlation = [&](std::uint32_t a, std::uint32_t b) {
    constexpr std::uint32_t count = 40'000;
    double sum = 0.0;
    for (std::uint32_t i = 0; i < count; ++i) {
      cb::RandomStream const random(9, i, a, 1);
      sum += error_of(observer, false, random)[0] * error_of(observer, false, random.at_step(b))[0] / count;
    }
    return sum;
  };
  double const step = 1.5707963267948966 / 10;
  CHECK(correlation(40, 41) == doctest::Approx(std::cos(step)).epsilon(0.03));
  CHECK(correlation(42, 46) == doctest::Approx(std::cos(4 * step)).epsilon(0.03));
  CHECK(std::abs(correlation(40, 50)) < 0.03);
  CHECK(std::abs(correlation(43, 63)) < 0.03);
}

TEST_CASE("who sees speeds with errors sees accelerations with errors, new in each step or lasting") {
  for (int const lasting : {1, 50}) {
    cb::World<cb::BehaviorSet<cb::ConstantAcceleration>, cb::InterpolateExecution, cb::SingleTrack,
              cb::ParametricObserver>
        world(support::straight_road(1, 5000.0), {.seed = 5});
    auto const id =
        world.add({.position = {10, -1.75}, .speed = 10, .observer = {.others = {.speed = 0.5}, .lasting = lasting}});
    world.add({.position = {50, -1.75}, .speed = 10});
    double sum = 0.0, squares = 0.0;
    constexpr int steps = 2000;
    for (int k = 0; k < steps; ++k) {
      auto const view = world.observe(id);
      double const error = view.acceleration(*view.ahead());
      sum += error;
      squares += error * error;
      REQUIRE(world.step(0.2));
    }
    CAPTURE(lasting);
    double const deviation = std::sqrt(squares / steps), expected = std::sqrt(2.0) * 0.5;
    CHECK(std::abs(sum / steps) < 0.05);
    if (lasting == 1) CHECK(deviation == doctest::Approx(expected).epsilon(0.1));
    if (lasting > 1) CHECK(deviation < 0.1 * expected);
    if (lasting > 1) CHECK(deviation > 0.0);
  }
}

TEST_CASE("perfect correlation is allowed, contradicting ones are refused in a sentence") {
  cb::ObservationNoise const same{.along = 1.0, .speed = 2.0, .along_speed = 1.0};
  CHECK_NOTHROW(cb::check_parameters(same));
  cb::ParametricObserver const observer{.others = same};
  for (std::uint32_t i = 0; i < 100; ++i) {
    auto const e = error_of(observer, false, cb::RandomStream(1, i, 0));
    CHECK(e[3] == doctest::Approx(2 * e[0]));
  }
  cb::ObservationNoise const impossible{.along_across = 0.9, .along_speed = 0.9, .across_speed = -0.9};
  CHECK_THROWS_AS(cb::check_parameters(cb::ParametricObserver{.others = impossible}, "agent 3"), cb::ParameterError);
}

TEST_CASE("an error to the left lies to the left, whatever the heading; BARK's does not where one heads north") {
  cb::ParametricObserver const observer{.others = {.mean_across = 1.0}};
  for (int i = 0; i < 16; ++i) {
    cb::State const truth{0, 5, -3, i * cb::geometry::pi / 8, 10};
    auto const seen = observer.observe(truth, false, cb::RandomStream(1, 2, 3));
    INFO("heading ", truth.heading);
    CHECK(seen.x - truth.x == doctest::Approx(-std::sin(truth.heading)));  // BARK: + sin
    CHECK(seen.y - truth.y == doctest::Approx(std::cos(truth.heading)));
  }
}

TEST_CASE("observers have the documented defaults, units and ranges") {
  CHECK(support::parameter_rows<cb::DelayedObserver<3>, cb::ObservationNoise, cb::OccludedObserver>() == &R"(
delayed | others | 3 | - | [0, 3]
delayed | own | 0 | - | [0, 3]
observation_noise | mean_along | 0 | m | [-1000, 1000]
observation_noise | mean_across | 0 | m | [-1000, 1000]
observation_noise | mean_heading | 0 | rad | [-4, 4]
observation_noise | mean_speed | 0 | m/s | [-1000, 1000]
observation_noise | along | 0 | m | [0, 1000]
observation_noise | across | 0 | m | [0, 1000]
observation_noise | heading | 0 | rad | [0, 4]
observation_noise | speed | 0 | m/s | [0, 1000]
observation_noise | along_across | 0 | - | [-1, 1]
observation_noise | along_heading | 0 | - | [-1, 1]
observation_noise | along_speed | 0 | - | [-1, 1]
observation_noise | across_heading | 0 | - | [-1, 1]
observation_noise | across_speed | 0 | - | [-1, 1]
observation_noise | heading_speed | 0 | - | [-1, 1]
occluded | range | 150 | m | [0, 1e+06]
occluded | field_of_view | 6.283185307179586 | rad | [0, 7]
occluded | resolution | 0.001 | rad | [0, 1]
occluded | behind_vehicles | false | - | -
occluded | behind_objects | false | - | -
occluded | objects_known | false | - | -
)"[1]);
  CHECK(support::parameter_rows<cb::ParametricObserver>().ends_with("\nparametric | lasting | 1 | - | [1, 1e+06]\n"));
}
