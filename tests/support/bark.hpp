#pragma once

#include <algorithm>
#include <cmath>

#include "cambium/behavior/law/acc.hpp"
#include "cambium/behavior/drivers.hpp"
#include "cambium/behavior/law/follow_lane.hpp"
#include "cambium/dynamics/integration.hpp"

/// The drivers of BARK (fortiss, commit bc4d92c2) as its trajectories show them, for comparison with its results: 10
/// equal sub-steps, each one's acceleration taken at the speed of the step's start, a desired gap that may become
/// negative, speeds from 0 to 50 m/s.
namespace bark {

namespace cb = cambium;

inline constexpr int substeps = 10;

/// Acceleration [m/s^2]: IDM whose desired gap is not kept above the minimum gap, blended as by the ACC model.
inline double acceleration(cb::Idm const& p, double coolness, double speed, cb::Constraint const& leader) {
  if (leader.gap <= 0) return p.lowest_acceleration;
  double const desired_gap =
      p.minimum_gap + speed * p.time_headway +
      speed * (speed - leader.speed) / (2 * std::sqrt(p.maximum_acceleration * p.comfortable_deceleration));
  double const closeness = desired_gap / leader.gap;
  double const free = 1 - std::pow(speed / p.desired_speed, p.exponent);
  double a = p.maximum_acceleration * (free - closeness * closeness);
  if (coolness > 0.0 && !std::isinf(leader.gap))
    a = cb::acc_blend(a, cb::cah_acceleration(speed, leader, p.maximum_acceleration), p.comfortable_deceleration,
                      coolness);
  return std::clamp(a, p.lowest_acceleration, p.highest_acceleration);
}

/// Moves the leader's gap by a sub-step of `h` [s] of a follower that had `speed` at the step's start.
inline void advance(cb::Constraint& leader, double speed, double a, double h) {
  leader.gap += leader.speed * h - (speed * h + a * h * h / 2);
}

/// The next vehicle ahead; its acceleration where there is `coolness`.
template <class View>
[[nodiscard]] cb::Constraint leader_of(View const& view, double coolness) {
  auto const next = view.ahead();
  if (!next) return {};
  return {next->gap, next->speed, coolness > 0.0 ? view.acceleration(*next) : 0.0};
}

/// BARK's IDM, and with `coolness` its ACC model.
struct Driver {
  cb::Idm idm{};
  double coolness = 0.0;

  static constexpr char const* name = "bark_driver";
  static constexpr auto parameters() {
    return cb::parameter_list(cb::parameter("idm", &Driver::idm, "car following"),
                              cb::parameter("coolness", &Driver::coolness, "-", cb::Range{0, 1}, "of the ACC model"));
  }

  template <class View>
  [[nodiscard]] cb::Plan<View> plan(View const& view, cb::NoMemory&, double dt) const {
    return follow(view, leader_of(view, coolness), dt);
  }

  template <class View>
  [[nodiscard]] cb::Plan<View> follow(View const& view, cb::Constraint leader, double dt) const {
    double const h = dt / substeps, start_speed = std::max(0.0, view.state().speed);
    cb::Plan<View> plan;
    cb::LongitudinalMotion<double> motion{0.0, start_speed};
    for (int i = 0; i < substeps; ++i) {
      double const a = acceleration(idm, coolness, start_speed, leader);
      if (i == 0) plan.action.acceleration = a;
      motion.distance += motion.speed * h + a * h * h / 2;
      motion.speed = std::clamp(motion.speed + a * h, 0.0, 50.0);
      advance(leader, start_speed, a, h);
      plan.trajectory.push_back(cb::follow_lane(view, motion, dt * (i + 1) / substeps));
    }
    return plan;
  }
};

/// BARK's lane tracking: the same along, steered by Stanley's law.
struct LaneTracking {
  cb::Idm idm{};

  template <class View>
  [[nodiscard]] cb::Plan<View> plan(View const& view, cb::NoMemory&, double dt) const {
    cb::IdmLaneTracking const steering;
    auto leader = leader_of(view, 0.0);
    auto const& model = view.dynamics();
    double const wheel_base = cb::wheel_base_of(model), h = dt / substeps;
    auto segment = view.place().segment;
    auto x = view.state();
    double const start_speed = std::max(0.0, x.speed);
    cb::Plan<View> plan;
    for (int i = 0; i < substeps; ++i) {
      double const a = acceleration(idm, 0.0, start_speed, leader);
      auto const at = cb::front_axle(view.corridor().center, x, wheel_base, segment);
      double const grip = std::atan2(steering.lateral.lateral_acceleration_limit * wheel_base, x.speed * x.speed);
      double const angle = at.heading_error + std::atan2(-steering.lateral.cross_track_gain * at.offset, x.speed);
      auto const u = model.input({a, std::clamp(angle, -grip, grip)}, x);
      if (i == 0) plan.action = cb::action_of(u, {a, angle});
      advance(leader, start_speed, a, h);
      x = cb::euler_step(model, x, u, h);
      x.speed = std::max(0.0, x.speed);
      x.time = view.time() + dt * (i + 1) / substeps;
      plan.trajectory.push_back(x);
    }
    return plan;
  }
};

}  // namespace bark
