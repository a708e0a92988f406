#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <type_traits>

#include "cambium/behavior/behavior_model.hpp"
#include "cambium/behavior/course.hpp"
#include "cambium/behavior/law/follow_lane.hpp"
#include "cambium/behavior/open_loop/constant_acceleration.hpp"
#include "cambium/behavior/wrap/rss.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/execution/interpolate.hpp"
#include "cambium/geometry/shape.hpp"

namespace cambium::inline v0_1 {

/// Any behaviour, overridden in dangerous situations by Responsibility-Sensitive Safety (see rss.hpp). In each step
/// - the nominal behaviour plans;
/// - the wrapper computes the proper response to all road users in the own lane, in the lanes beside and in the
///   oncoming lanes of the own road;
/// - it returns the nominal plan if that conforms to the response and to the bounds of acceleration that others rely
///   on; otherwise it brakes, or comes no closer to a side, and tells the nominal behaviour how much of its course was
///   not driven (`fell_short`).
///
/// If the vehicle must brake, it stays on the nominal course. If it must keep off a side, it keeps its lateral offset
/// and follows the lane. A plan that leads farther than its acceleration, such as a recording that went on while its
/// vehicle had to wait, is followed along its course with that acceleration.
///
/// Two assumptions: Plans may turn sideways harder than `lateral_acceleration`; whether they cause danger is decided by
/// where they end, assuming that the other comes closer by as much. A step longer than `response_time` takes its place.
/// O(agents within some hundred metres).
template <BehaviorModel Nominal>
struct RssConformant {
  Nominal nominal{};
  RssParameters rss{};

  static constexpr char const* name = "rss_conformant";
  static constexpr char const* summary =
      "any behaviour; below the safe distances along and across the lane it brakes, or comes no closer, as the proper "
      "response requires";
  static constexpr char const* source = "Shalev-Shwartz, Shammah, Shashua 2017";
  static constexpr auto parameters() {
    return parameter_list(parameter("nominal", &RssConformant::nominal, "the behaviour when there is no danger"),
                          parameter("rss", &RssConformant::rss, "safe distances and the response"));
  }

  using Memory = MemoryOf<Nominal>;
  using Workspace = WorkspaceOf<Nominal>;
  static constexpr bool looks_beside = true;
  static constexpr bool looks_around = detail::looks_around<Nominal>();
  static constexpr bool heeds_conflicts = detail::heeds_conflicts<Nominal>();

  [[nodiscard]] double start_time() const requires requires(Nominal const behavior) { behavior.start_time(); }
  { return nominal.start_time(); }

  template <class View>
  [[nodiscard]] Plan<View> plan(View const& view, Memory& memory,
                                double dt) const requires std::is_same_v<Workspace, NoWorkspace> {
    return conform(view, nominal.plan(view, memory, dt), memory, dt);
  }

  template <class View>
  [[nodiscard]] Plan<View> plan(View const& view, Memory& memory, double dt, Workspace& workspace) const {
    return conform(view, nominal.plan(view, memory, dt, workspace), memory, dt);
  }

  /// The proper response to all road users nearby if the vehicle plans to be in state `end` after `dt` [s]. `brake`
  /// depends on the present situation; a side to keep off depends on the situation at `end`, and only if that is
  /// closer.
  template <class View>
  CAMBIUM_NOINLINE [[nodiscard]] RssResponse response(View const& view, typename View::State const& end,
                                                      double dt) const {
    RssResponse all;
    auto const& at = view.place();
    Step const step(within_steps(dt), std::max(0.0, view.state().speed), dt,
                    across(view, view.state(), view.shape(), at.segment), across(view, end, view.shape(), at.segment));
    auto const &now = step.now, &then = step.then;
    for_each_oncoming(step, view, [&](RoadUser const& other) {
      if (may_matter(step, view, other)) respond(step, view, other, at.segment, all);
    });
    /// Whether an object ahead is too close; visits the agents nearby.
    auto const too_close = [&](map::LanePlace const& from) {
      bool is_close = false;
      view.around(from, farthest, [&](RoadUser const& other) {
        if (!is_valid(other.agent)) {
          is_close = is_close || (other.s >= from.s && other.gap < step.same);
        } else if (is_near(step, other, other.s >= from.s) && may_matter(step, view, other)) {
          respond(step, view, other, view.corridor().center.find(at.s + (other.s - from.s)), all);
        }
      });
      return is_close;
    };
    all.brake = too_close(at) || all.brake || lets_merge_first(step, view);
    for (bool const left : {true, false}) {
      auto const& piece = view.corridor().pieces[at.piece];
      auto const side = piece.beside(left);
      if (side == none<CorridorId>) continue;
      bool const closer = left ? then.left > now.left : then.right < now.right;
      auto& keep_off = left ? all.keep_off_left : all.keep_off_right;
      keep_off = (too_close(view.place(side)) && closer) || keep_off;
      auto const next = view.road().corridors[side].pieces[piece.piece_beside(left)].beside(left);
      if (next != none<CorridorId>) (void)too_close(view.place(next));
    }
    return all;
  }

