#pragma once

#include <cmath>

#include "cambium/behavior/view.hpp"
#include "cambium/core/ids.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/evaluation/collision.hpp"
#include "cambium/evaluation/rules/relative_place.hpp"
#include "cambium/geometry/collision.hpp"

// Labels of the agent that is judged and another one. See `OfOther` for labels of the other alone.

namespace cambium::inline v0_1 {

/// Whether the two agents are closer than `distance`, box to box. O(1).
struct AgentNear {
  double distance = 6.0;

  static constexpr char const* name = "agent_near";
  static constexpr char const* summary = "the other is near, box to box";
  static constexpr char const* source = "BARK";
  static constexpr auto parameters() {
    return parameter_list(parameter("distance", &AgentNear::distance, "m", Range{0, 1e5}, "a smaller one is near"));
  }

  template <class World>
  [[nodiscard]] bool operator()(World const& world, Slot slot, Slot other) const {
    auto circle = detail::circle_of(world, slot);
    circle.radius += distance;
    return circle.meets(detail::circle_of(world, other)) &&
           geometry::distance(box_at(world, slot), box_at(world, other)) < distance;
  }
};

/// Whether the agent is faster than the other by at least `difference`. O(1).
struct RelativeSpeed {
  double difference = 10.0 / 3.6;

  static constexpr char const* name = "relative_speed";
  static constexpr char const* summary = "is faster than the other by a margin";
  static constexpr char const* source = "BARK";
  static constexpr auto parameters() {
    return parameter_list(parameter("difference", &RelativeSpeed::difference, "m/s", any_finite,
                                    "own speed minus the other's, at least"));
  }

  template <class World>
  [[nodiscard]] bool operator()(World const& world, Slot slot, Slot other) const {
    auto const& agents = world.frame().agents;
    return agents[slot].state.speed - agents[other].state.speed >= difference;
  }
};

/// Whether the agent drives in the lane next to the other's: on its left, or on its right. How far ahead or behind does
/// not count. O(1).
template <bool left>
struct BesideOf {
  static constexpr char const* name = left ? "left_of" : "right_of";
  static constexpr char const* summary =
      left ? "drives in the lane to the left of the other's" : "drives in the lane to the right of the other's";
  static constexpr char const* source = "BARK";
  static constexpr auto parameters() { return parameter_list(); }

  template <class World>
  [[nodiscard]] bool operator()(World const& world, Slot slot, Slot other) const {
    auto const at = relative_place(world, slot, other);
    return at && at->lanes == (left ? -1 : 1);
  }
};
/// Drives in the lane to the left of the other's.
using LeftOf = BesideOf<true>;
/// Drives in the lane to the right of the other's.
using RightOf = BesideOf<false>;

/// Whether the agent is in front of the other or behind it, along the lanes of its road, in the same or another: the
/// rear end of the one ahead is not behind the front end of the one that follows. BARK counts vehicles on any road,
/// also oncoming ones. O(1).
template <bool front>
struct ClearOf {
  static constexpr char const* name = front ? "front_of" : "behind_of";
  static constexpr char const* summary =
      front ? "is in front of the other, in any lane of its road" : "is behind the other, in any lane of its road";
  static constexpr char const* source = "BARK";
  static constexpr auto parameters() { return parameter_list(); }

  template <class World>
  [[nodiscard]] bool operator()(World const& world, Slot slot, Slot other) const {
    auto const at = relative_place(world, slot, other);
    auto const &own = world.roster().agents[slot].shape, &its = world.roster().agents[other].shape;
    return at && (front ? at->way + its.front <= -own.rear : at->way - its.rear >= own.front);
  }
};
/// Is in front of the other, in any lane of its road.
using FrontOf = ClearOf<true>;
/// Is behind the other, in any lane of its road.
using BehindOf = ClearOf<false>;

/// Whether the other is the next road user in the agent's lane, ahead or behind; those that have yet to merge do not
/// count. BARK's SucceedingAgent finds the one ahead. O(1), as `ObservedWorld::ahead`.
template <bool ahead>
struct NextInLane {
  static constexpr char const* name = ahead ? "preceding_agent" : "succeeding_agent";
  static constexpr char const* summary =
      ahead ? "the other is the next one ahead in the lane" : "the other is the next one behind in the lane";
  static constexpr char const* source = "BARK";
  static constexpr auto parameters() { return parameter_list(); }

