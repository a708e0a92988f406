#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>

#include "cambium/behavior/lane_change/lane_changing.hpp"
#include "cambium/core/parameters.hpp"

namespace cambium {

/// A condition that a lane beside must fulfil for a change into it: a described struct with
///   `template <class View> bool operator()(View const& view, LaneOption const& option) const`.
template <class F>
concept CorridorFilter = std::copyable<F> && Described<F> &&
    requires(F const filter, ViewArchetype const view, LaneOption const option) {
  { filter(view, option) } -> std::convertible_to<bool>;
};

/// All of several conditions, in their order.
template <class... Filters>
struct AllOf;

template <>
struct AllOf<> {
  static constexpr char const* name = "all_of";
  static constexpr auto parameters() { return parameter_list(); }

  template <class View>
  [[nodiscard]] bool operator()(View const&, LaneOption const&) const {
    return true;
  }
};

template <class First, class... Rest>
struct AllOf<First, Rest...> {
  static_assert(CorridorFilter<First>,
                "cambium::AllOf<Filters...>: each filter must be a described struct with `template <class View> bool "
                "operator()(View const&, LaneOption const&) const` (see CorridorFilter)");
  First first{};
  [[no_unique_address]] AllOf<Rest...> rest{};

  static constexpr char const* name = "all_of";
  static constexpr auto parameters() {
    return parameter_list(parameter("first", &AllOf::first, "-", {}, "the first condition"),
                          parameter("rest", &AllOf::rest, "-", {}, "the further ones"));
  }

  template <class View>
  [[nodiscard]] bool operator()(View const& view, LaneOption const& option) const {
    return first(view, option) && rest(view, option);
  }
};

/// Free space ahead and behind as BARK asks for it: fixed distances, behind with a time for the difference of speeds.
struct FreeSpace {
  double front = 5.0;
  double rear = 5.0;
  double time = 1.0;

  static constexpr char const* name = "free_space";
  static constexpr char const* summary = "room ahead, and behind by a time times the difference of speeds";
  static constexpr char const* source = "BARK";
  static constexpr auto parameters() {
    return parameter_list(parameter("front", &FreeSpace::front, "m", Range{0, 1000}, "least gap to the new leader"),
                          parameter("rear", &FreeSpace::rear, "m", Range{0, 1000}, "least gap to the new follower"),
                          parameter("time", &FreeSpace::time, "s", Range{0, 60},
                                    "times the difference of speeds to the new follower, on top of that"));
  }

  template <class View>
  [[nodiscard]] bool operator()(View const& view, LaneOption const& option) const {
    if (option.front && option.front->gap < front) return false;
    return !option.rear || option.rear->gap >= rear + time * std::abs(option.rear->speed - view.state().speed);
  }
};
static_assert(CorridorFilter<FreeSpace>);

/// Enough of the lane is left before it ends, merges or leaves the route.
struct RemainingLength {
  double least = 60.0;

  static constexpr char const* name = "remaining_length";
  static constexpr char const* summary = "enough of the lane is left";
  static constexpr char const* source = "BARK";
  static constexpr auto parameters() {
    return parameter_list(parameter("least", &RemainingLength::least, "m", Range{0, 10'000},
                                    "left of the lane from beside the vehicle on"));
  }

  template <class View>
  [[nodiscard]] bool operator()(View const& view, LaneOption const& option) const {
    return lane_end(view, option.place.corridor, option.place.piece) - option.place.s >= least;
  }
};
static_assert(CorridorFilter<RemainingLength>);

/// No change into a lane whose speed limit is below what is asked for.
struct SpeedLimitAtLeast {
  double speed = 0.0;

  static constexpr char const* name = "speed_limit_at_least";
  static constexpr char const* summary = "the lane permits so much";
  static constexpr char const* source = "own";
  static constexpr auto parameters() {
    return parameter_list(
        parameter("speed", &SpeedLimitAtLeast::speed, "m/s", Range{0, 200}, "least speed limit of the lane"));
  }

  template <class View>
  [[nodiscard]] bool operator()(View const& view, LaneOption const& option) const {
    return view.road().corridors[option.place.corridor].speed_limit_at(option.place.s) >= speed;
  }
};
static_assert(CorridorFilter<SpeedLimitAtLeast>);

}  // namespace cambium
