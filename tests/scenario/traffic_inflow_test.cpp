// Traffic that comes and goes at sources.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <numeric>
#include <vector>

#include "../support/maps.hpp"
#include "cambium/behavior/drivers.hpp"
#include "cambium/core/distributions.hpp"
#include "cambium/dynamics/single_track.hpp"
#include "cambium/evaluation/collision.hpp"
#include "cambium/execution/interpolate.hpp"
#include "cambium/scenario/ring_road.hpp"
#include "cambium/scenario/traffic_inflow.hpp"
#include "cambium/world/world.hpp"

using namespace cambium;

namespace {

using Sim = World<BehaviorSet<IdmClassic>, InterpolateExecution, SingleTrack>;
using Inflow = TrafficInflow<Sim>;

/// Cars and trucks that like to enter at 15 m/s.
Sim::AgentSpec next_vehicle(Map const& map, TrafficSource const& source, RandomStream& random) {
  bool const is_truck = uniform01(random) < 0.35;
  return {.speed = 15.0,
          .shape = is_truck ? geometry::truck() : geometry::car(),
          .behavior = IdmClassic{.law = {.desired_speed = 12.0 + 6.0 * uniform01(random)}},
          .route = random_route(map, source.lane, random, 3000.0)};
}

struct Tally {
  std::size_t entered = 0, left = 0;
  double hardest = 0.0;  ///< braking [m/s^2]
  bool collided = false;
  std::vector<double> speeds;
};

Tally drive(std::shared_ptr<Map const> const& map, double per_hour, double seconds, double dt, std::uint64_t seed) {
  Sim world(map, {.seed = seed});
  auto sources = find_sources(*map);
  for (auto& source : sources) source.per_hour = per_hour;
  Inflow inflow(*map, sources, seed);
  Tally tally;
  while (world.time() < seconds) {
    for (auto const &entered : inflow.enter(world, [&](TrafficSource const&source, RandomStream&random) {
           return next_vehicle(*map, source, random);
         })) {
      ++tally.entered;
      tally.speeds.push_back(world.state(entered.id).speed);
    }
    REQUIRE(world.step(dt));
    for (auto const& record : world.frame().agents)
      tally.hardest = std::max(tally.hardest, -record.action.acceleration);
    tally.collided = tally.collided || AnyCollision{}(world);
    for (auto const& left : inflow.leave(world)) {
      CHECK(left.status == AgentStatus::left_map);
      ++tally.left;
    }
  }
  CHECK(tally.entered == tally.left + world.size());
  return tally;
}

}  // namespace

TEST_CASE("the safe speed behind a vehicle is that of Krauss") {
  InflowRules const rules{.headway = 2.0, .minimum_gap = 2.0, .deceleration = 1.5};
  CHECK(rules.safe_speed(1.9, 10.0) == -1.0);
  CHECK(rules.safe_speed(2.0, 4.0) == 2.0);  // hypot(3, 4) - 3
  CHECK(rules.safe_speed(14.0, 0.0) == doctest::Approx(std::sqrt(45.0) - 3.0));
}

TEST_CASE("a saturated lane fills to its capacity, and nobody who enters has to brake hard") {
  auto const road = support::straight_road(1, 600.0);
  for (double const dt : {0.05, 0.2, 0.5})
    for (std::uint64_t seed = 0; seed < 5; ++seed) {
      auto const tally = drive(road, TrafficSource::saturated, 600.0, dt, seed);
      CAPTURE(dt);
      CAPTURE(seed);
      CHECK_FALSE(tally.collided);
      CHECK(tally.hardest < 3.0);
      CHECK(tally.entered > 200);  // 1200 an hour, with a third of trucks
    }
}

TEST_CASE("vehicles enter as often as a source demands, whatever the step, and the same ones for a seed") {
  auto const road = support::straight_road(3, 600.0);
  double const hours = 2.0;
  for (double const dt : {0.1, 0.5}) {
    auto const tally = drive(road, 300.0, 3600.0 * hours, dt, 4);
    double const expected = 3 * 300.0 * hours;
    CHECK(std::abs(static_cast<double>(tally.entered) - expected) < 4.0 * std::sqrt(expected));
  }
  auto const speeds = drive(road, 300.0, 600.0, 0.2, 4).speeds;
  CHECK(drive(road, 300.0, 600.0, 0.2, 4).speeds == speeds);
  CHECK(drive(road, 300.0, 600.0, 0.2, 5).speeds != speeds);
  CHECK(std::accumulate(speeds.begin(), speeds.end(), 0.0) ==
        doctest::Approx(2478.44).epsilon(1e-5));  // on every platform
}

