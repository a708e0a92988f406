// Junctions under inflow that does not end: how many vehicles pass, and how long anybody stands; and starts of many
// cars at once.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "../support/corpus.hpp"
#include "../support/maps.hpp"
#include "../support/scale.hpp"
#include "cambium/behavior/people.hpp"
#include "cambium/behavior/presets.hpp"
#include "cambium/core/distributions.hpp"
#include "cambium/core/random.hpp"
#include "cambium/evaluation/collision.hpp"
#include "cambium/map/lanelet/lanelet2.hpp"
#include "cambium/map/opendrive.hpp"
#include "cambium/scenario/dataset/common_road.hpp"
#include "cambium/scenario/junction_site.hpp"
#include "cambium/scenario/traffic_inflow.hpp"

using namespace cambium;

namespace {

constexpr double duration = 600.0, warm_up = 120.0;  // [s]

struct Flow {
  double per_minute = 0.0, longest_stand = 0.0;
  int collisions = 0;
};

/// Drives vehicles into the junction from everywhere, as soon as there is room for them, with one of the `drivers`
/// each.
Flow saturate(JunctionSite const& site, double truck_share, bool lights, double dt, std::uint64_t seed,
              std::vector<UrbanDriver> const& drivers = {{}}) {
  JunctionSite::World world(site.map, {.seed = seed});
  auto const plans = lights ? site.sample(seed, 0, {.lights = true}).lights : std::vector<map::LightPlan>{};
  for (std::size_t i = 0; i < plans.size(); ++i) world.set_light(site.map->lights()[i].id, plans[i]);
  TrafficInflow<JunctionSite::World> inflow(*site.map, find_sources(*site.map), seed);
  auto const next = [&](TrafficSource const& source, RandomStream& random) {
    auto const route = site.random_route(source.lane, random);
    bool const fits = fits_route(*site.map, route, geometry::truck());  // a roundabout's ring is too narrow
    bool const large = uniform01(random) < truck_share && fits;
    auto driver = drivers.size() > 1 ? drivers[random() % drivers.size()] : drivers.front();
    driver.law.desired_speed = 10.0 + 4.0 * uniform01(random);
    return JunctionSite::World::AgentSpec{
        .speed = 10.0, .shape = large ? geometry::truck() : geometry::car(), .behavior = driver, .route = route};
  };
  std::map<AgentId, double> stands;
  Flow flow;
  int passed = 0;
  while (world.time() < duration) {
    inflow.enter(world, next);
    REQUIRE(world.step(dt));
    flow.collisions += AnyCollision{}(world);
    for (Slot i{}; index_of(i) < world.size(); ++i) {
      auto& stand = stands[world.roster().agents[i].id];
      stand = world.frame().agents[i].state.speed < standing_speed ? stand + dt : 0.0;
      flow.longest_stand = std::max(flow.longest_stand, stand);
    }
    auto const gone = inflow.leave(world).size();
    if (world.time() > warm_up) passed += static_cast<int>(gone);
  }
  flow.per_minute = passed / (duration - warm_up) * 60.0;
  return flow;
}

struct Expected {
  double cars, mixed;  ///< vehicles that pass in a minute at least, without trucks and where up to a third are trucks
};

/// Nobody collides or stands for 120 s in a saturated junction, and it passes what is expected.
void check_flow(std::shared_ptr<Map const> const& map, Expected const& expected, bool lights = false) {
  if (!map) return;
  auto const site = find_junction_site(map);
  std::pair<double, double> const cases[] = {{0.0, 0.5}, {0.3, 0.2}, {0.0, 0.2}, {0.3, 0.5}};
  for (auto const& [truck_share, dt] : std::span(cases).first(std::clamp(support::runs(4), 2u, 4u))) {
    auto const flow = saturate(site, truck_share, lights, dt, 100);
    INFO(flow.per_minute, " vehicles a minute, longest stand ", flow.longest_stand, " s, trucks ", truck_share, ", dt ",
         dt, ", lights ", lights);
    CHECK(flow.collisions == 0);
    CHECK(flow.longest_stand < 120.0);
    CHECK(flow.per_minute > (truck_share == 0.0 ? expected.cars : expected.mixed));
  }
}

}  // namespace

