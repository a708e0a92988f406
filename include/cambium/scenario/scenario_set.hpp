#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "cambium/core/described.hpp"
#include "cambium/core/hash.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/core/text.hpp"
#include "cambium/evaluation/infeasible.hpp"
#include "cambium/evaluation/metrics/closed_loop_score.hpp"
#include "cambium/map/content_hash.hpp"
#include "cambium/map/map.hpp"
#include "cambium/scenario/recipe.hpp"
#include "cambium/scenario/scenario.hpp"

namespace cambium::inline v0_1 {

/// What can make a run no success, besides a collision: a motion that no vehicle can make, or a broken rule.
enum class Criterion : std::uint8_t {
  infeasible,
  red_light,
  stop_sign,
  right_of_way,
  wrong_way,
  speeding,
  solid_line,
  off_road,
  imposed_braking,
  straddling,
  discomfort
};

/// As files write them.
inline constexpr char const* criterion_names =
    "infeasible|red_light|stop_sign|right_of_way|wrong_way|speeding|solid_line|off_road|imposed_braking|straddling|"
    "discomfort";

/// As files write it.
[[nodiscard]] inline std::string_view to_string(Criterion criterion) {
  return detail::split(criterion_names, "|")[static_cast<std::size_t>(criterion)];
}

/// From where on a run meets the criteria that are a matter of degree, and the bounds of its closed-loop score, which
/// are those of `discomfort`, too.
struct CriterionBounds {
  double wrong_way = 1.0;
  double imposed_braking = 4.0;
  double straddling = 10.0;
  Infeasible infeasible{};
  ClosedLoopScore score{};

  static constexpr char const* name = "criterion_bounds";
  static constexpr auto parameters() {
    using P = CriterionBounds;
    return parameter_list(
        parameter("wrong_way", &P::wrong_way, "s", non_negative, "in lanes of oncoming traffic, altogether"),
        parameter("imposed_braking", &P::imposed_braking, "m/s^2", non_negative, "harder braking of others fails"),
        parameter("straddling", &P::straddling, "s", non_negative, "longer times between two lanes fail"),
        parameter("infeasible", &P::infeasible, "what is no motion of a vehicle"),
        parameter("score", &P::score, "what is good driving"));
  }
};

/// What does so where a set does not choose.
[[nodiscard]] inline std::vector<Criterion> usual_fails() {
  return {Criterion::infeasible, Criterion::red_light, Criterion::wrong_way};
}

/// Scenarios that belong together, and how they are run.
template <class WorldType>
struct ScenarioSet {
  std::string title{};
  double time_step = 0.2;    ///< [s]
  double time_limit = 60.0;  ///< a scenario that takes longer has timed out [s]
  std::vector<Scenario<WorldType>> scenarios{};
  std::vector<ScenarioRecipe<WorldType>> recipes{};  ///< for more scenarios; empty once these are drawn
  int format = 0;                                    ///< version of the file that it was read from; 0: none
  std::vector<Criterion> fails = usual_fails();      ///< what makes a run no success, besides a collision
  CriterionBounds bounds{};                          ///< of these

  static constexpr int latest_format = 1;
  static constexpr char const* name = "scenario_set";
  static constexpr auto parameters() {
    using P = ScenarioSet;
    return parameter_list(
        parameter("format", &P::format, "-", Range{0, latest_format}, "version of the file format"),
        parameter("title", &P::title, "for reports"),
        parameter("time_step", &P::time_step, "s", Range{0.001, 10}, "of the simulation"),
        parameter("time_limit", &P::time_limit, "s", Range{0.001, 1e6}, "a scenario that takes longer has timed out"),
        parameter("scenarios", &P::scenarios, "situations to start from"),
        parameter("recipes", &P::recipes, "for more of them, drawn when the file is read"),
        choice("fails", &P::fails, criterion_names, "what makes a run no success, besides a collision"),
        parameter("bounds", &P::bounds, "of these"));
  }

  /// Hash of everything that a run depends on, the maps' content included, see `content_hash`; not of names.
  /// O(scenarios * agents + path segments of the maps).
  [[nodiscard]] std::uint64_t hash() const {
    auto plain = *this;
    plain.format = 0;
    plain.title.clear();
    for (auto& scenario : plain.scenarios) {
      scenario.title.clear();
      scenario.population.clear();
      scenario.map_file.clear();
    }
    detail::Fnv1a<std::uint64_t> hash(hash_parameters(plain));
    std::map<cambium::Map const*, std::uint64_t> known;
    for (auto const& scenario : scenarios) {
      if (!scenario.map) continue;
      auto const [at, is_new] = known.emplace(scenario.map.get(), 0);
      if (is_new) at->second = content_hash(*scenario.map);
      hash.add_word(at->second);
    }
    return hash.value();
  }
};

}  // namespace cambium::inline v0_1