 private:
  static constexpr double rounding = 1e-9;
  static constexpr double farthest = Look::horizon;
  static constexpr double before_merge = 15.0;  // [m]: bodies touch before lanes are one

  /// Place, extent and velocity of a road user relative to the own lane corridor.
  struct Across {
    double s{}, front{}, rear{};       ///< position along the corridor, and extent ahead and behind [m]
    double middle{}, left{}, right{};  ///< lateral positions of the reference point and the sides, left positive [m]
    double along{}, aside{};           ///< speeds [m/s]
  };

  /// What the responses of one step to all road users have in common.
  struct Step {
    Step(RssParameters const& assumed, double own_speed, double seconds, Across const& begin, Across const& end)
        : p(assumed),
          speed(own_speed),
          dt(seconds),
          now(begin),
          then(end),
          same(rss_same_direction(p, speed, 0.0)),
          opposite(rss_opposite_direction(p, speed, speed)) {}

    /// The same from vehicles that may be faster, at `fast` [m/s].
    [[nodiscard]] double same_at(double fast) const { return fast > speed ? rss_same_direction(p, fast, 0.0) : same; }
    [[nodiscard]] double opposite_at(double fast) const {
      return fast > speed ? rss_opposite_direction(p, fast, fast) : opposite;
    }

    RssParameters p;
    double speed, dt;       ///< [m/s], [s]
    Across now, then;       ///< of the own vehicle, and where it plans to be at the end
    double same, opposite;  ///< safe distances from those in its direction, and from those that come at its speed [m]
  };

  /// The assumptions if nobody responds before the next step.
  [[nodiscard]] RssParameters within_steps(double dt) const {
    auto p = rss;
    p.response_time = std::max(p.response_time, dt);
    return p;
  }

  /// The nominal behaviour's `plan`, changed as far as the response demands.
  template <class View>
  [[nodiscard]] Plan<View> conform(View const& view, Plan<View> plan, Memory& memory, double dt) const {
    if (plan.status != PlanStatus::valid) return plan;
    auto const end = InterpolateExecution{}.execute(plan, view.state(), view.dynamics(), view.time() + dt);
    if (!end.valid || !is_finite(end.state)) return plan;
    auto const must = response(view, end.state, dt);
    bool const keeps_off = must.keep_off_left || must.keep_off_right;
    double const speed = std::max(0.0, view.state().speed), wanted = (end.state.speed - speed) / dt;
    double const most = must.brake ? -rss.minimum_deceleration : rss.maximum_acceleration;
    double const acceleration = std::clamp(wanted, -rss.maximum_deceleration, most);
    auto const driven = ConstantAcceleration{.acceleration = acceleration}.motion(speed, dt);
    auto const reach = reach_of(view.state(), end.state, driven.distance);
    bool const as_wanted = reach == Reach::within && std::abs(acceleration - wanted) <= rounding;
    if (as_wanted && !keeps_off) return plan;
    while (!plan.trajectory.empty() && plan.trajectory.back().time >= end.state.time) plan.trajectory.pop_back();
    plan.trajectory.push_back(end.state);
    double const way = detail::course_length(plan, view.state());
    auto motion = as_wanted ? LongitudinalMotion<double>{way, end.state.speed} : driven;
    if (acceleration < wanted) motion.distance = std::min(motion.distance, way);
    fell_short(memory, keeps_off ? way : way - motion.distance, keeps_off);
    bool const along_lane = keeps_off || reach == Reach::behind;
    return along_lane ? plan_along_lane(view, motion, dt) : detail::plan_along_course(view, plan, motion, dt);
  }

