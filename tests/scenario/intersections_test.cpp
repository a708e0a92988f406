// Sampled traffic at junctions, as the example of junctions draws it: cars, vans and trucks on maps loaded without
// options. Nobody collides, and everybody gets through.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "../support/corpus.hpp"
#include "../support/maps.hpp"
#include "../support/scale.hpp"
#include "cambium/behavior/open_loop/constant_acceleration.hpp"
#include "cambium/evaluation/collision.hpp"
#include "cambium/evaluation/driving.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/geometry/collision.hpp"
#include "cambium/planner/policy/proposal_planner.hpp"
#include "cambium/scenario/junction_site.hpp"

using namespace cambium;

namespace {

struct Tally {
  std::uint32_t runs = 0, collisions = 0, stuck = 0, on_red = 0;
  std::uint64_t agents = 0;
  double longest = 0.0;
  std::string first;  ///< what went wrong first
};

/// Height of the road below an agent [m]: evaluators know none, and on some maps bridges cross roads.
double height(JunctionSite::World const& world, Slot slot) {
  auto const& at = world.frame().agents[slot].lane;
  auto const& corridor = world.roster().agents[slot].road->corridors[at.corridor];
  auto const place = corridor.lane_at(at.s);
  auto const& lane = world.map().lane(place.lane);
  return world.map().road(lane.road).elevation.value(lane.station_at(std::min(place.s, lane.length())));
}

bool collides(JunctionSite::World const& world) {
  if (!AnyCollision{}(world)) return false;
  for (Slot i{}; index_of(i) < world.size(); ++i)
    for (Slot k{}; k < i; ++k)
      if (geometry::intersects(box_at(world, i), box_at(world, k)) &&
          std::abs(height(world, i) - height(world, k)) < 3.0)
        return true;
  return false;
}

void remove_those_through(JunctionSite::World& world) {
  for (std::size_t i = world.size(); i-- > 0;)
    if (PastJunctions{}(world, static_cast<Slot>(i))) world.remove(world.roster().agents[i].id);
}

/// How many vehicles cross a red light's stop line in a step of `world`, whose positions before it were `before`.
std::uint32_t crossed_on_red(JunctionSite::World const& world, std::vector<double> const& before) {
  std::uint32_t count = 0;
  for (std::size_t i = 0; i < world.size(); ++i) {
    auto const& agent = world.roster().agents[i];
    auto const& at = world.frame().agents[i].lane;
    for (auto const& signal : agent.road->corridors[at.corridor].signals) {
      double const to_line = signal.line - agent.shape.front;
      if (is_valid(signal.light) && before[i] <= to_line && at.s > to_line &&
          world.roster().lights[index_of(signal.light)].at(world.time()) == map::LightColor::red)
        ++count;
    }
  }
  return count;
}

/// Seeds and numbers are scattered over their ranges.
void run(JunctionSite const& site, JunctionTraffic const& traffic, std::uint32_t number, double dt, Tally& tally) {
  auto world = site.sample(17 + 0x9e3779b97f4a7c15u * (number % 7), number * 2654435761u, traffic).make_world();
  tally.agents += world.size();
  bool hit = false;
  for (int step = 0; step * dt < 300.0 && world.size() > 0 && !hit; ++step) {
    std::vector<double> before;
    for (auto const& agent : world.frame().agents) before.push_back(agent.lane.s);
    REQUIRE(world.step(dt));
    if (traffic.lights) tally.on_red += crossed_on_red(world, before);
    remove_those_through(world);
    hit = collides(world);
  }
  ++tally.runs;
  tally.collisions += hit;
  tally.stuck += !hit && world.size() > 0;
  tally.longest = std::max(tally.longest, world.time());
  if (tally.first.empty() && (hit || world.size() > 0))
    tally.first = "run " + std::to_string(number) + " at " + std::to_string(world.time()) + " s";
}

void check_all_pass(std::shared_ptr<Map const> const& map, std::string const& name, std::uint32_t count,
                    JunctionTraffic traffic = {}, double dt = 0.2) {
  traffic.scattered_ids = true;
  auto const site = find_junction_site(map, name);
  Tally tally;
  for (std::uint32_t number = 0; number < count; ++number) run(site, traffic, number, dt, tally);
  CAPTURE(name);
  CAPTURE(tally.first);
  CHECK(tally.collisions == 0);
  CHECK(tally.stuck == 0);
  CHECK(tally.on_red == 0);
  CHECK(tally.agents > 2 * count);  // it is about somebody
  MESSAGE(name << ": " << tally.runs << " runs, " << static_cast<double>(tally.agents) / tally.runs << " agents each, "
               << tally.collisions << " collisions, " << tally.stuck << " stuck, longest " << tally.longest << " s");
}

}  // namespace

