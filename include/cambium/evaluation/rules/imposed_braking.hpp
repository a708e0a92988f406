#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "cambium/behavior/view.hpp"
#include "cambium/core/ids.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/evaluation/collision.hpp"
#include "cambium/evaluation/rules/junction_labels.hpp"
#include "cambium/evaluation/rules/relative_place.hpp"
#include "cambium/map/corridor/corridor.hpp"
#include "cambium/map/lanes/signals.hpp"
#include "cambium/world/frame.hpp"

namespace cambium::inline v0_1 {

namespace detail {

/// Whether a light is yellow or red.
template <class World>
[[nodiscard]] bool asks_to_stop(World& world, Slot slot, LightId light) {
  if (!is_valid(light)) return false;
  auto const color = world.truth(slot).light(light);
  return color == map::LightColor::yellow || color == map::LightColor::red;
}

/// Whether there is anything within `distance` [m] ahead of an agent's front end that may make a driver brake from
/// `speed` [m/s]: a road user, an object, a sign, a yellow or red light, a conflict, the end of its lane or its
/// way, a lower speed limit, or a bend. O(conflicts + signals + bends there).
template <class World>
[[nodiscard]] bool has_reason_to_brake(World& world, Slot slot, double distance, double speed) {
  if (auto const next = world.truth(slot).ahead(); next && next->gap < distance) {
    double const closing = std::max(0.0, speed - next->speed), room = std::max(0.1, next->gap - 2.0);  // [m]
    if (next->gap < 5.0 + speed || 0.5 * closing * closing / room > 1.0) return true;                  // [m], [m/s^2]
  }
  auto const& corridor = corridor_of(world, slot);
  double const s = world.frame().agents[slot].lane.s, front = s + world.roster().agents[slot].shape.front;
  double const end = front + distance;
  for (auto const& signal : corridor.signals) {
    bool const is_near = signal.line >= front && signal.line < end;
    if (is_near && (signal.kind != map::SignalKind::light || asks_to_stop(world, slot, signal.light))) return true;
  }
  for (auto const& conflict : corridor.conflicts)
    if (conflict.hull().end > s && conflict.hull().begin < end) return true;
  for (auto const& bend : corridor.bends)
    if (bend.end > s && bend.begin < end && bend.curvature * speed * speed > 1.0) return true;  // [m/s^2]
  return std::min(piece_of(world, slot).lane_end, corridor.length()) < end ||
         std::min(corridor.speed_limit_at(s), corridor.speed_limit_at(end)) < speed;
}

}  // namespace detail

/// How hard others had to brake because of an agent, beyond what the rules ask of them: the hardest braking [m/s^2] of
/// another road user
/// - that has the right of way over the agent, in a conflict in which the agent is, and brakes for nobody else;
/// - right behind the agent, which has changed into its lane in the last `memory` [s], and brakes less hard itself;
/// - right behind the agent, which in the last `reaction` [s] braked harder than `hard` for nothing.
/// 0 if none braked harder than `comfortable`. O(agents + conflicts near) per step.
struct ImposedBraking {
  double comfortable = 2.0;
  double hard = 4.0;
  double memory = 5.0;
  double reaction = 2.0;
  double horizon = 4.0;
  double headway = 3.0;

  static constexpr char const* name = "imposed_braking";
  static constexpr char const* summary = "how hard others had to brake because of it [m/s^2]";
  static constexpr auto parameters() {
    using P = ImposedBraking;
    return parameter_list(
        parameter("comfortable", &P::comfortable, "m/s^2", Range{0, 50}, "others' braking that does not count"),
        parameter("hard", &P::hard, "m/s^2", Range{0, 50}, "own braking that needs a reason"),
        parameter("memory", &P::memory, "s", Range{0, 1000}, "time in which a lane change counts"),
        parameter("reaction", &P::reaction, "s", Range{0, 1000}, "time in which its braking counts"),
        parameter("horizon", &P::horizon, "s", Range{0, 100},
                  "who is farther from a conflict brakes for other reasons"),
        parameter("headway", &P::headway, "s", Range{0, 100}, "who follows by more than this and 5 m does so, too"));
  }

  template <class World>
  void observe(World& world, Slot slot, double dt) {
    auto const& record = world.frame().agents[slot];
    auto const* const before = world.before_step();
    if (before == nullptr || record.status != AgentStatus::driving) return;
    auto const& then = (*before)[slot];
    if (then.status == AgentStatus::driving && then.lane.corridor != record.lane.corridor) changed_ = world.time();
    if (brakes_for_nothing(world, slot, dt)) braked_ = world.time();
    double const own = -static_cast<double>(record.acceleration);
    bool const has_changed = world.time() - changed_ <= memory, has_braked = world.time() - braked_ <= reaction;
    for (Slot other{}; index_of(other) < world.size(); ++other) {
      double const braking = -static_cast<double>(world.frame().agents[other].acceleration);
      if (other == slot || !in_traffic(world, other) || braking <= std::max(comfortable, hardest_)) continue;
      if (takes_right_of_way(world, slot, other) ||
          ((has_braked || (has_changed && braking > own)) && follows(world, other, slot)))
        hardest_ = braking;
    }
  }

  [[nodiscard]] double value() const { return hardest_; }

 private:
  template <class World>
  [[nodiscard]] bool takes_right_of_way(World& world, Slot slot, Slot other) const {
    double const way = horizon * world.frame().agents[other].state.speed;
    return detail::any_mutual_conflict(world, slot, other, 0.0, 0.0, [&](detail::MutualConflict const& mutual) {
      auto const& [conflict, zone, at] = mutual;
      if (conflict.right_of_way != map::RightOfWay::yields || at >= zone.other_end || zone.other_begin - at > way)
        return false;
      double const front = at + world.roster().agents[other].shape.front;
      auto const leader = world.truth(other).ahead();
      if (leader && !(is_valid(leader->agent) && leader->slot == slot) && leader->gap < zone.other_begin - front)
        return false;
      return front > zone.other_line || !detail::asks_to_stop(world, slot, conflict.other_light);
    });
  }

  template <class World>
  [[nodiscard]] bool follows(World& world, Slot other, Slot slot) const {
    constexpr double standing = 5.0;  // [m]
    auto const next = world.truth(other).ahead();
    return next && is_valid(next->agent) && next->slot == slot &&
           next->gap < standing + headway * world.frame().agents[other].state.speed;
  }

  /// Whether the agent braked hard in the last step though nothing was in the way in which it could stop comfortably.
  template <class World>
  [[nodiscard]] bool brakes_for_nothing(World& world, Slot slot, double dt) const {
    auto const& record = world.frame().agents[slot];
    double const braking = -static_cast<double>(record.acceleration), speed = record.state.speed + braking * dt;
    constexpr double spare = 10.0;  // [m]
    return braking > hard &&
           !detail::has_reason_to_brake(world, slot, spare + 0.5 * speed * speed / std::max(0.1, comfortable), speed);
  }

  double hardest_ = 0.0;
  double changed_ = -std::numeric_limits<double>::infinity();  ///< when it changed lanes last [s]
  double braked_ = -std::numeric_limits<double>::infinity();   ///< when it last braked for nothing [s]
};

}  // namespace cambium::inline v0_1