TEST_CASE("a saturated crossing keeps flowing, with lights and without") {
  auto const map = support::own_map("intersection_4way.xodr");
  check_flow(map, {36.0, 28.0});
  check_flow(map, {39.0, 34.0}, true);
}

// Aggressive drivers brake harder for their lines than `safe_deceleration`; if others took them for unable to stop,
// three or more would gridlock.
TEST_CASE("a saturated crossing keeps flowing, whatever the drivers' temperaments") {
  auto const site = find_junction_site(support::own_map("intersection_4way.xodr"));
  auto const timid = presets::timid<UrbanDriver>(), normal = presets::normal<UrbanDriver>(),
             aggressive = presets::aggressive<UrbanDriver>();
  for (auto const& [drivers, expected] : {std::pair{std::vector{timid}, 20.0},
                                          {std::vector{aggressive}, 38.0},
                                          {std::vector{timid, normal, aggressive}, 30.0}})
    for (std::uint64_t seed = 1; seed <= support::runs(3); ++seed) {
      auto const flow = saturate(site, 0.1, false, 0.2, seed, drivers);
      INFO(flow.per_minute, " vehicles a minute, longest stand ", flow.longest_stand, " s, seed ", seed);
      CHECK(flow.collisions == 0);
      CHECK(flow.longest_stand < 120.0);
      CHECK(flow.per_minute > expected);
    }
}

TEST_CASE("a saturated roundabout keeps flowing") { check_flow(support::own_map("roundabout.xodr"), {31.0, 31.0}); }

// Here the ring once filled up, and all waited for room behind the next entry.
TEST_CASE("a saturated roundabout keeps flowing with drivers who differ as people do") {
  auto const site = find_junction_site(support::own_map("roundabout.xodr"));
  RandomStream random(7, 0, 0);
  std::vector<UrbanDriver> drivers;
  for (int i = 0; i < 40; ++i) drivers.push_back(presets::town_cars().draw(random).of(UrbanDriver{}));
  for (std::uint64_t const seed : {7u, 8u}) {
    auto const flow = saturate(site, 0.0, false, 0.2, seed, drivers);
    INFO(flow.per_minute, " vehicles a minute, longest stand ", flow.longest_stand, " s, seed ", seed);
    CHECK(flow.collisions == 0);
    CHECK(flow.longest_stand < 120.0);
    CHECK(flow.per_minute > 36.0);
  }
}

// Trucks that turned left here once met head-on, ten of them in 20 minutes.
TEST_CASE("trucks do not collide in a large crossing of lanelets") {
  auto const file = corpus::find("lanelet2/autoware_intersection.osm");
  if (!file) return;
  auto const flow = saturate({load_lanelet2(file->string()).map, {}}, 0.35, false, 0.2, 5);
  CHECK(flow.collisions == 0);
  CHECK(flow.per_minute > 100.0);
}

// Two-way stop: 41 cars a minute by the Highway Capacity Manual 2000, gap acceptance (see examples/soak/capacity.hpp).
TEST_CASE("nobody waits forever on a side road that enters a saturated main road") {
  check_flow(support::own_map("intersection_3way.xodr"), {41.3, 29.0});
}

// Where all ways have to stop, each of four sends one vehicle per 9.47 s (Highway Capacity Manual 2000, exhibits 17-33
// and 17-37, one lane, traffic on all ways, a third turning either way): 25.4 cars a minute; each of three one per 6.87
// s: 26.2.
TEST_CASE("a saturated crossing of single lanes passes 93 % of what the manual says, in cars") {
  check_flow(support::corpus_map("4way_intersection.xodr"), {0.93 * 25.4, 16.0});
}

