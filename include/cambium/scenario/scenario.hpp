#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "cambium/core/described.hpp"
#include "cambium/core/error.hpp"
#include "cambium/core/ids.hpp"
#include "cambium/geometry/polygon.hpp"
#include "cambium/map/map.hpp"
#include "cambium/map/lanes/signals.hpp"

namespace cambium::inline v0_1 {

namespace detail {
inline void require_map(std::shared_ptr<Map const> const& map, std::string const& where) {
  if (!map) throw MapError(where, "there is no map", "pass the map that load_opendrive returned");
}

/// Throws `WorldError` unless there is a map and it has the lanes of a site, of which there is at least one.
inline void require_lanes(std::shared_ptr<Map const> const& map, std::vector<LaneId> const& lanes, char const* what,
                          char const* function) {
  auto const is_known = [&](LaneId lane) { return index_of(lane) < map->lanes().size(); };
  if (!map || lanes.empty() || !std::ranges::all_of(lanes, is_known))
    throw WorldError(what, "there are none, or some that the map does not have",
                     std::string("take the site as ") + function + " returns it");
}
}  // namespace detail

/// A situation to start from, as a value: the map, the agents, and the agent it is about. `WorldType` says which
/// behaviours, executions and vehicle models the agents may have.
template <class WorldType>
struct Scenario {
  std::shared_ptr<Map const> map;
  std::uint64_t seed = 0;                               ///< of the world's random numbers
  std::vector<typename WorldType::AgentSpec> agents{};  ///< in the order in which they enter, each with its id
  AgentId ego = none<AgentId>;                          ///< one of the agents; none if all are alike
  std::vector<map::LightPlan> lights{};                 ///< of the map's first traffic lights; the others are off
  std::vector<geometry::Polygon> objects{};             ///< static objects in the way
  std::vector<AgentId> controlled{};                    ///< agents that a benchmark drives, too, besides the ego
  std::string map_file{};                               ///< that `map` was read from; files name it
  std::string title{};                                  ///< for reports
  std::string population{};                             ///< how the others drive, for reports (`TrafficPopulation`)

  static constexpr char const* name = "scenario";
  /// What a file holds of it.
  static constexpr auto parameters() {
    using P = Scenario;
    return parameter_list(
        parameter("title", &P::title, "for reports"),
        parameter("map_file", &P::map_file, "OpenDRIVE file, relative to the folder of the scenario file"),
        parameter("seed", &P::seed, "-", Range{0, std::numeric_limits<double>::max()}, "of the random numbers"),
        parameter("ego", &P::ego, "the agent that the scenario is about"),
        parameter("controlled", &P::controlled, "further agents that a benchmark drives"),
        parameter("lights", &P::lights, "of the map's first traffic lights; the others are off"),
        parameter("objects", &P::objects, "m", any_finite, "corners of static objects"),
        parameter("agents", &P::agents, "in the order in which they enter"),
        parameter("population", &P::population, "how the others drive, for reports"));
  }

  /// A world with all agents in it. Throws `WorldError` if an agent or a light plan is invalid, if two agents have the
  /// same id, or if the ego is not among the agents. O(agents^2) for the checks of entering.
  [[nodiscard]] WorldType make_world() const {
    WorldType world(map, {.seed = seed});
    for (std::size_t i = 0; i < lights.size(); ++i) world.set_light(static_cast<LightId>(i), lights[i]);
    for (auto const& object : objects) world.add_object(object);
    for (auto const& agent : agents) world.add(agent);
    auto const require = [&world](AgentId id, char const* what) {
      if (is_valid(id) && !world.roster().slot_of(id))
        throw WorldError("Scenario",
                         std::string("its ") + what + ", agent " + to_string(id) + ", is not among its agents",
                         "name one of them by its id");
    };
    require(ego, "ego");
    for (auto const id : controlled) require(id, "controlled agent");
    return world;
  }
};

/// The same scenario for worlds of another type: `behavior(spec)` returns what drives each agent there. Executions and
/// vehicle models are kept, and observers where `OtherWorld` has such; else they are its default. O(agents).
template <class OtherWorld, class WorldType, class ToBehavior>
[[nodiscard]] Scenario<OtherWorld> with_behaviors(Scenario<WorldType> const& scenario, ToBehavior const& behavior) {
  static_assert(
      requires { typename OtherWorld::AgentSpec; },
      "cambium::with_behaviors<OtherWorld>: OtherWorld must be a cambium::World<BehaviorSet<...>, ...>");
  static_assert(
      std::is_convertible_v<typename WorldType::Execution, typename OtherWorld::Execution> &&
          std::is_convertible_v<typename WorldType::Dynamics, typename OtherWorld::Dynamics>,
      "cambium::with_behaviors<OtherWorld>: OtherWorld must take the scenario's executions and vehicle models: "
      "the same types, or an ExecutionSet and a DynamicSet that contain them");
  Scenario<OtherWorld> other{.map = scenario.map,
                             .seed = scenario.seed,
                             .agents = {},
                             .ego = scenario.ego,
                             .lights = scenario.lights,
                             .objects = scenario.objects,
                             .controlled = scenario.controlled,
                             .map_file = scenario.map_file,
                             .title = scenario.title,
                             .population = scenario.population};
  other.agents.reserve(scenario.agents.size());
  for (auto const& spec : scenario.agents) {
    other.agents.push_back({.position = spec.position,
                            .heading = spec.heading,
                            .speed = spec.speed,
                            .acceleration = spec.acceleration,
                            .shape = spec.shape,
                            .behavior = behavior(spec),
                            .goal = spec.goal.given(),
                            .route = spec.route,
                            .road = spec.road,
                            .way = spec.way,
                            .execution = spec.execution,
                            .dynamics = spec.dynamics,
                            .id = spec.id.given()});
    if constexpr (std::is_convertible_v<typename WorldType::Observer, typename OtherWorld::Observer>)
      other.agents.back().observer = spec.observer;
  }
  return other;
}

}  // namespace cambium::inline v0_1
