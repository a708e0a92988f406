#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>

#include "cambium/behavior/law/gap_before_merge.hpp"
#include "cambium/behavior/view.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/geometry/frenet.hpp"
#include "cambium/geometry/polygon.hpp"
#include "cambium/map/corridor/corridor.hpp"

namespace cambium::inline v0_1 {

namespace detail {

/// The part of a lane corridor that a road user occupies: along it, and to its right and left [m].
struct LaneReach {
  double begin, end, right, left;

  [[nodiscard]] bool meets(double from_right, double to_left) const { return right < to_left && left > from_right; }
};

template <MotionState S>
[[nodiscard]] LaneReach lane_reach(geometry::Line const& line, S const& state, geometry::Shape const& shape,
                                   std::uint32_t hint) {
  auto const at = geometry::to_frenet(line, state, hint);
  auto const [sin, cos] = portable::sin_cos(at.heading_error);
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

/// The part of lane corridor `number` that `user` occupies.
template <class View>
[[nodiscard]] LaneReach lane_reach(View const& view, CorridorId number, RoadUser const& user, std::uint32_t hint) {
  auto const& line = view.road().corridors[number].center;
  return is_valid(user.agent) ? lane_reach(line, view.state(user), view.shape(user), hint)
                              : lane_reach(line, view.outline(user), hint);
}

}  // namespace detail

/// Whether `neighbor` is in lane corridor `number` but leaves room for a vehicle that drives `offset` [m] to the left
/// of its middle with `clearance` [m] to both sides. A road user that is still to merge into the lane leaves none.
template <class View>
[[nodiscard]] bool leaves_room(View const& view, CorridorId number, RoadUser const& neighbor, double offset,
                               double clearance) {
  auto const at = view.place(number);
  auto const sides = view.road().corridors[number].widths_at(at.s, at.segment);
  auto const reach = detail::lane_reach(view, number, neighbor, at.segment);
  return reach.meets(-sides.right, sides.left) &&
         !reach.meets(offset - view.shape().right - clearance, offset + view.shape().left + clearance);
}

namespace detail {

/// Calls `f(RoadUser)` for the road users ahead in lanes that merge into the own corridor, or have just split off it,
/// if these begin less than `distance` [m] ahead. Gaps as in `ViewArchetype::ahead`. O(feeders + their agents).
template <class View, class F>
CAMBIUM_NOINLINE void for_each_on_feeders(View const& view, double distance, Merging merging, F const& f) {
  double const s = view.place().s, front = s + view.shape().front;
  for (auto const& feeder : view.corridor().feeders) {
    if (feeder.begin > s + distance) break;
    if (feeder.end < s || (merging == Merging::ignored && feeder.is_still_to_merge())) continue;
    double const from = s <= feeder.begin ? feeder.index_begin : feeder.index_at(s);
    view.on_lane(from, feeder.index_end, [&](RoadUser const& user) {
      if (user.s < feeder.index_begin || user.s > feeder.index_end) return;  // it only extends into the stretch
      double const position = feeder.image(user.s);
      if (position <= s || (merging == Merging::by_rule && feeder.is_up_to_rule(position + user.front))) return;
      double const gap = gap_before_merge(front, position - user.rear, feeder.free_until);
      auto ahead = user;
      ahead.gap = gap;
      ahead.s = position;
      f(ahead);
    });
  }
}

/// The next road user in the path of a vehicle that drives `offset` [m] to the left of the middle of its lane with
/// `clearance` [m] to both sides. It passes road users in the lane that are beside this path, except those that are
/// still to merge. O(agents nearby) if it passes anybody.
template <class View>
[[nodiscard]] std::optional<RoadUser> next_in_way(View const& view, double offset, double clearance,
                                                  Merging merging = Merging::counts) {
  auto next = view.ahead({.merging = merging});
  auto const& at = view.place();
  if (!next || !leaves_room(view, at.corridor, *next, offset, clearance)) return next;
  auto const& line = view.corridor().center;
  double const right = offset - view.shape().right - clearance, left = offset + view.shape().left + clearance,
               front = at.s + view.shape().front;
  next.reset();
  auto const consider = [&](LaneReach const& reach, RoadUser user, double speed) {
    if (reach.end <= front || !reach.meets(right, left) || (next && next->gap <= reach.begin - front)) return;
    user.gap = reach.begin - front;
    user.speed = speed;
    next = user;
  };
  constexpr double farthest = 200.0;  // [m]
  view.around(at, farthest, [&](RoadUser const& other) {
    if (!is_valid(other.agent)) return;
    auto const& state = view.state(other);
    auto const reach = lane_reach(line, state, view.shape(other), at.segment);
    auto hint = at.segment;
    consider(reach, other, geometry::to_frenet(line, state, hint).longitudinal_speed);
  });
  view.for_each_object([&](ObjectId id, geometry::Polygon const& outline) {
    auto const reach = lane_reach(line, outline, at.segment);
    if (reach.begin < front + farthest) consider(reach, {.object = id}, 0.0);
  });
  for_each_on_feeders(view, farthest, merging, [&](RoadUser const& other) {
    if ((!next || other.gap < next->gap) && !leaves_room(view, at.corridor, other, offset, clearance)) next = other;
  });
  return next;
}

}  // namespace detail

}  // namespace cambium::inline v0_1
