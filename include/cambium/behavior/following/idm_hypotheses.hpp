#pragma once

#include <algorithm>
#include <cstddef>
#include <string>

#include "cambium/behavior/behavior_model.hpp"
#include "cambium/behavior/following/idm_classic.hpp"
#include "cambium/core/distributions.hpp"

namespace cambium {

/// A driver by IDM whose time headway is not known, but lies in one of a few regions of equal width: what a planner
/// believes of somebody, see `MctsHypothesis`. The headway that is assumed is its memory: a search draws it anew.
struct IdmHypotheses {
  static constexpr std::size_t most_regions = 8;

  struct Memory {
    float time_headway = 1.5f;  ///< assumed [s]
    IdmClassic::Memory driver{};

    friend bool operator==(Memory const&, Memory const&) = default;
  };

  IdmClassic driver{};
  double shortest_headway = 0.5;
  double longest_headway = 3.5;
  int regions = 4;

  static constexpr char const* name = "idm_hypotheses";
  static constexpr char const* summary = "as idm_classic, with a time headway from one of a few regions, as assumed";
  static constexpr char const* source = "Treiber 2000; regions after Bernhard 2020";
  static constexpr auto parameters() {
    using P = IdmHypotheses;
    return parameter_list(
        parameter("driver", &P::driver, "-", {}, "all but the time headway"),
        parameter("shortest_headway", &P::shortest_headway, "s", Range{0, 20}, "where the first region begins"),
        parameter("longest_headway", &P::longest_headway, "s", Range{0, 20}, "where the last one ends"),
        parameter("regions", &P::regions, "-", Range{1, most_regions}, "how many there are"));
  }

  /// Throws `ParameterError` where the headways are in the wrong order.
  void check(std::string const& where) const {
    if (!(shortest_headway <= longest_headway))
      throw ParameterError(where, "has its longest headway below the shortest", "swap the two");
  }

  /// The headway at `share`, 0 to 1, of region `number` [s].
  [[nodiscard]] double headway(std::size_t number, double share) const {
    return shortest_headway + (longest_headway - shortest_headway) * (static_cast<double>(number) + share) / regions;
  }

  template <class View>
  [[nodiscard]] Plan<View> plan(View const& view, Memory& memory, double dt) const {
    IdmClassic assumed = driver;
    assumed.time_headway = static_cast<double>(memory.time_headway);
    return assumed.plan(view, memory.driver, dt);
  }
};
static_assert(BehaviorModel<IdmHypotheses>);

}  // namespace cambium