TEST_CASE("nobody collides, waits forever or crosses a stop line on red in sampled traffic") {
  JunctionTraffic const many_trucks{.mix = {.truck_share = 0.35, .van_share = 0.15}}, dense{.most_vehicles = 30},
      bicycles{.mix = {.truck_share = 0.15, .van_share = 0.15, .bicycle_share = 0.3}};
  for (char const* name : {"intersection_3way.xodr", "intersection_4way.xodr", "roundabout.xodr"}) {
    auto const map = support::own_map(name);
    check_all_pass(map, name, support::runs(1000));
    check_all_pass(map, name + std::string(" with bicycles"), support::runs(1000), bicycles);
    for (double const dt : {0.1, 0.5}) {
      check_all_pass(map, name + std::string(" with a third of trucks"), support::runs(150), many_trucks, dt);
      check_all_pass(map, name + std::string(" with 30 vehicles"), support::runs(100), dense, dt);
    }
  }
  auto const map = support::own_map("intersection_4way.xodr");
  REQUIRE(map->lights().size() == 2);
  check_all_pass(map, "intersection_4way.xodr with lights", support::runs(1000), {.lights = true});
}

TEST_CASE("so it is at the junctions of the corpus") {
  for (std::string const name : {"simple_3way_intersection_lht", "multi_intersections", "route_strategy_test_road",
                                 "parking_demo", "4way_intersection", "threeway_intersection", "fabriksgatan"})
    if (auto const map = support::corpus_map(name + ".xodr")) check_all_pass(map, name, support::runs(60));
  for (std::string const name : {"libopendrive_test", "Town04"})
    if (auto const map = support::corpus_map(name + ".xodr")) check_all_pass(map, name, support::runs(20));
  for (std::string const name : {"simple_3way_intersection_lht", "fabriksgatan", "route_strategy_test_road"})
    for (double const dt : {0.1, 0.5})
      if (auto const map = support::corpus_map(name + ".xodr"))
        check_all_pass(map, name, support::runs(50), {.most_vehicles = 30}, dt);
}

// Three drivers may leave their places to wait in one step (run 48), or pass places so far before the junction that
// others could take them for being outside: either would gridlock.
TEST_CASE("no three vehicles block each other for good that leave their places to wait together") {
  JunctionTraffic const dense{.most_vehicles = 30, .scattered_ids = true};
  Tally tally;
  auto const check = [&](std::string const& name, std::uint32_t number) {
    auto const map = support::corpus_map(name + ".xodr");
    if (!map) return;
    for (double const dt : {0.2, 0.5}) run(find_junction_site(map, name), dense, number, dt, tally);
  };
  check("simple_3way_intersection_lht", 48);
  check("libopendrive_test", 154);
  check("libopendrive_test", 185);
  CAPTURE(tally.first);
  CHECK(tally.collisions == 0);
  CHECK(tally.stuck == 0);
}

// The van once stopped with its front end in the merge, where the cyclist followed it.
TEST_CASE("a van that waits for a cyclist to merge before it does not block it") {
  auto const site = find_junction_site(support::own_map("intersection_4way.xodr"));
  Tally tally;
  run(site, {.mix = {.truck_share = 0.15, .van_share = 0.15, .bicycle_share = 0.3}, .scattered_ids = true}, 1644, 0.2,
      tally);
  CAPTURE(tally.first);
  CHECK(tally.collisions == 0);
  CHECK(tally.stuck == 0);
}

