#pragma once

#include <algorithm>
#include <cmath>

#include "cambium/behavior/law/braking.hpp"
#include "cambium/behavior/law/stepping_out.hpp"
#include "cambium/core/described.hpp"

namespace cambium::inline v0_1 {

/// Brakes for agents on no lane, such as pedestrians, who will step into its way.
struct Pedestrians {
  double crossing_time = 4.0;
  double stop_margin = 1.0;

  static constexpr char const* name = "pedestrians";
  static constexpr char const* summary = "brakes for agents on no lane who will step into its way";
  static constexpr char const* source = "own";
  static constexpr auto parameters() {
    using P = Pedestrians;
    return parameter_list(parameter("crossing_time", &P::crossing_time, "s", Range{0, 60},
                                    "within which they will be there; 0: only for those in its lane"),
                          parameter("stop_margin", &P::stop_margin, "m", Range{0, 20}, "it keeps to their way"));
  }

  /// O(agents on no lane).
  template <class View, class Limits>
  void heed(View const& view, Limits& limits, double dt) const {
    if (!view.anybody_off_lanes() || !(crossing_time > 0.0)) [[likely]]
      return;
    constexpr double beyond = 20.0;  // [m]
    auto const& law = limits.law();
    double const speed = limits.response().speed(), comfortable = law.comfortable_deceleration;
    double const fastest = speed + law.maximum_acceleration * dt;
    double const braking = stopping_distance(fastest, law.maximum_acceleration, comfortable, limits.jerk_bound);
    double const look_ahead = fastest * dt + braking + beyond;
    double const way = detail::distance_before_crossing(view, view.place().s, speed, crossing_time, look_ahead);
    if (std::isfinite(way)) limits.stop_within(std::max(0.0, way - stop_margin), comfortable, dt);
  }
};

}  // namespace cambium::inline v0_1
