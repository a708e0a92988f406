// Pairs of vehicles side by side where two lanes become one: with RSS, and with drivers.
#include <doctest/doctest.h>

#include <array>
#include <cstdint>
#include <string>
#include <utility>

#include "../support/maps.hpp"
#include "../support/scale.hpp"
#include "cambium/behavior/drivers.hpp"
#include "cambium/behavior/open_loop/constant_acceleration.hpp"
#include "cambium/behavior/wrap/rss_conformant.hpp"
#include "cambium/core/distributions.hpp"
#include "cambium/dynamics/single_track.hpp"
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

/// Collisions of `support::runs(100)` pairs, whose shapes are these, driven by what `draw(random, speed)` returns.
template <class Draw>
std::uint32_t collisions(std::string const& name, std::array<geometry::Shape, 2> const& shapes, double dt,
                         Draw const& draw) {
  using Behavior = decltype(draw(std::declval<RandomStream&>(), 0.0));
  using Sim = World<BehaviorSet<Behavior>, InterpolateExecution, SingleTrack>;
  auto const map = support::own_map(name);
  auto const merge = merge_of(*map);
  std::uint32_t count = 0;
  for (std::uint32_t number = 0; number < support::runs(100); ++number) {
    RandomStream random(4, number, 0);
    double const speed = Uniform{5.0, 25.0}(random), distance = Uniform{67.0, 187.0}(random),
                 offset = Uniform{-6.0, 6.0}(random);
    Sim world(map, {.seed = number});
    auto const add = [&](geometry::Pose const& pose, geometry::Shape const& shape) {
      world.add({.position = pose.position(),
                 .heading = pose.heading,
                 .speed = speed,
                 .shape = shape,
                 .behavior = draw(random, speed)});
    };
    add(upstream(*map, merge.lane, merge.at, distance), shapes[0]);
    add(upstream(*map, merge.other, merge.other_at, distance + offset), shapes[1]);
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

constexpr auto car = geometry::car(), truck = geometry::truck();

/// A driver that keeps about the speed at which it starts, with a short headway.
template <class Driver>
Driver drawn(RandomStream& random, double speed) {
  Driver driver;
  driver.law.desired_speed = speed * Uniform{1.0, 1.05}(random);
  driver.law.time_headway = Uniform{0.9, 1.2}(random);
  driver.law.maximum_acceleration = Uniform{0.6, 1.2}(random);
  driver.law.comfortable_deceleration = Uniform{1.2, 2.0}(random);
  return driver;
}

}  // namespace

TEST_CASE("of two vehicles side by side before a merge, RSS lets one go first") {
  auto const draw = [](RandomStream&, double) { return RssConformant<ConstantAcceleration>{}; };
  for (std::string const name : {"lane_drop.xodr", "merging.xodr"})
    for (auto const& shape : {car, truck})
      for (double const dt : {0.1, 0.2, 0.5}) {
        CAPTURE(name);
        CAPTURE(shape.length());
        CAPTURE(dt);
        CHECK(collisions(name, {shape, shape}, dt, draw) == 0);
      }
}

TEST_CASE("without RSS most of these pairs collide") {
  auto const draw = [](RandomStream&, double) { return ConstantAcceleration{}; };
  CHECK(collisions("lane_drop.xodr", {car, car}, 0.2, draw) > support::runs(100) / 2);
}

TEST_CASE_TEMPLATE("drivers who come to a merge side by side let one go first, though one drives a little faster",
                   Driver, UrbanDriver, ZipMerge, AdaptiveCruiseControl, IdmClassic) {
  for (std::string const name : {"lane_drop.xodr", "merging.xodr"})
    for (auto const& shapes :
         {std::array{car, car}, std::array{car, truck}, std::array{truck, car}, std::array{truck, truck}})
      for (double const dt : {0.1, 0.5}) {
        CAPTURE(name);
        CAPTURE(shapes[0].length());
        CAPTURE(shapes[1].length());
        CAPTURE(dt);
        CHECK(collisions(name, shapes, dt, drawn<Driver>) == 0);
      }
}
