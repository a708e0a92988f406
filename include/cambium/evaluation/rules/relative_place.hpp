#pragma once

#include <cmath>
#include <cstddef>
#include <optional>

#include "cambium/behavior/view.hpp"
#include "cambium/core/ids.hpp"
#include "cambium/map/corridor/corridor.hpp"
#include "cambium/map/corridor/lane_place.hpp"

namespace cambium::inline v0_1 {

namespace detail {

/// A road corridor and a place on it.
template <class World>
[[nodiscard]] map::RoadCorridor const& road_of(World const& world, Slot slot) {
  return *world.roster().agents[slot].road;
}
template <class World>
[[nodiscard]] map::LaneCorridor const& corridor_of(World const& world, Slot slot) {
  return road_of(world, slot).corridors[world.frame().agents[slot].lane.corridor];
}
template <class World>
[[nodiscard]] map::CorridorPiece const& piece_of(World const& world, Slot slot) {
  return corridor_of(world, slot).pieces[world.frame().agents[slot].lane.piece];
}

}  // namespace detail

/// Where another agent is, counted along and across the lanes of an agent's road.
struct RelativePlace {
  double way{};  ///< from the agent's reference point to the other's along the lane, positive ahead [m]
  int lanes{};   ///< how many lanes the other is to the left of the agent's lane; negative: to the right
};

/// The place of `other` relative to the agent at `slot`: on a lane of the agent's corridor or one beside, as far as
/// `Look::horizon`. Nothing where it is on none of these: it is far away, oncoming, crosses, or has yet to merge. Lanes
/// are those of the reference points. O(lanes of the road there).
template <class World>
[[nodiscard]] std::optional<RelativePlace> relative_place(World const& world, Slot slot, Slot other) {
  auto const lane = detail::piece_of(world, other).lane;
  if (!is_valid(lane)) return std::nullopt;
  double const index = world.frame().agents[other].lane.index;
  auto const& road = detail::road_of(world, slot);
  auto const& own = world.frame().agents[slot].lane;
  auto const& pieces = road.corridors[own.corridor].pieces;
  // Along `piece` of the own corridor or beside it, where lanes keep the same shares of their lengths.
  auto const find_at = [&](map::CorridorPiece const& piece) -> std::optional<RelativePlace> {
    auto const at = [&](map::CorridorPiece const& there, int lanes) {
      double const share = (index - there.index_offset - there.begin) / (there.end - there.begin);
      return RelativePlace{piece.begin + share * (piece.end - piece.begin) - own.s, lanes};
    };
    if (piece.lane == lane) return RelativePlace{index - piece.index_offset - own.s, 0};
    for (bool const leftwards : {true, false}) {
      constexpr int most_lanes = 20;
      auto const* from = &piece;
      for (int lanes = 1; lanes <= most_lanes && is_valid(from->beside(leftwards)); ++lanes) {
        auto const& there = road.corridors[from->beside(leftwards)].pieces[from->piece_beside(leftwards)];
        if (there.lane == lane) return at(there, leftwards ? lanes : -lanes);
        from = &there;
      }
    }
    return std::nullopt;
  };
  for (auto i = index_of(own.piece); i < pieces.size(); ++i) {
    if (pieces[i].begin - own.s > Look::horizon) break;
    if (auto const found = find_at(pieces[i])) return found;
  }
  for (auto i = index_of(own.piece); i-- > 0;) {
    if (own.s - pieces[i].end > Look::horizon) break;
    if (auto const found = find_at(pieces[i])) return found;
  }
  return std::nullopt;
}

}  // namespace cambium::inline v0_1
