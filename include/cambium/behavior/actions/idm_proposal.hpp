#pragma once

#include <algorithm>

#include "cambium/behavior/behavior_model.hpp"
#include "cambium/behavior/driver/heeding.hpp"
#include "cambium/behavior/driver/limits.hpp"
#include "cambium/behavior/heed/bends.hpp"
#include "cambium/behavior/heed/conflicts.hpp"
#include "cambium/behavior/heed/pedestrians.hpp"
#include "cambium/behavior/heed/signals.hpp"
#include "cambium/behavior/lateral/change_lanes.hpp"
#include "cambium/behavior/lateral/lane_change.hpp"
#include "cambium/behavior/law/idm.hpp"
#include "cambium/behavior/law/lane_reach.hpp"
#include "cambium/core/described.hpp"
#include "cambium/core/macros.hpp"

namespace cambium::inline v0_1 {

/// A rule of lane changes for `ChangeLanes` that somebody else decides: to the lane corridor `towards`, as soon as that
/// is safe and the lane stays beside until the change has ended. Until then it comes to the speed of a slower
/// vehicle ahead there.
struct ChangeTowards {
  CorridorId towards = none<CorridorId>;

  static constexpr char const* name = "change_towards";
  static constexpr auto parameters() {
    return parameter_list(
        parameter("towards", &ChangeTowards::towards, "lane corridor; a planner's choice overrides it"));
  }

  template <class Choice>
  [[nodiscard]] CorridorId operator()(Choice const& now) const {
    return now.may_change && may_change(now) ? towards : none<CorridorId>;
  }

 private:
  template <class Choice>
  CAMBIUM_NOINLINE [[nodiscard]] bool may_change(Choice const& now) const {
    auto const& view = now.view;
    auto const& piece = view.corridor().pieces[view.place().piece];
    bool const left = towards == piece.left;
    if (!is_valid(towards) || (!left && towards != piece.right)) return false;
    double const speed = now.limits.response().speed();
    double const length = now.changing.course.begin(towards, view.shape(), speed, 0.0).left;
    if (!stays_beside(view, left, view.place().s + length)) return false;
    auto const option = now.beside(left);
    if (!option) return false;
    bool const is_safe = now.is_safe(*option);
    if (!is_safe && option->front && option->front->speed < speed) now.adapt_to(option->front);
    return is_safe;
  }

  /// Whether the lane beside on that side is of corridor `towards` up to corridor position `until` [m].
  template <class View>
  [[nodiscard]] bool stays_beside(View const& view, bool left, double until) const {
    auto const& pieces = view.corridor().pieces;
    for (auto p = view.place().piece; index_of(p) < pieces.size() && pieces[p].begin < until; ++p)
      if (pieces[p].beside(left) != towards) return false;
    return view.corridor().length() >= until;
  }
};

/// Follows the next vehicle in its path by `Law`, at a share of its desired speed and an offset from the middle of its
/// lane, or changes into a lane beside it as soon as that is safe (see `ChangeLanes`). Share, offset and lane are its
/// memory, which a planner sets to try several proposals (see `ProposalPlanner`). It passes road users in its lane that
/// leave enough room, and heeds `Heeds`. It has no `heeds_conflicts`, for nobody is expected to drive like this; the
/// planner has.
template <CarFollowingLaw Law, class... Heeds>
struct BasicProposal {
  using Lateral = ChangeLanes<ChangeTowards>;

  struct Memory {
    float speed_share = 1.0f;               ///< of the driver's desired speed
    float offset = 0.0f;                    ///< from the middle of the lane, left positive [m]; not for lane changes
    CorridorId towards = none<CorridorId>;  ///< lane corridor beside its own into which it changes; none: stays
    Lateral::Memory lateral{};
    [[no_unique_address]] typename Heeding<Heeds...>::Memory heeds{};

