#pragma once

#include <concepts>
#include <cstddef>
#include <string>

#include "cambium/behavior/behavior_model.hpp"
#include "cambium/core/described.hpp"

namespace cambium::inline v0_1 {

/// A behaviour with something unknown about its driver, which a planner learns by observation, see `Mcts`:
/// - `hypotheses()`: the number of hypotheses about it, 1 to 8;
/// - `assume(memory, number, share)`: sets the memory of a driver for whom hypothesis `number` holds. Where that is a
///   range of values, `share`, 0 to 1, says which; the middle, 0.5, stands for all when the planner compares what it
///   observes.
template <class B>
concept HypothesisModel = BehaviorModel<B> && requires(B const driver, MemoryOf<B>& memory) {
  { driver.hypotheses() } -> std::convertible_to<std::size_t>;
  driver.assume(memory, std::size_t{}, double{});
};

/// A driver whose time headway is unknown but lies in one of a few regions of equal width: a planner's belief
/// about another driver, see `Mcts`. The assumed headway is its memory, which a search draws anew. With `Intersection`
/// as the driver, the drivers about whom it learns obey the rules of junctions.
template <BehaviorModel Driver>
struct HeadwayHypotheses {
  static_assert(
      requires(Driver driver) { driver.law.time_headway; },
      "cambium::HeadwayHypotheses<Driver>: Driver must have a law with a time_headway, as every cambium::Driver does");

  static constexpr std::size_t most_regions = 8;
  static constexpr bool looks_beside = detail::looks_beside<Driver>();
  static constexpr bool looks_around = detail::looks_around<Driver>();
  static constexpr bool heeds_conflicts = detail::heeds_conflicts<Driver>();

  struct Memory {
    float time_headway = 1.5f;  ///< assumed [s]
    MemoryOf<Driver> driver{};

    void fell_short(double way, bool left_course) { cambium::fell_short(driver, way, left_course); }
    void was_set() { cambium::was_set(driver); }

    static constexpr char const* name = "headway_hypotheses_memory";
    static constexpr auto parameters() {
      using P = Memory;
      return parameter_list(parameter("time_headway", &P::time_headway, "s", any_finite, "assumed"),
                            parameter("driver", &P::driver, "the driver's"));
    }

    friend bool operator==(Memory const&, Memory const&) = default;
  };

  Driver driver{};
  double shortest_headway = 0.5;
  double longest_headway = 3.5;
  int regions = 4;

  static constexpr char const* name = "headway_hypotheses";
  static constexpr char const* summary = "as another driver, with an assumed time headway from one of a few regions";
  static constexpr char const* source = "regions after Bernhard 2020";
  static constexpr auto parameters() {
    using P = HeadwayHypotheses;
    return parameter_list(
        parameter("driver", &P::driver, "everything except the time headway"),
        parameter("shortest_headway", &P::shortest_headway, "s", Range{0, 20}, "begin of the first region"),
        parameter("longest_headway", &P::longest_headway, "s", Range{0, 20}, "end of the last region"),
        parameter("regions", &P::regions, "-", Range{1, most_regions}, "number of regions"));
  }

  /// Throws `ParameterError` if the longest headway is below the shortest.
  void check(std::string const& where) const {
    if (!(shortest_headway <= longest_headway))
      throw ParameterError(where, "has its longest headway below the shortest", "swap the two");
  }

  [[nodiscard]] std::size_t hypotheses() const { return static_cast<std::size_t>(regions); }
  void assume(Memory& memory, std::size_t number, double share) const {
    memory.time_headway = static_cast<float>(headway(number, share));
  }

  /// Headway [s] at `share`, 0 to 1, of region `number`.
  [[nodiscard]] double headway(std::size_t number, double share) const {
    return shortest_headway + (longest_headway - shortest_headway) * (static_cast<double>(number) + share) / regions;
  }

  template <class View>
  [[nodiscard]] Plan<View> plan(View const& view, Memory& memory, double dt) const {
    auto assumed = driver;
    assumed.law.time_headway = static_cast<double>(memory.time_headway);
    return assumed.plan(view, memory.driver, dt);
  }
};

}  // namespace cambium::inline v0_1
