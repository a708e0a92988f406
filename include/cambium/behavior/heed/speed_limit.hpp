#pragma once

#include <algorithm>

#include "cambium/behavior/law/braking.hpp"
#include "cambium/core/described.hpp"

namespace cambium {

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
};

}  // namespace cambium