    void fell_short(double way, bool left_course) { lateral.fell_short(way, left_course); }
    static constexpr char const* name = "idm_proposal_memory";
    static constexpr auto parameters() {
      using P = Memory;
      return parameter_list(parameter("speed_share", &P::speed_share, "-", any_finite, "of the driver's desired speed"),
                            parameter("offset", &P::offset, "m", any_finite, "from the middle of the lane"),
                            parameter("towards", &P::towards, "lane corridor into which it changes"),
                            parameter("lateral", &P::lateral, "of the driver's lane changes"),
                            parameter("heeds", &P::heeds, "of what it heeds"));
    }

    friend bool operator==(Memory const&, Memory const&) = default;
  };

  Law law{};
  Lateral lateral{.keep = {.merging = Merging::by_rule}, .rest = 0.0, .leaves_room = true};
  [[no_unique_address]] Heeding<Heeds...> heeds{};
  double clearance = 0.2;

  static constexpr char const* name = "idm_proposal";
  static constexpr char const* summary =
      "follows at a share of the desired speed, and at an offset from the lane's middle or into a lane beside it, as a "
      "planner sets; passes road users that leave room; heeds bends, signals and the right of way";
  static constexpr char const* source = "Treiber 2000; after Dauner et al. 2023";
  static constexpr auto parameters() {
    using P = BasicProposal;
    return parameter_list(
        parameter("law", &P::law, "by which it follows"),
        parameter("lateral", &P::lateral, "how it changes lanes, and what it assumes of others"),
        parameter("heeds", &P::heeds, "what it heeds besides"),
        parameter("clearance", &P::clearance, "m", Range{0, 5}, "to each side of the road users that it passes"));
  }

  template <class View>
  [[nodiscard]] Plan<View> plan(View const& view, Memory& memory, double dt) const {
    double const speed = std::max(0.0, view.state().speed);
    constexpr double slowest = 0.1, lower = 0.76;  // [m/s]; of its speed, so that IDM brakes with 3 m/s^2 or less
    double const share = memory.speed_share;
    double const desired = std::max({slowest, lower * speed, share * heeds.desired_speed(law, view, speed)});
    Limits<Law> limits(law, speed, desired, heeds.merging(view, lateral.keep.merging));
    limits.gives_way = (detail::heeds_conflicts<Heeds>() || ...);
    bool const is_there = memory.towards == none<CorridorId> || memory.towards == view.place().corridor;
    if (memory.lateral.change.active() || !is_there) {
      auto changing = lateral;
      changing.rule.towards = memory.towards;
      auto const seen = changing.look(view, memory.lateral, limits, dt);
      heeds.heed(view, memory.heeds, limits, dt);
      return changing.drive(view, memory.lateral, seen, limits, dt);
    }
    memory.lateral.lane.adrift = false;
    memory.lateral.rest = std::max(0.0f, memory.lateral.rest - static_cast<float>(dt));
    double const offset = static_cast<double>(memory.offset);
    using Response = typename Limits<Law>::Response;
    auto const next = detail::next_in_way(view, offset, clearance, limits.merging);
    if (next) limits.heed(detail::constraint_of<Response>(view, *next));
    if (!view.corridor().feeders.empty())
      detail::for_each_on_feeders(view, Look::horizon, limits.merging, [&](RoadUser const& other) {
        if (!leaves_room(view, view.place().corridor, other, offset, clearance))
          limits.heed(detail::constraint_of<Response>(view, other));
      });
    if (lateral.leaves_room) lateral.heed_lane_end(view, limits);
    heeds.heed(view, memory.heeds, limits, dt);
    auto motion = limits.motion(dt);
    if (lateral.leaves_room && next) motion = lateral.course.leave_room(view, *next, motion, dt);
    return plan_to_center(view, memory.lateral.change.bend, limits.within(motion, dt), dt, offset);
  }
};

/// By IDM, with bends, lights, those who step onto the road, and the right of way.
using IdmProposal = BasicProposal<Idm, Bends, Signals, Pedestrians, Conflicts>;
static_assert(BehaviorModel<IdmProposal>);

}  // namespace cambium::inline v0_1
