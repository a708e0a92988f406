#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "cambium/behavior/law/braking.hpp"
#include "cambium/behavior/law/constraint.hpp"
#include "cambium/behavior/law/follow_lane.hpp"
#include "cambium/behavior/law/idm.hpp"
#include "cambium/behavior/view.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/map/corridor/corridor.hpp"
#include "cambium/map/lanes/signals.hpp"

namespace cambium {

/// The highest speed [m/s] at `s` of a corridor that lets a driver who brakes by `deceleration` [m/s^2] be at each
/// limit ahead 3 s in time, as car following comes down to a desired speed slowly; infinite where there is none.
/// O(limits within the way to brake).
CAMBIUM_NOINLINE [[nodiscard]] inline double permitted_speed(map::LaneCorridor const& corridor, double s, double speed,
                                                             double deceleration) {
  double permitted = corridor.speed_limit_at(s);
  double const early = s + 3.0 * speed, reach = early + speed * speed / (2.0 * deceleration);
  for (auto const& step : corridor.speed_limits) {
    if (step.begin <= s) continue;
    if (step.begin > reach) break;
    double const room = std::max(0.0, step.begin - early);
    permitted = std::min(permitted, std::sqrt(step.limit * step.limit + 2.0 * deceleration * room));
  }
  return permitted;
}

/// What the bends within reach allow.
struct BendsAhead {
  double highest;                    ///< speed in the sharpest of them [m/s]
  LongitudinalMotion<double> bound;  ///< of a step: it goes no farther
};

/// The bends that a vehicle of `speed` [m/s] at `s` [m] comes to within a step of `dt` [s] and its way to brake with
/// `deceleration` [m/s^2]: so that its `lateral_acceleration` [m/s^2] in them is in bounds. It brakes up to `hardest`
/// where it is too late; `desired_speed` [m/s] where there is none. O(log bends) and those within reach.
[[nodiscard]] inline BendsAhead bends_ahead(map::LaneCorridor const& corridor, double s, double speed,
                                            double desired_speed, double lateral_acceleration, double deceleration,
                                            double hardest, double dt) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  BendsAhead ahead{desired_speed, {infinite, infinite}};
  double const reach = s + speed * (dt + speed / (2.0 * deceleration));
  auto const& bends = corridor.bends;
  auto bend = std::partition_point(bends.begin(), bends.end(), [s](map::Bend const& b) { return b.end < s; });
  for (; bend != bends.end() && bend->begin <= reach; ++bend) {
    double const highest = std::sqrt(lateral_acceleration / bend->curvature);
    auto const motion = motion_before_bend(speed, bend->begin - s, highest, deceleration, hardest, dt);
    ahead.highest = std::min(ahead.highest, highest);
    if (motion.distance < ahead.bound.distance) ahead.bound = motion;
  }
  return ahead;
}

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

/// A neighbour as a constraint; its acceleration only where `Law` asks for it.
template <class Law, class View>
[[nodiscard]] Constraint constraint_of(View const& view, RoadUser const& user) {
  Constraint constraint{user.gap, user.speed, 0.0};
  if constexpr (Law::asks_acceleration)
    if (is_valid(user.agent)) constraint.acceleration = view.acceleration(user);
  return constraint;
}

/// What a driver heeds on the road, beside the next vehicle: the same for all models that drive. A model asks for its
/// desired speed, lets the rules add constraints to those that its law answers, and bounds the motion that comes of it.
struct RoadRules {
  enum class LaneEnd {
    ignored,
    before_destination,  ///< brakes where its lane ends or leads away before the route does
    always,              ///< brakes before every end of its lane corridor, as BARK's option does
  };

  LaneEnd lane_end = LaneEnd::ignored;
  double lane_end_distance = 60.0;
  double lane_end_offset = 15.0;
  bool obey_speed_limits = false;
  bool slow_for_bends = false;
  double lateral_acceleration = 2.5;
  bool obey_signals = false;
  double stop_margin = 1.0;
  double safe_deceleration = 3.0;
  Merging merging = Merging::counts;

