// Junctions under inflow that does not end: how many vehicles pass, and how long anybody stands.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "../support/corpus.hpp"
#include "../support/maps.hpp"
#include "cambium/core/distributions.hpp"
#include "cambium/evaluation/collision.hpp"
#include "cambium/scenario/junction_site.hpp"
#include "cambium/scenario/traffic_inflow.hpp"

using namespace cambium;

namespace {

constexpr double duration = 600.0, warm_up = 120.0;  // [s]

struct Flow {
  double per_minute = 0.0, longest_stand = 0.0;
  int collisions = 0;
};

/// Drives vehicles into the junction from everywhere, as soon as there is room for them.
Flow saturate(JunctionSite const& site, double truck_share, bool lights, double dt, std::uint64_t seed) {
  JunctionSite::World world(site.map, {.seed = seed});
  auto const plans = site.sample(seed, 0, {.lights = lights}).lights;
  for (std::size_t i = 0; i < plans.size(); ++i) world.set_light(site.map->lights()[i].id, plans[i]);
  std::vector<TrafficSource> sources;
  for (auto const lane : site.entrances) sources.push_back({.lane = lane});
  TrafficInflow<JunctionSite::World> inflow(*site.map, sources, seed);
  auto const next = [&](TrafficSource const& source, RandomStream& random) {
    auto const route = site.random_route(source.lane, random);
    auto const heading_at = [&](LaneId lane, double share) {
      auto const& path = site.map->lane(lane).path;
      return path.pose(share * path.length()).heading;
    };
    bool const turns = std::cos(heading_at(route.lanes.back(), 1.0) - heading_at(source.lane, 0.0)) < 0.9;
    bool const fits = !turns && fits_route(*site.map, route, geometry::truck());  // a roundabout's ring is too narrow
    bool const large = uniform01(random) < truck_share && fits;
    return JunctionSite::World::AgentSpec{
        .speed = 10.0,
        .shape = large ? geometry::truck() : geometry::car(),
        .behavior = Intersection{.idm = {.desired_speed = 10.0 + 4.0 * uniform01(random)}},
        .route = route};
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
      stand = world.frame().agents[i].state.speed < 0.1 ? stand + dt : 0.0;
      flow.longest_stand = std::max(flow.longest_stand, stand);
    }
    auto const gone = inflow.leave(world).size();
    if (world.time() > warm_up) passed += static_cast<int>(gone);
  }
  flow.per_minute = passed / (duration - warm_up) * 60.0;
  return flow;
}

void check_flow(JunctionSite const& site, bool lights, double least) {
  for (double const truck_share : {0.0, 0.3})
    for (double const dt : {0.2, 0.5}) {
      auto const flow = saturate(site, truck_share, lights, dt, 6);
      INFO(flow.per_minute, " vehicles a minute, longest stand ", flow.longest_stand, " s, trucks ", truck_share,
           ", dt ", dt, ", lights ", lights);
      CHECK(flow.collisions == 0);
      CHECK(flow.longest_stand < 120.0);
      CHECK(flow.per_minute > (truck_share == 0.0 ? 1.0 : 0.85) * least);
    }
}

}  // namespace

TEST_CASE("a saturated crossing keeps flowing, with lights and without") {
  auto const site = find_junction_site(support::own_map("intersection_4way.xodr"));
  check_flow(site, false, 22.0);
  check_flow(site, true, 38.0);
}

TEST_CASE("a saturated roundabout keeps flowing") {
  auto const site = find_junction_site(support::own_map("roundabout.xodr"));
  check_flow(site, false, 24.0);
}

// Where all four ways have to stop, each sends one vehicle per 9.6 s (Highway Capacity Manual 2000, exhibit 17-37, one
// lane, traffic on all ways): 25 a minute. Ours pass about 20, which is 20 % less.
TEST_CASE("a saturated crossing of single lanes without signs passes 18 vehicles a minute") {
  if (auto const map = support::corpus_map("4way_intersection.xodr")) check_flow(find_junction_site(map), false, 18.0);
}
