// IDM traffic hardly depends on the step length: within a step it is exact, between agents of first order.
#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "fixtures.hpp"

using namespace fixtures;

namespace {

/// Positions after `duration` s of a column of vehicles behind one that brakes and stands.
std::vector<double> column(double dt, double duration) {
  Sim world(straight_road(1, 2000.0));
  for (int i = 0; i < 8; ++i) {
    cb::IdmClassic driver;
    driver.law.desired_speed = 14 + i % 3;
    Sim::AgentSpec spec{.position = {200.0 - 22.0 * i, -1.75}, .speed = 12.0, .behavior = driver};
    if (i == 0) spec.behavior = cb::ConstantAcceleration{.acceleration = -1.0};
    world.add(spec);
  }
  auto const steps = std::lround(duration / dt);
  for (long k = 0; k < steps; ++k) REQUIRE(world.step(dt));
  std::vector<double> x;
  for (auto const& record : world.frame().agents) x.push_back(record.state.x);
  return x;
}

double difference(std::vector<double> const& a, std::vector<double> const& b) {
  double worst = 0;
  for (std::size_t i = 0; i < a.size(); ++i) worst = std::max(worst, std::abs(a[i] - b[i]));
  return worst;
}

}  // namespace

TEST_CASE("halving the step halves the error of IDM traffic: order one between agents") {
  auto const finest = column(0.0125, 12.0);
  double previous = 0;
  for (double dt : {0.4, 0.2, 0.1}) {
    double const error = difference(column(dt, 12.0), finest);
    MESSAGE("dt " << dt << " s: largest position error " << error << " m");
    CHECK(error < 4.0 * dt);
    if (previous > 0) CHECK(previous / error > 1.6);
    previous = error;
  }
}

TEST_CASE("a vehicle on a free road, or behind a steady leader, is exact for any step length, but for bounded jerk") {
  auto const travelled = [](double dt, bool leader, double jerk = 1e6) {
    Sim world(straight_road(1, 2000.0));
    auto const id = world.add({.position = {10, -1.75}, .speed = 3.0, .behavior = cb::IdmClassic{.jerk = jerk}});
    if (leader) world.add({.position = {60, -1.75}, .speed = 8.0, .behavior = cb::ConstantAcceleration{}});
    for (long k = 0; k < std::lround(12.0 / dt); ++k) REQUIRE(world.step(dt));
    return world.state(id).x;
  };
  for (bool leader : {false, true}) {
    double const fine = travelled(0.01, leader);
    for (double dt : {0.1, 0.2, 0.5, 2.0}) CHECK(std::abs(travelled(dt, leader) - fine) < 5e-3);
    double const fine_bounded = travelled(0.01, leader, 2.5);
    for (double dt : {0.1, 0.2, 0.5}) CHECK(std::abs(travelled(dt, leader, 2.5) - fine_bounded) < 6.0 * dt);
  }
}
