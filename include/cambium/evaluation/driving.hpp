#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "cambium/behavior/lateral/lane_change.hpp"
#include "cambium/behavior/law/lane_ends.hpp"
#include "cambium/behavior/view.hpp"
#include "cambium/core/ids.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/core/state.hpp"
#include "cambium/evaluation/collision.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/geometry/collision.hpp"
#include "cambium/geometry/shape.hpp"
#include "cambium/world/frame.hpp"

namespace cambium::inline v0_1 {

/// Whether an agent is at its goal; false without a goal.
struct AtGoal {
  static constexpr char const* name = "at_goal";
  static constexpr char const* summary = "is at its goal";
  static constexpr auto parameters() { return parameter_list(); }

  template <class World>
  [[nodiscard]] bool operator()(World const& world, Slot slot) const {
    return world.reached_goal(slot);
  }
};

/// Whether an agent's rear has passed the junctions and the conflicts on its way, or the agent has left traffic. The
/// lanes of its corridor count, and those beyond it on its route. O(lanes of the route + conflicts).
struct PastJunctions {
  static constexpr char const* name = "past_junctions";
  static constexpr char const* summary = "has passed the last junction on its route";
  static constexpr auto parameters() { return parameter_list(); }

  template <class World>
  [[nodiscard]] bool operator()(World const& world, Slot slot) const {
    auto const& record = world.frame().agents[slot];
    if (record.status == AgentStatus::not_started) return false;
    if (record.status != AgentStatus::driving) return true;
    auto const& agent = world.roster().agents[slot];
    auto const& corridor = agent.road->corridors[record.lane.corridor];
    double const rear = record.lane.s - agent.shape.rear;
    auto const is_in_junction = [&](LaneId id) { return is_valid(id) && world.map().in_junction(id); };
    for (auto const& piece : corridor.pieces)
      if (piece.end > rear && is_in_junction(piece.lane)) return false;
    for (auto const& conflict : corridor.conflicts)
      if (conflict.hull().end > rear) return false;
    if (corridor.reaches_destination) return true;
    auto const& route = agent.road->route;
    auto const last = std::ranges::find(route, corridor.pieces.back().lane);
    return std::none_of(last, route.end(), is_in_junction);
  }
};

/// An agent's speed along its lane [m/s].
struct Progress {
  static constexpr char const* name = "progress";
  static constexpr char const* summary = "speed along its lane [m/s]";
  static constexpr auto parameters() { return parameter_list(); }

  template <class World>
  [[nodiscard]] double operator()(World const& world, Slot slot) const {
    auto const& record = world.frame().agents[slot];
    return record.state.speed * portable::sin_cos(record.lane.heading_error).cos;
  }
};

/// Absolute difference between the agent's speed and the desired speed [m/s].
struct SpeedDeviation {
  double desired_speed = 15.0;  ///< [m/s]

  static constexpr char const* name = "speed_deviation";
  static constexpr char const* summary = "difference between its speed and the desired speed [m/s]";
  static constexpr auto parameters() {
    return parameter_list(
        parameter("desired_speed", &SpeedDeviation::desired_speed, "m/s", Range{0, 200}, "speed to compare with"));
  }

  template <class World>
  [[nodiscard]] double operator()(World const& world, Slot slot) const {
    return std::abs(world.frame().agents[slot].state.speed - desired_speed);
  }
};

/// How much faster than the speed limit of its lane the agent drives [m/s]; 0 within the limit, or without one.
struct SpeedLimitExcess {
  static constexpr char const* name = "speed_limit_excess";
  static constexpr char const* summary = "speed above the limit of its lane [m/s]";
  static constexpr auto parameters() { return parameter_list(); }

  template <class World>
  [[nodiscard]] double operator()(World const& world, Slot slot) const {
    auto const& record = world.frame().agents[slot];
    auto const& corridor = world.roster().agents[slot].road->corridors[record.lane.corridor];
    return std::max(0.0, record.state.speed - corridor.speed_limit_at(record.lane.s));
  }
};

/// The agent's distance from the centre line of its lane [m].
struct LaneOffset {
  static constexpr char const* name = "lane_offset";
  static constexpr char const* summary = "distance from the centre line of its lane [m]";
  static constexpr auto parameters() { return parameter_list(); }

  template <class World>
  [[nodiscard]] double operator()(World const& world, Slot slot) const {
    return std::abs(world.frame().agents[slot].lane.lateral);
  }
};

/// How urgent a lane change is for the agent, because its lane ends, does not lead to its goal, or is blocked by one
/// that is parked: 0 if it may stay, and growing to 1 over the last `horizon` [m] for each lane to cross, or over those
/// that it drives in `time_horizon` [s] if these are more: the sixth power of the driven share of this way (see
/// `lane_urgency`). As a term with a negative weight, it draws a planner into the lane of its exit long before the end
/// of its prediction, and still lets it leave that lane to pass somebody if there is room to return.
struct LaneChangeUrgency {
  double horizon = 300.0;
  double time_horizon = 25.0;

