#pragma once

#include <algorithm>

#include "cambium/behavior/behavior_model.hpp"
#include "cambium/behavior/following/idm_classic.hpp"
#include "cambium/behavior/lane_change/lane_change.hpp"
#include "cambium/behavior/lane_change/lane_changing.hpp"
#include "cambium/behavior/law/lane_reach.hpp"
#include "cambium/core/macros.hpp"

namespace cambium {

/// Follows the next vehicle in its path by IDM, at a share of its desired speed and an offset from the middle of its
/// lane, or changes into a lane beside it as soon as that is safe (see `LaneChanging`). Share, offset and lane are its
/// memory, which a planner sets to try several proposals (see `ProposalPlanner`). It passes road users in its lane that
/// leave enough room, and brakes in time for bends.
struct IdmProposal {
  struct Memory {
    float speed_share = 1.0f;               ///< of the driver's desired speed
    float offset = 0.0f;                    ///< from the middle of the lane, left positive [m]; not for lane changes
    CorridorId towards = none<CorridorId>;  ///< lane corridor beside its own into which it changes; none: stays
    LaneChanging::Memory lane{};

    void fell_short(double way, bool left_course) { lane.fell_short(way, left_course); }
    friend bool operator==(Memory const&, Memory const&) = default;
  };

  IdmClassic driver{.rules = {.slow_for_bends = true}};
  double clearance = 0.2;
  LaneChanging changing{.rest = 0.0, .leaves_room = true};

  static constexpr char const* name = "idm_proposal";
  static constexpr char const* summary =
      "as idm_classic, at a share of the desired speed, and at an offset from the lane's middle or into a lane beside "
      "it, as a planner sets; passes road users that leave room; brakes for bends";
  static constexpr char const* source = "Treiber 2000; after Dauner et al. 2023";
  static constexpr auto parameters() {
    using P = IdmProposal;
    return parameter_list(
        parameter("driver", &P::driver, "-", {}, "its car following"),
        parameter("clearance", &P::clearance, "m", Range{0, 5}, "to each side of the road users that it passes"),
        parameter("changing", &P::changing, "-", {}, "how it changes lanes, and what it assumes of others"));
  }

  template <class View>
  [[nodiscard]] Plan<View> plan(View const& view, Memory& memory, double dt) const {
    double const speed = std::max(0.0, view.state().speed);
    auto idm = driver;
    idm.desired_speed =
        std::max(0.1, static_cast<double>(memory.speed_share) * driver.rules.desired_speed(driver, view, speed));
    bool const is_there = memory.towards == none<CorridorId> || memory.towards == view.place().corridor;
    if (memory.lane.change.active() || !is_there) return change_lane(view, memory, idm, dt);
    double const offset = static_cast<double>(memory.offset);
    IdmLaw const law(idm, speed, idm.desired_speed);
    Strictest ahead(law);
    auto const merging = driver.rules.merging;
    auto next = detail::next_in_way(view, offset, clearance, merging);
    if (next) next->gap -= changing.course.room_behind(view, view.place(), *next);
    driver.rules.heed(view, next, ahead);
    if (!view.corridor().feeders.empty())
      detail::for_each_on_feeders(view, Look::horizon, merging, [&](RoadUser const& other) {
        if (!leaves_room(view, view.place().corridor, other, offset, clearance)) ahead.heed({other.gap, other.speed});
      });
    auto const motion = driver.rules.bound(view, driver, view.place().s, speed,
                                           law.motion(ahead.constraint(), dt, driver.tolerance), dt, memory.lane.rules);
    return plan_to_center(view, memory.lane.change.bend, motion, dt, offset);
  }

 private:
  template <class View>
  CAMBIUM_NOINLINE [[nodiscard]] Plan<View> change_lane(View const& view, Memory& memory, IdmClassic const& idm,
                                                        double dt) const {
    auto const choose = [&](LaneKeeping<View> const& now) {
      auto const& piece = view.corridor().pieces[view.place().piece];
      bool const left = memory.towards == piece.left;
      if (!now.may_change || !is_valid(memory.towards) || (!left && memory.towards != piece.right))
        return none<CorridorId>;
      LaneOption option{view.place(memory.towards), left, {}, {}};
      option.front = view.ahead(option.place);
      option.rear = view.behind(option.place);
      return changing.is_safe(view, now.law, option, changing.safe_deceleration) ? memory.towards : none<CorridorId>;
    };
    return changing.drive(view, memory.lane, idm, driver.rules, driver.tolerance, dt, choose);
  }
};
static_assert(BehaviorModel<IdmProposal>);

}  // namespace cambium
