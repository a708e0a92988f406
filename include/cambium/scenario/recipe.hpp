#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "cambium/behavior/behavior_set.hpp"
#include "cambium/core/described.hpp"
#include "cambium/core/error.hpp"
#include "cambium/core/ids.hpp"
#include "cambium/core/one_of.hpp"
#include "cambium/core/random.hpp"
#include "cambium/evaluation/collision.hpp"
#include "cambium/evaluation/off_road.hpp"
#include "cambium/goal/goal.hpp"
#include "cambium/map/corridor/build_corridor.hpp"
#include "cambium/map/map.hpp"
#include "cambium/map/map_queries.hpp"
#include "cambium/scenario/highway_site.hpp"
#include "cambium/scenario/junction_site.hpp"
#include "cambium/scenario/lane_traffic.hpp"
#include "cambium/scenario/merging_site.hpp"
#include "cambium/scenario/scenario.hpp"
#include "cambium/scenario/traffic_inflow.hpp"

namespace cambium {

/// Which of a flow's vehicles becomes the ego.
enum class EgoRule : std::uint8_t { none, first, middle, last, random };

/// A behaviour that a part of a flow's drivers has.
template <class World>
struct DriverShare {
  double share = 1.0;
  typename World::Behavior behavior{};

  static constexpr char const* name = "driver_share";
  static constexpr auto parameters() {
    using P = DriverShare;
    return parameter_list(parameter("share", &P::share, "-", non_negative, "of the drivers, relative to the others'"),
                          parameter("behavior", &P::behavior, "-", {}, "of these drivers"));
  }
};

/// Traffic on one lane corridor: where, how dense, how fast, who drives, where to, and who is under test.
template <class World>
struct LaneFlow {
  LaneId lane = none<LaneId>;
  LaneTraffic traffic{};
  std::vector<DriverShare<World>> drivers{};
  Goal goal{};
  EgoRule ego = EgoRule::none;
  bool all_controlled = false;

  static constexpr char const* name = "lane_flow";
  static constexpr auto parameters() {
    using P = LaneFlow;
    return parameter_list(
        parameter("lane", &P::lane, "-", {}, "where the corridor begins; it goes to the goal, straight on without one"),
        parameter("traffic", &P::traffic, "-", {}, "where on the corridor, speeds, headways, share of trucks"),
        parameter("drivers", &P::drivers, "-", {},
                  "drawn by their shares; without any: IDM drivers as drawn by traffic"),
        parameter("goal", &P::goal, "-", {}, "of all vehicles of the flow"),
        choice("ego", &P::ego, "none|first|middle|last|random", "which vehicle is the ego; the front one is the first"),
        parameter("all_controlled", &P::all_controlled, "-", Range{0, 1},
                  "the others of the flow are controlled, too"));
  }
};

/// Scenarios of one kind on one map, drawn from a seed: what a file holds instead of thousands of scenarios.
template <class World>
struct ScenarioRecipe {
  enum class Kind : std::uint8_t { lanes, merging, highway, junction };

  std::string title{};
  std::string map_file{};
  Kind kind = Kind::lanes;
  std::uint64_t seed = 1;
  std::uint32_t first = 0;
  std::uint32_t scenarios = 20;
  double truck_share = 0.1;
  double non_yielding_share = 0.0;
  JunctionTraffic junction{};
  std::vector<LaneFlow<World>> flows{};

