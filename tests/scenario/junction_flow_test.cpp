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

using namespace cambium;

namespace {

constexpr double duration = 600.0, warm_up = 120.0;  // [s]

struct Flow {
  double per_minute = 0.0, longest_stand = 0.0;
  int collisions = 0;
};

/// Whether a vehicle can start at `pose`; lowers `speed` [m/s] to that of the next one ahead.
bool has_room(JunctionSite::World const& world, geometry::Pose const& pose, double front, double& speed) {
  for (auto const& agent : world.frame().agents) {
    if (agent.status != AgentStatus::driving) continue;
    double const x = agent.state.x - pose.x, y = agent.state.y - pose.y;
    double const ahead = x * std::cos(pose.heading) + y * std::sin(pose.heading);
    double const aside = -x * std::sin(pose.heading) + y * std::cos(pose.heading);
    if (std::abs(aside) > 2.0 || std::cos(agent.state.heading - pose.heading) < 0.5) continue;
    if (std::abs(ahead) < 16.0 + front) return false;
    if (ahead > 0.0 && ahead < 60.0) speed = std::min(speed, std::max(0.0, agent.state.speed));
  }
  return true;
}

/// Drives vehicles into the junction from everywhere, as soon as there is room for them.
Flow saturate(JunctionSite const& site, double truck_share, bool lights, double dt, std::uint64_t seed) {
  JunctionSite::World world(site.map, {.seed = seed});
  auto const plans = site.sample(seed, 0, {.lights = lights}).lights;
  for (std::size_t i = 0; i < plans.size(); ++i) world.set_light(site.map->lights()[i].id, plans[i]);
  RandomStream random(seed, 77, 0);
  std::map<AgentId, double> stands;
  Flow flow;
  int passed = 0;
  while (world.time() < duration) {
    for (auto const lane : site.entrances) {
      auto const route = site.random_route(lane, random);
      auto const& end = site.map->lane(route.lanes.back()).path;
      bool const turns = std::cos(end.pose(end.length()).heading - site.map->lane(lane).path.pose(0.0).heading) < 0.9;
      bool const large = uniform01(random) < truck_share && !turns;
      auto const shape = large ? geometry::truck() : geometry::car();
      auto const pose = site.map->lane(lane).path.pose(1.0 + shape.rear);
      double speed = 10.0;
      if (!has_room(world, pose, shape.front, speed)) continue;
      world.add({.position = pose.position(),
                 .heading = pose.heading,
                 .speed = speed,
                 .shape = shape,
                 .behavior = Intersection{.idm = {.desired_speed = 10.0 + 4.0 * uniform01(random)}},
                 .route = route});
    }
    REQUIRE(world.step(dt));
    flow.collisions += AnyCollision{}(world);
    std::vector<AgentId> gone;
    for (Slot i{}; index_of(i) < world.size(); ++i) {
      auto const id = world.roster().agents[i].id;
      auto const& agent = world.frame().agents[i];
      if (agent.status != AgentStatus::driving) gone.push_back(id);
      auto& stand = stands[id];
      stand = agent.state.speed < 0.1 ? stand + dt : 0.0;
      flow.longest_stand = std::max(flow.longest_stand, stand);
    }
    if (world.time() > warm_up) passed += static_cast<int>(gone.size());
    for (auto const id : gone) world.remove(id);
  }
  flow.per_minute = passed / (duration - warm_up) * 60.0;
  return flow;
}

void check_flow(JunctionSite const& site, bool lights, double least) {
  for (double const truck_share : {0.0, 0.3})
    for (double const dt : {0.2, 0.5}) {
      auto const flow = saturate(site, truck_share, lights, dt, 5);
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
