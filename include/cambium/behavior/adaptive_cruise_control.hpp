#pragma once

#include <algorithm>

#include "cambium/behavior/acc.hpp"
#include "cambium/behavior/bark.hpp"
#include "cambium/behavior/behavior_model.hpp"
#include "cambium/behavior/idm.hpp"
#include "cambium/behavior/leader.hpp"

namespace cambium {

/// Follows its lane corridor and the next vehicle in it by the ACC model: IDM that does not overreact to small gaps, as
/// after a lane change of another, as long as the leader's acceleration makes them no danger.
struct AdaptiveCruiseControl {
  enum class Integration { accurate, bark_substeps };

  IdmParameters idm{};
  double coolness = 0.99;
  RoadRules rules{};
  Integration integration = Integration::accurate;

  static constexpr char const* name = "adaptive_cruise_control";
  static constexpr char const* summary =
      "IDM, but where that brakes harder than the constant-acceleration heuristic c asks for: (1 - coolness) a_IDM + "
      "coolness (c + b tanh((a_IDM - c) / b))";
  static constexpr char const* source = "Kesting, Treiber, Helbing 2010, eq. 2.3 and 2.6";
  static constexpr auto parameters() {
    using Self = AdaptiveCruiseControl;
    return parameter_list(
        parameter("idm", &Self::idm, "-", {}, "the car following it is built on"),
        parameter("coolness", &Self::coolness, "-", Range{0, 1},
                  "0: IDM; 1: brakes no harder than the leader's acceleration asks for"),
        parameter("rules", &Self::rules, "-", {}, "what it heeds beside other road users"),
        choice("integration", &Self::integration, "accurate|bark_substeps", "the latter with BARK's desired gap, too"));
  }

  template <class View>
  [[nodiscard]] Plan<View> plan(View const& view, NoMemory&, double dt) const {
    double const speed = std::max(0.0, view.state().speed);
    auto const p = within_limits(rules, idm, view, speed);
    auto const law = [&](double v, Leader const& leader) { return acc_acceleration(p, coolness, v, leader); };
    auto const leader = leader_to_follow<true>(rules, view, view.ahead(), [&](auto const& l) { return law(speed, l); });
    if (integration == Integration::bark_substeps) return bark::plan_along_lane(view, p, coolness, leader, dt);
    return plan_along_lane(view, follow_motion(law, speed, leader, dt), dt);
  }
};
static_assert(BehaviorModel<AdaptiveCruiseControl>);

}  // namespace cambium
