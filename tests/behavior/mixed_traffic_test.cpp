// Cars, bicycles and pedestrians in one world, each with its own dynamics.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "cambium/map/road/curve_layout.hpp"

#include "lane_traffic_fixtures.hpp"

using namespace lane_traffic;

namespace {

using Mixed = cb::World<cb::BehaviorSet<cb::Pedestrian, cb::IdmLaneTracking>, cb::StanleyExecution,
                        cb::DynamicSet<cb::SingleTrack, cb::KinematicPoint>>;

/// A lane for cars, one for bicycles and a sidewalk, in a wide bend.
std::shared_ptr<cb::Map const> street() {
  using cb::map::LaneType;
  return support::map_of(
      {.id = "1",
       .line = cb::map::lay_from({}, {{400.0, 0.005, 0.005}}),
       .sections = {
           {.right = {{}, {.type = LaneType::biking, .width = 2.0}, {.type = LaneType::sidewalk, .width = 3.0}}}}});
}

cb::map::Lane const& lane_of(cb::Map const& map, cb::map::LaneType type) {
  return *std::find_if(map.lanes().begin(), map.lanes().end(), [type](auto const& lane) { return lane.type == type; });
}

cb::AgentId enter(Mixed& world, cb::map::LaneType type, double s, Mixed::AgentSpec spec) {
  auto const& lane = lane_of(world.map(), type);
  spec.position = lane.path.pose(s).position();
  if (!spec.road) spec.route = cb::map::straight_route(world.map(), lane.id);
  return world.add(spec);
}

}  // namespace

TEST_CASE("cars, cyclists and pedestrians with their own dynamics follow their ways and do not touch") {
  auto const map = street();
  Mixed world(map, {.seed = 2});
  using cb::map::LaneType;
  auto const car = enter(world, LaneType::driving, 10.0,
                         {.speed = 8.0, .behavior = cb::IdmLaneTracking{.law = {.desired_speed = 12.0}}});
  auto const cyclist = enter(world, LaneType::biking, 20.0,
                             {.speed = 3.0,
                              .shape = cb::geometry::bicycle(),
                              .behavior = cb::IdmLaneTracking{.law = cb::presets::cyclist()},
                              .dynamics = cb::presets::bicycle_dynamics()});
  auto const walker = enter(world, LaneType::sidewalk, 10.0,
                            {.shape = cb::geometry::pedestrian(),
                             .behavior = cb::Pedestrian{},
                             .dynamics = cb::presets::pedestrian_dynamics()});
  // A pedestrian loiters in the car's lane, 120 m ahead.
  auto const& driving = lane_of(*map, LaneType::driving);
  auto const there = driving.path.pose(130.0);
  cb::geometry::Point const aside{-std::sin(there.heading), std::cos(there.heading)};
  std::vector<cb::geometry::Point> const points{there.position() + 8.0 * aside, there.position() - 10.0 * aside};
  auto const slow = world.add({.position = there.position() + 1.0 * aside,
                               .shape = cb::geometry::pedestrian(),
                               .behavior = cb::Pedestrian{.social = {.desired_speed = 0.1}},
                               .road = cb::map::build_free_corridor(*map, points),
                               .dynamics = cb::presets::pedestrian_dynamics()});
  double slowest = 100.0, farthest = 0.0;
  for (int i = 0; i < 250; ++i) {
    drive_safely(world, 1, 0.1);
    slowest = std::min(slowest, world.state(car).speed);
    if (i > 50) farthest = std::max(farthest, std::abs(world.record(cyclist).lane.lateral));
  }
  CHECK(world.status(slow) == cb::AgentStatus::driving);
  CHECK(slowest < 0.3);
  CHECK(world.record(car).lane.s < 130.0 - 3.6);
  CHECK(world.state(cyclist).speed == doctest::Approx(5.0).epsilon(0.03));
  CHECK(world.record(cyclist).lane.s > 100.0);
  CHECK(farthest < 0.1);
  CHECK(world.record(walker).lane.s == doctest::Approx(10.0 + 1.34 * 24.5).epsilon(0.06));
  CHECK(std::abs(world.record(walker).lane.lateral) < 1.2);
}

TEST_CASE("cars and bicycles in one lane follow each other without contact and make progress") {
  auto const road = support::straight_road(1, 2000.0);
  using Queue = Traffic<cb::Intersection>;
  for (std::uint32_t seed = 0; seed < 40; ++seed) {
    CAPTURE(seed);
    cb::RandomStream random(seed, 3, 0);
    Queue world(road, {.seed = seed});
    std::vector<double> begins;
    double s = 10.0;
    for (int i = 0; i < 10; ++i) {
      bool const cycles = cb::uniform01(random) < 0.4;
      double const most = cycles ? cb::presets::cyclist().desired_speed : 14.0, speed = most * cb::uniform01(random);
      auto const idm = cycles ? cb::presets::cyclist() : cb::Idm{.desired_speed = 14.0};
      world.add({.position = {s, -1.75},
                 .speed = speed,
                 .shape = cycles ? cb::geometry::bicycle() : cb::geometry::car(),
                 .behavior = cb::Intersection{.law = idm},
                 .dynamics = cycles ? cb::presets::bicycle_dynamics() : cb::SingleTrack{}});
      begins.push_back(s);
      s += 8.0 + 40.0 * cb::uniform01(random);
      if (speed > 6.0) s += 20.0;
    }
    drive_safely(world, 400);
    for (std::size_t i = 0; i < world.size(); ++i)
      CHECK(world.frame().agents[i].lane.s > begins[i] + 300.0);  // 80 s at 18 km/h are 400 m
  }
}