  template <class World>
  [[nodiscard]] bool operator()(World& world, Slot slot, Slot other) const {
    auto const view = world.truth(slot);
    Look const look{.merging = Merging::ignored};
    auto const next = ahead ? view.ahead(look) : view.behind(look);
    return next && next->agent == world.roster().agents[other].id;
  }
};
/// The other is the next one ahead in the lane.
using PrecedingAgent = NextInLane<true>;
/// The other is the next one behind in the lane.
using SucceedingAgent = NextInLane<false>;

namespace detail {

/// Where an agent's lane merges into its neighbour.
struct MergeAhead {
  int side = 0;      ///< 1: to the left, -1: to the right, 0: it does not
  double end = 0.0;  ///< where the two lanes are one: corridor position [m]
};

/// Where the agent's lane merges, if that begins within `distance` [m] of its front end or has begun. O(pieces there).
template <class World>
[[nodiscard]] MergeAhead merge_ahead(World const& world, Slot slot, double distance) {
  auto const& corridor = corridor_of(world, slot);
  auto const& at = world.frame().agents[slot].lane;
  double const front = at.s + world.roster().agents[slot].shape.front;
  for (auto i = index_of(at.piece); i < corridor.pieces.size(); ++i) {
    auto const& piece = corridor.pieces[i];
    if (piece.begin - front > distance || !is_valid(piece.lane)) break;
    auto const& lane = world.map().lane(piece.lane);
    if (!is_valid(lane.merges_into)) continue;
    if (lane.merge_begin - piece.lane_offset - front > distance) break;
    return {lane.left_neighbor == lane.merges_into ? 1 : -1, piece.end};
  }
  return {};
}

}  // namespace detail

/// Whether a third vehicle is to be let in between the agent and the other, which is ahead in its lane: where two lanes
/// become one, it is in the other one of these lanes, behind the other agent, and ahead of the agent by less than
/// `reach`, bumper to bumper; the lanes begin to merge within `distance`. O(1), O(agents) where the other is ahead.
struct ZipPartner {
  double reach = 6.0;
  double distance = 55.0;

  static constexpr char const* name = "zip_partner";
  static constexpr char const* summary =
      "a third vehicle is to be let in between the two: its lane and theirs become one";
  static constexpr char const* source = "the conditions on the second vehicle in BARK's rule for DR_DEU_Merging_MT";
  static constexpr auto parameters() {
    using P = ZipPartner;
    return parameter_list(
        parameter("reach", &P::reach, "m", Range{0, 1000}, "from the own front end to its rear end"),
        parameter("distance", &P::distance, "m", Range{0, 1e5}, "from a front end to where its lane begins to merge"));
  }

  template <class World>
  [[nodiscard]] bool operator()(World const& world, Slot slot, Slot other) const {
    auto const ahead = relative_place(world, slot, other);
    if (!ahead || ahead->lanes != 0 || !(ahead->way > 0.0)) return false;
    double const s = world.frame().agents[slot].lane.s, front = world.roster().agents[slot].shape.front;
    auto const merge = detail::merge_ahead(world, slot, distance);
    for (Slot third{}; index_of(third) < world.size(); ++third) {
      if (third == slot || third == other || !in_traffic(world, third)) continue;
      auto const at = relative_place(world, slot, third);
      if (!at || (at->lanes != 1 && at->lanes != -1) || at->way >= ahead->way) continue;
      double const gap = at->way - world.roster().agents[third].shape.rear - front;
      if (gap < 0.0 || gap >= reach) continue;
      bool const into_its_lane = at->lanes == merge.side && s + at->way < merge.end;
      if (into_its_lane || at->lanes == -detail::merge_ahead(world, third, distance).side) return true;
    }
    return false;
  }
};

}  // namespace cambium::inline v0_1