// A driver counts as inside once it has passed its place to wait, even before the edge of the junction; otherwise three
// vehicles would gridlock here.
TEST_CASE("who has left its place to wait is let through, before the edge of the junction too") {
  auto const map = support::corpus_map("threeway_intersection.xodr");
  if (!map) return;
  auto const flow = saturate(find_junction_site(map), 0.3, false, 0.2, 17);
  CHECK(flow.collisions == 0);
  CHECK(flow.longest_stand < 120.0);
  CHECK(flow.per_minute > 14.5);
}

TEST_CASE("trucks and cars do not block each other in small junctions for good") {
  check_flow(support::corpus_map("threeway_intersection.xodr"), {15.8, 14.0});
  check_flow(support::corpus_map("fabriksgatan.xodr"), {19.0, 18.0});
  check_flow(support::corpus_map("simple_3way_intersection_lht.xodr"), {19.5, 12.6});
}

TEST_CASE("roads that cross without a junction element keep flowing") {
  for (auto const& [name, expected] : {std::pair{"opendrive/XCrossStopAllWay.xodr", 15.0},
                                       {"cases/odr_all_way_stop_no_junction.xodr", 12.0},
                                       {"cases/odr_crossing_no_signs_no_junction.xodr", 20.0}}) {
    auto const file = corpus::find(name);
    if (!file) return;
    auto const flow = saturate({load_opendrive(file->string()).map, {}}, 0.3, false, 0.2, 7);
    CAPTURE(name);
    CHECK(flow.collisions == 0);
    CHECK(flow.longest_stand < 120.0);
    CHECK(flow.per_minute > expected);
  }
}

namespace {

/// Lets `count` cars start from standstill at random places outside of junctions, on random routes. Returns whether all
/// get through, and nobody collides.
bool all_get_through(std::shared_ptr<Map const> const& map, int count, std::uint64_t seed) {
  JunctionSite::World world(map, {.seed = seed});
  RandomStream random(seed, 0, 0);
  for (int tries = 0; tries < 20 * count && static_cast<int>(world.size()) < count; ++tries) {
    auto const from = static_cast<LaneId>(uniform_index(random, static_cast<std::uint32_t>(map->lanes().size())));
    auto const& lane = map->lane(from);
    if (!lane.drivable() || map->in_junction(from) || lane.length() < 8.0) continue;
    auto const pose = lane.path.pose(5.0 + uniform01(random) * (lane.length() - 6.0));
    if (std::ranges::any_of(world.frame().agents, [&](auto const& agent) {
          return std::hypot(agent.state.x - pose.x, agent.state.y - pose.y) < 12.0;
        }))
      continue;
    world.add({.position = pose.position(),
               .heading = pose.heading,
               .behavior = UrbanDriver{.law = {.desired_speed = 8.0 + 7.0 * uniform01(random)}},
               .route = random_route(*map, from, random)});
  }
  REQUIRE(static_cast<int>(world.size()) > count / 2);
  while (world.time() < 300.0 && world.size() > 0) {
    REQUIRE(world.step(0.2));
    if (AnyCollision{}(world)) return false;
    for (std::size_t i = world.size(); i-- > 0;) {
      auto const& [agent, record] = std::pair(world.roster().agents[i], world.frame().agents[i]);
      if (agent.road->corridors[record.lane.corridor].length() - record.lane.s < 8.0) world.remove(agent.id);
    }
  }
  return world.size() == 0;
}

}  // namespace

TEST_CASE("cars that start anywhere on short, tangled roads all get through") {
  auto const tee = corpus::find("cases/cr_tight_tee_short.xml");
  auto const tangle = support::corpus_map("libopendrive_test.xodr");
  if (!tee || !tangle) return;
  auto const map = load_common_road(tee->string()).map;
  for (std::uint64_t seed = 0; seed < 16; ++seed) {
    CAPTURE(seed);
    CHECK(all_get_through(map, 3, seed));
  }
  for (std::uint64_t const seed : {4u, 9u}) CHECK(all_get_through(tangle, 40, seed));
  for (std::uint64_t seed = 10; seed < 9 + support::runs(10); ++seed) {
    CAPTURE(seed);
    CHECK(all_get_through(tangle, 40, seed));
  }
}