  static constexpr char const* name = "scenario_recipe";
  static constexpr auto parameters() {
    using P = ScenarioRecipe;
    auto const what = parameter_list(
        parameter("title", &P::title, "-", {}, "of the scenarios; by default that of the set"),
        parameter("map_file", &P::map_file, "-", {}, "OpenDRIVE file, relative to the folder of the scenario file"),
        choice("kind", &P::kind, "lanes|merging|highway|junction",
               "traffic as given by flows, or at the merge, on the road or at the junctions of the map"),
        parameter("seed", &P::seed, "-", Range{0, 1.8446744073709552e19}, "of all random numbers"),
        parameter("first", &P::first, "-", Range{0, 4e9}, "number of the first scenario of the seed"),
        parameter("scenarios", &P::scenarios, "-", Range{1, 1e7}, "how many"));
    auto const how =
        parameter_list(parameter("truck_share", &P::truck_share, "-", Range{0, 1}, "part of the vehicles (merging)"),
                       parameter("non_yielding_share", &P::non_yielding_share, "-", Range{0, 1},
                                 "part of the drivers on the through road who open no gap (merging)"),
                       parameter("junction", &P::junction, "-", {}, "what traffic consists of (junction)"),
                       parameter("flows", &P::flows, "-", {}, "traffic by lane (lanes)"));
    return join_parameters(what, how);
  }
};

namespace detail {

/// The drawn scenario for worlds of type `World`, whose set must have its drivers.
template <class World, class Drawn>
[[nodiscard]] Scenario<World> with_drivers_of(Drawn const& scenario, std::string const& where) {
  return with_behaviors<World>(scenario, [&](auto const& spec) {
    return std::visit(
        [&]<class Driver>(Driver const& driver) -> typename World::Behavior {
          if constexpr (World::Behaviors::template contains<Driver>)
            return driver;
          else
            throw ParameterError(where,
                                 std::string("needs the behaviour ") + Driver::name + ", which the program lacks",
                                 "add it to the BehaviorSet of the program's World");
        },
        spec.behavior);
  });
}

/// Whether a vehicle that has just entered, and the next ones ahead and behind, can go on without braking hard, and can
/// stop before what is ahead.
template <class World>
[[nodiscard]] bool has_room(World& world, AgentId id, InflowRules const& rules) {
  auto const slot = world.slot_of(id);
  if (Collision{}(world, slot) || OffRoad{}(world, slot)) return false;
  auto const view = world.observe(id);
  double const speed = view.state().speed;
  if (auto const ahead = view.ahead(); ahead && speed > rules.safe_speed(ahead->gap, ahead->speed)) return false;
  if (auto const behind = view.behind(); behind && behind->speed > rules.safe_speed(behind->gap, speed)) return false;
  return speed <= entering_speed(world.map(), view.corridor(), view.place().s, view.shape(), rules);
}

/// Scenario `number` of a recipe of flows. Vehicles that would have to brake hard at once are left out.
template <class World>
[[nodiscard]] Scenario<World> draw_flows(std::shared_ptr<Map const> const& map, ScenarioRecipe<World> const& recipe,
                                         std::uint32_t number, std::string const& where) {
  Scenario<World> scenario{.map = map, .seed = recipe.seed};
  World world(map, {.seed = recipe.seed});
  RandomStream random(recipe.seed, number, 0, 0x666c6f77);
  InflowRules const rules{.headway = 0.6};
  for (std::size_t f = 0; f < recipe.flows.size(); ++f) {
    auto const& flow = recipe.flows[f];
    auto const place = where + ".flows[" + std::to_string(f) + "]";
    if (!is_valid(flow.lane)) throw ParameterError(place, "names no lane", "give \"lane\": \"road/section/lane\"");
    double shares = 0.0;
    for (auto const& driver : flow.drivers) shares += driver.share;
    // The corridor that leads from the lane to the goal is the one that an agent at its begin gets.
    World probe(map);
    auto const begin = map->lane(flow.lane).path.pose(0.0);
    auto const scout = probe.add({.position = begin.position(), .heading = begin.heading, .goal = flow.goal});
    auto const road = probe.roster().agents[probe.slot_of(scout)].road;
    auto const& corridor = road->corridors[road->main];
    auto traffic = flow.traffic;
    traffic.end = std::min(traffic.end, corridor.length());
    std::vector<AgentId> entered;
    for (auto const& vehicle : traffic.sample(random)) {
      double drawn = uniform01(random) * shares;
      auto const* driver = flow.drivers.empty() ? nullptr : &flow.drivers.back();
      for (auto const& candidate : flow.drivers)
        if (drawn -= candidate.share; drawn < 0.0) {
          driver = &candidate;
          break;
        }
      auto const pose = corridor.center.pose(vehicle.s);
      typename World::AgentSpec spec{.position = pose.position(),
                                     .heading = pose.heading,
                                     .speed = vehicle.speed,
                                     .shape = vehicle.shape,
                                     .goal = flow.goal,
                                     .route = map::Route{.lanes = road->route}};
      if (driver != nullptr)
        spec.behavior = driver->behavior;
      else if constexpr (World::Behaviors::template contains<IdmClassic>)
        spec.behavior = vehicle.driver;
      else
        throw ParameterError(place, "has no drivers, and the program's BehaviorSet no IdmClassic", "give \"drivers\"");
      auto const id = world.add(spec);
      if (!has_room(world, id, rules)) {
        world.remove(id);
        continue;
      }
      spec.id = id;
      scenario.agents.push_back(std::move(spec));
      entered.push_back(id);
    }
    if (flow.ego != EgoRule::none && !entered.empty()) {
      auto const any = std::min(entered.size() - 1,
                                static_cast<std::size_t>(uniform01(random) * static_cast<double>(entered.size())));
      std::size_t const chosen[] = {0, 0, entered.size() / 2, entered.size() - 1, any};
      scenario.ego = entered[chosen[static_cast<std::size_t>(flow.ego)]];
    }
    if (flow.all_controlled) scenario.controlled.insert(scenario.controlled.end(), entered.begin(), entered.end());
  }
  std::erase(scenario.controlled, scenario.ego);
  if (scenario.agents.empty()) throw ParameterError(where, "draws no vehicle", "give longer or denser flows");
  return scenario;
}

}  // namespace detail

/// The scenarios of a recipe. The same recipe gives the same scenarios on every platform. No two vehicles overlap, and
/// none has to brake hard at once. Throws `ParameterError` if the recipe asks for a behaviour that `World` lacks, and
/// what the samplers throw; `where` is the recipe, for messages. O(scenarios * vehicles^2).
template <class World>
[[nodiscard]] std::vector<Scenario<World>> draw(ScenarioRecipe<World> const& recipe,
                                                std::shared_ptr<Map const> const& map,
                                                std::string const& where = "recipe") {
  using Kind = typename ScenarioRecipe<World>::Kind;
  std::vector<Scenario<World>> scenarios;
  scenarios.reserve(recipe.scenarios);
  auto const each = [&](auto const& sample) {
    for (std::uint32_t i = 0; i < recipe.scenarios; ++i) {
      scenarios.push_back(sample(recipe.first + i));
      scenarios.back().map_file = recipe.map_file;
      scenarios.back().title = recipe.title;
    }
  };
  switch (recipe.kind) {
    case Kind::lanes:
      each([&](std::uint32_t number) { return detail::draw_flows(map, recipe, number, where); });
      break;
    case Kind::merging: {
      auto site = find_merging_site(map, where);
      site.truck_share = recipe.truck_share;
      site.non_yielding_share = recipe.non_yielding_share;
      each([&](std::uint32_t n) { return detail::with_drivers_of<World>(site.sample(recipe.seed, n), where); });
      break;
    }
    case Kind::highway: {
      auto const site = find_highway_site(map, where);
      each([&](std::uint32_t n) { return detail::with_drivers_of<World>(site.sample(recipe.seed, n), where); });
      break;
    }
    case Kind::junction: {
      auto const site = find_junction_site(map, where);
      each([&](std::uint32_t n) {
        return detail::with_drivers_of<World>(site.sample(recipe.seed, n, recipe.junction), where);
      });
      break;
    }
  }
  return scenarios;
}

}  // namespace cambium
