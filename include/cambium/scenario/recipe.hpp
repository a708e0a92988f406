#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "cambium/core/described.hpp"
#include "cambium/core/error.hpp"
#include "cambium/core/random.hpp"
#include "cambium/geometry/polygon.hpp"
#include "cambium/map/lanes/signals.hpp"
#include "cambium/map/map.hpp"
#include "cambium/scenario/highway_site.hpp"
#include "cambium/scenario/junction_site.hpp"
#include "cambium/scenario/lane_flow.hpp"
#include "cambium/scenario/merging_site.hpp"
#include "cambium/scenario/scenario.hpp"
#include "cambium/scenario/traffic_inflow.hpp"
#include "cambium/scenario/traffic_population.hpp"

namespace cambium::inline v0_1 {

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
  MergingTraffic merging{};
  JunctionTraffic junction{};
  std::vector<LaneFlow<World>> flows{};
  std::vector<map::LightPlan> lights{};
  std::vector<geometry::Polygon> objects{};
  InflowRules room{.headway = 0.8};
  std::vector<TrafficPopulation> populations{TrafficPopulation::as_given};

  static constexpr char const* name = "scenario_recipe";
  static constexpr auto parameters() {
    using P = ScenarioRecipe;
    auto const what = parameter_list(
        parameter("title", &P::title, "of the scenarios; by default that of the set"),
        parameter("map_file", &P::map_file, "OpenDRIVE file, relative to the folder of the scenario file"),
        choice("kind", &P::kind, "lanes|merging|highway|junction",
               "traffic as given by flows, or at the merge, on the road or at the junctions of the map"),
        parameter("seed", &P::seed, "-", Range{0, 1.8446744073709552e19}, "of all random numbers"),
        parameter("first", &P::first, "-", Range{0, 4e9}, "number of the first scenario of the seed"),
        parameter("scenarios", &P::scenarios, "-", Range{1, 1e7}, "how many"));
    auto const how =
        parameter_list(parameter("merging", &P::merging, "what traffic consists of (merging)"),
                       parameter("junction", &P::junction, "what traffic consists of (junction)"),
                       parameter("flows", &P::flows, "traffic from sources to sinks (lanes)"),
                       parameter("lights", &P::lights, "of the map's first traffic lights (lanes)"),
                       parameter("objects", &P::objects, "m", any_finite, "corners of static objects (lanes)"),
                       parameter("room", &P::room, "that a vehicle needs; without, it is left out (lanes)"),
                       choice("populations", &P::populations, population_names,
                              "of the drivers that are people (lanes): all scenarios with each"));
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

/// Whether flows have drivers who differ by population.
template <class World>
[[nodiscard]] bool has_people(std::vector<LaneFlow<World>> const& flows) {
  return std::ranges::any_of(flows, [](auto const& flow) {
    return std::ranges::any_of(flow.drivers, [](auto const& driver) { return is_person(driver); });
  });
}

/// Throws `ParameterError` for populations that would draw nothing, or the same twice.
template <class World>
void check_populations(ScenarioRecipe<World> const& recipe, std::string const& where) {
  auto const& all = recipe.populations;
  if (all.empty()) throw ParameterError(where, "has no populations", "leave them out, or name some");
  for (auto one = all.begin(); one != all.end(); ++one)
    if (std::find(all.begin(), one, *one) != one)
      throw ParameterError(where + ".populations", "has " + std::string(to_string(*one)) + " twice", "name each once");
  if (std::ranges::all_of(all, [](auto one) { return one == TrafficPopulation::as_given; })) return;
  if (recipe.kind != ScenarioRecipe<World>::Kind::lanes)
    throw ParameterError(where, "has populations, but no flows", "leave them out, or make it of kind lanes");
  if (!has_people(recipe.flows))
    throw ParameterError(where, "has populations, but none of its drivers are people",
                         "leave them out, or give drivers \"people\": true");
}

}  // namespace detail

/// The scenarios of a recipe. The same recipe gives the same scenarios on every platform. No two vehicles overlap, and
/// none has to brake hard at once. Throws `ParameterError` if the recipe asks for a behaviour that `World` lacks or for
/// populations without effect, and what the samplers throw; `where` is the recipe, for messages.
/// O(scenarios * vehicles^2).
template <class World>
[[nodiscard]] std::vector<Scenario<World>> draw(ScenarioRecipe<World> const& recipe,
                                                std::shared_ptr<Map const> const& map,
                                                std::string const& where = "recipe") {
  using Kind = typename ScenarioRecipe<World>::Kind;
  std::vector<Scenario<World>> scenarios;
  scenarios.reserve(std::min(recipe.scenarios, 1024u));  // the number may come from a file
  auto const each = [&](auto const& sample) {
    for (std::uint32_t i = 0; i < recipe.scenarios; ++i) {
      scenarios.push_back(sample(recipe.first + i));
      scenarios.back().seed =
          RandomStream(recipe.seed, recipe.first + i, 0, 0x73656564)();  // of the world: each its own
      scenarios.back().map_file = recipe.map_file;
      scenarios.back().title = recipe.title;
    }
  };
  if (recipe.kind != Kind::lanes && !(recipe.lights.empty() && recipe.objects.empty()))
    throw ParameterError(where, "has lights or objects, but no flows", "leave them out, or make it of kind lanes");
  detail::check_populations(recipe, where);
  auto const sample = [&](auto const& site, auto const&... traffic) {
    each([&](std::uint32_t n) {
      return detail::with_drivers_of<World>(site.sample(recipe.seed, n, traffic...), where);
    });
  };
  if (recipe.kind == Kind::merging) sample(find_merging_site(map, where), recipe.merging);
  if (recipe.kind == Kind::highway) sample(find_highway_site(map, where));
  if (recipe.kind == Kind::junction) sample(find_junction_site(map, where), recipe.junction);
  if (recipe.kind != Kind::lanes) return scenarios;
  check_parameters(recipe.room, where);
  Scenario<World> const site{.map = map, .seed = recipe.seed, .lights = recipe.lights, .objects = recipe.objects};
  try {
    static_cast<void>(site.make_world());
  } catch (Error const& problem) {
    throw ParameterError(where, problem.what());
  }
  auto const plans = detail::plan_flows(map, recipe.flows, where);
  for (auto const population : recipe.populations) {
    auto const first = scenarios.size();
    each([&](std::uint32_t number) { return detail::draw_flows(site, plans, recipe.room, population, number, where); });
    if (!detail::has_people(recipe.flows)) continue;
    for (auto i = first; i < scenarios.size(); ++i) scenarios[i].population = to_string(population);
  }
  return scenarios;
}

}  // namespace cambium::inline v0_1
