#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "cambium/behavior/behavior_model.hpp"
#include "cambium/behavior/idm.hpp"

namespace cambium {

/// Follows its lane corridor and the next vehicle in it by the Intelligent Driver Model (Treiber, Hennecke, Helbing
/// 2000); defaults are BARK's. Keeps its lateral offset; heads along the lane.
struct IdmClassic {
  /// How the model is integrated over a step; the leader keeps its speed meanwhile.
  enum class Integration {
    exact,          ///< to `tolerance`, for any step length: the default
    bark_substeps,  ///< 10 equal sub-steps as in BARK, for comparison with its results: each one's acceleration is
                    ///< taken at the speed of the step's start, and the desired gap may become negative
  };

  double desired_speed = 15.0;
  double time_headway = 1.5;
  double minimum_gap = 2.0;
  double maximum_acceleration = 1.7;
  double comfortable_deceleration = 1.67;
  double exponent = 4.0;
  double lowest_acceleration = -5.0;
  double highest_acceleration = 8.0;
  Integration integration = Integration::exact;
  double tolerance = 1e-4;

  static constexpr char const* name = "idm_classic";
  static constexpr auto parameters() {
    return std::tuple_cat(idm_parameters<IdmClassic>(),
                          std::make_tuple(parameter("integration", &IdmClassic::integration, "-", Range{0, 1},
                                                    "0 exact within the step, 1 BARK's sub-steps"),
                                          parameter("tolerance", &IdmClassic::tolerance, "m/s^2", Range{1e-12, 1},
                                                    "error of the exact integration, as speed per second")));
  }

  template <class View>
  [[nodiscard]] Plan<View> plan(View const& view, NoMemory&, double dt) const {
    constexpr double infinite = std::numeric_limits<double>::infinity();
    auto const leader = view.front();
    double const gap = leader ? leader->gap : infinite;
    double const leader_speed = leader ? leader->speed : 0.0;
    double const speed = std::max(0.0, view.state().speed);
    if (integration == Integration::bark_substeps) return bark_plan(view, speed, gap, leader_speed, dt);
    return plan_along_lane(view, idm_motion(*this, speed, gap, leader_speed, dt, tolerance), dt);
  }

 private:
  /// BARK's acceleration: s* is not kept above the minimum gap.
  [[nodiscard]] double bark_acceleration(double speed, double gap, double leader_speed) const {
    if (gap <= 0) return lowest_acceleration;
    double const desired_gap =
        minimum_gap + speed * time_headway +
        speed * (speed - leader_speed) / (2 * std::sqrt(maximum_acceleration * comfortable_deceleration));
    double const closeness = desired_gap / gap;
    double const a = maximum_acceleration * (1 - std::pow(speed / desired_speed, exponent) - closeness * closeness);
    return std::clamp(a, lowest_acceleration, highest_acceleration);
  }

  template <class View>
  [[nodiscard]] Plan<View> bark_plan(View const& view, double start_speed, double gap, double leader_speed,
                                     double dt) const {
    constexpr int substeps = 10;
    double const h = dt / substeps;
    Plan<View> plan;
    LongitudinalMotion<double> motion{0.0, start_speed};
    for (int i = 0; i < substeps; ++i) {
      double const a = bark_acceleration(start_speed, gap, leader_speed);
      if (i == 0) plan.action.acceleration = a;
      motion.distance += motion.speed * h + a * h * h / 2;
      motion.speed = std::clamp(motion.speed + a * h, 0.0, 50.0);
      gap += leader_speed * h - (start_speed * h + a * h * h / 2);
      plan.trajectory.push_back(follow_lane(view, motion, dt * (i + 1) / substeps));
    }
    return plan;
  }
};
static_assert(BehaviorModel<IdmClassic>);

}  // namespace cambium