TEST_CASE("who reaches the end of its route sees a vehicle beyond it that still reaches back") {
  auto const site = find_junction_site(support::own_map("intersection_4way.xodr"));
  for (LaneId const entrance : site.entrances) {
    auto const& lane = site.map->lane(entrance);
    for (LaneId const next : lane.successors) {
      JunctionSite::World world(site.map);
      auto const add = [&](LaneId where, double s, double speed, double desired) {
        return world.add(
            {.position = site.map->lane(where).path.pose(s).position(),
             .speed = speed,
             .behavior = UrbanDriver{.law = {.desired_speed = desired}, .lateral = {.rule = {.threshold = 10.0}}},
             .route = map::Route{{where}, site.map->lane(where).length()}});
      };
      auto const behind = add(entrance, lane.length() - 60.0, 10.0, 10.0);
      add(next, 0.5, 0.0, 0.1);
      double gap = 60.0;
      for (int step = 0; step < 60 && world.frame().agents[world.slot_of(behind)].status == AgentStatus::driving;
           ++step) {
        REQUIRE(world.step(0.2));
        auto const ahead = world.observe(behind).ahead();
        REQUIRE(ahead);
        gap = std::min(gap, ahead->gap);
      }
      CHECK_FALSE(AnyCollision{}(world));
      CHECK(gap > 0.0);
      CHECK(gap < 5.0);  // it came up to it
    }
  }
}

TEST_CASE("a vehicle larger than those that conflicts are found for is refused with a sentence") {
  auto const site = find_junction_site(support::own_map("intersection_4way.xodr"));
  RandomStream random(1, 0, 0);
  auto const pose = site.map->lane(site.entrances[0]).path.pose(20.0);
  auto const add = [&](geometry::Shape const& shape) {
    JunctionSite::World world(site.map);
    world.add({.position = pose.position(),
               .shape = shape,
               .behavior = UrbanDriver{},
               .route = site.random_route(site.entrances[0], random)});
  };
  CHECK_NOTHROW(add(geometry::bus()));
  CHECK_THROWS_WITH_AS(add(geometry::articulated_truck()), doctest::Contains("large_conflict_shape"), WorldError);
}

TEST_CASE("a planner that expects everybody to heed conflicts plans among vehicles too large for them") {
  using Predicted = BehaviorSet<IdmProposal, UrbanDriver>;
  using Prediction = World<Predicted, InterpolateExecution, SingleTrack>;
  using Planner = ProposalPlanner<Prediction, UrbanDriver>;
  auto const site = find_junction_site(support::own_map("intersection_4way.xodr"));
  World<BehaviorSet<Planner, ConstantAcceleration>, InterpolateExecution, SingleTrack> world(site.map);
  RandomStream random(1, 0, 0);
  auto const enter = [&](std::size_t entrance, geometry::Shape const& shape, auto const& behavior) {
    auto const pose = site.map->lane(site.entrances[entrance]).path.pose(20.0);
    return world.add({.position = pose.position(),
                      .speed = 3.0,
                      .shape = shape,
                      .behavior = behavior,
                      .route = site.random_route(site.entrances[entrance], random)});
  };
  enter(0, geometry::car(), Planner{});
  enter(1, geometry::articulated_truck(), ConstantAcceleration{});
  for (int i = 0; i < 50; ++i) REQUIRE(world.step(0.2));
  auto prediction = world.observe(world.roster().agents[0].id).predict(predict_all_as<Predicted>(UrbanDriver{}));
  REQUIRE(prediction.size() == 2);
  for (int i = 0; i < 50; ++i) REQUIRE(prediction.step(0.2));
}

TEST_CASE("nobody drives through a bend with more than the lateral acceleration it is given") {
  auto const site = find_junction_site(support::own_map("intersection_4way.xodr"));
  double const dt = 0.2;
  double fastest = 0.0;
  for (std::uint32_t number = 0; number < 20; ++number) {
    auto world = site.sample(3, number).make_world();
    for (int step = 0; step < 300; ++step) {
      std::vector<std::pair<AgentId, double>> before;
      for (std::size_t i = 0; i < world.size(); ++i)
        before.emplace_back(world.roster().agents[i].id, world.frame().agents[i].state.heading);
      REQUIRE(world.step(dt));
      for (auto const& [id, heading] : before) {
        double const turn = geometry::angle_difference(world.state(id).heading, heading);
        if (step > 25) fastest = std::max(fastest, std::abs(turn) / dt * world.state(id).speed);
      }
      world.remove_departed();
    }
  }
  CHECK(fastest <= 2.5 * 1.05);  // a step may be in two pieces of a bend
  CHECK(fastest > 2.0);
}
