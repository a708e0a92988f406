#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "cambium/core/parameters.hpp"
#include "cambium/map/corridor/corridor.hpp"
#include "cambium/planner/frenet/frenet_motion.hpp"
#include "cambium/planner/frenet/quintic.hpp"

namespace cambium::inline v0_1 {

/// Weights of the cost of a course (Werling, Ziegler, Kammel, Thrun 2010, sections V and VI).
struct FrenetCosts {
  double jerk = 0.1;
  double time = 0.1;
  double offset = 1.0;
  double speed = 1.0;
  double lateral = 1.0;
  double route = 40.0;
  double route_urgency = 20.0;

  static constexpr char const* name = "frenet_costs";
  static constexpr char const* summary =
      "weights of jerk, duration and deviations at the end, as Werling 2010, and of lane changes to the destination";
  static constexpr auto parameters() {
    using P = FrenetCosts;
    return parameter_list(
        parameter("jerk", &P::jerk, "s^5/m^2", non_negative, "weight of the integral of the squared jerk"),
        parameter("time", &P::time, "1/s", non_negative, "weight of the duration"),
        parameter("offset", &P::offset, "1/m^2", non_negative,
                  "weight of the squared offset from the lane's middle at the end"),
        parameter("speed", &P::speed, "s^2/m^2", non_negative,
                  "weight of the squared deviation from the desired speed at the end"),
        parameter("lateral", &P::lateral, "-", non_negative,
                  "weight of the lateral motion relative to the longitudinal one"),
        parameter("route", &P::route, "-", non_negative,
                  "cost of each lane change still needed to reach the destination"),
        parameter("route_urgency", &P::route_urgency, "-", non_negative,
                  "how often that cost is added again at the end of the lane"));
  }
};

/// Limits of the vehicle or of comfort, and the clearance to others.
struct FrenetLimits {
  double lowest_acceleration = -6.0;
  double highest_acceleration = 3.0;
  double lateral_acceleration = 4.0;
  double highest_curvature = 0.2;
  double clearance = 0.3;

  static constexpr char const* name = "frenet_limits";
  static constexpr char const* summary = "limits of the vehicle or of comfort, and the clearance to others";
  static constexpr auto parameters() {
    using P = FrenetLimits;
    return parameter_list(
        parameter("lowest_acceleration", &P::lowest_acceleration, "m/s^2", Range{-50, -0.1},
                  "of valid courses, and for braking if none is valid"),
        parameter("highest_acceleration", &P::highest_acceleration, "m/s^2", Range{0.1, 50}, "of valid courses"),
        parameter("lateral_acceleration", &P::lateral_acceleration, "m/s^2", Range{0.1, 50}, "of valid courses"),
        parameter("highest_curvature", &P::highest_curvature, "1/m", Range{1e-3, 10}, "of valid courses"),
        parameter("clearance", &P::clearance, "m", Range{0, 10},
                  "distance kept on all sides, where there is a course that does"));
  }
};

/// The result of checking a course: valid, or why not.
enum class FrenetVerdict : std::uint8_t {
  unchecked,
  valid,
  not_finite,  ///< its cost or its motion is not a finite number
  reverses,
  speed,
  acceleration,
  curvature,
  gap,
  road,
  collision,
  stop,      ///< it passes a place where it has to stop by the rules
  follower,  ///< one behind in the lane beside would have to brake hard
  close      ///< it touches nobody, but without the clearance; driven if no course is valid
};

/// What a candidate failed by, in words.
[[nodiscard]] constexpr char const* to_string(FrenetVerdict verdict) {
  constexpr char const* names[] = {"unchecked",
                                   "valid",
                                   "not finite",
                                   "reverses",
                                   "too fast",
                                   "acceleration",
                                   "curvature",
                                   "gap",
                                   "off road",
                                   "collision",
                                   "red light, stop sign or right of way",
                                   "follower brakes",
                                   "too close"};
  return names[static_cast<std::size_t>(verdict)];
}

/// A course along a lane: two polynomials for `duration`, then constant speed at a constant offset.
struct FrenetCandidate {
  enum class Kind : std::uint8_t { keep_speed, follow };  ///< to follow a standing leader is to stop

  CorridorId corridor = none<CorridorId>;  ///< the lane corridor along whose centre line it runs
  Kind kind = Kind::keep_speed;
  bool by_way = false;       ///< at low speed: the offset depends on the distance, not on time
  bool tight = false;        ///< likewise, over as little distance as it can steer
  double duration{};         ///< [s]
  double offset{};           ///< at the end [m]
  double speed{};            ///< at the end [m/s]
  Quintic<double> along{};   ///< `s` over time
  Quintic<double> across{};  ///< offset over time or, if `by_way`, over the distance
  double way{};              ///< distance at which the offset is reached [m]
  double cost{};
  FrenetVerdict verdict = FrenetVerdict::unchecked;

