#pragma once

#include <algorithm>
#include <limits>
#include <optional>

#include "cambium/behavior/lateral/corridor_filters.hpp"
#include "cambium/behavior/lateral/change_lanes.hpp"

namespace cambium::inline v0_1 {

/// Changes to the lane with the most free space ahead (BARK's rule-based lane change), if that is at least `advantage`
/// more than in the own lane, `space` is free and the gap is safe. Free space counts up to `horizon`. Where its lane
/// ends, it changes towards one that goes on, whatever the space.
struct FreeSpaceRule {
  FreeSpace space{};
  double minimum_remaining = 60.0;
  double advantage = 10.0;
  double horizon = 150.0;
  double route_horizon = 300.0;

  static constexpr char const* name = "free_space_rule";
  static constexpr char const* summary = "changes to the lane with the most free space ahead, if that is safe";
  static constexpr char const* source = "rule: BARK; safety: Kesting, Treiber, Helbing 2007";
  static constexpr auto parameters() {
    using P = FreeSpaceRule;
    return parameter_list(
        parameter("space", &P::space, "what must be free in the new lane"),
        parameter(
            "minimum_remaining", &P::minimum_remaining, "m", Range{0, 10'000},
            "length of the new lane that must remain after changing there and back, unless the route needs the change"),
        parameter("advantage", &P::advantage, "m", Range{0, 1000},
                  "additional free space that makes a change worthwhile"),
        parameter("horizon", &P::horizon, "m", Range{0, 400}, "limit of the free space considered"),
        parameter("route_horizon", &P::route_horizon, "m", Range{1, 10'000},
                  "distance before a lane's end from which it counts, for each lane to cross"));
  }

  template <class Choice>
  [[nodiscard]] CorridorId operator()(Choice const& now) const {
    return now.may_change ? roomiest_side(now) : none<CorridorId>;
  }

 private:
  [[nodiscard]] double space_ahead(std::optional<RoadUser> const& front) const {
    return front ? std::min(front->gap, horizon) : horizon;
  }

  template <class Choice>
  [[nodiscard]] CorridorId roomiest_side(Choice const& now) const {
    auto const& view = now.view;
    auto const& piece = view.corridor().pieces[view.place().piece];
    if (piece.left == none<CorridorId> && piece.right == none<CorridorId>) return none<CorridorId>;
    auto const urgency = lane_urgency(view, route_horizon);
    double best = space_ahead(now.leader) + advantage;
    auto target = none<CorridorId>;
    for (bool const left : {true, false}) {
      auto const side = piece.beside(left);
      if (side == none<CorridorId> || !now.changing.marks_permit(view, view.place(), left)) continue;
      double const urge = left ? urgency.left : urgency.right;
      LaneOption option{view.place(side), left, {}, {}};
      double const remaining = lane_end(view, side, option.place.piece) - option.place.s;
      if (urge < 0.0 || (urge == 0.0 && !now.may_return(option, remaining, minimum_remaining))) continue;
      option.front = view.ahead(option.place, now.look());
      double const ahead = urge > 0.0 ? std::numeric_limits<double>::infinity() : space_ahead(option.front);
      if (!(ahead > best)) continue;
      option.rear = view.behind(option.place, now.look());
      if (!space(view, option) || !now.is_safe(option)) continue;
      best = ahead;
      target = side;
    }
    return target;
  }
};
}  // namespace cambium::inline v0_1