TEST_CASE("a random route leaves a roundabout, and ends before it comes round on a ring without exits") {
  auto const check_length = [](Map const& map, map::Route const& route) {
    double length = 0.0;
    for (auto const lane : route.lanes) length += map.lane(lane).length();
    CHECK(route.length == doctest::Approx(length));
  };
  auto const map = support::own_map("roundabout.xodr");
  for (auto const& source : find_sources(*map))
    for (std::uint64_t seed = 1; seed <= 200; ++seed) {
      RandomStream random(seed, 0, 0);
      auto const route = random_route(*map, source.lane, random, 3000.0);
      check_length(*map, route);
      CHECK(map->lane(route.lanes.back()).successors.empty());
    }
  auto const ring = make_ring_road(1000.0, 1);
  RandomStream random(1, 0, 0);
  auto const route = random_route(*ring.map, ring.route.lanes.front(), random, 3000.0);
  check_length(*ring.map, route);
  CHECK(route.length == doctest::Approx(ring.length));
}

TEST_CASE("nobody enters into a queue that has grown back to the source, and they wait there") {
  auto const road = support::straight_road(1, 200.0);
  Sim world(road, {});
  world.add_object(geometry::Polygon({{60.0, -4.0}, {62.0, -4.0}, {62.0, 1.0}, {60.0, 1.0}}));
  Inflow inflow(*road, {{.lane = find_sources(*road).at(0).lane, .per_hour = 1200.0}}, 1);
  for (int step = 0; step < 1500; ++step) {
    inflow.enter(
        world, [&](TrafficSource const& source, RandomStream& random) { return next_vehicle(*road, source, random); });
    REQUIRE(world.step(0.2));
    REQUIRE_FALSE(AnyCollision{}(world));
  }
  CHECK(world.size() >= 3);
  CHECK(world.size() <= 10);
  CHECK(inflow.waiting(0) > 70);
  Inflow saturated(*road, {{.lane = find_sources(*road).at(0).lane, .per_hour = TrafficSource::saturated}}, 1);
  CHECK_NOTHROW(check_parameters(saturated));
  saturated.enter(
      world, [&](TrafficSource const& source, RandomStream& random) { return next_vehicle(*road, source, random); });
  CHECK(saturated.waiting(0) == 1);
  CHECK_NOTHROW(check_parameters(saturated));  // who waits has a place
}

TEST_CASE("nobody enters beside a vehicle that changes into the lane, in a bend as on a straight road") {
  for (double const curvature : {-0.005, 0.0, 0.005}) {
    auto const road = support::straight_road(2, 200.0, curvature);
    auto const left = road->nearest_lane({0.0, -1.75, 0.0})->lane, right = road->nearest_lane({0.0, -5.25, 0.0})->lane;
    for (bool const to_left : {true, false})
      for (double const turn : {-0.04, 0.0, 0.04}) {  // [rad], positive: towards the source
        Sim world(road, {});
        auto const pose = road->lane(to_left ? right : left).path.pose(12.0);
        world.add({.position = pose.position(), .heading = pose.heading + (to_left ? turn : -turn), .speed = 12.0});
        Inflow inflow(*road, {{.lane = to_left ? left : right, .per_hour = TrafficSource::saturated}}, 1);
        auto const draw = [](TrafficSource const&, RandomStream&) { return Sim::AgentSpec{.speed = 12.0}; };
        CAPTURE(curvature);
        CAPTURE(to_left);
        CHECK(inflow.enter(world, draw).size() == (turn > 0.0 ? 0 : 1));
      }
  }
}

TEST_CASE("sources are where traffic can enter a map; wrong ones are refused with a sentence") {
  CHECK(find_sources(*support::own_map("highway.xodr")).size() == 3);
  CHECK(find_sources(*support::own_map("highway_exit.xodr")).size() == 3);  // not the lane that opens for the exit
  CHECK(find_sources(*support::own_map("intersection_4way.xodr")).size() == 8);
  auto const road = support::straight_road(1, 200.0);
  auto const refuse = [&](TrafficSource const& source, char const* words) {
    CHECK_THROWS_WITH_AS(Inflow(*road, {source}, 1), doctest::Contains(words), WorldError);
  };
  refuse({}, "no lane of this map");
  refuse({.lane = find_sources(*road).at(0).lane, .per_hour = 0.0}, "agents per hour");
  refuse({.lane = find_sources(*road).at(0).lane, .per_hour = std::nan("")}, "agents per hour");
  refuse({.lane = find_sources(*road).at(0).lane, .per_hour = 1e300}, "agents per hour");
}
