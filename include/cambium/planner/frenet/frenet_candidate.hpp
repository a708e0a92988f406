#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "cambium/core/parameters.hpp"
#include "cambium/map/corridor/corridor.hpp"
#include "cambium/planner/frenet/frenet_motion.hpp"
#include "cambium/planner/frenet/quintic.hpp"

namespace cambium {

/// What a course beside a lane costs (Werling, Ziegler, Kammel, Thrun 2010, sections V and VI).
struct FrenetCosts {
  double jerk = 0.1;
  double time = 0.1;
  double offset = 1.0;
  double speed = 1.0;
  double lateral = 1.0;
  double route = 40.0;

  static constexpr char const* name = "frenet_costs";
  static constexpr char const* summary =
      "of jerk, time, and deviations at the end, as Werling 2010; of lanes off the route";
  static constexpr auto parameters() {
    using P = FrenetCosts;
    return parameter_list(
        parameter("jerk", &P::jerk, "s^5/m^2", non_negative, "of the integral of its square"),
        parameter("time", &P::time, "1/s", non_negative, "of the time until it drives evenly"),
        parameter("offset", &P::offset, "1/m^2", non_negative, "of the squared offset from the lane's middle then"),
        parameter("speed", &P::speed, "s^2/m^2", non_negative, "of the squared deviation from the desired speed then"),
        parameter("lateral", &P::lateral, "-", non_negative, "of all that is across the lane, against all along it"),
        parameter("route", &P::route, "-", non_negative, "of each lane between it and the one that the route ends in"));
  }
};

/// What a vehicle can do, or its passengers bear.
struct FrenetLimits {
  double lowest_acceleration = -6.0;
  double highest_acceleration = 3.0;
  double lateral_acceleration = 4.0;
  double highest_curvature = 0.2;
  double clearance = 0.3;

  static constexpr char const* name = "frenet_limits";
  static constexpr char const* summary = "what a vehicle can do, or its passengers bear";
  static constexpr auto parameters() {
    using P = FrenetLimits;
    return parameter_list(
        parameter("lowest_acceleration", &P::lowest_acceleration, "m/s^2", Range{-50, -0.1},
                  "of valid courses, and where none is valid"),
        parameter("highest_acceleration", &P::highest_acceleration, "m/s^2", Range{0.1, 50}, "of valid courses"),
        parameter("lateral_acceleration", &P::lateral_acceleration, "m/s^2", Range{0.1, 50}, "of valid courses"),
        parameter("highest_curvature", &P::highest_curvature, "1/m", Range{1e-3, 10}, "of valid courses"),
        parameter("clearance", &P::clearance, "m", Range{0, 10}, "to all sides"));
  }
};

/// What a course is found to be.
enum class FrenetVerdict : std::uint8_t {
  unchecked,
  valid,
  not_finite,  ///< its cost, or how it is to be driven, is no number
  reverses,
  speed,
  acceleration,
  curvature,
  gap,
  road,
  collision
};

[[nodiscard]] constexpr char const* to_string(FrenetVerdict verdict) {
  constexpr char const* names[] = {"unchecked",    "valid",     "not finite", "reverses", "too fast",
                                   "acceleration", "curvature", "gap",        "off road", "collision"};
  return names[static_cast<std::size_t>(verdict)];
}

/// A course along a lane: for `duration` by two polynomials, then evenly.
struct FrenetCandidate {
  enum class Kind : std::uint8_t { keep_speed, follow };  ///< following what stands is stopping

  CorridorId corridor = none<CorridorId>;  ///< along whose centre line
  Kind kind = Kind::keep_speed;
  bool by_way = false;       ///< the offset changes with the way, not with time: at low speed
  double duration{};         ///< [s]
  double offset{};           ///< at the end [m]
  double speed{};            ///< at the end [m/s]
  Quintic<double> along{};   ///< of time
  Quintic<double> across{};  ///< of time or, by way, of the way driven
  double way{};              ///< until the offset is reached [m]
  double cost{};
  FrenetVerdict verdict = FrenetVerdict::unchecked;

  /// Where it is after `time` [s].
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
      constexpr double slowest = 0.1;  // [m/s]
      double const v = std::max(s.speed, slowest);
      motion.offset = d.position;
      motion.slope = d.speed / v;
      motion.bend = (d.acceleration - motion.slope * s.acceleration) / (v * v);
    }
    return motion;
  }
};

/// A place to be at some time: what the end of a course is chosen by.
struct FrenetTarget {
  double position{};  ///< of the reference point; infinite where only the speed counts [m]
  double speed{};     ///< [m/s]
};

/// The course from `start` to `target` at `offset` after `duration` [s], with its cost, but for the route's. Slower
/// than `low_speed` [m/s] at either end, its offset changes with the way.
[[nodiscard]] inline FrenetCandidate frenet_candidate(FrenetMotion<double> const& start, FrenetTarget const& target,
                                                      double offset, double duration, double desired_speed,
                                                      double low_speed, FrenetCosts const& costs) {
  constexpr double shortest_way = 10.0;  // [m] on which a vehicle can move aside
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
  c.across = c.by_way ? quintic({start.offset, start.slope, start.bend}, {offset, 0.0, 0.0}, c.way) : in_time;
  double const off = target.speed - desired_speed;
  c.cost = costs.lateral * (costs.jerk * in_time.squared_jerk(duration) + costs.offset * offset * offset) +
           costs.jerk * c.along.squared_jerk(duration) + (1.0 + costs.lateral) * costs.time * duration +
           costs.speed * off * off;
  return c;
}

/// Whether a vehicle can drive as `course`, no faster than `fastest` [m/s], where that has `frenet`; else why not.
[[nodiscard]] inline FrenetVerdict drivable(FrenetLimits const& limits, CourseMotion<double> const& course,
                                            FrenetMotion<double> const& frenet, double fastest) {
  constexpr double standing = -0.02;  // [m/s], for rounding
  if (!std::isfinite(course.speed) || !std::isfinite(course.acceleration) || !std::isfinite(course.curvature))
    return FrenetVerdict::not_finite;
  if (frenet.speed < standing) return FrenetVerdict::reverses;
  if (course.speed > fastest) return FrenetVerdict::speed;
  double const across = course.speed * course.speed * std::abs(course.curvature);
  if (course.acceleration < limits.lowest_acceleration || course.acceleration > limits.highest_acceleration ||
      across > limits.lateral_acceleration)
    return FrenetVerdict::acceleration;
  return std::abs(course.curvature) > limits.highest_curvature ? FrenetVerdict::curvature : FrenetVerdict::valid;
}

}  // namespace cambium
