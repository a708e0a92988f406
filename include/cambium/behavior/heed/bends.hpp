#pragma once

#include <algorithm>

#include "cambium/behavior/law/braking.hpp"
#include "cambium/core/described.hpp"

namespace cambium::inline v0_1 {

/// Brakes in time for bends: comfortably, and harder only if that no longer suffices.
struct Bends {
  double lateral_acceleration = 2.5;

  static constexpr char const* name = "bends";
  static constexpr char const* summary = "brakes in time for bends";
  static constexpr char const* source = "own";
  static constexpr auto parameters() {
    return parameter_list(
        parameter("lateral_acceleration", &Bends::lateral_acceleration, "m/s^2", Range{0.1, 50}, "highest in bends"));
  }

  /// Sets `limits.highest_speed`, for what it heeds after this. O(log bends + bends within the braking distance).
  template <class View, class Limits>
  void heed(View const& view, Limits& limits, double dt) const {
    auto const& corridor = view.corridor();
    auto const& law = limits.law();
    double const speed = limits.response().speed(), gains = law.maximum_acceleration;
    double const fastest = speed + gains * (dt + 0.5 * gains / limits.jerk_bound.planned());
    bool const matters = fastest * fastest * corridor.sharpest_bend > lateral_acceleration;
    if (!matters && corridor.conflicts.empty()) [[likely]]
      return;
    auto const bends =
        detail::bends_ahead(corridor, view.place().s, speed, limits.highest_speed, lateral_acceleration,
                            law.comfortable_deceleration, -law.lowest_acceleration, dt, limits.jerk_bound);
    limits.highest_speed = bends.highest;
    limits.bound(bends.bound);
  }
};

/// `Bends` with another default: `percent` hundredths of a metre per second squared.
template <int percent>
struct BendsFor : Bends {
  constexpr BendsFor() : Bends{percent / 100.0} {}
  constexpr BendsFor(Bends const& bends) : Bends(bends) {}
};

}  // namespace cambium::inline v0_1
