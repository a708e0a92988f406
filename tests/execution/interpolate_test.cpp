#include "cambium/execution/interpolate.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "cambium/dynamics/single_track_steering.hpp"
#include "cambium/dynamics/triple_integrator.hpp"
#include "cambium/geometry/angle.hpp"

namespace cb = cambium;

namespace {

using Plan = cb::BasicPlan<cb::State>;

cb::Executed<cb::State> execute(Plan const& plan, double time, cb::State const& now = {}) {
  return cb::InterpolateExecution{}.execute(plan, now, cb::SingleTrack{}, time);
}

/// x = 0, 1, 4, 9, 16 at 0.2 s.
Plan squares() {
  Plan plan;
  for (int i = 0; i < 5; ++i)
    plan.trajectory.push_back({.time = 0.2 * i, .x = 1.0 * i * i, .y = -1.0 * i, .heading = 0.1 * i, .speed = 2.0 * i});
  return plan;
}

}  // namespace

TEST_CASE("at a sample's time the state is the sample") {
  auto const plan = squares();
  for (auto const& sample : plan.trajectory) {
    auto const executed = execute(plan, sample.time);
    REQUIRE(executed.valid);
    CHECK(executed.state == sample);
  }
  CHECK(execute(plan, plan.trajectory.back().time).state == plan.trajectory.back());
}

TEST_CASE("between two samples every field runs linearly") {
  // BARK gives x = 3.5 here: it draws the line through its first two samples.
  auto const executed = execute(squares(), 0.7);
  REQUIRE(executed.valid);
  CHECK(executed.state.time == 0.7);
  CHECK(executed.state.x == doctest::Approx(12.5));
  CHECK(executed.state.y == doctest::Approx(-3.5));
  CHECK(executed.state.heading == doctest::Approx(0.35));
  CHECK(executed.state.speed == doctest::Approx(7.0));
}

TEST_CASE("nothing is extrapolated: before and after the plan, and of an empty one, there is no state") {
  auto const plan = squares();
  for (double const time : {-1.0, -1e-6, 0.8 + 1e-6, 2.0, std::numeric_limits<double>::quiet_NaN(),
                            std::numeric_limits<double>::infinity()})
    CHECK_FALSE(execute(plan, time).valid);
  CHECK_FALSE(execute({}, 0.0).valid);
  Plan single;
  single.trajectory.push_back({.time = 1.0, .x = 5.0});
  CHECK(execute(single, 1.0).state.x == 5.0);
  CHECK_FALSE(execute(single, 1.1).valid);
  CHECK_FALSE(execute(single, 0.9, {.time = 0.95}).valid);
  CHECK_FALSE(execute(single, 0.9, {.time = 1.0}).valid);
}

TEST_CASE("between now and a plan that begins later every field runs linearly too") {
  Plan plan;
  plan.trajectory.push_back({.time = 1.0, .x = 5.0, .y = -1.0, .heading = 0.4, .speed = 8.0});
  auto const executed = execute(plan, 0.75, {.time = 0.5, .x = 1.0, .heading = 0.2, .speed = 6.0});
  REQUIRE(executed.valid);
  CHECK(executed.state.x == doctest::Approx(3.0));
  CHECK(executed.state.y == doctest::Approx(-0.5));
  CHECK(executed.state.heading == doctest::Approx(0.3));
  CHECK(executed.state.speed == doctest::Approx(7.0));
}

TEST_CASE("times that differ by rounding only are the same") {
  auto const plan = squares();
  auto const late = execute(plan, 0.8 + 1e-12);
  REQUIRE(late.valid);
  CHECK(late.state.x == 16.0);
  CHECK(late.state.time == 0.8 + 1e-12);
  auto const early = execute(plan, -1e-12);
  REQUIRE(early.valid);
  CHECK(early.state.x == doctest::Approx(0.0));
}

TEST_CASE("the heading turns the short way over the border of a full turn") {
  for (double const turns : {0.0, 2.0, -4.0}) {
    Plan plan;
    plan.trajectory.push_back({.time = 0.0, .heading = cb::geometry::pi - 0.1});
    plan.trajectory.push_back({.time = 1.0, .heading = -cb::geometry::pi + 0.3 + turns * cb::geometry::pi});
    auto const executed = execute(plan, 0.25);
    REQUIRE(executed.valid);
    CHECK(cb::geometry::angle_difference(executed.state.heading, cb::geometry::pi) == doctest::Approx(0.0));
    CHECK(std::abs(cb::geometry::angle_difference(execute(plan, 0.75).state.heading, cb::geometry::pi + 0.2)) < 1e-12);
  }
}

TEST_CASE("two samples of one time do not disturb") {
  Plan plan;
  for (double const time : {0.0, 0.5, 0.5, 1.0}) plan.trajectory.push_back({.time = time, .x = time});
  CHECK(execute(plan, 0.5).state.x == doctest::Approx(0.5));
  CHECK(execute(plan, 0.6).state.x == doctest::Approx(0.6));
}

TEST_CASE(
    "fields that a vehicle model adds to its state are interpolated too, and at the time of a sample the state is the "
    "sample") {
  using Steering = cb::SingleTrackSteering::State;
  cb::BasicPlan<Steering> plan;
  for (int i = 0; i < 5; ++i)
    plan.trajectory.push_back(
        {.time = 0.2 * i, .x = 0.1 * i * i, .heading = 3.1 * i, .speed = 7.0, .steering = 0.07 * i});
  auto const at = [&](double time) {
    return cb::InterpolateExecution{}.execute(plan, plan.trajectory.front(), cb::SingleTrackSteering{}, time);
  };
  for (auto const& sample : plan.trajectory) {
    REQUIRE(at(sample.time).valid);
    CHECK(at(sample.time).state == sample);
  }
  CHECK(at(0.5).state.steering == doctest::Approx(0.175));
  CHECK(at(0.5).state.time == 0.5);
  using Accelerated = cb::TripleIntegrator::State;
  cb::BasicPlan<Accelerated> braking;
  braking.trajectory.push_back({.time = 1.0, .speed = 4.0, .acceleration = -6.0, .lateral_acceleration = 1.0});
  auto const executed =
      cb::InterpolateExecution{}.execute(braking, Accelerated{.speed = 7.0}, cb::TripleIntegrator{}, 0.25);
  REQUIRE(executed.valid);
  CHECK(executed.state.acceleration == doctest::Approx(-1.5));
  CHECK(executed.state.lateral_acceleration == doctest::Approx(0.25));
}
