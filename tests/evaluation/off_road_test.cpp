// The drivable area against a twin that looks at points all around the vehicle.
#include "cambium/evaluation/off_road.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "../world/fixtures.hpp"
#include "cambium/core/distributions.hpp"
#include "cambium/map/road/curve_layout.hpp"

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

/// What the twin says of an agent.
struct Twin {
  bool off = false;       ///< a corner or the middle of a side is beyond the road
  double farthest = 0.0;  ///< any point of the border [m]
};

Twin look(Sim const& world, cb::AgentId id) {
  constexpr int parts = 100;  // of each side
  auto const corners = cb::geometry::box_of(world.roster().agents[world.slot_of(id)].shape, world.state(id)).corners();
  Twin twin;
  for (std::size_t i = 0; i < corners.size(); ++i)
    for (int k = 0; k < parts; ++k) {
      Point const p = corners[i] + (corners[(i + 1) % corners.size()] - corners[i]) * (k / double{parts});
      if (!is_off(world.map(), p)) continue;
      twin.off = twin.off || k % (parts / 2) == 0;
      twin.farthest = std::max(twin.farthest, beyond(world.map(), p));
    }
  return twin;
}

struct Count {
  int off = 0, on = 0;
};

/// Puts an agent on the lanes of a map at random, straight or slanting, near the middle or over the border, but away
/// from the ends of the road, and compares. Who drives along the road and is not off it reaches `overlooked` m beyond
/// it at most.
Count compare(std::shared_ptr<cb::Map const> const& map, std::uint32_t places, double overlooked) {
  Count count;
  cb::RandomStream random(5, 0, 0);
  for (auto const& lane : map->lanes()) {
    if (!lane.drivable() || lane.length() < 30) continue;
    Sim world(map);
    cb::geometry::Shape const shape = lane.number % 2 == 0 ? cb::geometry::truck() : cb::geometry::car();
    auto const id = world.add({.position = lane.path.pose(lane.length() / 2).position(), .shape = shape});
    for (std::uint32_t k = 0; k < places; ++k) {
      auto const pose = lane.path.pose(between(12, lane.length() - 12, random));
      bool const along = k % 2 == 0;
      double const aside = between(-3.0, 3.0, random),
                   turn = along ? between(-0.05, 0.05, random) : between(-1.3, 1.3, random);
      auto const at = cb::geometry::to_map(pose, {0.0, aside});
      world.set_state(id, {.x = at.x(), .y = at.y(), .heading = pose.heading + turn, .speed = 5});
      bool const off = cb::OffRoad{}(world, world.slot_of(id));
      auto const twin = look(world, id);
      CAPTURE(map->describe(lane.id));
      CAPTURE(at.x());
      CAPTURE(at.y());
      CAPTURE(turn);
      CHECK(off == twin.off);
      if (!off && along) CHECK(twin.farthest <= overlooked);
      (off ? count.off : count.on) += 1;
    }
  }
  return count;
}

}  // namespace

TEST_CASE("agents that reach beyond the drivable lanes are off the road, as a brute-force twin finds") {
  // Where a ramp parts from the road, the tip of what is between them fits between two of the points that are looked
  // at.
  for (auto const& [name, overlooked] :
       {std::pair<std::string, double>{"highway.xodr", 0.1}, {"lane_drop.xodr", 0.1}, {"merging.xodr", 0.5}}) {
    auto const count = compare(own_map(name), 200, overlooked);
    MESSAGE(name << ": " << count.off << " off the road, " << count.on << " on it");
    CHECK(count.off > 100);
    CHECK(count.on > 100);
  }
}

TEST_CASE("beside a lane whose width changes, along bends to both sides, the road ends where that lane does") {
  cb::map::LanePlan const own{}, opens{.width = 1.0, .end_width = 4.0}, closes{.width = 4.0, .end_width = 1.0};
  for (double const curvature : {-0.02, 0.0, 0.02})
    for (auto const& beside : {opens, closes}) {
      CAPTURE(curvature);
      CAPTURE(beside.width);
      auto const map = support::map_of({.id = "1",
                                        .line = cb::map::lay_from({}, {{150.0, curvature, curvature}}),
                                        .sections = {{.left = {own, beside}, .right = {own, beside}}}});
      auto const count = compare(map, 600, 0.15);
      CHECK(count.off > 400);
      CHECK(count.on > 400);
    }
}

