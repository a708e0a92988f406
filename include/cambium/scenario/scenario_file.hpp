#pragma once

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cambium/core/binary.hpp"
#include "cambium/core/error.hpp"
#include "cambium/core/json.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/core/read_file.hpp"
#include "cambium/evaluation/collision.hpp"
#include "cambium/scenario/detail/scenario_maps.hpp"
#include "cambium/scenario/scenario_set.hpp"

/// Scenario sets as files: JSON to read and to exchange, or compact bytes for large sets. A file names maps by their
/// path and lanes as "road/section/lane"; behaviours and other models by the names of the alternatives that the
/// program's `World` has.
///
///   {"format": 1, "scenarios": [
///     {"map_file": "merging.xodr", "ego": 0, "agents": [
///       {"id": 0, "position": {"x": 20, "y": -5.25}, "speed": 12, "behavior": {"idm_classic": {"law":
///       {"desired_speed": 20}}},
///        "goal": {"reach_lane": {"lane": "3/0/-2"}}}]}]}
namespace cambium::inline v0_1 {

namespace detail {

/// A set as bytes, with the names of its lanes.
template <class WorldType>
struct PackedSet {
  std::vector<std::string> lanes{};
  ScenarioSet<WorldType> set{};

  static constexpr char const* name = "packed_set";
  static constexpr auto parameters() {
    using P = PackedSet;
    return parameter_list(parameter("lanes", &P::lanes, "names of all lanes"),
                          parameter("set", &P::set, "with numbers of these names as lanes"));
  }
};

/// Loads the maps of a set as its file holds it, and draws its recipes.
template <class WorldType>
void complete(ScenarioSet<WorldType>& set, LaneTable const& lanes, std::filesystem::path const& folder,
              std::string const& where, std::function<void(ScenarioRecipe<WorldType>&)> const& adjust) {
  detail::MapFiles maps;
  for (std::size_t i = 0; i < set.scenarios.size(); ++i) {
    auto& scenario = set.scenarios[i];
    auto const place = where + ": scenarios[" + std::to_string(i) + "]";
    scenario.map = maps.load(folder, scenario.map_file, place);
    detail::exchange_lanes(type_info<Scenario<WorldType>>(), &scenario, *scenario.map, lanes, true, place);
    std::optional<WorldType> world;
    try {
      world.emplace(scenario.make_world());
    } catch (Error const& problem) {
      throw WorldError(place, problem.what());
    }
    for (Slot slot{}; index_of(slot) < world->size(); ++slot) {
      auto const contact = Collision{}.contact(*world, slot);
      if (!contact) continue;
      auto const id = to_string(world->roster().agents[slot].id);
      throw WorldError(place,
                       is_valid(contact->agent)
                           ? "agents " + id + " and " + to_string(contact->agent) + " overlap at the start"
                           : "agent " + id + " overlaps a static object",
                       "move one of them");
    }
  }
  for (std::size_t i = 0; i < set.recipes.size(); ++i) {
    auto& recipe = set.recipes[i];
    auto const place = where + ": recipes[" + std::to_string(i) + "]";
    auto const map = maps.load(folder, recipe.map_file, place);
    detail::exchange_lanes(type_info<ScenarioRecipe<WorldType>>(), &recipe, *map, lanes, true, place);
    if (adjust) adjust(recipe);
    auto drawn = draw(recipe, map, place);
    std::move(drawn.begin(), drawn.end(), std::back_inserter(set.scenarios));
  }
  set.recipes.clear();
}

/// The set as its file holds it: with numbers of `lanes` as lanes.
template <class WorldType>
[[nodiscard]] ScenarioSet<WorldType> as_in_file(ScenarioSet<WorldType> set, LaneTable const& lanes) {
  if (!set.recipes.empty())
    throw ParameterError("scenario set", "has recipes that were not drawn", "`draw` gives their scenarios");
  set.format = ScenarioSet<WorldType>::latest_format;
  for (std::size_t i = 0; i < set.scenarios.size(); ++i) {
    auto& scenario = set.scenarios[i];
    auto const place = "scenarios[" + std::to_string(i) + "]";
    require_map(scenario.map, place);
    for (auto const& agent : scenario.agents)
      if (agent.road)
        throw ParameterError(place, "an agent has a road of its own", "give it a route or a way: files hold no roads");
    exchange_lanes(type_info<Scenario<WorldType>>(), &scenario, *scenario.map, lanes, false, place);
  }
  return set;
}

}  // namespace detail

/// Reads a set from JSON text, or from bytes as `to_bytes` gives them, and draws the scenarios of its recipes. Maps are
/// loaded once each, relative to `folder`. Throws `ParameterError` as `read_json` and `from_binary` (also for a model
/// that `WorldType` lacks, or a lane that the map lacks), `MapError` if a map is missing, and `WorldError` if two
/// agents overlap, or as `Scenario::make_world`; all with `where` and the scenario. `adjust` may
/// change a recipe before its scenarios are drawn.
template <class WorldType>
[[nodiscard]] ScenarioSet<WorldType> parse_scenarios(
    std::string_view text, std::filesystem::path const& folder, std::string const& where = "scenarios",
    std::function<void(ScenarioRecipe<WorldType>&)> const& adjust = {}) {
  detail::LaneTable lanes;
  ScenarioSet<WorldType> set;
  if (is_binary(text)) {
    auto packed = from_binary<detail::PackedSet<WorldType>>(text, where);
    lanes = detail::LaneTable(packed.lanes);
    if (lanes.names().size() != packed.lanes.size())
      throw ParameterError(where, "lists a lane twice", "it is damaged: take another copy");
    set = std::move(packed.set);
  } else {
    set = from_json<ScenarioSet<WorldType>>(text, where, &lanes);
  }
  detail::complete(set, lanes, folder, where, adjust);
  return set;
}

/// Reads a set from a file. Throws as `parse_scenarios`, and `Error` if the file cannot be read.
template <class WorldType>
[[nodiscard]] ScenarioSet<WorldType> read_scenarios(
    std::filesystem::path const& path, std::function<void(ScenarioRecipe<WorldType>&)> const& adjust = {}) {
  return parse_scenarios<WorldType>(
      read_file<Error>(path.string(), {.largest = std::size_t{1} << 31, .expected = "give a scenario file"}),
      path.parent_path(), path.string(), adjust);
}

/// The set as JSON text, which `parse_scenarios` reads back as the same bits. Throws `ParameterError` if an agent has a
/// road or a goal of its own, or a model without description.
template <class WorldType>
[[nodiscard]] std::string to_json_text(ScenarioSet<WorldType> const& set) {
  detail::LaneTable lanes;
  auto const written = detail::as_in_file(set, lanes);
  return to_json(written, JsonDetail::differences, &lanes);
}

/// The set as bytes, a tenth of the JSON text. Throws as `to_json_text`.
template <class WorldType>
[[nodiscard]] std::string to_bytes(ScenarioSet<WorldType> const& set) {
  detail::LaneTable lanes;
  detail::PackedSet<WorldType> packed{{}, detail::as_in_file(set, lanes)};
  packed.lanes = lanes.names();
  return to_binary(packed);
}

}  // namespace cambium::inline v0_1
