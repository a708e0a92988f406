#pragma once

#include <algorithm>
#include <limits>

#include "cambium/behavior/view.hpp"
#include "cambium/core/macros.hpp"

namespace cambium::inline v0_1 {

/// Corridor position [m] by which a vehicle on corridor `number`, in its piece `piece`, must have left its lane because
/// the lane ends or leaves the route, or should have left it because the lane begins to merge; infinite if it may stay.
/// O(1).
template <class View>
[[nodiscard]] double lane_end(View const& view, CorridorId number, PieceId piece) {
  auto const& corridor = view.road().corridors[number];
  double const end = corridor.pieces[piece].lane_end;
  return corridor.reaches_destination || !view.has_goal() ? end : std::min(end, corridor.length());
}

/// Whether a vehicle must stop at `end`, a finite `lane_end` of the corridor; it may drive over a merge.
[[nodiscard]] inline bool is_dead_end(map::LaneCorridor const& corridor, double end) {
  return end >= corridor.length();
}

/// As `lane_end` [m], but infinite for a merge, over which a vehicle may drive.
template <class View>
[[nodiscard]] double dead_end(View const& view, CorridorId number, PieceId piece) {
  double const end = lane_end(view, number, piece);
  return is_dead_end(view.road().corridors[number], end) ? end : std::numeric_limits<double>::infinity();
}

/// Whether a lane with the finite `lane_end` `end` leaves the route of a driver without a goal: it does not end, but
/// leads elsewhere, as an exit lane does.
template <class View>
[[nodiscard]] bool is_way_out(View const& view, CorridorId number, double end) {
  auto const& corridor = view.road().corridors[number];
  return !view.has_goal() && corridor.continues && is_dead_end(corridor, end);
}

/// To which side the lanes lie that go further than the own lane, and how urgent a change is.
struct LaneUrgency {
  double left{}, right{};  ///< urgency of a change to that side, from -1 to 1; negative: leads away from these lanes,
                           ///< or into a lane that ends
};

namespace detail {

/// Length [m] that is left of a corridor's lane, from `along` [m] after the begin of one of its pieces.
template <class View>
[[nodiscard]] double remaining_from(View const& view, CorridorId number, PieceId piece, double along) {
  return lane_end(view, number, piece) - view.road().corridors[number].pieces[piece].begin - along;
}

/// Number of lanes to cross from a piece of lane corridor `number` to the nearest one on the left (right) of which
/// `fits(corridor, piece)`; 0 if there is none.
template <class Fits>
[[nodiscard]] int lanes_until(map::RoadCorridor const& road, CorridorId number, PieceId piece, bool left,
                              Fits const& fits) {
  constexpr int most = 16;
  for (int lanes = 1; lanes <= most; ++lanes) {
    auto const& at = road.corridors[number].pieces[piece];
    number = at.beside(left);
    piece = at.piece_beside(left);
    if (number == none<CorridorId>) return 0;
    if (fits(number, piece)) return lanes;
  }
  return 0;
}

}  // namespace detail

/// Number of lanes to cross to the nearest lane that goes further; both 0 if there is none.
struct LanesToCross {
  int left{}, right{};  ///< to that side; the farther side is 0
};

/// Lanes to cross from position `s` [m] on a lane corridor, in its piece `piece`, with a finite `lane_end`. The lane
/// that goes further may begin later. O(lanes beside), at worst for each piece up to the end.
template <class View>
CAMBIUM_NOINLINE [[nodiscard]] LanesToCross lanes_to_cross(View const& view, CorridorId number, PieceId piece,
                                                           double s) {
  auto const& pieces = view.road().corridors[number].pieces;
  double const end = lane_end(view, number, piece);
  for (auto p = piece; index_of(p) < pieces.size(); ++p) {
    double const along = p == piece ? s - pieces[p].begin : 0.0, remaining = end - pieces[p].begin - along;
    if (!(remaining > 0.0)) break;
    auto const goes_further = [&](CorridorId beside, PieceId there) {
      return detail::remaining_from(view, beside, there, along) > remaining + 1.0;
    };
    int const left = detail::lanes_until(view.road(), number, p, true, goes_further);
    int const right = detail::lanes_until(view.road(), number, p, false, goes_further);
    if (left == 0 && right == 0) continue;
    bool const is_left = right == 0 || (left != 0 && left <= right);
    return is_left ? LanesToCross{left, 0} : LanesToCross{0, right};
  }
  return {};
}

/// Urgency of a lane change from place `at` because of lane ends, merges and the goal's lane. It grows from 0 to 1 over
/// the last `horizon` [m] before the lane end for each lane to cross. O(1) without an end ahead, else O(lanes beside),
/// at worst for each piece up to the end.
template <class View>
CAMBIUM_NOINLINE [[nodiscard]] LaneUrgency lane_urgency(View const& view, map::LanePlace const& at, double horizon) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  auto const& piece = view.road().corridors[at.corridor].pieces[at.piece];
  double const remaining = lane_end(view, at.corridor, at.piece) - at.s;
  auto const closeness = [&](double length, int lanes) {
    return std::clamp(1.0 - length / (lanes * horizon), 0.0, 1.0);
  };
  if (remaining == infinite) {
    auto const away = [&](CorridorId number, PieceId there) {
      if (number == none<CorridorId>) return 0.0;
      double const left = detail::remaining_from(view, number, there, at.s - piece.begin);
      return left == infinite ? 0.0 : -closeness(left, 1);
    };
    return {away(piece.left, piece.left_piece), away(piece.right, piece.right_piece)};
  }
  auto const lanes = lanes_to_cross(view, at.corridor, at.piece, at.s);
  if (lanes.left == 0 && lanes.right == 0) return {};
  double const urgency = closeness(remaining, lanes.left + lanes.right);
  return lanes.left > 0 ? LaneUrgency{urgency, -urgency} : LaneUrgency{-urgency, urgency};
}
/// The same from the own place.
template <class View>
[[nodiscard]] LaneUrgency lane_urgency(View const& view, double horizon) {
  return lane_urgency(view, view.place(), horizon);
}

/// Number of lane changes from `piece` of lane corridor `number` to a corridor that reaches the destination; 0 if none
/// can be reached from there. O(lanes).
[[nodiscard]] inline int lanes_to_destination(map::RoadCorridor const& road, CorridorId number, PieceId piece) {
  if (road.corridors[number].reaches_destination) return 0;
  auto const reaches = [&](CorridorId beside, PieceId) { return road.corridors[beside].reaches_destination; };
  int const left = detail::lanes_until(road, number, piece, true, reaches);
  return left != 0 ? left : detail::lanes_until(road, number, piece, false, reaches);
}

}  // namespace cambium::inline v0_1
