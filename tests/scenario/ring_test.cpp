// Traffic without beginning or end: IDM on a ring against the theory of traffic flow.
#include <doctest/doctest.h>

#include <cmath>
#include <complex>
#include <limits>

#include "../../examples/ring/ring_traffic.hpp"
#include "cambium/behavior/presets.hpp"

namespace cb = cambium;
namespace presets = cambium::presets;

namespace {

/// How strong the wave of `m` periods round the ring is in the speeds [m/s].
double amplitude(ring::Sim const& world, int m) {
  std::complex<double> sum = 0.0;
  auto const n = static_cast<double>(world.size());
  for (std::size_t i = 0; i < world.size(); ++i)
    sum += std::polar(world.frame().agents[i].state.speed, -2 * cb::geometry::pi * m * static_cast<double>(i) / n);
  return std::abs(sum) / n;
}

/// Rate [1/s] at which that wave grows, from small beginnings.
double measured_growth(cb::RingRoad const& road, cb::Idm const& driver, int vehicles, int m, double step) {
  auto const wave = [=](int i) { return 0.05 * std::sin(2 * cb::geometry::pi * m * i / vehicles); };
  auto world = ring::start(road, driver, vehicles, wave, [](int) { return 0.0; });
  ring::measure(world, road.length, 100.0, step);  // the other root, which decays at once, is gone
  double const before = amplitude(world, m);
  ring::measure(world, road.length, 100.0, step);
  return std::log(amplitude(world, m) / before) / 100.0;
}

/// The wave of `m` periods round the ring in the speeds, or of those with up to 12 the strongest, by where it is.
struct Wave {
  int m{};
  double strength{}, phase{};
};
Wave strongest_wave(ring::Sim const& world, double length, int m = 0) {
  Wave best;
  for (int k = m > 0 ? m : 1; k <= (m > 0 ? m : 12); ++k) {
    std::complex<double> sum = 0.0;
    for (auto const& agent : world.frame().agents)
      sum += std::polar(agent.state.speed, 2 * cb::geometry::pi * k * agent.lane.s / length);
    if (std::abs(sum) > best.strength) best = {k, std::abs(sum), std::arg(sum)};
  }
  return best;
}

}  // namespace

TEST_CASE("a ring is closed: as long as asked for, and as seamless at its joints as elsewhere") {
  auto const road = cb::make_ring_road(1000.0, 3);
  CHECK(road.length == doctest::Approx(1000.0).epsilon(1e-4));
  CHECK(road.route.length == doctest::Approx(3 * road.length));
  for (double const s : {0.0, 499.9, 500.1, 999.9, 1500.0}) {
    auto const a = road.pose(s), b = road.pose(s + road.length), c = road.pose(s + 0.5);
    CHECK((a.position() - b.position()).norm() < 1e-6);
    CHECK((a.position() - c.position()).norm() == doctest::Approx(0.5).epsilon(1e-3));
  }
  CHECK_THROWS_AS((void)cb::make_ring_road(10.0, 1), cb::MapError);
  CHECK_THROWS_AS((void)cb::make_ring_road(std::numeric_limits<double>::quiet_NaN(), 1), cb::MapError);
  CHECK_THROWS_AS((void)cb::make_ring_road(1000.0, 0), cb::MapError);
}

TEST_CASE("small waves on a ring grow or decay at the rate of linear theory") {
  auto const road = cb::make_ring_road(1000.0, 10);
  auto const driver = presets::treiber_2000();
  auto const law = [&](double v, double s, double l) { return cb::idm_acceleration(driver, v, s, l); };
  int growing = 0, decaying = 0;
  for (int const vehicles : {25, 40, 60, 100})
    for (int const m : {1, 2, 4}) {
      auto const e = ring::equilibrium(driver, road.length, vehicles);
      double const expected =
          cb::linear_following(law, e.speed, e.gap).growth_rate(2 * cb::geometry::pi * m / vehicles);
      if (expected < -0.05) continue;  // gone before it is measured
      // Between agents a world's steps are of order one: two step lengths tell where the limit is.
      double const coarse = measured_growth(road, driver, vehicles, m, 0.2),
                   fine = measured_growth(road, driver, vehicles, m, 0.1), measured = 2 * fine - coarse;
      CAPTURE(vehicles);
      CAPTURE(m);
      CHECK(std::abs(measured - expected) < 1e-4 + 0.02 * std::abs(expected));
      CHECK((fine > 0.0) == (expected > 0.0));
      (expected > 0.0 ? growing : decaying)++;
    }
  CHECK(growing >= 8);
  CHECK(decaying >= 2);
}

TEST_CASE("string stable traffic keeps to the curve of equilibrium of flow and density, and no wave comes up") {
  auto const road = cb::make_ring_road(2000.0, 50);
  struct Case {
    cb::Idm driver;
    int vehicles;
  };
  for (auto const& one :
       {Case{presets::treiber_2000(), 10}, Case{presets::treiber_2000(), 20}, Case{presets::treiber_2000(), 30},
        Case{presets::kesting_2010_car(), 30}, Case{presets::kesting_2010_car(), 50},
        Case{presets::kesting_2010_car(), 200}, Case{presets::kesting_2010_car(), 270}}) {
    auto const driver = one.driver;
    int const vehicles = one.vehicles;
    CAPTURE(vehicles);
    auto const e = ring::equilibrium(driver, road.length, vehicles);
    REQUIRE(e.is_stable);
    auto world = ring::start_disturbed(road, driver, vehicles);
    ring::measure(world, road.length, 900.0, 0.25);
    auto const seen = ring::measure(world, road.length, 300.0, 0.25);
    CHECK(seen.drove);
    CHECK(seen.flow == doctest::Approx(e.flow).epsilon(1e-4));
    CHECK(seen.fastest - seen.slowest < 0.05);
  }
}

TEST_CASE(
    "a disturbance of unstable traffic becomes stop-and-go waves, which run upstream about as kinematic waves do") {
  auto const road = cb::make_ring_road(2000.0, 50);
  auto const driver = presets::treiber_2000();
  for (int const vehicles : {80, 120, 160, 200}) {
    CAPTURE(vehicles);
    auto const e = ring::equilibrium(driver, road.length, vehicles);
    REQUIRE_FALSE(e.is_stable);
    auto world = ring::start_disturbed(road, driver, vehicles);
    ring::measure(world, road.length, 1500.0, 0.25);
    auto const before = strongest_wave(world, road.length);
    auto const seen = ring::measure(world, road.length, 20.0, 0.25);
    auto const after = strongest_wave(world, road.length, before.m);
    CHECK(seen.drove);
    CHECK(seen.slowest < 2.0);
    CHECK(seen.fastest > e.speed + 3.0);
    CHECK(ring::measure(world, road.length, 300.0, 0.25).flow < 0.95 * e.flow);
    double const turn = cb::geometry::angle_difference(after.phase, before.phase);
    double const celerity = 3.6 * turn / (2 * cb::geometry::pi * before.m) * road.length / 20.0;
    double const slope =
        3.6 * road.length * (ring::equilibrium(driver, road.length, vehicles + 1).flow - e.flow);  // of the curve
    MESSAGE(vehicles << " vehicles: waves at " << celerity << " km/h, kinematic waves at " << slope);
    CHECK(celerity == doctest::Approx(slope).epsilon(0.2));
  }
}
