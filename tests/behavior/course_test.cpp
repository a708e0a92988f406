#include "cambium/behavior/course.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "../world/fixtures.hpp"

using namespace fixtures;

namespace {

/// A course of six states on an arc, `step` rad apart, that starts at the agent of `view`.
template <class View>
cb::Plan<View> arc_from(View const& view, double radius, double step) {
  cb::Plan<View> plan;
  auto const begin = view.state();
  for (int k = 1; k <= 6; ++k) {
    double const turn = k * step;
    auto at = begin;
    at.x += radius * (std::sin(begin.heading + turn) - std::sin(begin.heading));
    at.y -= radius * (std::cos(begin.heading + turn) - std::cos(begin.heading));
    at.heading += turn;
    plan.trajectory.push_back(at);
  }
  plan.action = {1.0, 0.1};
  return plan;
}

}  // namespace

TEST_CASE("the length of a course is that of the arcs between its states") {
  Sim world(straight_road(1, 500));
  auto const id = world.add({.position = {10, -1.75}, .speed = 10});
  auto const view = world.observe(id);
  CHECK(cb::detail::course_length(cb::Plan<decltype(view)>{}, view.state()) == 0.0);
  for (double const radius : {15.0, -15.0, 80.0}) {
    auto const plan = arc_from(view, radius, std::copysign(0.1, radius));
    CHECK(cb::detail::course_length(plan, view.state()) == doctest::Approx(0.6 * std::abs(radius)).epsilon(1e-5));
  }
}

TEST_CASE("a plan along a course stays on it for any motion, and goes straight on beyond its end") {
  Sim world(straight_road(1, 500));
  auto const id = world.add({.position = {10, -1.75}, .speed = 10});
  auto const view = world.observe(id);
  auto const begin = view.state();
  double const radius = 30.0, angle = 0.6, length = radius * angle;
  auto const plan = arc_from(view, radius, angle / 6);
  for (double way = 0.0; way < 1.5 * length; way += 0.37) {
    CAPTURE(way);
    auto const result = cb::detail::plan_along_course(view, plan, {.distance = way, .speed = 7.0}, 0.4);
    REQUIRE(result.trajectory.size() == 1);
    auto const& at = result.trajectory.front();
    double const turn = std::min(way / radius, angle), beyond = std::max(0.0, way - length);
    CHECK(at.x == doctest::Approx(begin.x + radius * std::sin(turn) + beyond * std::cos(turn)).epsilon(1e-4));
    CHECK(at.y == doctest::Approx(begin.y + radius * (1.0 - std::cos(turn)) + beyond * std::sin(turn)).epsilon(1e-4));
    CHECK(at.heading == doctest::Approx(turn).epsilon(1e-3));
    CHECK(at.speed == 7.0);
    CHECK(at.time == doctest::Approx(view.time() + 0.4));
    CHECK(result.action.steering == plan.action.steering);
  }
}

TEST_CASE("a plan along a course to a place beside it turns no farther than the course does") {
  Sim world(straight_road(1, 500));
  auto const view = world.observe(world.add({.position = {10, -1.75}, .speed = 1}));
  auto end = view.state();
  end.x += 0.01;
  end.y += 0.0002;
  end.heading += 0.001;
  cb::Plan<decltype(view)> plan;
  plan.trajectory.push_back(end);
  for (double const share : {0.1, 0.5, 0.9}) {
    auto const at = cb::detail::plan_along_course(view, plan, {.distance = share * 0.01, .speed = 1.0}, 0.01);
    CHECK(at.trajectory.front().heading == doctest::Approx(share * 0.001).epsilon(1e-6));
  }
}
