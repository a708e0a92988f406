#pragma once

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <iterator>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "cambium/core/json.hpp"
#include "cambium/core/write_file.hpp"
#include "cambium/scenario/detail/scenario_maps.hpp"
#include "cambium/scenario/scenario_set.hpp"

/// Scenario sets as JSON files. A file names maps by their path and lanes as "road/section/lane"; behaviours and other
/// models by the names of the alternatives that the program's `World` has.
///
///   {"format": 1, "scenarios": [
///     {"map_file": "merging.xodr", "ego": 0, "agents": [
///       {"id": 0, "position": {"x": 20, "y": -5.25}, "speed": 12, "behavior": {"idm_classic": {"desired_speed": 20}},
///        "goal": {"reach_lane": {"lane": "3/0/-2"}}}]}]}
namespace cambium {

/// Reads a set from JSON text, and draws the scenarios of its recipes. Maps are loaded once each, relative to `folder`.
/// Throws `ParameterError` as `read_json` (also for a model that `WorldType` lacks), `MapError` if a map is missing,
/// and `WorldError` if a scenario has no agent, two with one id or overlapping, or none of the ego's id; all with
/// `where` and the scenario. What needs a route is checked by `Scenario::make_world`.
template <class WorldType>
[[nodiscard]] ScenarioSet<WorldType> parse_scenarios(
    std::string_view text, std::filesystem::path const& folder, std::string const& where = "scenarios",
    std::function<void(ScenarioRecipe<WorldType>&)> const& adjust = {}) {
  detail::LaneTable lanes;
  auto set = from_json<ScenarioSet<WorldType>>(text, where, &lanes);
  detail::MapFiles maps;
  Scenario<WorldType> const usual{};
  for (std::size_t i = 0; i < set.scenarios.size(); ++i) {
    auto& scenario = set.scenarios[i];
    auto const place = where + ": scenarios[" + std::to_string(i) + "]";
    scenario.map = maps.load(folder, scenario.map_file, place);
    detail::exchange_lanes(&scenario, &usual, &detail::transfer_any<Scenario<WorldType>>, *scenario.map, lanes, true,
                           place);
    std::vector<detail::StartingBody> bodies;
    for (auto const& agent : scenario.agents)
      if (agent.heading)
        bodies.push_back({agent.id.given().value_or(none<AgentId>),
                          {agent.position.x(), agent.position.y(), *agent.heading},
                          agent.shape});
    detail::check_overlaps(bodies, place);
  }
  ScenarioRecipe<WorldType> const usual_recipe{};
  for (std::size_t i = 0; i < set.recipes.size(); ++i) {
    auto& recipe = set.recipes[i];
    auto const place = where + ": recipes[" + std::to_string(i) + "]";
    auto const map = maps.load(folder, recipe.map_file, place);
    detail::exchange_lanes(&recipe, &usual_recipe, &detail::transfer_any<ScenarioRecipe<WorldType>>, *map, lanes, true,
                           place);
    if (adjust) adjust(recipe);
    auto drawn = draw(recipe, map, place);
    std::move(drawn.begin(), drawn.end(), std::back_inserter(set.scenarios));
  }
  set.recipes.clear();
  return set;
}

/// Reads a set from a file. Throws as `parse_scenarios`, and `Error` if the file cannot be read.
template <class WorldType>
[[nodiscard]] ScenarioSet<WorldType> read_scenarios(
    std::filesystem::path const& path, std::function<void(ScenarioRecipe<WorldType>&)> const& adjust = {}) {
  return parse_scenarios<WorldType>(
      read_file<Error>(path.string(), {.largest = std::size_t{1} << 31, .expected = "give a scenario file (.json)"}),
      path.parent_path(), path.string(), adjust);
}

/// The set as JSON text, which `parse_scenarios` reads back as the same bits. Throws `ParameterError` if an agent has a
/// road or a goal of its own, or a model without description.
template <class WorldType>
[[nodiscard]] std::string to_json_text(ScenarioSet<WorldType> set) {
  detail::LaneTable lanes;
  Scenario<WorldType> const usual{};
  if (!set.recipes.empty())
    throw ParameterError("scenario set", "has recipes that were not drawn", "`draw` gives their scenarios");
  set.format = ScenarioSet<WorldType>::latest_format;
  for (std::size_t i = 0; i < set.scenarios.size(); ++i) {
    auto& scenario = set.scenarios[i];
    auto const place = "scenarios[" + std::to_string(i) + "]";
    detail::require_map(scenario.map, place);
    for (auto const& agent : scenario.agents)
      if (agent.road)
        throw ParameterError(place, "an agent has a road of its own", "give it a route: files hold no roads");
    detail::exchange_lanes(&scenario, &usual, &detail::transfer_any<Scenario<WorldType>>, *scenario.map, lanes, false,
                           place);
  }
  return to_json(set, JsonDetail::differences, &lanes);
}

/// Writes a set atomically. Map files are named as in `Scenario::map_file`, so relative ones must fit the folder of
/// `path`. Throws as `to_json_text`, and `Error` if the file cannot be written.
template <class WorldType>
void write_scenarios(std::filesystem::path const& path, ScenarioSet<WorldType> const& set) {
  write_file(path, to_json_text(set));
}

}  // namespace cambium
