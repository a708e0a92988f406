#include "cambium/viewer/record_world.hpp"

#include <cstddef>

#include <doctest/doctest.h>

#include "cambium/behavior/behavior_set.hpp"
#include "cambium/behavior/following/idm_classic.hpp"
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

TEST_CASE("a recording has the colours that the world's lights show, and where everybody is") {
  using Sim = World<BehaviorSet<IdmClassic>, InterpolateExecution, SingleTrack>;
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
