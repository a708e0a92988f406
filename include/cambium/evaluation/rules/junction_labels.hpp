#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>

#include "cambium/core/ids.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/evaluation/rules/relative_place.hpp"
#include "cambium/geometry/pose.hpp"
#include "cambium/geometry/shape.hpp"
#include "cambium/map/corridor/corridor.hpp"
#include "cambium/map/lanes/signals.hpp"
#include "cambium/map/map.hpp"
#include "cambium/world/frame.hpp"

// Labels about junctions: signs, lights, and the right of way.

namespace cambium::inline v0_1 {

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

/// The way that the agent at `slot` made along its lane corridor in the last step, as it is numbered now [m]; nothing
/// where no step led here, or where the agent was not in traffic. O(1), after a lane change O(segments).
template <class World>
[[nodiscard]] std::optional<double> last_way(World const& world, Slot slot) {
  auto const* const before = world.before_step();
  auto const& now = world.frame().agents[slot];
  if (before == nullptr || (*before)[slot].status != AgentStatus::driving || now.status != AgentStatus::driving)
    return std::nullopt;
  auto const& then = (*before)[slot];
  if (then.lane.corridor == now.lane.corridor) return now.lane.s - then.lane.s;
  // By its front end, which passes the lines: in a bend, other points make other ways.
  double const front = world.roster().agents[slot].shape.front;
  auto const heads = portable::sin_cos(then.state.heading);
  geometry::Point const end{then.state.x + front * heads.cos, then.state.y + front * heads.sin};
  return now.lane.s + front - corridor_of(world, slot).center.project(end, now.lane.segment).s;
}

}  // namespace detail

/// Whether an agent's front end passed the line of a signal in the last step: of a traffic light, of one that was red
/// when it passed, or of a stop sign. However long the step is, no line is missed. A front end may be over a line by
/// `tolerance`. False where no step led here, see `World::before_step`. O(signals of its lane corridor).
struct PassesSignal {
  using Of = SignalAhead::Of;

  Of of = Of::red_light;
  double tolerance = 0.05;

  static constexpr char const* name = "passes_signal";
  static constexpr char const* summary = "passed the line of a light, a red light or a stop sign in the last step";
  static constexpr auto parameters() {
    using P = PassesSignal;
    return parameter_list(choice("of", &P::of, "light|red_light|stop_sign", "the signal"),
                          parameter("tolerance", &P::tolerance, "m", Range{0, 10}, "a front end may be over the line"));
  }

  template <class World>
  [[nodiscard]] bool operator()(World const& world, Slot slot) const {
    auto const way = detail::last_way(world, slot);
    if (!way || !(*way > 0.0)) return false;
    auto const& record = world.frame().agents[slot];
    double const front = record.lane.s + world.roster().agents[slot].shape.front - tolerance, began = front - *way;
    double const time = (*world.before_step())[slot].state.time, dt = record.state.time - time;
    auto const kind = of == Of::stop_sign ? map::SignalKind::stop : map::SignalKind::light;
    auto const& lights = world.roster().lights;
    for (auto const& signal : detail::corridor_of(world, slot).signals) {
      if (signal.line >= front) return false;
      if (signal.kind != kind || signal.line < began) continue;
      if (of != Of::red_light) return true;
      if (index_of(signal.light) < lights.size() &&
          lights[index_of(signal.light)].at(time + dt * (signal.line - began) / *way) == map::LightColor::red)
        return true;
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
/// of the agent and end at most `behind` [m] behind it, in which `other` is on its way by its route. O(conflicts there
/// * stretches of their ways).
template <class World, class F>
[[nodiscard]] bool any_mutual_conflict(World const& world, Slot slot, Slot other, double ahead, double behind,
                                       F const& f) {
  auto const& conflicts = corridor_of(world, slot).conflicts;
  if (conflicts.empty()) return false;
  auto const is_large = [&](Slot one) {
    return !world.map().options().conflict_shape.holds(world.roster().agents[one].shape);
  };
  double const s = world.frame().agents[slot].lane.s, index = world.frame().agents[other].lane.index;
  for (auto const& conflict : conflicts) {
    if (conflict.farthest_end < s - behind) continue;
    if (conflict.hull().end < s - behind || conflict.hull().begin > s + ahead) continue;
    for (auto const& way : conflict.ways) {
      if (index < way.index_begin || index > way.index_end) continue;
      auto const& zone = conflict.zones[is_large(slot)][is_large(other)];
      if (zone.empty() || zone.end < s - behind || zone.begin > s + ahead ||
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
    return detail::any_mutual_conflict(world, slot, other, distance, 0.0, [&](detail::MutualConflict const& mutual) {
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
    double const speed = record.state.speed,
                 brakes = std::clamp(-static_cast<double>(record.acceleration), 0.0, braking);
    double const moves = brakes * time > speed ? speed / brakes : time;  // until it stands
    return speed * moves - 0.5 * brakes * moves * moves;
  }
};

/// Whether the agent is where the other, on its way, would touch it, or was there in the last step. O(conflicts near).
struct InConflict {
  static constexpr char const* name = "in_conflict";
  static constexpr char const* summary = "is, or was in the last step, where the other, on its way, would touch it";
  static constexpr char const* source = "after Maierhofer, Moosbrugger, Althoff 2022";
  static constexpr auto parameters() { return parameter_list(); }

  template <class World>
  [[nodiscard]] bool operator()(World& world, Slot slot, Slot other) const {
    double const way = std::max(0.0, detail::last_way(world, slot).value_or(0.0));
    return detail::any_mutual_conflict(world, slot, other, 0.0, way, [&](detail::MutualConflict const& mutual) {
      return mutual.at <= mutual.zone.other_end;
    });
  }
};

}  // namespace cambium::inline v0_1
