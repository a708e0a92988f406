#pragma once

#include <algorithm>

#include "cambium/behavior/behavior_model.hpp"
#include "cambium/behavior/law/idm.hpp"
#include "cambium/behavior/law/road_rules.hpp"

namespace cambium {

/// Follows its lane corridor and the next vehicle in it by the Intelligent Driver Model (Treiber, Hennecke, Helbing
/// 2000); defaults are BARK's. Keeps its lateral offset and takes the lane's heading.
struct IdmClassic {
  using Memory = RoadRules::Memory;

  double desired_speed = IdmParameters{}.desired_speed;
  double time_headway = IdmParameters{}.time_headway;
  double minimum_gap = IdmParameters{}.minimum_gap;
  double maximum_acceleration = IdmParameters{}.maximum_acceleration;
  double comfortable_deceleration = IdmParameters{}.comfortable_deceleration;
  double exponent = IdmParameters{}.exponent;
  double lowest_acceleration = IdmParameters{}.lowest_acceleration;
  double highest_acceleration = IdmParameters{}.highest_acceleration;
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
        parameter_list(parameter("tolerance", &IdmClassic::tolerance, "m/s^2", Range{1e-12, 1},
                                 "integration error in speed, per second"),
                       parameter("rules", &IdmClassic::rules, "what it heeds besides other road users")));
  }

  template <class View>
  [[nodiscard]] Plan<View> plan(View const& view, Memory& memory, double dt) const {
    double const speed = std::max(0.0, view.state().speed);
    IdmLaw const law(*this, speed, rules.desired_speed(*this, view, speed));
    return rules.keep_lane(view, Strictest(law), *this, tolerance, dt, memory);
  }
};
static_assert(BehaviorModel<IdmClassic>);

/// An `IdmClassic` with the given parameters, such as those in `presets`.
[[nodiscard]] constexpr IdmClassic idm_classic(IdmParameters const& p) {
  IdmClassic driver;
  follow_as(driver, p);
  return driver;
}

}  // namespace cambium