  static constexpr char const* name = "road_rules";
  static constexpr char const* summary =
      "what a driver heeds beside the next vehicle: the end of its lane, speed limits, bends, lights and stop signs";
  static constexpr char const* source = "own; lane end: BARK";
  static constexpr auto parameters() {
    using P = RoadRules;
    return parameter_list(
        choice("lane_end", &P::lane_end, "ignored|before_destination|always",
               "which ends of its lane a driver brakes for"),
        parameter("lane_end_distance", &P::lane_end_distance, "m", Range{0, 10'000},
                  "from how far before the end; above about 15 m/s the default is too short to stop"),
        parameter("lane_end_offset", &P::lane_end_offset, "m", Range{0, 1000},
                  "how far before the end the place is where it would stop"),
        parameter("obey_speed_limits", &P::obey_speed_limits, "-", Range{0, 1},
                  "desire no more than the limit, and be there in time for a lower one ahead"),
        parameter("slow_for_bends", &P::slow_for_bends, "-", Range{0, 1}, "brake in time for bends"),
        parameter("lateral_acceleration", &P::lateral_acceleration, "m/s^2", Range{0.1, 50}, "in bends, at most"),
        parameter("obey_signals", &P::obey_signals, "-", Range{0, 1}, "stop at red lights and stop signs"),
        parameter("stop_margin", &P::stop_margin, "m", Range{0, 20}, "from the front end to a line where it waits"),
        parameter("safe_deceleration", &P::safe_deceleration, "m/s^2", Range{0.1, 20},
                  "who would have to brake harder does not stop at a light that has just turned yellow"),
        choice("merging", &P::merging, "counts|by_rule|ignored",
               "those in lanes that are still to merge into the own one: followed, in junctions not, nowhere"));
  }

  /// What a driver remembers of them.
  struct Memory {
    float stopped_at = -1.0f;  ///< corridor position of the last stop sign that it has stopped at [m]

    friend bool operator==(Memory const&, Memory const&) = default;
  };

  /// What a driver of parameters `idm` desires where it is, at `speed` [m/s]: within the limits, if it obeys them.
  template <HasIdmParameters P, class View>
  [[nodiscard]] double desired_speed(P const& idm, View const& view, double speed) const {
    if (!obey_speed_limits) [[likely]]
      return idm.desired_speed;
    return std::clamp(permitted_speed(view.corridor(), view.place().s, speed, idm.comfortable_deceleration), 0.1,
                      idm.desired_speed);
  }

  /// The end of the lane, where there is one to brake for.
  template <class View>
  [[nodiscard]] std::optional<Constraint> lane_end_ahead(View const& view) const {
    if (lane_end == LaneEnd::ignored) [[likely]]
      return std::nullopt;
    auto const& corridor = view.corridor();
    if (lane_end == LaneEnd::before_destination && corridor.reaches_destination) return std::nullopt;
    double const left = corridor.length_until_end(view.place().s) - view.shape().front;
    if (left > lane_end_distance) return std::nullopt;
    return Constraint{std::max(0.0, left - lane_end_offset), 0.0, 0.0};
  }

  /// Adds the next vehicle ahead, `next`, and the end of the lane.
  template <class View, class Law>
  void heed(View const& view, std::optional<RoadUser> const& next, Strictest<Law>& ahead) const {
    if (next) ahead.heed(constraint_of<Law>(view, *next));
    if (auto const end = lane_end_ahead(view)) ahead.heed(*end);
  }
  template <class View, class Law>
  void heed(View const& view, Strictest<Law>& ahead) const {
    heed(view, view.ahead({.merging = merging}), ahead);
  }

  /// The motion of a step of `dt` [s] from `s` [m] at `speed` [m/s], bounded so that bends and signals are heeded; a
  /// driver of parameters `idm` brakes comfortably for them, and harder only where that is too late.
  template <class View, HasIdmParameters P>
  [[nodiscard]] LongitudinalMotion<double> bound(View const& view, P const& idm, double s, double speed,
                                                 LongitudinalMotion<double> const& motion, double dt,
                                                 Memory& memory) const {
    double const fastest = std::max(speed, motion.speed);
    bool const bends = slow_for_bends && fastest * fastest * view.corridor().sharpest_bend > lateral_acceleration;
    if (!bends && !obey_signals) [[likely]]
      return motion;
    View const here = view;  // what is not inlined gets copies, so that the originals can stay in registers
    Memory changed = memory;
    auto const bounded =
        within_bounds(here, {idm.comfortable_deceleration, -idm.lowest_acceleration}, s, speed, motion, dt, changed);
    memory = changed;
    return bounded;
  }

 private:
  struct Braking {
    double comfortable, hardest;  // [m/s^2]
  };

  template <class View>
  CAMBIUM_NOINLINE [[nodiscard]] LongitudinalMotion<double> within_bounds(View const& view, Braking const& braking,
                                                                          double s, double speed,
                                                                          LongitudinalMotion<double> motion, double dt,
                                                                          Memory& memory) const {
    auto const bound_by = [&motion](LongitudinalMotion<double> const& other) {
      if (other.distance < motion.distance) motion = other;
    };
    if (slow_for_bends)
      bound_by(
          bends_ahead(view.corridor(), s, speed, speed, lateral_acceleration, braking.comfortable, braking.hardest, dt)
              .bound);
    if (!obey_signals) return motion;
    double const look_ahead = speed * speed / (2.0 * braking.comfortable) + 20.0;
    auto const stop = stop_at_signals(view, s + view.shape().front, speed, look_ahead, stop_margin, safe_deceleration,
                                      memory.stopped_at);
    if (std::isfinite(stop.distance))
      bound_by(motion_before_stop(speed, stop.distance, braking.comfortable, braking.hardest, dt));
    return motion;
  }
};

}  // namespace cambium
