#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <tuple>

#include "cambium/behavior/behavior_model.hpp"
#include "cambium/behavior/constant_acceleration.hpp"
#include "cambium/behavior/follow_lane.hpp"
#include "cambium/behavior/rss.hpp"
#include "cambium/geometry/shape.hpp"

namespace cambium {

/// Any behaviour, but for dangerous situations by Responsibility-Sensitive Safety (see rss.hpp) with the next road
/// users in the own lane and those beside: there it brakes, or comes no closer to a side, as the proper response asks.
/// It also keeps its accelerations within what others count on. A plan that is not followed is forgotten: the nominal
/// behaviour decides again from what it remembered before. No longer step than `response_time` is safe.
template <BehaviorModel Nominal>
struct RssConformant {
  Nominal nominal{};
  RssParameters rss{};

  static constexpr char const* name = "rss_conformant";
  static constexpr auto parameters() {
    return std::make_tuple(
        parameter("nominal", &RssConformant::nominal, "-", {}, "the behaviour where nothing is dangerous"),
        parameter("rss", &RssConformant::rss, "-", {}, "what is dangerous, and the response"));
  }

  using Memory = MemoryOf<Nominal>;

  template <class View>
  [[nodiscard]] Plan<View> plan(View const& view, Memory& memory, double dt) const {
    auto remembered = memory;
    auto plan = nominal.plan(view, remembered, dt);
    if (plan.status != PlanStatus::valid || plan.trajectory.empty()) return plan;
    auto const must = response(view);
    auto const& end = plan.trajectory.back();
    double const speed = std::max(0.0, view.state().speed), wanted = (end.speed - speed) / dt;
    double const most = must.brake ? -rss.minimum_deceleration : rss.maximum_acceleration;
    double const acceleration = std::clamp(wanted, -rss.maximum_deceleration, most);
    auto const& at = view.lane_position();
    double const sideways = view.corridor().center.project({end.x, end.y}, at.segment).lateral - at.lateral;
    bool const closer = (must.keep_off_left && sideways > rounding) || (must.keep_off_right && sideways < -rounding);
    if (std::abs(acceleration - wanted) <= rounding && !closer) {
      memory = remembered;
      return plan;
    }
    return plan_along_lane(view, ConstantAcceleration{.acceleration = acceleration}.motion(speed, dt), dt);
  }

  /// The proper response to all that is near.
  template <class View>
  [[nodiscard]] RssResponse response(View const& view) const {
    RssResponse all;
    auto const& at = view.lane_position();
    respond(view, view.front(), true, std::nullopt, all);
    respond(view, view.rear(), false, std::nullopt, all);
    auto const& piece = view.corridor().pieces[at.piece];
    for (bool const left : {true, false}) {
      auto const side = left ? piece.left : piece.right;
      if (side == map::no_corridor) continue;
      auto const beside = view.neighbors(side);
      respond(view, beside.front, true, left, all);
      respond(view, beside.rear, false, left, all);
    }
    return all;
  }

 private:
  static constexpr double rounding = 1e-9;

  /// `side`: where the neighbour's lane is, left or right; none for the own.
  template <class View>
  void respond(View const& view, std::optional<Neighbor> const& neighbor, bool is_ahead, std::optional<bool> side,
               RssResponse& all) const {
    if (!neighbor) return;
    auto const& at = view.lane_position();
    double const error = at.heading_error;
    RssSituation situation{.gap = neighbor->gap,
                           .speed = view.state().speed * std::cos(error),
                           .other_speed = neighbor->speed,
                           .lateral_speed = view.state().speed * std::sin(error),
                           .is_ahead = is_ahead,
                           .is_left = side.value_or(false)};
    if (is_valid(neighbor->agent))
      look_sideways(view, *neighbor, situation);
    else
      situation.side_gap = side ? 1e-3 : 0.0;  // an object fills its lane
    auto const one = rss_response(rss, situation);
    all.brake = all.brake || (one.brake && (is_valid(neighbor->agent) || !side));
    all.keep_off_left = all.keep_off_left || one.keep_off_left;
    all.keep_off_right = all.keep_off_right || one.keep_off_right;
  }

  /// Distance and speeds across the own lane's direction.
  template <class View>
  static void look_sideways(View const& view, Neighbor const& neighbor, RssSituation& situation) {
    auto const& at = view.lane_position();
    auto const& center = view.corridor().center;
    auto const other = view.agent(neighbor);
    auto const foot = center.project({other.state.x, other.state.y}, at.segment);
    auto const& segment = center.segments()[foot.segment];
    double const inside = std::clamp(foot.s - segment.s, 0.0, segment.length);
    double const turn = other.state.heading - (segment.heading + segment.curvature * inside);
    auto const across = [](geometry::Shape const& shape, double angle) {
      return geometry::extent_along(shape, std::sin(angle), -std::cos(angle));
    };
    auto const own = across(view.shape(), at.heading_error), others = across(other.shape, turn);
    situation.is_left = foot.lateral > at.lateral;
    situation.side_gap = situation.is_left ? foot.lateral - others.negative - (at.lateral + own.positive)
                                           : at.lateral - own.negative - (foot.lateral + others.positive);
    situation.other_lateral_speed = other.state.speed * std::sin(turn);
  }
};

}  // namespace cambium
