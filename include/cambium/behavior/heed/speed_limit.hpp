#pragma once

#include <algorithm>

#include "cambium/behavior/law/braking.hpp"
#include "cambium/core/described.hpp"

namespace cambium::inline v0_1 {

/// Desires no more than the speed limit, and slows down in time for a lower one ahead.
struct SpeedLimit {
  double factor = 1.0;

  static constexpr char const* name = "speed_limit";
  static constexpr char const* summary = "desires no more than the limit, and slows down in time for a lower one";
  static constexpr char const* source = "own";
  static constexpr auto parameters() {
    return parameter_list(
        parameter("factor", &SpeedLimit::factor, "-", Range{0.1, 3}, "speed on a free road, in shares of the limit"));
  }

  /// The desired speed of a driver with `law` at `speed` [m/s]. O(limits within the braking distance).
  template <class Law, class View>
  [[nodiscard]] double desired_speed(Law const& law, View const& view, double speed) const {
    double const permitted =
        detail::permitted_speed(view.corridor(), view.place().s, speed, law.comfortable_deceleration);
    return factor * permitted;
  }

  /// Brakes with comfort where the law alone comes to a lower limit ahead too slowly. O(limits within the braking
  /// distance).
  template <class View, class Limits>
  void heed(View const& view, Limits& limits, double dt) const {
    auto const& changes = view.corridor().speed_limits;
    double const s = view.place().s;
    if (changes.empty() || changes.back().begin <= s) [[likely]]
      return;
    double const speed = limits.response().speed(), braking = limits.law().comfortable_deceleration;
    double const reach =
        s + speed * dt +
        stopping_distance(speed, std::max(0.0, limits.jerk_bound.acceleration), braking, limits.jerk_bound);
    for (auto const& change : changes) {
      if (change.begin <= s) continue;
      if (change.begin > reach) break;
      limits.bound(
          motion_before_bend(speed, change.begin - s, factor * change.limit, braking, braking, dt, limits.jerk_bound));
    }
  }
};

}  // namespace cambium::inline v0_1