  /// Where a plan ends compared with what can be driven in the step. A recording goes on while its vehicle waits.
  enum class Reach : std::uint8_t { within, beyond, behind };

  /// The reach of a plan from `now` to `end` if `distance` [m] is driven. Tolerates the slightly longer way sideways or
  /// on the outside of a bend.
  template <MotionState S>
  [[nodiscard]] static Reach reach_of(S const& now, S const& end, double distance) {
    constexpr double share = 0.05, apart = 0.1;  // [-], [m]
    auto const ahead = portable::sin_cos(now.heading);
    if ((end.x - now.x) * ahead.cos + (end.y - now.y) * ahead.sin < -apart) return Reach::behind;
    return detail::way_between(now, end) <= (1.0 + share) * distance + apart ? Reach::within : Reach::beyond;
  }

  /// Whether the vehicle must brake because lanes become one ahead. Sideways, traffic in the other lane is at a safe
  /// distance until then, but there is no room to respond to it afterwards. So of two vehicles without a safe distance
  /// lengthwise, the one farther from the merge stays able to stop before it. O(feeders + agents on them).
  template <class View>
  CAMBIUM_NOINLINE [[nodiscard]] static bool lets_merge_first(Step const& step, View const& view) {
    double const s = view.place().s, front = s + view.shape().front;
    double const stop = front + step.same;
    bool lets = false;
    for (auto const& feeder : view.corridor().feeders) {
      if (feeder.begin > stop + farthest || lets) break;
      if (!feeder.is_still_to_merge() || feeder.free_until < front || stop < feeder.free_until - before_merge) continue;
      view.on_lane(feeder.index_begin, feeder.index_end, [&](RoadUser const& other) {
        if (!is_valid(other.agent) || other.s < feeder.index_begin || other.s > feeder.index_end) return;
        double const place = feeder.image(other.s), gap = place - other.rear - front;
        bool const is_ahead = place > s || (place == s && other.agent < view.id());
        lets = lets || (is_ahead && gap < rss_same_direction(step.p, step.speed, std::max(0.0, other.speed)));
      });
    }
    return lets;
  }

  /// False for an agent of a lane beside, or of one that merges, that is too far away along it to matter, `is_ahead` or
  /// behind. That distance may be longer than the one along the own lane, on the outside of a bend.
  [[nodiscard]] static bool is_near(Step const& step, RoadUser const& other, bool is_ahead) {
    constexpr double share = 1.2, apart = 15.0;  // [-], [m]
    double const fast = std::abs(other.speed), gap = (other.gap - apart) * (1.0 / share);
    return gap <= (is_ahead ? step.same : step.same_at(fast)) || (other.speed < 0.0 && gap <= step.opposite_at(fast));
  }

  /// False for a road user too far away to matter, whatever it does.
  template <class View>
  [[nodiscard]] static bool may_matter(Step const& step, View const& view, RoadUser const& other) {
    auto const &own = view.state(), &state = view.state(other);
    double const dx = state.x - own.x, dy = state.y - own.y, fast = std::abs(state.speed);
    double const sizes = 2.0 * (half_girth(view.shape()) + half_girth(view.shape(other)));
    double const same = step.same_at(fast) + sizes;
    double const apart = dx * dx + dy * dy;
    if (apart <= same * same) return true;
    double const opposite = step.opposite_at(fast) + sizes;
    return apart <= opposite * opposite;
  }
  /// At least the radius of a shape [m], without a root.
  [[nodiscard]] static double half_girth(geometry::Shape const& shape) {
    return 0.5 * (shape.length() + shape.width());
  }

