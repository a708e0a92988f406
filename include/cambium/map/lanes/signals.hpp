#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include "cambium/core/described.hpp"
#include "cambium/core/ids.hpp"

namespace cambium::inline v0_1::map {

/// What a sign or light at the road tells the traffic of a lane.
enum class SignalKind : std::uint8_t {
  priority,  ///< it goes before traffic without that sign: 301, 306 of the German catalogue, which OpenDRIVE files use
  give_way,  ///< it gives way to other traffic: 205
  stop,      ///< it stops, then gives way: 206
  light,     ///< a traffic light: 1000001
};

/// A sign or light for one lane.
struct LaneSignal {
  double s{};  ///< on the lane's path [m]
  SignalKind kind = SignalKind::priority;
  LightId light = none<LightId>;  ///< only of a light

  friend bool operator==(LaneSignal const&, LaneSignal const&) = default;
};

/// Traffic lights that are switched together: a controller of the file, or a single light that no controller switches.
struct TrafficLight {
  LightId id = none<LightId>;
  std::string name;  ///< the file's id of the controller; of a single light "signal " and its id
};

/// What a light shows. One that is out of order is `off`: the signs beside it count.
enum class LightColor : std::uint8_t { off, green, yellow, red };

/// A light's phases, which repeat: green from `green_begin` to `green_end`, then yellow, else red. A cycle of 0 s: off.
struct LightPlan {
  double cycle = 0.0;        ///< [s]
  double green_begin = 0.0;  ///< in the cycle [s]
  double green_end = 0.0;    ///< [s], may lie beyond the cycle's end
  double yellow = 3.0;       ///< [s]

  static constexpr char const* name = "light_plan";
  static constexpr auto parameters() {
    using P = LightPlan;
    constexpr double day = 86'400.0;
    return parameter_list(
        parameter("cycle", &P::cycle, "s", Range{0, day}, "after which the phases repeat; 0: off"),
        parameter("green_begin", &P::green_begin, "s", Range{-day, day}, "in the cycle"),
        parameter("green_end", &P::green_end, "s", Range{-day, 2 * day}, "may lie beyond the cycle's end"),
        parameter("yellow", &P::yellow, "s", Range{0, day}, "duration of yellow, after green"));
  }

  friend bool operator==(LightPlan const&, LightPlan const&) = default;

  /// Whether its phases are not negative, and within a day.
  [[nodiscard]] bool is_possible() const {
    constexpr double day = 86'400.0;
    return cycle >= 0.0 && cycle <= day && yellow >= 0.0 && yellow <= day && std::abs(green_begin) <= day &&
           green_end >= green_begin && green_end <= 2.0 * day;
  }

  /// What it shows at `time` [s]. O(1).
  [[nodiscard]] LightColor at(double time) const {
    if (!(cycle > 0.0)) return LightColor::off;
    double const passed = since_green(time), green = std::min(cycle, green_end - green_begin);
    if (passed < green) return LightColor::green;
    return passed < green + yellow ? LightColor::yellow : LightColor::red;
  }

  /// How long it has shown its colour at `time` [s]; infinite if it is always green, 0 for a light that is off. O(1).
  [[nodiscard]] double shown_for(double time) const {
    if (!(cycle > 0.0)) return 0.0;
    double const passed = since_green(time), green = green_end - green_begin;
    if (green >= cycle) return std::numeric_limits<double>::infinity();
    return passed - (passed < green ? 0.0 : passed < green + yellow ? green : green + yellow);
  }

  /// Time since the light turned red at `time` [s]; while it is green or yellow, minus the time until it does. 0 for a
  /// light that is off. O(1).
  [[nodiscard]] double red_for(double time) const {
    if (!(cycle > 0.0)) return 0.0;
    return since_green(time) - std::min(cycle, green_end - green_begin) - yellow;
  }

 private:
  /// Time in the cycle since green began [s].
  [[nodiscard]] double since_green(double time) const {
    double const since = time - green_begin;
    return since - std::floor(since / cycle) * cycle;
  }
};

}  // namespace cambium::inline v0_1::map
