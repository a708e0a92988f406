#include "cambium/viewer/record_world.hpp"

#include <array>
#include <cmath>
#include <cstddef>

#include <doctest/doctest.h>

#include "cambium/behavior/behavior_set.hpp"
#include "cambium/behavior/drivers.hpp"
#include "cambium/dynamics/single_track.hpp"
#include "cambium/execution/interpolate.hpp"
#include "cambium/world/world.hpp"
#include "support/maps.hpp"

using namespace cambium;

TEST_CASE("each lane that leads to a light stops where the junction begins, across the lane") {
  auto const map = support::own_map("intersection_4way.xodr");
  auto const lines = recorded_stop_lines(*map);
  CHECK(lines.size() == 8);  // two lanes from each of four sides
  for (auto const& line : lines) {
    CHECK(is_valid(line.light));
    CHECK((line.left - line.right).norm() == doctest::Approx(3.5).epsilon(0.01));
    std::size_t ends = 0;
    for (auto const& lane : map->lanes()) {
      if (lane.successors.empty() || is_valid(map->road(lane.road).junction)) continue;
      auto const at = lane.path.pose(lane.length()).position();
      ends += (0.5 * (line.left + line.right) - at).norm() < 0.01;
    }
    CHECK(ends == 1);
  }
  CHECK(recorded_stop_lines(*support::own_map("merging.xodr")).empty());
}

using Sim = World<BehaviorSet<IdmClassic>, InterpolateExecution, SingleTrack>;

TEST_CASE("a recording has objects as rectangles along their longest side, and agents from when they enter") {
  Sim world(support::straight_road(2, 200));
  auto const first = world.add({.position = {50, -1.75}, .speed = 5});
  world.add_object(geometry::Polygon({{100, -3}, {104, -1}, {103, 1}, {99, -1}}));
  WorldRecorder recorder(world, "an object");
  auto const late = world.add({.position = {20, -1.75}, .speed = 5});
  REQUIRE(world.step(0.2));
  recorder.record(world);
  recorder.show_as(first, RecordedAgentKind::ego, "me");
  auto const& [title, lanes, stop_lines, agents, frames, notes] = recorder.recording();
  CHECK(title == "an object");
  CHECK(lanes.size() == 2);
  REQUIRE(agents.size() == 3);
  CHECK(agents[0].kind == RecordedAgentKind::ego);
  CHECK(agents[0].label == "me");
  CHECK(agents[1].id == late);
  CHECK(agents[1].kind == RecordedAgentKind::other);
  CHECK(agents[2].kind == RecordedAgentKind::static_object);
  CHECK(agents[2].label == "object 0");
  auto const& shape = agents[2].shape;
  for (double const side : {shape.front, shape.rear}) CHECK(side == doctest::Approx(std::sqrt(5.0)));
  for (double const side : {shape.left, shape.right}) CHECK(side == doctest::Approx(0.5 * std::sqrt(5.0)));
  REQUIRE(frames.size() == 2);
  for (auto const& frame : frames) {
    REQUIRE(frame.poses.size() == 3);
    CHECK(frame.poses[0].present);
    CHECK(frame.poses[1].present == (frame.time > 0.0));
    CHECK(frame.poses[2].x == 101.5);
    CHECK(frame.poses[2].y == -1.0);
    CHECK(frame.poses[2].heading == doctest::Approx(std::atan2(2.0, 4.0)));
  }
  auto const& state = world.state(late);
  auto const& pose = frames[1].poses[1];
  CHECK(std::array{pose.x, pose.y, pose.heading, pose.speed, pose.acceleration} ==
        std::array{state.x, state.y, state.heading, state.speed, double{world.record(late).acceleration}});
}

TEST_CASE("a recording has the colours that the world's lights show, and where everybody is") {
  Sim world(support::own_map("intersection_4way.xodr"));
  auto const from = world.map().find_lane("1", 30.0, -1);
  auto const at = world.map().lane(from).path.pose(20.0);
  world.add({.position = at.position(), .heading = at.heading, .speed = 5.0});
  world.set_light(LightId{1}, {.cycle = 20.0, .green_begin = 0.0, .green_end = 0.9, .yellow = 1.0});
  WorldRecorder recorder(world);
  for (int i = 0; i < 15; ++i) {
    REQUIRE(world.step(0.2));
    recorder.record(world);
  }
  auto const& recording = recorder.recording();
  CHECK(recording.stop_lines.size() == 8);
  REQUIRE(recording.frames.size() == 16);
  for (auto const& frame : recording.frames) {
    using map::LightColor;
    REQUIRE(frame.lights.size() == 2);
    CHECK(frame.lights[0] == LightColor::off);
    CHECK(frame.lights[1] == (frame.time < 0.9   ? LightColor::green
                              : frame.time < 1.9 ? LightColor::yellow
                                                 : LightColor::red));
  }
  CHECK(recording.frames.back().poses.at(0).x == world.frame().agents[0].state.x);
}