  /// Calls `f(RoadUser)` for the road users beside and ahead in the oncoming lanes of the own road.
  template <class View, class F>
  static void for_each_oncoming(Step const& step, View const& view, F const& f) {
    constexpr double fast = 50.0, beside = 20.0;  // [m/s], [m]
    auto const& corridor = view.corridor();
    auto const& at = view.place();
    double const from = at.s - beside, to = at.s + beside + rss_opposite_direction(step.p, step.speed, fast);
    for (auto i = corridor.piece_at(from, at.piece); index_of(i) < corridor.pieces.size(); ++i) {
      auto const& piece = corridor.pieces[i];
      if (piece.begin > to) return;
      if (!is_valid(piece.lane)) continue;
      auto const& lane = view.map().lane(piece.lane);
      for (auto const& entry : view.map().road(lane.road).sections[lane.section].lanes)
        for (auto const id : {entry.id, entry.opposite}) {
          if (!is_valid(id)) continue;
          auto const& other = view.map().lane(id);
          if (!other.drivable() || other.along_road == lane.along_road) continue;
          auto const stretch = other.stretch_between(lane.station_at(std::max(from, piece.begin) + piece.lane_offset),
                                                     lane.station_at(std::min(to, piece.end) + piece.lane_offset));
          view.on_lane(other.index_begin + stretch.begin, other.index_begin + stretch.end, [&](RoadUser const& user) {
            if (is_valid(user.agent)) f(user);
          });
        }
    }
  }

  template <class View>
  [[nodiscard]] static Across across(View const& view, typename View::State const& state, geometry::Shape const& shape,
                                     std::uint32_t hint) {
    auto const& center = view.corridor().center;
    auto const foot = center.project({state.x, state.y}, hint);
    auto const& segment = center.segments()[foot.segment];
    double const inside = std::clamp(foot.s - segment.s, 0.0, segment.length);
    auto const [sin, cos] =
        portable::sin_cos_often_slight(state.heading - (segment.heading + segment.curvature * inside));
    auto const lengthwise = geometry::extent_along(shape, cos, sin),
               sideways = geometry::extent_along(shape, sin, -cos);
    return {foot.s,
            lengthwise.positive,
            lengthwise.negative,
            foot.lateral,
            foot.lateral + sideways.positive,
            foot.lateral - sideways.negative,
            state.speed * cos,
            state.speed * sin};
  }

  /// Adds the response to one road user, whose place along the corridor is near segment `hint`.
  template <class View>
  static void respond(Step const& step, View const& view, RoadUser const& other, std::uint32_t hint, RssResponse& all) {
    auto const& p = step.p;
    auto const &now = step.now, &then = step.then;
    auto const its = across(view, view.state(other), view.shape(other), hint);
    RssSituation at{.speed = now.along, .other_speed = its.along, .other_lateral_speed = its.aside};
    if (its.along < 0.0) {
      auto const sides = view.corridor().widths_at(now.s, view.place().segment);
      at.in_own_lane = -now.middle <= sides.right && now.middle <= sides.left;
    }
    at.is_ahead = its.s >= now.s;
    at.gap = at.is_ahead ? its.s - its.rear - (now.s + now.front) : now.s - now.rear - (its.s + its.front);
    if (at.gap > 0.0 && at.gap >= rss_safe_gap(p, at)) return;
    at.is_left = its.middle > now.middle;
    at.side_gap = at.is_left ? its.right - now.left : now.right - its.left;
    all.brake = all.brake || rss_response(p, at).brake;
    if (!(at.side_gap > 0.0)) return;
    double const closing = std::max(0.0, at.is_left ? then.left - now.left : now.right - then.right);
    if (!(closing > rounding)) return;
    // The situation at the end of the plan if the other comes closer by as much.
    double const toward = std::max(closing / step.dt, at.is_left ? then.aside : -then.aside);
    at.lateral_speed = at.is_left ? toward : -toward;
    at.side_gap = std::max(at.side_gap - 2.0 * closing, rounding);
    auto const one = rss_response(p, at);
    all.keep_off_left = all.keep_off_left || one.keep_off_left;
    all.keep_off_right = all.keep_off_right || one.keep_off_right;
  }
};

}  // namespace cambium::inline v0_1
