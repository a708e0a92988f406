#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <tuple>

#include "cambium/core/described.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/geometry/line.hpp"
#include "cambium/map/corridor/corridor.hpp"

namespace cambium::inline v0_1::map {

/// Where a vehicle is on a road corridor. `corridor` and `piece` number the lane corridor and its lane.
struct LanePlace {
  double s{};               ///< along the lane corridor's centre line [m]
  double lateral{};         ///< from the centre line, left positive [m]
  double heading_error{};   ///< vehicle's heading minus the lane's [rad], in (-pi, pi]
  double index{};           ///< the map-wide lane coordinate (see `Lane::index_begin`)
  std::uint32_t segment{};  ///< of the centre line: the hint for the next projection
  CorridorId corridor = none<CorridorId>;
  PieceId piece{};

  static constexpr char const* name = "lane_place";
  /// All but `index`, which follows: see `lane_coordinate`.
  static constexpr auto parameters() {
    using P = LanePlace;
    return parameter_list(
        parameter("s", &P::s, "m", any_finite, "along the centre line of the lane corridor"),
        parameter("lateral", &P::lateral, "m", any_finite, "from the centre line, left positive"),
        parameter("heading_error", &P::heading_error, "rad", any_finite, "vehicle's heading minus the lane's"),
        parameter("segment", &P::segment, "-", Range{0, 4294967295.0}, "of the centre line: a hint"),
        parameter("corridor", &P::corridor, "number of the lane corridor"),
        parameter("piece", &P::piece, "number of its piece"));
  }

  friend bool operator==(LanePlace const&, LanePlace const&) = default;
};

/// The map-wide lane coordinate at `s` on a piece of a corridor. A vehicle beyond an end of its corridor stays in its
/// lane's own range of it.
[[nodiscard]] inline double lane_coordinate(CorridorPiece const& piece, double s) {
  return std::min(std::max(s, piece.begin - 1.0), piece.end + 1.0) + piece.index_offset;
}

/// Places `pose` on lane corridor `number` of `road`; `hint` is the last position there. O(segments moved since).
[[nodiscard]] inline LanePlace locate(RoadCorridor const& road, CorridorId number, geometry::Pose const& pose,
                                      LanePlace const& hint) {
  auto const& corridor = road.corridors[number];
  auto const foot = corridor.center.project(pose.position(), hint.segment);
  auto const& segment = corridor.center.segments()[foot.segment];
  double const inside = std::min(std::max(foot.s - segment.s, 0.0), segment.length);
  double error = pose.heading - (segment.heading + segment.curvature * inside);
  if (std::abs(error) > geometry::pi) error = geometry::normalize_angle(error);
  auto const piece = corridor.piece_at(foot.s, hint.piece);
  double const index = lane_coordinate(corridor.pieces[piece], foot.s);
  return {foot.s, foot.lateral, error, index, foot.segment, number, piece};
}

/// As above without a hint: exact. O(segments).
[[nodiscard]] inline LanePlace locate(RoadCorridor const& road, CorridorId number, geometry::Pose const& pose) {
  LanePlace hint;
  hint.segment = road.corridors[number].center.project(pose.position()).segment;
  return locate(road, number, pose, hint);
}

namespace detail {

/// See `nearest_corridor`. Where `heading` is null directions do not count.
[[nodiscard]] inline LanePlace nearest_corridor(RoadCorridor const& road, geometry::Point const& p,
                                                double const* heading) {
  LanePlace best;
  auto best_rank = std::tuple(0.0, 0.0, 0.0);
  for (std::size_t i = 0; i < road.corridors.size(); ++i) {
    auto const& corridor = road.corridors[i];
    auto at = locate(road, static_cast<CorridorId>(i), {p.x(), p.y(), heading ? *heading : 0.0});
    if (!heading) at.heading_error = 0.0;
    auto const sides = corridor.widths_at(at.s, at.segment);
    double const aside = std::max({at.lateral - sides.left, -sides.right - at.lateral, 0.0});
    double const outside = portable::hypot(aside, std::max({-at.s, at.s - corridor.length(), 0.0}));
    double const turn = outside > 0.0 ? 0.0 : std::floor(std::abs(at.heading_error) / 0.05);
    auto const rank = std::tuple(outside, turn, std::abs(at.lateral));
    if (best.corridor != none<CorridorId> && !(rank < best_rank)) continue;
    best = at;
    best_rank = rank;
  }
  return best;
}

}  // namespace detail

/// The lane corridor of `road` that a vehicle at `pose` is in, and where on it: that which holds the position; of
/// several that with the best direction (to steps of 0.05 rad), then that whose centre line is nearest, then the first.
/// Where none holds it, the nearest. On no corridor only where the road has none. O(segments).
[[nodiscard]] inline LanePlace nearest_corridor(RoadCorridor const& road, geometry::Pose const& pose) {
  return detail::nearest_corridor(road, pose.position(), &pose.heading);
}

/// As above for a point: directions do not count, and the heading error is 0.
[[nodiscard]] inline LanePlace nearest_corridor(RoadCorridor const& road, geometry::Point const& p) {
  return detail::nearest_corridor(road, p, nullptr);
}

}  // namespace cambium::inline v0_1::map
