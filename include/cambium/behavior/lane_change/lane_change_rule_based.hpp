#pragma once

#include <algorithm>
#include <limits>
#include <optional>

#include "cambium/behavior/behavior_model.hpp"
#include "cambium/behavior/lane_change/corridor_filters.hpp"
#include "cambium/behavior/lane_change/lane_changing.hpp"
#include "cambium/behavior/law/idm.hpp"

namespace cambium {

/// Changes to the lane with the most free space ahead (BARK's rule-based lane change), if that is at least `advantage`
/// more than in the own lane, `space` is free and the gap is safe. Free space counts up to `horizon`. Where its lane
/// ends, it changes towards one that goes on, whatever the space. Car following by IDM; `LaneChanging` carries out the
/// change.
struct LaneChangeRuleBased {
  IdmParameters idm{};
  LaneChanging changing{};
  RoadRules rules{.slow_for_bends = true, .lateral_acceleration = 3.0};
  FreeSpace space{};
  double minimum_remaining = 60.0;
  double advantage = 10.0;
  double horizon = 150.0;
  double route_horizon = 300.0;
  double tolerance = 1e-4;

  using Memory = LaneChanging::Memory;
  static constexpr bool looks_beside = true;

  static constexpr char const* name = "lane_change_rule_based";
  static constexpr char const* summary = "IDM; changes to the lane with the most free space ahead, if that is safe";
  static constexpr char const* source = "rule: BARK; safety: Kesting, Treiber, Helbing 2007";
  static constexpr auto parameters() {
    using P = LaneChangeRuleBased;
    return parameter_list(
        parameter("idm", &P::idm, "the driver's own car following"),
        parameter("changing", &P::changing, "how it changes lanes, and what it assumes of others"),
        parameter("rules", &P::rules, "what it heeds besides other road users"),
        parameter("space", &P::space, "what must be free in the new lane"),
        parameter(
            "minimum_remaining", &P::minimum_remaining, "m", Range{0, 10'000},
            "length of the new lane that must remain after changing there and back, unless the route needs the change"),
        parameter("advantage", &P::advantage, "m", Range{0, 1000},
                  "additional free space that makes a change worthwhile"),
        parameter("horizon", &P::horizon, "m", Range{0, 400}, "limit of the free space considered"),
        parameter("route_horizon", &P::route_horizon, "m", Range{1, 10'000},
                  "distance before a lane's end from which it counts, for each lane to cross"),
        parameter("tolerance", &P::tolerance, "m/s^2", Range{1e-12, 1}, "integration error in speed, per second"));
  }

  template <class View>
  [[nodiscard]] Plan<View> plan(View const& view, Memory& memory, double dt) const {
    return changing.drive(view, memory, idm, rules, tolerance, dt, [this](LaneKeeping<View> const& now) {
      return now.may_change ? roomiest_side(now) : none<CorridorId>;
    });
  }

 private:
  [[nodiscard]] double space_ahead(std::optional<RoadUser> const& front) const {
    return front ? std::min(front->gap, horizon) : horizon;
  }

  template <class View>
  [[nodiscard]] CorridorId roomiest_side(LaneKeeping<View> const& now) const {
    auto const& view = now.view;
    auto const& piece = view.corridor().pieces[view.place().piece];
    if (piece.left == none<CorridorId> && piece.right == none<CorridorId>) return none<CorridorId>;
    auto const urgency = lane_urgency(view, route_horizon);
    double best = space_ahead(now.leader) + advantage;
    auto target = none<CorridorId>;
    for (bool const left : {true, false}) {
      auto const side = piece.beside(left);
      if (side == none<CorridorId> || !changing.marks_permit(view, left)) continue;
      double const urge = left ? urgency.left : urgency.right;
      LaneOption option{view.place(side), left, {}, {}};
      double const remaining = lane_end(view, side, option.place.piece) - option.place.s;
      if (urge < 0.0 || (urge == 0.0 && remaining < minimum_remaining + changing.there_and_back(now.law.speed())))
        continue;
      option.front = view.ahead(option.place);
      double const ahead = urge > 0.0 ? std::numeric_limits<double>::infinity() : space_ahead(option.front);
      if (!(ahead > best)) continue;
      option.rear = view.behind(option.place);
      if (!space(view, option) || !changing.is_safe(view, now.law, option, changing.safe_deceleration)) continue;
      best = ahead;
      target = side;
    }
    return target;
  }
};
static_assert(BehaviorModel<LaneChangeRuleBased>);

}  // namespace cambium
