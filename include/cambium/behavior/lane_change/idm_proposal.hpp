#pragma once

#include <algorithm>

#include "cambium/behavior/behavior_model.hpp"
#include "cambium/behavior/following/idm_classic.hpp"
#include "cambium/behavior/lane_change/lane_change.hpp"
#include "cambium/behavior/lane_change/lane_changing.hpp"
#include "cambium/behavior/law/lane_reach.hpp"
#include "cambium/core/described.hpp"
#include "cambium/core/macros.hpp"

namespace cambium {

/// Follows the next vehicle in its path by IDM, at a share of its desired speed and an offset from the middle of its
/// lane, or changes into a lane beside it as soon as that is safe (see `LaneChanging`). Share, offset and lane are its
/// memory, which a planner sets to try several proposals (see `ProposalPlanner`). It passes road users in its lane that
/// leave enough room, and brakes in time for bends. In a junction it gives way to nobody: the planner judges that.
struct IdmProposal {
  struct Memory {
    float speed_share = 1.0f;               ///< of the driver's desired speed
    float offset = 0.0f;                    ///< from the middle of the lane, left positive [m]; not for lane changes
    CorridorId towards = none<CorridorId>;  ///< lane corridor beside its own into which it changes; none: stays
    LaneChanging::Memory lane{};

    void fell_short(double way, bool left_course) { lane.fell_short(way, left_course); }
    static constexpr char const* name = "idm_proposal_memory";
    static constexpr auto parameters() {
      using P = Memory;
      return parameter_list(parameter("speed_share", &P::speed_share, "-", any_finite, "of the driver's desired speed"),
                            parameter("offset", &P::offset, "m", any_finite, "from the middle of the lane"),
                            parameter("towards", &P::towards, "lane corridor into which it changes"),
                            parameter("lane", &P::lane, "of the driver's lane changes"));
    }

    friend bool operator==(Memory const&, Memory const&) = default;
  };

  IdmClassic driver{.rules = {.slow_for_bends = true, .merging = Merging::by_rule}};
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
        parameter("driver", &P::driver, "its car following"),
        parameter("clearance", &P::clearance, "m", Range{0, 5}, "to each side of the road users that it passes"),
        parameter("changing", &P::changing, "how it changes lanes, and what it assumes of others"));
  }

  template <class View>
  [[nodiscard]] Plan<View> plan(View const& view, Memory& memory, double dt) const {
    double const speed = std::max(0.0, view.state().speed);
    auto idm = driver;
    idm.desired_speed =
        std::max(0.1, static_cast<double>(memory.speed_share) * driver.rules.desired_speed(driver, view, speed));
    IdmLaw const law(idm, speed, idm.desired_speed);
    bool const is_there = memory.towards == none<CorridorId> || memory.towards == view.place().corridor;
    if (memory.lane.change.active() || !is_there)
      return changing.drive(
          view, memory.lane, idm, driver.rules, driver.tolerance, dt, [&](LaneKeeping<View> const& now) {
            return now.may_change && may_change(view, memory.towards, law) ? memory.towards : none<CorridorId>;
          });
    memory.lane.rules.adrift = false;
    memory.lane.rest = std::max(0.0f, memory.lane.rest - static_cast<float>(dt));
    double const offset = static_cast<double>(memory.offset);
    Strictest ahead(law);
    auto const merging = driver.rules.merging;
    auto const next = detail::next_in_way(view, offset, clearance, merging);
    driver.rules.heed(view, next, ahead);
    if (!view.corridor().feeders.empty())
      detail::for_each_on_feeders(view, Look::horizon, merging, [&](RoadUser const& other) {
        if (!leaves_room(view, view.place().corridor, other, offset, clearance)) ahead.heed({other.gap, other.speed});
      });
    auto motion = law.motion(ahead.constraint(), dt, driver.tolerance);
    if (changing.leaves_room && next) motion = changing.course.leave_room(view, *next, motion, dt);
    motion = driver.rules.bound(view, driver, view.place().s, speed, motion, dt, memory.lane.rules);
    return plan_to_center(view, memory.lane.change.bend, motion, dt, offset);
  }

 private:
  /// Whether the lane beside on that side is of corridor `target` up to corridor position `until` [m].
  template <class View>
  [[nodiscard]] static bool stays_beside(View const& view, CorridorId target, bool left, double until) {
    auto const& pieces = view.corridor().pieces;
    for (auto p = view.place().piece; index_of(p) < pieces.size() && pieces[p].begin < until; ++p)
      if (pieces[p].beside(left) != target) return false;
    return view.corridor().length() >= until;
  }

  /// Whether a change into the lane beside of corridor `target` may begin.
  template <class View>
  CAMBIUM_NOINLINE [[nodiscard]] bool may_change(View const& view, CorridorId target, IdmLaw const& law) const {
    auto const& piece = view.corridor().pieces[view.place().piece];
    bool const left = target == piece.left;
    if (!is_valid(target) || (!left && target != piece.right) || !changing.marks_permit(view, left)) return false;
    double const length = changing.course.begin(target, view.shape(), law.speed(), 0.0).left;
    if (!stays_beside(view, target, left, view.place().s + length)) return false;
    LaneOption option{view.place(target), left, {}, {}};
    option.front = view.ahead(option.place);
    option.rear = view.behind(option.place);
    return changing.is_safe(view, law, option, changing.safe_deceleration);
  }
};
static_assert(BehaviorModel<IdmProposal>);

}  // namespace cambium
