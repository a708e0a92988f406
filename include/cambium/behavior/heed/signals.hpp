#pragma once

#include <algorithm>
#include <cmath>

#include "cambium/behavior/law/braking.hpp"
#include "cambium/core/described.hpp"

namespace cambium {

/// Stops at red lights and stop signs; at yellow lights if it can stop by `safe_deceleration`.
struct Signals {
  double stop_margin = 1.0;
  double safe_deceleration = 3.0;
  double late_at_red = 0.0;

  static constexpr char const* name = "signals";
  static constexpr char const* summary = "stops at red lights and stop signs";
  static constexpr char const* source = "own";
  static constexpr auto parameters() {
    using P = Signals;
    return parameter_list(
        parameter("stop_margin", &P::stop_margin, "m", Range{0, 20}, "from the front end to the line where it waits"),
        parameter("safe_deceleration", &P::safe_deceleration, "m/s^2", Range{0.1, 20},
                  "a driver who would have to brake harder passes a light that has just turned yellow"),
        parameter("late_at_red", &P::late_at_red, "s", Range{0, 60},
                  "the driver still passes a light that has been red for less than this when it gets there"));
  }

  struct Memory {
    float stopped_at = -1.0f;  ///< corridor position of the stop sign at which it stopped last [m]

    static constexpr char const* name = "signals_memory";
    static constexpr auto parameters() {
      return parameter_list(parameter("stopped_at", &Memory::stopped_at, "m", any_finite,
                                      "corridor position of the stop sign at which it stopped last"));
    }
    friend bool operator==(Memory const&, Memory const&) = default;
  };

  /// Sets `limits.is_at_light`. O(signals).
  template <class View, class Limits>
  void heed(View const& view, Memory& memory, Limits& limits, double dt) const {
    constexpr double least = 80.0, beyond = 20.0;  // [m] it looks ahead
    if (view.corridor().signals.empty()) return;
    auto const& law = limits.law();
    double const speed = limits.response().speed();
    double const comfortable = law.comfortable_deceleration, fastest = speed + law.maximum_acceleration * dt;
    double const braking = stopping_distance(fastest, law.maximum_acceleration, comfortable, limits.jerk_bound);
    double const look_ahead = std::max(least, fastest * dt + braking + beyond);
    auto const stop = detail::stop_at_signals(view, view.place().s + view.shape().front, speed, look_ahead, stop_margin,
                                              safe_deceleration, late_at_red, memory.stopped_at);
    limits.is_at_light = stop.is_light && speed < standing_speed;
    if (std::isfinite(stop.distance)) limits.stop_within(stop.distance, comfortable, dt);
  }
};

}  // namespace cambium
