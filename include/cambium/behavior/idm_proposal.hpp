#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <tuple>

#include "cambium/behavior/behavior_model.hpp"
#include "cambium/behavior/idm_classic.hpp"
#include "cambium/behavior/lane_change.hpp"
#include "cambium/geometry/frenet.hpp"
#include "cambium/geometry/polygon.hpp"

namespace cambium {

namespace detail {

/// What somebody occupies of a lane corridor: from where to where along it, and to its right and left. [m]
struct LaneReach {
  double begin, end, right, left;

  [[nodiscard]] bool meets(double from_right, double to_left) const { return right < to_left && left > from_right; }
};

template <MotionState S>
[[nodiscard]] LaneReach lane_reach(geometry::Line const& line, S const& state, geometry::Shape const& shape,
                                   std::uint32_t hint) {
  auto const at = geometry::to_frenet(line, state, hint);
  auto const [sin, cos] = geometry::sin_cos(at.heading_error);
  auto const along = geometry::extent_along(shape, cos, sin), across = geometry::extent_along(shape, sin, -cos);
  return {at.s - along.negative, at.s + along.positive, at.lateral - across.negative, at.lateral + across.positive};
}

[[nodiscard]] inline LaneReach lane_reach(geometry::Line const& line, geometry::Polygon const& outline,
                                          std::uint32_t hint) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  LaneReach reach{infinite, -infinite, infinite, -infinite};
  for (auto const& corner : outline.points()) {
    auto const foot = line.project(corner, hint);
    reach = {std::min(reach.begin, foot.s), std::max(reach.end, foot.s), std::min(reach.right, foot.lateral),
             std::max(reach.left, foot.lateral)};
  }
  return reach;
}

/// The next one ahead that is in the way of a vehicle that drives `offset` [m] beside the middle of its lane,
/// `clearance` [m] kept to both sides. Who is beside the way but in the lane is passed; who is still to merge into it
/// is not. O(agents near) where somebody is passed.
template <class View>
[[nodiscard]] std::optional<Neighbor> next_in_way(View const& view, double offset, double clearance) {
  auto next = view.front();
  if (!next) return next;
  auto const& line = view.corridor().center;
  auto const& at = view.lane_position();
  double const right = offset - view.shape().right - clearance, left = offset + view.shape().left + clearance,
               front = at.s + view.shape().front;
  std::optional<LaneReach> first;
  if (is_valid(next->agent)) {
    auto const other = view.agent(*next);
    first = lane_reach(line, other.state, other.shape, at.segment);
  } else {
    view.for_each_object([&](ObjectId id, geometry::Polygon const& outline) {
      if (id == next->object) first = lane_reach(line, outline, at.segment);
    });
  }
  auto const sides = view.corridor().widths_at(at.s, at.segment);
  if (!first || first->meets(right, left) || !first->meets(-sides.right, sides.left)) return next;
  next.reset();
  auto const consider = [&](LaneReach const& reach, AgentId agent, ObjectId object, double speed) {
    if (reach.end <= front || !reach.meets(right, left) || (next && next->gap <= reach.begin - front)) return;
    next = Neighbor{agent, object, reach.begin - front, speed, reach.end - reach.begin, 0};
  };
  constexpr double farthest = 200.0;  // [m]
  view.for_each_near(at.corridor, farthest, [&](auto const& other) {
    auto const reach = lane_reach(line, other.state, other.shape, at.segment);
    auto hint = at.segment;
    consider(reach, other.id, none<ObjectId>, geometry::to_frenet(line, other.state, hint).longitudinal_speed);
  });
  view.for_each_object([&](ObjectId id, geometry::Polygon const& outline) {
    auto const reach = lane_reach(line, outline, at.segment);
    if (reach.begin < front + farthest) consider(reach, none<AgentId>, id, 0.0);
  });
  return next;
}

}  // namespace detail

/// Follows the next vehicle in its way by IDM, at a share of its desired speed and an offset from the middle of its
/// lane: both are its memory, to be set from outside, as a planner does that tries several (see `ProposalPlanner`).
/// Passes who is in its lane but leaves it room.
struct IdmProposal {
  struct Memory {
    float speed_share = 1.0f;  ///< of the driver's desired speed
    float offset = 0.0f;       ///< from the middle of the lane, left positive [m]
    float bend = 0.0f;         ///< of the course at the vehicle, see `plan_to_center` [1/m]

    void fell_short(double, bool left_course) {
      if (left_course) bend = 0.0f;
    }
    friend bool operator==(Memory const&, Memory const&) = default;
  };

  IdmClassic driver{};
  double clearance = 0.2;

  static constexpr char const* name = "idm_proposal";
  static constexpr char const* summary =
      "as idm_classic, at a share of the desired speed and an offset from the lane's middle that a planner sets; "
      "passes "
      "who leaves room beside";
  static constexpr char const* source = "Treiber 2000; after Dauner et al. 2023";
  static constexpr auto parameters() {
    return std::make_tuple(
        parameter("driver", &IdmProposal::driver, "-", {}, "its car following; integration is exact"),
        parameter("clearance", &IdmProposal::clearance, "m", Range{0, 5}, "to each side of those that it passes"));
  }

  template <class View>
  [[nodiscard]] Plan<View> plan(View const& view, Memory& memory, double dt) const {
    double const speed = std::max(0.0, view.state().speed), offset = static_cast<double>(memory.offset);
    auto p = within_limits(driver.rules, driver, view, speed);
    p.desired_speed = std::max(0.1, static_cast<double>(memory.speed_share) * p.desired_speed);
    auto const leader = leader_to_follow(driver.rules, view, detail::next_in_way(view, offset, clearance),
                                         [&](Leader const& l) { return idm_acceleration(p, speed, l.gap, l.speed); });
    auto const motion = idm_motion(p, speed, leader.gap, leader.speed, dt, driver.tolerance);
    return plan_to_center(view, memory.bend, motion, dt, offset);
  }
};
static_assert(BehaviorModel<IdmProposal>);

}  // namespace cambium