  static constexpr char const* name = "lane_change_urgency";
  static constexpr char const* summary = "how urgent a lane change is: 0 to 1";
  static constexpr auto parameters() {
    return parameter_list(parameter("horizon", &LaneChangeUrgency::horizon, "m", Range{1, 10'000},
                                    "length for each lane to cross over which the urgency grows"),
                          parameter("time_horizon", &LaneChangeUrgency::time_horizon, "s", Range{0, 1000},
                                    "the same as a time, where that is the longer way"));
  }

  template <class World>
  [[nodiscard]] double operator()(World& world, Slot slot) const {
    auto const view = world.truth(slot);
    return at(view, view.place());
  }

  /// The same as if the agent of `view` were at a place in another lane.
  template <class View>
  [[nodiscard]] double at(View const& view, map::LanePlace const& place) const {
    double const way = std::max(horizon, time_horizon * std::abs(view.state().speed));
    auto const urgency = lane_urgency(view, place, way);
    double share = std::max({0.0, urgency.left, urgency.right});
    if (place.corridor == view.place().corridor) share = std::max(share, 1.0 - detail::free_until_parked(view) / way);
    double const cube = share * share * share;
    return cube * cube;
  }
};

/// The agent's acceleration over the last step, along its heading [m/s^2]: that it drove, whatever it had planned.
struct Acceleration {
  static constexpr char const* name = "acceleration";
  static constexpr char const* summary = "over the last step [m/s^2]";
  static constexpr auto parameters() { return parameter_list(); }

  template <class World>
  [[nodiscard]] double operator()(World const& world, Slot slot) const {
    return static_cast<double>(world.frame().agents[slot].acceleration);
  }
};

/// Whether the agent braked harder than `deceleration` in the last step.
struct HardBraking {
  double deceleration = 4.0;  ///< [m/s^2]

  static constexpr char const* name = "hard_braking";
  static constexpr char const* summary = "braked harder than a threshold";
  static constexpr auto parameters() {
    return parameter_list(
        parameter("deceleration", &HardBraking::deceleration, "m/s^2", Range{0, 50}, "harder braking counts"));
  }

  template <class World>
  [[nodiscard]] bool operator()(World const& world, Slot slot) const {
    return Acceleration{}(world, slot) < -deceleration;
  }
};

/// The sum, over others within `range` [m], of the squared excess of their deceleration over `comfortable` [m^2/s^4].
/// With a negative weight it keeps a planner from relying on others to brake.
struct OthersBraking {
  double comfortable = 1.0;  ///< [m/s^2]
  double range = 60.0;       ///< [m]

  static constexpr char const* name = "others_braking";
  static constexpr char const* summary = "how hard others brake beyond what is comfortable, squared [m^2/s^4]";
  static constexpr auto parameters() {
    using P = OthersBraking;
    return parameter_list(parameter("comfortable", &P::comfortable, "m/s^2", Range{0, 50}, "harder braking counts"),
                          parameter("range", &P::range, "m", non_negative, "others farther away do not count"));
  }

  template <class World>
  [[nodiscard]] double operator()(World const& world, Slot slot) const {
    auto const& agents = world.frame().agents;
    auto const& own = agents[slot].state;
    double sum = 0.0;
    for (Slot i{}; index_of(i) < agents.size(); ++i) {
      double const excess = -static_cast<double>(agents[i].acceleration) - comfortable;
      if (excess <= 0.0 || i == slot || agents[i].status != AgentStatus::driving) continue;
      double const dx = agents[i].state.x - own.x, dy = agents[i].state.y - own.y;
      if (dx * dx + dy * dy <= range * range) sum += excess * excess;
    }
    return sum;
  }
};

/// The agent's acceleration across its heading, left positive [m/s^2], from the turn over the last step. Needs a world
/// that keeps a history (`World::keep_history`); 0 without one.
struct LateralAcceleration {
  static constexpr bool needs_history = true;
  static constexpr char const* name = "lateral_acceleration";
  static constexpr char const* summary = "over the last step, left positive [m/s^2]; needs a history";
  static constexpr auto parameters() { return parameter_list(); }

  template <class World>
  [[nodiscard]] double operator()(World const& world, Slot slot) const {
    if (world.history_size() == 0 || world.history(1).agents[slot].status != AgentStatus::driving) return 0.0;
    return between(world.history(1).agents[slot].state, world.frame().agents[slot].state);
  }