TEST_CASE("on a narrow bend the border of the road is met where it is") {
  auto const map = straight_road(1, 60, 0.05);
  auto const count = compare(map, 2000, 0.15);
  CHECK(count.off > 100);
  CHECK(count.on > 100);
}

namespace {

/// A road of one lane, 3.5 m wide: 40 m straight on, arcs of that length and those curvatures, 40 m straight on.
std::shared_ptr<cb::Map const> bends(std::vector<double> const& curvatures, double length) {
  std::vector<cb::map::CurvePiece> pieces{{40.0}};
  for (double const curvature : curvatures) pieces.push_back({length, curvature, curvature});
  pieces.push_back({40.0});
  return support::map_of({.line = cb::map::lay_from({}, pieces),
                          .sections = {{.right = cb::map::equal_lanes(1)}},
                          .lane_offset = {{0.0, 1.75, 0.0, 0.0, 0.0}}});
}

/// Vehicles of all sizes at random along such a road.
Count compare_on_bends(std::vector<double> const& curvatures, double length, std::uint32_t seed) {
  auto const map = bends(curvatures, length);
  auto const& path = map->lanes()[0].path;
  Count count;
  cb::RandomStream random(seed, 1, 0);
  for (auto const& shape : {cb::geometry::car(), cb::geometry::van(), cb::geometry::truck(), cb::geometry::bus(),
                            cb::geometry::articulated_truck()}) {
    Sim world(map);
    auto const id = world.add({.position = path.pose(20).position(), .shape = shape});
    for (int k = 0; k < 200; ++k) {
      auto const pose = path.pose(between(18, path.length() - 18, random));
      auto const at = cb::geometry::to_map(pose, {0.0, k % 2 == 0 ? 0.0 : between(-0.8, 0.8, random)});
      double const turn = k % 3 == 0 ? 0.0 : between(-0.1, 0.1, random);
      world.set_state(id, {.x = at.x(), .y = at.y(), .heading = pose.heading + turn, .speed = 5});
      bool const off = cb::OffRoad{}(world, world.slot_of(id));
      CAPTURE(curvatures[0]);
      CAPTURE(curvatures.size());
      CAPTURE(length);
      CAPTURE(shape.front);
      CAPTURE(world.record(id).lane.s);
      CAPTURE(world.record(id).lane.lateral);
      CAPTURE(world.record(id).lane.heading_error);
      CHECK(off == look(world, id).off);
      (off ? count.off : count.on) += 1;
    }
  }
  return count;
}

}  // namespace

TEST_CASE("a truck that enters a tight bend along its lane leaves the road with its front, a car does not") {
  for (double const side : {1.0, -1.0}) {
    auto const map = bends({side / 12.0}, 15.0);
    for (bool const truck : {true, false}) {
      Sim world(map);
      auto const id =
          world.add({.position = {38, 0}, .speed = 5, .shape = truck ? cb::geometry::truck() : cb::geometry::car()});
      CHECK(world.record(id).lane.lateral == doctest::Approx(0.0));
      CHECK(world.record(id).lane.heading_error == doctest::Approx(0.0));
      CHECK(cb::OffRoad{}(world, world.slot_of(id)) == truck);
      CHECK(look(world, id).off == truck);
      world.set_state(id, {.x = 20, .y = 0, .speed = 5});  // well before
      CHECK_FALSE(cb::OffRoad{}(world, world.slot_of(id)));
    }
  }
}

TEST_CASE("on bends of any radius, alone or to both sides one after the other, the road is where the map says") {
  for (bool const both : {false, true}) {
    Count count;
    cb::RandomStream random(both ? 9 : 8, 0, 0);
    for (std::uint32_t i = 0; i < 60; ++i) {
      double const least = both ? 8.0 : 6.0, most = both ? 96.0 : 180.0;
      double const radius = least * std::pow(most / least, cb::uniform01(random)), side = i % 2 == 0 ? 1.0 : -1.0;
      std::vector<double> curvatures{side / radius};
      if (both) curvatures.push_back(-side / radius);
      auto const some = compare_on_bends(curvatures, both ? between(3, 10, random) : std::min(40.0, 2.5 * radius), i);
      count.off += some.off;
      count.on += some.on;
    }
    MESSAGE(count.off << " off the road, " << count.on << " on it");
    CHECK(count.off > 5000);
    CHECK(count.on > 5000);
  }
}

