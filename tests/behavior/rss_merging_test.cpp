// RSS where two lanes become one: pairs of vehicles that keep their speeds unless RSS stops them.
#include <doctest/doctest.h>

#include <cstdint>
#include <string>

#include "../support/maps.hpp"
#include "../support/scale.hpp"
#include "cambium/behavior/open_loop/constant_acceleration.hpp"
#include "cambium/behavior/wrap/rss_conformant.hpp"
#include "cambium/core/distributions.hpp"
#include "cambium/evaluation/collision.hpp"
#include "cambium/execution/interpolate.hpp"
#include "cambium/world/world.hpp"

using namespace cambium;

namespace {

/// Two lanes that merge, and where: positions on their paths [m].
struct Merge {
  LaneId lane, other;
  double at, other_at;
};

Merge merge_of(Map const& map) {
  for (auto const& lane : map.lanes())
    for (auto const& overlap : lane.overlaps)
      if (overlap.kind == map::OverlapKind::merge) return {lane.id, overlap.other, overlap.begin, overlap.other_begin};
  FAIL("the map has no merge");
  return {};
}

/// The place `distance` [m] upstream of position `s` of a lane.
geometry::Pose upstream(Map const& map, LaneId lane, double s, double distance) {
  while (s < distance && !map.lane(lane).predecessors.empty()) {
    lane = map.lane(lane).predecessors.front();
    s += map.lane(lane).length();
  }
  return map.lane(lane).path.pose(s - distance);
}

/// Collisions of `support::runs(100)` pairs with and without RSS.
template <class Behavior>
std::uint32_t collisions(std::string const& name, geometry::Shape const& shape, double dt) {
  using Sim = World<BehaviorSet<Behavior>, InterpolateExecution, SingleTrack>;
  auto const map = support::own_map(name);
  auto const merge = merge_of(*map);
  std::uint32_t count = 0;
  for (std::uint32_t number = 0; number < support::runs(100); ++number) {
    RandomStream random(4, number, 0);
    double const speed = Uniform{5.0, 25.0}(random), distance = Uniform{67.0, 187.0}(random),
                 offset = Uniform{-6.0, 6.0}(random);
    Sim world(map, {.seed = number});
    for (auto const& pose : {upstream(*map, merge.lane, merge.at, distance),
                             upstream(*map, merge.other, merge.other_at, distance + offset)})
      world.add({.position = pose.position(), .heading = pose.heading, .speed = speed, .shape = shape});
    REQUIRE_FALSE(AnyCollision{}(world));
    bool hit = false;
    for (int step = 0; step * dt < 40.0 && !hit; ++step) {
      REQUIRE(world.step(dt));
      hit = AnyCollision{}(world);
    }
    count += hit;
  }
  return count;
}

}  // namespace

TEST_CASE("of two vehicles side by side before a merge, RSS lets one go first") {
  for (std::string const name : {"lane_drop.xodr", "merging.xodr"})
    for (auto const& shape : {geometry::car(), geometry::truck()})
      for (double const dt : {0.1, 0.2, 0.5}) {
        CAPTURE(name);
        CAPTURE(shape.length());
        CAPTURE(dt);
        CHECK(collisions<RssConformant<ConstantAcceleration>>(name, shape, dt) == 0);
      }
}

TEST_CASE("without RSS most of these pairs collide") {
  CHECK(collisions<ConstantAcceleration>("lane_drop.xodr", geometry::car(), 0.2) > support::runs(100) / 2);
}
