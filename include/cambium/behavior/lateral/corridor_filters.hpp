#pragma once

#include <cmath>
#include <concepts>

#include "cambium/behavior/behavior_model.hpp"
#include "cambium/behavior/law/lane_option.hpp"
#include "cambium/core/parameters.hpp"

namespace cambium::inline v0_1 {

/// A condition that the target lane of a lane change must meet: a described struct with
///   `template <class View> bool operator()(View const& view, LaneOption const& option) const`.
template <class F>
concept CorridorFilter = std::copyable<F> && Described<F> &&
    requires(F const filter, ViewArchetype const view, LaneOption const option) {
  { filter(view, option) } -> std::convertible_to<bool>;
};

/// The conjunction of several conditions, evaluated in order.
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
    return parameter_list(parameter("first", &AllOf::first, "the first condition"),
                          parameter("rest", &AllOf::rest, "the further conditions"));
  }

  template <class View>
  [[nodiscard]] bool operator()(View const& view, LaneOption const& option) const {
    return first(view, option) && rest(view, option);
  }
};

/// Free space as BARK requires it: a fixed gap ahead, and behind a fixed gap plus a time times the speed difference.
struct FreeSpace {
  double front = 5.0;
  double rear = 5.0;
  double time = 1.0;

  static constexpr char const* name = "free_space";
  static constexpr char const* summary = "a gap ahead, and one behind that grows with the speed difference";
  static constexpr char const* source = "BARK";
  static constexpr auto parameters() {
    return parameter_list(parameter("front", &FreeSpace::front, "m", Range{0, 1000}, "smallest gap to the new leader"),
                          parameter("rear", &FreeSpace::rear, "m", Range{0, 1000}, "smallest gap to the new follower"),
                          parameter("time", &FreeSpace::time, "s", Range{0, 60},
                                    "times the speed difference to the new follower, added to the gap behind"));
  }

  template <class View>
  [[nodiscard]] bool operator()(View const& view, LaneOption const& option) const {
    if (option.front && option.front->gap < front) return false;
    return !option.rear || option.rear->gap >= rear + time * std::abs(option.rear->speed - view.state().speed);
  }
};
static_assert(CorridorFilter<FreeSpace>);

/// The target lane must be long enough before it ends, merges or leaves the route.
struct RemainingLength {
  double least = 60.0;

  static constexpr char const* name = "remaining_length";
  static constexpr char const* summary = "the target lane is long enough";
  static constexpr char const* source = "BARK";
  static constexpr auto parameters() {
    return parameter_list(parameter("least", &RemainingLength::least, "m", Range{0, 10'000},
                                    "length of the lane from beside the vehicle on"));
  }

  template <class View>
  [[nodiscard]] bool operator()(View const& view, LaneOption const& option) const {
    return lane_end(view, option.place.corridor, option.place.piece) - option.place.s >= least;
  }
};
static_assert(CorridorFilter<RemainingLength>);

/// The speed limit of the target lane must be high enough.
struct SpeedLimitAtLeast {
  double speed = 0.0;

  static constexpr char const* name = "speed_limit_at_least";
  static constexpr char const* summary = "the target lane permits this speed";
  static constexpr char const* source = "own";
  static constexpr auto parameters() {
    return parameter_list(
        parameter("speed", &SpeedLimitAtLeast::speed, "m/s", Range{0, 200}, "lowest speed limit of the lane"));
  }

  template <class View>
  [[nodiscard]] bool operator()(View const& view, LaneOption const& option) const {
    return view.road().corridors[option.place.corridor].speed_limit_at(option.place.s) >= speed;
  }
};
static_assert(CorridorFilter<SpeedLimitAtLeast>);

}  // namespace cambium::inline v0_1
