#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "cambium/behavior/braking.hpp"
#include "cambium/map/corridor.hpp"
#include "cambium/map/signals.hpp"

namespace cambium {

/// How far a vehicle may go [m] before a signal that stops it; infinite where none does.
struct SignalStop {
  double distance = std::numeric_limits<double>::infinity();
  bool is_light = false;  ///< a light is one of them
};

/// The stop at signs and lights within `look_ahead` [m] of a vehicle with its front end at `front` [m]: at lights that
/// are red, or yellow while it can stop by `deceleration` [m/s^2], and at stop signs, `margin` [m] before the line if
/// it can. `stopped_at`: the last stop sign's line at which it has stopped [m], kept up to date. O(signals).
template <class View>
[[nodiscard]] SignalStop stop_at_signals(View const& view, double front, double speed, double look_ahead, double margin,
                                         double deceleration, float& stopped_at) {
  SignalStop stop;
  for (auto const& signal : view.corridor().signals) {
    double const to_line = signal.line - front;
    if (to_line > look_ahead) break;
    if (to_line < 0.0) continue;
    if (signal.kind == map::SignalKind::stop) {
      if (speed < standing_speed && to_line < margin + 1.0) stopped_at = static_cast<float>(signal.line);
      if (std::abs(static_cast<double>(stopped_at) - signal.line) < 0.1) continue;
    } else {
      auto const color = view.light(signal.light);
      if (color == map::LightColor::off || color == map::LightColor::green) continue;
      if (color == map::LightColor::yellow && !can_stop(speed, to_line, deceleration)) continue;
      stop.is_light = true;
    }
    double const before = can_stop(speed, to_line - margin, deceleration) ? margin : 0.0;
    stop.distance = std::min(stop.distance, std::max(0.0, to_line - before));
  }
  return stop;
}

}  // namespace cambium
