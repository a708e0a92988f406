#pragma once

#include <cstdint>

#include "cambium/core/ids.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/evaluation/collision.hpp"
#include "cambium/evaluation/rules/relative_place.hpp"
#include "cambium/map/corridor/corridor.hpp"
#include "cambium/world/frame.hpp"

// Labels of one agent. Those that other headers bring: `Collision`, `OffRoad`, and by `Exceeds` every evaluator that
// returns a number.

namespace cambium::inline v0_1 {

/// The same at every step.
struct Constant {
  bool value = true;

  static constexpr char const* name = "constant";
  static constexpr char const* summary = "the same at every step";
  static constexpr auto parameters() { return parameter_list(parameter("value", &Constant::value, "what it says")); }

  template <class World>
  [[nodiscard]] bool operator()(World const&, Slot) const {
    return value;
  }
};

/// Whether an agent's reference point passed into a neighbouring lane in the last step. Needs a world that keeps a
/// history (`World::keep_history`); false without one. O(1).
///
/// BARK asks whether the way since the last state crosses a border of the lane that the agent is in now, and misses a
/// change of two lanes.
struct ChangesLane {
  static constexpr bool needs_history = true;
  static constexpr char const* name = "lane_change";
  static constexpr char const* summary = "passed into a neighbouring lane in the last step; needs a history";
  static constexpr auto parameters() { return parameter_list(); }

  template <class World>
  [[nodiscard]] bool operator()(World const& world, Slot slot) const {
    if (world.history_size() == 0) return false;
    auto const& before = world.history(1).agents[slot];
    auto const& now = world.frame().agents[slot];
    return before.status == AgentStatus::driving && before.lane.corridor != now.lane.corridor;
  }
};

/// Whether an agent's reference point passed into a neighbouring lane in the last step, where the road marks do not
/// permit it, by those beside its place before the step. Only lanes of its own direction count: `OncomingLane` sees the
/// others. False where no step led here, see `World::before_step`. O(1).
struct CrossesSolidLine {
  static constexpr char const* name = "crosses_solid_line";
  static constexpr char const* summary = "passed into a neighbouring lane where the road marks forbid it";
  static constexpr auto parameters() { return parameter_list(); }

  template <class World>
  [[nodiscard]] bool operator()(World const& world, Slot slot) const {
    auto const* const before = world.before_step();
    auto const& now = world.frame().agents[slot];
    if (before == nullptr || now.status != AgentStatus::driving) return false;
    auto const& then = (*before)[slot];
    if (then.status != AgentStatus::driving || then.lane.corridor == now.lane.corridor) return false;
    auto const& piece = detail::road_of(world, slot).corridors[then.lane.corridor].pieces[then.lane.piece];
    if (!is_valid(piece.lane)) return false;
    auto const& lane = world.map().lane(piece.lane);
    double const s = then.lane.s + piece.lane_offset;
    bool const leftwards = piece.left == now.lane.corridor;
    if (!leftwards && piece.right != now.lane.corridor) return false;
    return leftwards ? !lane.may_change_left(s) : !lane.may_change_right(s);
  }
};

/// Whether at least `agents` others are within `radius` of an agent, reference point to reference point. O(agents).
struct DenseTraffic {
  double radius = 20.0;
  std::uint32_t agents = 8;

  static constexpr char const* name = "dense_traffic";
  static constexpr char const* summary = "many others are near";
  static constexpr char const* source = "BARK";
  static constexpr auto parameters() {
    using P = DenseTraffic;
    return parameter_list(parameter("radius", &P::radius, "m", Range{0, 1e5}, "between reference points"),
                          parameter("agents", &P::agents, "-", Range{0, 1e6}, "from this number on it is dense"));
  }

  template <class World>
  [[nodiscard]] bool operator()(World const& world, Slot slot) const {
    auto const& own = world.frame().agents[slot].state;
    std::uint32_t count = 0;
    for (Slot other{}; index_of(other) < world.size(); ++other) {
      auto const& state = world.frame().agents[other].state;
      double const dx = state.x - own.x, dy = state.y - own.y;
      bool const is_near = dx * dx + dy * dy < radius * radius;
      count += is_near && other != slot && in_traffic(world, other) ? 1 : 0;
    }
    return count >= agents;
  }
};

/// Whether the lane that an agent is in ends, or leaves its route, within `distance` of its front end: there it must
/// have changed lanes, or merges. O(1).
struct AtLaneEnd {
  double distance = 50.0;

  static constexpr char const* name = "at_lane_end";
  static constexpr char const* summary = "its lane ends, merges or leaves its route soon";
  static constexpr char const* source = "BARK";
  static constexpr auto parameters() {
    return parameter_list(
        parameter("distance", &AtLaneEnd::distance, "m", Range{0, 1e5}, "from its front end to the end of the lane"));
  }

  template <class World>
  [[nodiscard]] bool operator()(World const& world, Slot slot) const {
    double const front = world.frame().agents[slot].lane.s + world.roster().agents[slot].shape.front;
    return detail::piece_of(world, slot).lane_end - front < distance;
  }
};

/// Whether there is no lane of its direction beside an agent's lane, or one that ends soon: on its left, or on its
/// right. O(1).
template <bool leftwards>
struct OutermostLane {
  double distance = 100.0;

  static constexpr char const* name = leftwards ? "leftmost_lane" : "rightmost_lane";
  static constexpr char const* summary = leftwards ? "there is no lane to its left, or one that ends soon"
                                                   : "there is no lane to its right, or one that ends soon";
  static constexpr char const* source = "BARK";
  static constexpr auto parameters() {
    return parameter_list(parameter("distance", &OutermostLane::distance, "m", Range{0, 1e5},
                                    "a lane that ends within it does not count"));
  }

  template <class World>
  [[nodiscard]] bool operator()(World const& world, Slot slot) const {
    auto const& piece = detail::piece_of(world, slot);
    auto const corridor = piece.beside(leftwards);
    if (!is_valid(corridor)) return true;
    auto const& beside = detail::road_of(world, slot).corridors[corridor].pieces[piece.piece_beside(leftwards)];
    double const share = (world.frame().agents[slot].lane.s - piece.begin) / (piece.end - piece.begin);
    double const s = beside.begin + share * (beside.end - beside.begin);
    return beside.lane_end - s - world.roster().agents[slot].shape.front <= distance;
  }
};
/// No lane to the left goes on.
using LeftmostLane = OutermostLane<true>;
/// No lane to the right goes on.
using RightmostLane = OutermostLane<false>;

/// Whether an agent's reference point has passed a point of the map, measured along its lane corridor: the point's
/// foot on the centre line is behind it. O(segments of the centre line in between).
struct BeyondPoint {
  double x = 0.0, y = 0.0;

  static constexpr char const* name = "beyond_point";
  static constexpr char const* summary = "has passed a point of the map, along its lane";
  static constexpr char const* source = "BARK";
  static constexpr auto parameters() {
    return parameter_list(parameter("x", &BeyondPoint::x, "m", any_finite, "of the point"),
                          parameter("y", &BeyondPoint::y, "m", any_finite, "of the point"));
  }

  template <class World>
  [[nodiscard]] bool operator()(World const& world, Slot slot) const {
    auto const& own = world.frame().agents[slot].lane;
    return own.s > detail::corridor_of(world, slot).center.project({x, y}, own.segment).s;
  }
};

}  // namespace cambium::inline v0_1
