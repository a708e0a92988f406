#pragma once

#include <algorithm>

#include "cambium/behavior/bark.hpp"
#include "cambium/behavior/behavior_model.hpp"
#include "cambium/behavior/idm.hpp"
#include "cambium/behavior/leader.hpp"

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
  RoadRules rules{};

  static constexpr char const* name = "idm_classic";
  static constexpr char const* summary =
      "keeps its lane; a = a_max (1 - (v/v0)^4 - (s*/s)^2), s* = s0 + max(0, v T + v (v - v_leader) / (2 sqrt(a_max "
      "b)))";
  static constexpr char const* source = "Treiber, Hennecke, Helbing 2000, eq. 3 and 4";
  static constexpr auto parameters() {
    return join_parameters(
        idm_parameters<IdmClassic>(),
        parameter_list(
            choice("integration", &IdmClassic::integration, "exact|bark_substeps", "of the motion within a step"),
            parameter("tolerance", &IdmClassic::tolerance, "m/s^2", Range{1e-12, 1},
                      "error of the exact integration, as speed per second"),
            parameter("rules", &IdmClassic::rules, "-", {}, "what it heeds beside other road users")));
  }

  template <class View>
  [[nodiscard]] Plan<View> plan(View const& view, NoMemory&, double dt) const {
    double const speed = std::max(0.0, view.state().speed);
    double const desired = desired_within_limits(rules, *this, view, speed);
    // A copy with that desired speed only where one is needed: it would be written field by field and read at once in
    // wide parts, which processors wait for (by half of a step with g++ 12 -march=native on Zen 5).
    auto const limited = [this, desired] {
      auto p = *this;
      p.desired_speed = desired;
      return p;
    };
    auto const leader = leader_to_follow(
        rules, view, view.ahead(), [&](Leader const& l) { return idm_acceleration(limited(), speed, l.gap, l.speed); });
    if (integration == Integration::bark_substeps) return bark::plan_along_lane(view, limited(), 0.0, leader, dt);
    detail::IdmTerms<double> const terms(*this, desired);
    return plan_along_lane(view, detail::idm_motion(terms, speed, leader.gap, leader.speed, dt, tolerance), dt);
  }
};
static_assert(BehaviorModel<IdmClassic>);

/// A driver of these parameters, as of `presets`.
[[nodiscard]] constexpr IdmClassic idm_classic(IdmParameters const& p) {
  return {.desired_speed = p.desired_speed,
          .time_headway = p.time_headway,
          .minimum_gap = p.minimum_gap,
          .maximum_acceleration = p.maximum_acceleration,
          .comfortable_deceleration = p.comfortable_deceleration,
          .exponent = p.exponent,
          .lowest_acceleration = p.lowest_acceleration,
          .highest_acceleration = p.highest_acceleration};
}

}  // namespace cambium
