#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "cambium/behavior/law/braking.hpp"
#include "cambium/core/described.hpp"
#include "cambium/core/ids.hpp"
#include "cambium/map/lanes/signals.hpp"

namespace cambium::inline v0_1 {

/// Stops at red lights and stop signs; at yellow lights if it can stop by `safe_deceleration`.
struct Signals {
  double stop_margin = 1.0;
  double safe_deceleration = 3.6;
  double late_at_red = 0.0;
  double reaction = 0.8;
  double rolling_speed = 0.0;

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
                  "the driver still passes a light that has been red for less than this when it gets there"),
        parameter("reaction", &P::reaction, "s", Range{0, 10},
                  "after which it responds to a light that turns yellow, or green before one that stands"),
        parameter("rolling_speed", &P::rolling_speed, "m/s", Range{0, 10},
                  "a driver this slow at a stop sign has stopped there; 0: it comes to a stop"));
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
    double const soft_way = limits.jerk_bound.matters() ? soft_stop(speed, limits.jerk_bound.planned()) : 0.0;
    auto const stop =
        stop_at(view, view.place().s + view.shape().front, speed, soft_way, look_ahead, memory.stopped_at);
    limits.is_at_light = stop.is_light && speed < standing_speed;
    if (std::isfinite(stop.distance)) limits.stop_within(stop.distance, comfortable, dt);
  }

  /// How far [m] an agent may drive before signals within `look_ahead` [m] that stop it, for planners; infinite without
  /// such. O(signals).
  template <class View>
  [[nodiscard]] double free_way(View const& view, Memory& memory, double look_ahead) const {
    double const front = view.place().s + view.shape().front, speed = std::max(0.0, view.state().speed);
    return stop_at(view, front, speed, 0.0, look_ahead, memory.stopped_at).distance;
  }

 private:
  /// How far it may drive before signals that stop it.
  struct Stop {
    double distance = std::numeric_limits<double>::infinity();
    bool is_light = false;  ///< a traffic light is among them
  };

  [[nodiscard]] bool can_stop(double speed, double distance) const {
    return cambium::can_stop(speed, distance, safe_deceleration);
  }

  /// With its front end at `front` [m], for signals within `look_ahead` [m]: before the margin if it can, and a little
  /// farther where it stops softly then, within `soft_way` [m]. `stopped_at` [m]: see `Memory`.
  template <class View>
  [[nodiscard]] Stop stop_at(View const& view, double front, double speed, double soft_way, double look_ahead,
                             float& stopped_at) const {
    constexpr double closest = 0.1;  // [m]
    Stop stop;
    for (auto const& signal : view.corridor().signals) {
      double const to_line = signal.line - front;
      if (to_line > look_ahead) break;
      if (to_line < 0.0) continue;
      if (signal.kind == map::SignalKind::stop) {
        if (speed < std::max(standing_speed, rolling_speed) && to_line < stop_margin + 1.0 + rolling_speed)
          stopped_at = static_cast<float>(signal.line);
        if (std::abs(static_cast<double>(stopped_at) - signal.line) < 0.1) continue;
      } else {
        if (passes(view, signal.light, speed, to_line)) continue;
        stop.is_light = true;
      }
      double const before = can_stop(speed, to_line - stop_margin) ? stop_margin : std::min(stop_margin, 2.0 * closest);
      double const least = speed > 0.0 && to_line <= closest ? to_line : 0.0;
      double const way = std::max({to_line - before, std::min(soft_way, to_line - closest), least});
      stop.distance = std::min(stop.distance, way);
    }
    return stop;
  }

  /// Whether it passes a light `to_line` [m] ahead. Not to pass on red, it brakes up to 40 % harder.
  template <class View>
  [[nodiscard]] bool passes(View const& view, LightId light, double speed, double to_line) const {
    auto const color = view.light(light);
    if (color == map::LightColor::off) return true;
    bool const is_new = view.shown_for(light) < reaction;
    if (color == map::LightColor::green) return speed >= standing_speed || !is_new;
    if (color == map::LightColor::yellow) {
      bool const is_in_time = view.red_for(light) * speed + to_line <= 0.0;
      double const braking = is_in_time ? safe_deceleration : 1.4 * safe_deceleration;
      if (is_new || !cambium::can_stop(speed, to_line, braking)) return true;
    }
    if (late_at_red <= 0.0 || speed < standing_speed) return false;
    double const red_for = view.red_for(light);
    if (red_for >= late_at_red) return false;
    return red_for + to_line / speed < late_at_red || !can_stop(speed, to_line);
  }
};

}  // namespace cambium::inline v0_1