  /// The motion after `time` [s].
  [[nodiscard]] FrenetMotion<double> at(double time) const {
    double const t = std::min(time, duration);
    auto const s = along.at(t);
    FrenetMotion<double> motion{s.position, s.speed, s.acceleration, offset, 0.0, 0.0};
    if (time > duration) motion = {s.position + speed * (time - duration), speed, 0.0, offset, 0.0, 0.0};
    if (by_way) {
      double const driven = motion.s - along.c[0];
      if (driven >= way) return motion;
      auto const d = across.at(std::max(0.0, driven));
      motion.offset = d.position;
      motion.slope = d.speed;
      motion.bend = d.acceleration;
    } else if (time < duration) {
      auto const d = across.at(t);
      constexpr double slowest = 0.1;  // [m/s] below it the slope over the way is that of this speed
      double const v = std::max(s.speed, slowest);
      motion.offset = d.position;
      motion.slope = d.speed / v;
      motion.bend = (d.acceleration - motion.slope * s.acceleration) / (v * v);
    }
    return motion;
  }
};

/// What the end of a course aims at.
struct FrenetTarget {
  double position{};  ///< of the reference point; infinite if only the speed matters [m]
  double speed{};     ///< [m/s]
};

/// The course from `start` that reaches `target` at `offset` after `duration` [s], with its cost except that of the
/// route. If either end is slower than `low_speed` [m/s], its offset depends on the distance (`by_way`), because a
/// vehicle moves sideways only while it drives: over the whole distance or, if `tight`, over as little as it can steer.
[[nodiscard]] inline FrenetCandidate frenet_candidate(FrenetMotion<double> const& start, FrenetTarget const& target,
                                                      double offset, double duration, double desired_speed,
                                                      double low_speed, FrenetCosts const& costs, bool tight = false) {
  constexpr double shortest_way = 10.0;            // [m] in which a vehicle can move sideways
  constexpr double tight_way = 11.0, width = 3.5;  // [m] in which it can move that far sideways
  FrenetCandidate c;
  c.duration = duration;
  c.offset = offset;
  c.speed = target.speed;
  PointMotion<double> const s{start.s, start.speed, start.acceleration};
  PointMotion<double> const d{start.offset, start.slope * start.speed,
                              start.bend * start.speed * start.speed + start.slope * start.acceleration};
  bool const follows = std::isfinite(target.position);
  c.kind = follows ? FrenetCandidate::Kind::follow : FrenetCandidate::Kind::keep_speed;
  c.along = follows ? quintic(s, {target.position, target.speed, 0.0}, duration)
                    : quartic(s, {0.0, target.speed, 0.0}, duration);
  auto const in_time = quintic(d, {offset, 0.0, 0.0}, duration);
  c.by_way = std::min(start.speed, target.speed) < low_speed;
  c.way = std::max(shortest_way, c.along.at(duration).position - start.s);
  c.tight = tight;
  if (tight) c.way = std::min(c.way, tight_way * std::sqrt(std::abs(offset - start.offset) / width));
  c.across = c.by_way ? quintic({start.offset, start.slope, start.bend}, {offset, 0.0, 0.0}, c.way) : in_time;
  double const off = target.speed - desired_speed;
  c.cost = costs.lateral * (costs.jerk * in_time.squared_jerk(duration) + costs.offset * offset * offset) +
           costs.jerk * c.along.squared_jerk(duration) + (1.0 + costs.lateral) * costs.time * duration +
           costs.speed * off * off;
  return c;
}

/// `valid` if a vehicle can drive the motion, given as `course` and as `frenet`, within `limits` and no faster than
/// `fastest` [m/s]; else the first limit that it violates.
[[nodiscard]] inline FrenetVerdict drivable(FrenetLimits const& limits, CourseMotion<double> const& course,
                                            FrenetMotion<double> const& frenet, double fastest) {
  constexpr double rounding = -0.02;  // [m/s] of the speed of a vehicle that stands
  if (!std::isfinite(course.speed) || !std::isfinite(course.acceleration) || !std::isfinite(course.curvature))
    return FrenetVerdict::not_finite;
  if (frenet.speed < rounding) return FrenetVerdict::reverses;
  if (course.speed > fastest) return FrenetVerdict::speed;
  double const across = course.speed * course.speed * std::abs(course.curvature);
  if (course.acceleration < limits.lowest_acceleration || course.acceleration > limits.highest_acceleration ||
      across > limits.lateral_acceleration)
    return FrenetVerdict::acceleration;
  return std::abs(course.curvature) > limits.highest_curvature ? FrenetVerdict::curvature : FrenetVerdict::valid;
}

}  // namespace cambium::inline v0_1
