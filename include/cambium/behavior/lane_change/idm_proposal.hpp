#pragma once

#include <algorithm>

#include "cambium/behavior/behavior_model.hpp"
#include "cambium/behavior/following/idm_classic.hpp"
#include "cambium/behavior/lane_change/lane_change.hpp"
#include "cambium/behavior/law/lane_reach.hpp"

namespace cambium {

/// Follows the next vehicle in its path by IDM, at a share of its desired speed and an offset from the middle of its
/// lane. Share and offset are its memory, which a planner sets to try several proposals (see `ProposalPlanner`). It
/// passes road users in its lane that leave enough room, and brakes in time for bends.
struct IdmProposal {
  struct Memory {
    float speed_share = 1.0f;  ///< of the driver's desired speed
    float offset = 0.0f;       ///< from the middle of the lane, left positive [m]
    float bend = 0.0f;         ///< of the course at the vehicle, see `plan_to_center` [1/m]
    RoadRules::Memory rules{};

    void fell_short(double, bool left_course) {
      if (left_course) bend = 0.0f;
    }
    friend bool operator==(Memory const&, Memory const&) = default;
  };

  IdmClassic driver{.rules = {.slow_for_bends = true}};
  double clearance = 0.2;

  static constexpr char const* name = "idm_proposal";
  static constexpr char const* summary =
      "as idm_classic, at a share of the desired speed and an offset from the lane's middle that a planner sets; "
      "passes road users that leave room; brakes for bends";
  static constexpr char const* source = "Treiber 2000; after Dauner et al. 2023";
  static constexpr auto parameters() {
    return parameter_list(parameter("driver", &IdmProposal::driver, "-", {}, "its car following"),
                          parameter("clearance", &IdmProposal::clearance, "m", Range{0, 5},
                                    "to each side of the road users that it passes"));
  }

  template <class View>
  [[nodiscard]] Plan<View> plan(View const& view, Memory& memory, double dt) const {
    double const speed = std::max(0.0, view.state().speed), offset = static_cast<double>(memory.offset);
    double const share = static_cast<double>(memory.speed_share);
    IdmLaw const law(driver, speed, std::max(0.1, share * driver.rules.desired_speed(driver, view, speed)));
    Strictest ahead(law);
    auto const merging = driver.rules.merging;
    driver.rules.heed(view, detail::next_in_way(view, offset, clearance, merging), ahead);
    if (!view.corridor().feeders.empty())
      detail::for_each_on_feeders(view, Look::horizon, merging, [&](RoadUser const& other) {
        if (!leaves_room(view, view.place().corridor, other, offset, clearance)) ahead.heed({other.gap, other.speed});
      });
    auto const motion = driver.rules.bound(view, driver, view.place().s, speed,
                                           law.motion(ahead.constraint(), dt, driver.tolerance), dt, memory.rules);
    return plan_to_center(view, memory.bend, motion, dt, offset);
  }
};
static_assert(BehaviorModel<IdmProposal>);

}  // namespace cambium
