#pragma once

#include <cmath>

#include "cambium/behavior/view.hpp"
#include "cambium/core/ids.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/evaluation/collision.hpp"
#include "cambium/evaluation/rules/relative_place.hpp"
#include "cambium/geometry/collision.hpp"

// Labels of the agent that is judged and another one. See `OfOther` for labels of the other alone.

namespace cambium {

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

/// Whether the agent drives in the lane next to the other's, on its left. How far ahead or behind does not count. O(1).
struct LeftOf {
  static constexpr char const* name = "left_of";
  static constexpr char const* summary = "drives in the lane to the left of the other's";
  static constexpr char const* source = "BARK";
  static constexpr auto parameters() { return parameter_list(); }

  template <class World>
  [[nodiscard]] bool operator()(World const& world, Slot slot, Slot other) const {
    auto const at = relative_place(world, slot, other);
    return at && at->lanes == -1;
  }
};

/// Whether the agent drives in the lane next to the other's, on its right. How far ahead or behind does not count.
/// O(1).
struct RightOf {
  static constexpr char const* name = "right_of";
  static constexpr char const* summary = "drives in the lane to the right of the other's";
  static constexpr char const* source = "BARK";
  static constexpr auto parameters() { return parameter_list(); }

  template <class World>
  [[nodiscard]] bool operator()(World const& world, Slot slot, Slot other) const {
    auto const at = relative_place(world, slot, other);
    return at && at->lanes == 1;
  }
};

/// Whether the agent is in front of the other: its rear end is not behind the other's front end, along the lanes of its
/// road, the same or another. BARK counts vehicles on any road, also oncoming ones. O(1).
struct FrontOf {
  static constexpr char const* name = "front_of";
  static constexpr char const* summary = "is in front of the other, in any lane of its road";
  static constexpr char const* source = "BARK";
  static constexpr auto parameters() { return parameter_list(); }

  template <class World>
  [[nodiscard]] bool operator()(World const& world, Slot slot, Slot other) const {
    auto const at = relative_place(world, slot, other);
    auto const& agents = world.roster().agents;
    return at && at->way + agents[other].shape.front <= -agents[slot].shape.rear;
  }
};

/// Whether the agent is behind the other: its front end is not ahead of the other's rear end, along the lanes of its
/// road, the same or another. O(1).
struct BehindOf {
  static constexpr char const* name = "behind_of";
  static constexpr char const* summary = "is behind the other, in any lane of its road";
  static constexpr char const* source = "BARK";
  static constexpr auto parameters() { return parameter_list(); }

  template <class World>
  [[nodiscard]] bool operator()(World const& world, Slot slot, Slot other) const {
    auto const at = relative_place(world, slot, other);
    auto const& agents = world.roster().agents;
    return at && at->way - agents[other].shape.rear >= agents[slot].shape.front;
  }
};

/// Whether the other is the next road user ahead of the agent in its lane; those that have yet to merge do not count.
/// O(1), as `ObservedWorld::ahead`.
struct PrecedingAgent {
  static constexpr char const* name = "preceding_agent";
  static constexpr char const* summary = "the other is the next one ahead in the lane";
  static constexpr char const* source = "BARK";
  static constexpr auto parameters() { return parameter_list(); }

  template <class World>
  [[nodiscard]] bool operator()(World& world, Slot slot, Slot other) const {
    auto const next = world.truth(slot).ahead({.merging = Merging::ignored});
    return next && next->agent == world.roster().agents[other].id;
  }
};

/// Whether the other is the next road user behind the agent in its lane. BARK's label of that name finds the one ahead.
/// O(1), as `ObservedWorld::behind`.
struct SucceedingAgent {
  static constexpr char const* name = "succeeding_agent";
  static constexpr char const* summary = "the other is the next one behind in the lane";
  static constexpr char const* source = "BARK";
  static constexpr auto parameters() { return parameter_list(); }

  template <class World>
  [[nodiscard]] bool operator()(World& world, Slot slot, Slot other) const {
    auto const next = world.truth(slot).behind({.merging = Merging::ignored});
    return next && next->agent == world.roster().agents[other].id;
  }
};

}  // namespace cambium