  /// The same for two states of an agent, one step apart.
  template <MotionState S>
  [[nodiscard]] static double between(S const& before, S const& now) {
    double const dt = now.time - before.time;
    return dt > 0.0 ? now.speed * geometry::angle_difference(now.heading, before.heading) / dt : 0.0;
  }
};

/// The change of the agent's acceleration since the previous step [m/s^3]. Needs a world that keeps a history; 0
/// without one, and in the first step of a world or of the agent, before which it did not drive.
struct Jerk {
  static constexpr bool needs_history = true;
  static constexpr char const* name = "jerk";
  static constexpr char const* summary = "change of the acceleration since the previous step [m/s^3]; needs a history";
  static constexpr auto parameters() { return parameter_list(); }

  template <class World>
  [[nodiscard]] double operator()(World const& world, Slot slot) const {
    if (world.history_size() == 0 || world.history(1).step == 0) return 0.0;
    auto const &now = world.frame().agents[slot], &before = world.history(1).agents[slot];
    if (before.status != AgentStatus::driving) return 0.0;
    double const dt = now.state.time - before.state.time;
    return dt > 0.0 ? (Acceleration{}(world, slot) - static_cast<double>(before.acceleration)) / dt : 0.0;
  }
};

/// The gap to the next road user ahead along the lane corridor, bumper to bumper, at most `farthest` [m].
struct Gap {
  double farthest = Look::horizon;

  static constexpr char const* name = "gap";
  static constexpr char const* summary = "gap to the next road user ahead [m]";
  static constexpr auto parameters() {
    return parameter_list(parameter("farthest", &Gap::farthest, "m", Range{0, Look::horizon},
                                    "gap where nobody is ahead, or farther away"));
  }

  template <class World>
  [[nodiscard]] double operator()(World& world, Slot slot) const {
    auto const next = world.truth(slot).ahead();
    return next ? std::min(next->gap, farthest) : farthest;
  }
};

namespace detail {

/// The next road user or object ahead in the agent's lane, also of those that merge as soon as they have. Whom it
/// passes in one lane, without touching, is not ahead. O(1), while it passes somebody O(agents).
template <class World>
[[nodiscard]] std::optional<RoadUser> next_in_lane(World& world, Slot slot) {
  auto const view = world.truth(slot);
  auto next = view.ahead({.merging = Merging::ignored});
  auto const touches = [&](RoadUser const& user) {
    auto const own = box_at(world, slot);
    return is_valid(user.agent) ? geometry::intersects(own, box_at(world, user.slot))
                                : geometry::intersects(own, world.roster().objects[index_of(user.slot)].outline);
  };
  if (!next || next->gap >= 0.0 || touches(*next)) return next;
  next.reset();
  view.around(view.place(), Look::horizon, [&](RoadUser const& user) {
    if (user.s > view.place().s && user.gap >= 0.0 && (!next || user.gap < next->gap)) next = user;
  });
  return next;
}

}  // namespace detail

/// Time until the agent's front reaches the present rear of the next road user ahead in its lane, at most `longest`
/// [s] (time headway, THW); that, too, where nobody is ahead or it stands.
struct TimeHeadway {
  double longest = 10.0;

  static constexpr char const* name = "time_headway";
  static constexpr char const* summary = "gap to the next road user ahead in its lane, over its speed [s]";
  static constexpr auto parameters() {
    return parameter_list(parameter("longest", &TimeHeadway::longest, "s", Range{0, 1000}, "where nobody is nearer"));
  }

  template <class World>
  [[nodiscard]] double operator()(World& world, Slot slot) const {
    auto const next = detail::next_in_lane(world, slot);
    double const speed = world.frame().agents[slot].state.speed;
    return next && speed > 0.0 ? std::clamp(next->gap / speed, 0.0, longest) : longest;
  }
};

/// How much of the gap that the agent should keep to the next road user ahead is missing: 0 to 1.
struct Closeness {
  double minimum_gap = 2.0;   ///< [m]
  double time_headway = 0.6;  ///< [s]

  static constexpr char const* name = "closeness";
  static constexpr char const* summary = "missing share of the gap to keep to the next road user ahead";
  static constexpr auto parameters() {
    using P = Closeness;
    return parameter_list(parameter("minimum_gap", &P::minimum_gap, "m", Range{0.1, 100}, "to keep at standstill"),
                          parameter("time_headway", &P::time_headway, "s", Range{0, 20}, "to keep besides"));
  }

  template <class World>
  [[nodiscard]] double operator()(World& world, Slot slot) const {
    double const wanted = minimum_gap + time_headway * std::max(0.0, world.frame().agents[slot].state.speed);
    return std::clamp(1.0 - Gap{wanted}(world, slot) / wanted, 0.0, 1.0);
  }
};

}  // namespace cambium::inline v0_1