TEST_CASE("a vehicle is off the road across its border, not from lane to lane nor past the end of the map") {
  struct Case {
    int lanes;
    double x, y;
    bool off;
  };
  for (auto const& [lanes, x, y, off] :
       {Case{2, 50, -3.5, false}, Case{2, 50, -0.92, false}, Case{2, 50, -6.08, false}, Case{2, 50, -0.85, true},
        Case{2, 50, -6.15, true}, Case{1, 98, -1.75, false}, Case{1, 0.3, -1.75, false}, Case{1, 98, -0.5, true},
        Case{1, 0.3, -3.2, true}}) {
    CAPTURE(x);
    CAPTURE(y);
    Sim world(straight_road(lanes, 100));
    auto const id = world.add({.position = {50, -1.75}});
    world.set_state(id, {.x = x, .y = y});
    CHECK(cb::OffRoad{}(world, world.slot_of(id)) == off);
  }
}

TEST_CASE("a long vehicle straddles the border of a tight bend, a short one does not") {
  struct Case {
    double radius;
    cb::geometry::Shape shape;
    bool straddles;
  };
  for (auto const& [radius, shape, straddles] :
       {Case{15, cb::geometry::truck(), true}, Case{25, cb::geometry::truck(), true},
        Case{100, cb::geometry::truck(), false}, Case{15, cb::geometry::car(), false}})
    for (double const turn : {1.0, -1.0}) {  // to the left, to the right
      CAPTURE(radius);
      CAPTURE(turn);
      Sim world(straight_road(2, 60, turn / radius));
      auto const pose = world.map().lanes().front().path.pose(30.0);
      auto const id = world.add({.position = pose.position(), .heading = pose.heading, .shape = shape});
      CHECK(cb::Straddles{}(world, world.slot_of(id)) == straddles);
    }
}

TEST_CASE("agents that have left traffic are not off the road") {
  Sim world(straight_road(1, 100));
  auto const id = world.add({.position = {98, -1.75}, .speed = 20, .behavior = cb::ConstantAcceleration{}});
  REQUIRE(world.step(1.0));
  REQUIRE(world.status(id) == cb::AgentStatus::left_map);
  CHECK_FALSE(cb::OffRoad{}(world, world.slot_of(id)));
  world.set_state(id, {.x = 50, .y = 2});  // back in traffic
  CHECK(cb::OffRoad{}(world, world.slot_of(id)));
}

TEST_CASE("a vehicle between two lanes is on the road up to the end of the map") {
  for (auto const* name : {"highway.xodr", "intersection_4way.xodr", "merging.xodr"}) {
    Sim world(support::own_map(name));
    int tried = 0;
    for (auto const& lane : world.map().lanes()) {
      if (!lane.drivable() || !lane.successors.empty() || lane.length() < 30.0 || !cb::is_valid(lane.left_neighbor) ||
          cb::is_valid(lane.merges_into) || !world.map().lane(lane.left_neighbor).drivable() ||
          cb::is_valid(world.map().lane(lane.left_neighbor).merges_into) ||
          world.map().lane(lane.left_neighbor).along_road != lane.along_road)
        continue;
      for (double const left : {10.0, 5.0, 3.0, 1.0}) {
        auto const pose = lane.path.pose(lane.length() - left);
        double const aside = lane.widths.back().left;
        auto const ego = world.slot_of(
            world.add({.position = {pose.x - aside * std::sin(pose.heading), pose.y + aside * std::cos(pose.heading)},
                       .heading = pose.heading}));
        CAPTURE(name);
        CAPTURE(left);
        CHECK_FALSE(cb::OffRoad{}(world, ego));
        world.remove(world.roster().agents[ego].id);
        ++tried;
      }
    }
    CHECK(tried > 0);
  }
}
