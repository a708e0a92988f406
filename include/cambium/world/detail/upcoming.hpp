#pragma once

#include "cambium/geometry/line.hpp"
#include "cambium/map/corridor/corridor.hpp"
#include "cambium/world/detail/on_lanes.hpp"

namespace cambium::inline v0_1::detail {

/// The centre line segment under an agent, for a prefetch before the step reaches that agent. Returns the address
/// instead of prefetching it, because compilers drop calls to functions that only prefetch.
template <class Roster, class Frame>
[[nodiscard]] geometry::Line::Segment const* road_under(Roster const& roster, Frame const& frame, Slot slot) {
  auto const& at = frame.agents[slot].lane;
  return roster.agents[slot].road->corridors[at.corridor].center.segments().data() + at.segment;
}

/// The same for the lane to the left (right); the agent's own segment if no such lane exists.
template <class Roster, class Frame>
[[nodiscard]] geometry::Line::Segment const* road_beside(Roster const& roster, Frame const& frame, Slot slot,
                                                         bool left) {
  auto const& at = frame.agents[slot].lane;
  auto const& road = *roster.agents[slot].road;
  auto const& piece = road.corridors[at.corridor].pieces[at.piece];
  auto const side = piece.beside(left);
  if (side == none<CorridorId>) return road_under(roster, frame, slot);
  return road.corridors[side].center.segments().data() + hint_beside(road, at, piece, side).segment;
}

}  // namespace cambium::inline v0_1::detail
