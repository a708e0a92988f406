// The drivable area against a twin that looks at points all around the vehicle.
#include "cambium/evaluation/drivable_area.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "../world/fixtures.hpp"
#include "cambium/core/distributions.hpp"

using namespace fixtures;
using cb::geometry::Point;

namespace {

double between(double low, double high, cb::RandomStream& random) { return low + (high - low) * cb::uniform01(random); }

bool is_off(cb::Map const& map, Point const& p) { return !map.on_drivable_lane(p); }

/// How far `p` is from the nearest drivable lane [m], up to 1 m.
double beyond(cb::Map const& map, Point const& p) {
  for (auto const& hit : map.lanes_near(p, 1.0))
    if (map.lane(hit.lane).drivable()) return hit.distance;
  return 1.0;
}

/// Points on the border of a box, `spacing` m apart or less, with the corners.
template <class F>
void around(cb::geometry::OrientedBox const& box, double spacing, F const& f) {
  auto const corners = box.corners();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    Point const a = corners[i], b = corners[(i + 1) % corners.size()];
    int const parts = static_cast<int>(std::ceil((b - a).norm() / spacing));
    for (int k = 0; k < parts; ++k) f(Point(a + (b - a) * (static_cast<double>(k) / parts)));
  }
}

/// What the twin says of the agent: the vehicle's farthest reach beyond the road [m].
double farthest_beyond(Sim const& world, cb::AgentId id) {
  auto const slot = world.slot_of(id);
  double farthest = 0;
  around(cb::geometry::box_of(world.roster().agents[slot].shape, world.state(id)), 0.05, [&](Point const& p) {
    if (is_off(world.map(), p)) farthest = std::max(farthest, beyond(world.map(), p));
  });
  return farthest;
}

struct Count {
  int off = 0, on = 0;
};

/// Puts an agent on the lanes of a map at random, straight or slanting, near the middle or over the border, but away from the ends
/// of the road, and compares.
Count compare(std::shared_ptr<cb::Map const> const& map, std::uint32_t places) {
  Count count;
  cb::RandomStream random(5, 0, 0);
  for (auto const& lane : map->lanes()) {
    if (!lane.drivable() || lane.length() < 30) continue;
    Sim world(map);
    cb::geometry::Shape const shape = lane.number % 2 == 0 ? cb::geometry::truck() : cb::geometry::car();
    auto const id = world.add({.position = lane.path.pose(lane.length() / 2).position(), .shape = shape});
    for (std::uint32_t k = 0; k < places; ++k) {
      auto const pose = lane.path.pose(between(12, lane.length() - 12, random));
      double const aside = between(-3.0, 3.0, random), turn = k % 2 == 0 ? between(-0.05, 0.05, random) : between(-1.6, 1.6, random);
      auto const at = cb::geometry::to_map(pose, {0.0, aside});
      world.set_state(id, {.x = at.x(), .y = at.y(), .heading = pose.heading + turn, .speed = 5});
      bool const off = cb::DrivableArea{id}.evaluate(world).off_road;
      double const farthest = farthest_beyond(world, id);
      // Between the corners and the middles of its sides the vehicle is looked at by the twin alone.
      constexpr double overlooked = 0.1;  // [m]
      CAPTURE(map->describe(lane.id));
      CAPTURE(at.x());
      CAPTURE(at.y());
      CAPTURE(turn);
      if (off) CHECK(farthest > 0.0);
      if (!off) CHECK(farthest < overlooked);
      (off ? count.off : count.on) += 1;
    }
  }
  return count;
}

}  // namespace

TEST_CASE("off the road is who reaches beyond the drivable lanes, as a brute-force twin finds") {
  for (auto const* name : {"highway.xodr", "merging.xodr", "lane_drop.xodr"}) {
    auto const count = compare(own_map(name), 300);
    MESSAGE(name << ": " << count.off << " off the road, " << count.on << " on it");
    CHECK(count.off > 100);
    CHECK(count.on > 100);
  }
}

TEST_CASE("on a narrow bend the border of the road is met where it is") {
  auto const map = straight_road(1, 60, 0.05);
  auto const count = compare(map, 3000);
  CHECK(count.off > 100);
  CHECK(count.on > 100);
}

TEST_CASE("a vehicle that crosses from lane to lane stays on the road, one that crosses its border does not") {
  Sim world(straight_road(2));
  auto const id = world.add({.position = {100, -1.75}});
  auto const off_at = [&](double y) {
    world.set_state(id, {.x = 100, .y = y});
    return cb::DrivableArea{id}.evaluate(world).off_road;
  };
  CHECK_FALSE(off_at(-3.5));
  CHECK_FALSE(off_at(-0.92));
  CHECK_FALSE(off_at(-6.08));
  CHECK(off_at(-0.85));
  CHECK(off_at(-6.15));
}

TEST_CASE("where the map ends the road does not: who drives out of it is not off the road, unless beside it") {
  Sim world(straight_road(1, 100));
  auto const id = world.add({.position = {50, -1.75}});
  auto const off_at = [&](double x, double y) {
    world.set_state(id, {.x = x, .y = y});
    return cb::DrivableArea{id}.evaluate(world).off_road;
  };
  CHECK_FALSE(off_at(98, -1.75));
  CHECK_FALSE(off_at(0.3, -1.75));
  CHECK(off_at(98, -0.5));
  CHECK(off_at(0.3, -3.2));
}

TEST_CASE("who has left traffic is not off the road") {
  Sim world(straight_road(1, 100));
  auto const id = world.add({.position = {98, -1.75}, .speed = 20, .behavior = cb::ConstantAcceleration{}});
  world.step(1.0);
  REQUIRE(world.status(id) == cb::AgentStatus::left_map);
  world.set_state(id, {.x = 50, .y = 30});
  CHECK_FALSE(cb::DrivableArea{id}.evaluate(world).off_road);
}

TEST_CASE("the road of an agent that is not there is an error") {
  Sim const world(straight_road(1, 100));
  CHECK_THROWS_AS((void)cb::DrivableArea{static_cast<cb::AgentId>(5)}.evaluate(world), cb::WorldError);
}
