#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "cambium/core/ids.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/evaluation/rules/relative_place.hpp"
#include "cambium/geometry/shape.hpp"
#include "cambium/map/corridor/corridor.hpp"
#include "cambium/map/lanes/signals.hpp"
#include "cambium/map/map.hpp"

// Labels about junctions: signs, lights, and the right of way.

namespace cambium {

/// Whether the next line of a signal is at most `distance` ahead of an agent's front end: of a traffic light, of one
/// that is red, or of a stop sign. O(signals of its lane corridor).
struct SignalAhead {
  enum class Of : std::uint8_t { light, red_light, stop_sign };

  Of of = Of::light;
  double distance = 20.0;

  static constexpr char const* name = "signal_ahead";
  static constexpr char const* summary = "the next line of a light, a red light or a stop sign is close ahead";
  static constexpr char const* source = "after Maierhofer, Moosbrugger, Althoff 2022";
  static constexpr auto parameters() {
    using P = SignalAhead;
    return parameter_list(choice("of", &P::of, "light|red_light|stop_sign", "the signal"),
                          parameter("distance", &P::distance, "m", Range{0, 1000}, "from its front end to the line"));
  }

  template <class World>
  [[nodiscard]] bool operator()(World& world, Slot slot) const {
    constexpr double over = 0.05;  // [m] a front end may be over the line by rounding
    double const front = world.frame().agents[slot].lane.s + world.roster().agents[slot].shape.front;
    auto const kind = of == Of::stop_sign ? map::SignalKind::stop : map::SignalKind::light;
    for (auto const& signal : detail::corridor_of(world, slot).signals) {
      if (signal.line > front + distance) return false;
      if (signal.kind != kind || signal.line < front - over) continue;
      return of != Of::red_light || world.truth(slot).light(signal.light) == map::LightColor::red;
    }
    return false;
  }
};

namespace detail {

/// A conflict of an agent's corridor in which another agent is on its way: where it is on that way, and the zone for
/// the sizes of the two.
struct MutualConflict {
  map::Conflict const& conflict;
  map::ConflictZone const& zone;
  double at;  ///< position of its reference point, as in `map::Conflict::ways` [m]
};

/// Whether `f(MutualConflict)` is true for one of the conflicts whose zones begin at most `ahead` [m] ahead
/// of the agent and do not end behind it, in which `other` is on its way by its route. O(conflicts there * stretches of
/// their ways).
template <class World, class F>
[[nodiscard]] bool any_mutual_conflict(World const& world, Slot slot, Slot other, double ahead, F const& f) {
  auto const& conflicts = corridor_of(world, slot).conflicts;
  if (conflicts.empty()) return false;
  auto const is_large = [&](Slot one) {
    return !world.map().options().conflict_shape.holds(world.roster().agents[one].shape);
  };
  double const s = world.frame().agents[slot].lane.s, index = world.frame().agents[other].lane.index;
  for (auto const& conflict : conflicts) {
    if (conflict.farthest_end < s) continue;
    if (conflict.hull().end < s || conflict.hull().begin > s + ahead) continue;
    for (auto const& way : conflict.ways) {
      if (index < way.index_begin || index > way.index_end) continue;
      auto const& zone = conflict.zones[is_large(slot)][is_large(other)];
      if (zone.empty() || zone.end < s || zone.begin > s + ahead ||
          road_of(world, other).corridor_of(conflict.other) == none<CorridorId>)
        break;
      if (f(MutualConflict{conflict, zone, way.begin + index - way.index_begin})) return true;
      break;
    }
  }
  return false;
}

}  // namespace detail

/// Whether the agent has to let the other go first, and the other comes at once: it has the right of way in a conflict
/// at most `distance` ahead of the agent, and gets to its zone within `time` at its speed. If it brakes, by up to
/// `braking`, it is taken to do so for reasons of its own, as to turn, and to go on braking. One that is in the zone
/// already goes first anyway; one that waits at a red light does not come. O(conflicts near).
struct MustGiveWay {
  double time = 2.0;
  double distance = 20.0;
  double braking = 3.0;

  static constexpr char const* name = "must_give_way";
  static constexpr char const* summary = "the other has the right of way and comes at once";
  static constexpr char const* source = "StVO section 8 (2); after Maierhofer, Moosbrugger, Althoff 2022";
  static constexpr auto parameters() {
    using P = MustGiveWay;
    return parameter_list(
        parameter("time", &P::time, "s", Range{0, 60}, "until the other reaches the conflict as it drives now"),
        parameter("distance", &P::distance, "m", Range{0, 400}, "from the agent to the conflict"),
        parameter("braking", &P::braking, "m/s^2", Range{0, 20}, "of the other that is not taken to be forced"));
  }

  template <class World>
  [[nodiscard]] bool operator()(World& world, Slot slot, Slot other) const {
    return detail::any_mutual_conflict(world, slot, other, distance, [&](detail::MutualConflict const& mutual) {
      auto const& [conflict, zone, at] = mutual;
      if (conflict.right_of_way != map::RightOfWay::yields || at >= zone.other_begin) return false;
      bool const is_past_line = at + world.roster().agents[other].shape.front > zone.other_line;
      if (!is_past_line && is_valid(conflict.other_light) &&
          world.truth(slot).light(conflict.other_light) == map::LightColor::red)
        return false;
      return zone.other_begin - at < way_of(world.frame().agents[other]);
    });
  }

 private:
  /// How far a vehicle gets within `time` [m].
  template <class Record>
  [[nodiscard]] double way_of(Record const& record) const {
    double const speed = record.state.speed, brakes = std::clamp(-record.action.acceleration, 0.0, braking);
    double const moves = brakes * time > speed ? speed / brakes : time;  // until it stands
    return speed * moves - 0.5 * brakes * moves * moves;
  }
};

/// Whether the agent is where the other, on its way, would touch it. O(conflicts near).
struct InConflict {
  static constexpr char const* name = "in_conflict";
  static constexpr char const* summary = "is where the other, on its way, would touch it";
  static constexpr char const* source = "after Maierhofer, Moosbrugger, Althoff 2022";
  static constexpr auto parameters() { return parameter_list(); }

  template <class World>
  [[nodiscard]] bool operator()(World& world, Slot slot, Slot other) const {
    return detail::any_mutual_conflict(world, slot, other, 0.0, [&](detail::MutualConflict const& mutual) {
      return mutual.at <= mutual.zone.other_end;
    });
  }
};

}  // namespace cambium
