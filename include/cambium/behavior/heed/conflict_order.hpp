#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include "cambium/behavior/law/braking.hpp"
#include "cambium/behavior/view.hpp"
#include "cambium/core/described.hpp"
#include "cambium/geometry/shape.hpp"
#include "cambium/map/corridor/corridor.hpp"
#include "cambium/map/lanes/signals.hpp"

namespace cambium::inline v0_1 {

namespace detail {

/// A slow vehicle so close to its line has just started, or is about to stop there [m].
inline constexpr double short_way = 15.0;
/// A vehicle that stands at its line is not beyond it, whatever the rounding [m].
inline constexpr double over_line = 0.1;

/// Length [m] by which a body exceeds the shape for which conflicts are computed, for instance a larger one or one at
/// an angle.
struct ExtraReach {
  double front{}, rear{};
};

/// Another vehicle at position `at` [m] of its way to a conflict (see `map::Conflict::ways`).
struct ConflictUser {
  RoadUser const& user;
  double at;
  ExtraReach reach;
  bool is_behind_slow = false;                             ///< behind a slow vehicle that has not entered yet
  double place = std::numeric_limits<double>::infinity();  ///< where it waits, by `map::ConflictSection` [m]
  double earliest = 0.0;                                   ///< time until it is there, by the bends before it [s]
};

/// Whether a shape needs the conflicts of the large shape.
template <class View>
[[nodiscard]] bool is_large(View const& view, geometry::Shape const& shape) {
  return !view.map().options().conflict_shape.holds(shape);
}

template <class View>
[[nodiscard]] ExtraReach extra_reach(View const& view, bool large, double front, double rear) {
  auto const& options = view.map().options();
  auto const& known = large ? options.large_conflict_shape : options.conflict_shape;
  return {std::max(0.0, front - known.front), std::max(0.0, rear - known.rear)};
}

/// Deceleration by which all drivers judge who can still stop where it waits [m/s^2]. One for all, for two drivers have
/// to find the same answer.
inline constexpr double judged_deceleration = 3.0;
/// The highest acceleration that drivers reckon with in others, in a step [m/s^2].
inline constexpr double hardest_start = 3.5;

/// How far apart two vehicles are at most that count as one queue [m].
inline constexpr double queue_view = 60.0;

/// Whether a vehicle has entered the section before which it waits at `place` [m]: it is beyond that, or can no longer
/// stop there.
[[nodiscard]] inline bool has_entered(double s, double speed, double place) {
  double const way = place + over_line - s;
  return way < 0.0 || !can_stop(speed, way, judged_deceleration);
}

/// When a vehicle stopped before a junction, as another driver there remembers it.
enum class Arrival : std::uint8_t { earlier, together, later };

/// A vehicle in its section, and the own section with which that conflicts: the low bits of its id and their numbers.
using SectionKey = std::uint32_t;
[[nodiscard]] inline SectionKey section_key(AgentId id, std::uint32_t section, std::uint32_t own_section) {
  return static_cast<SectionKey>(static_cast<std::uint16_t>(id)) << 16 | (section & 0xff) << 8 | (own_section & 0xff);
}

/// The vehicles that came before a driver to where their ways cross: those that have entered their sections before it,
/// and those that stood there when it stopped. Holds seven, rather those that have entered.
class AgentsBefore {
 public:
  /// Whether there is no room for another one that has entered.
  [[nodiscard]] bool is_full_of_entered() const { return entered_ == 127; }
  [[nodiscard]] bool holds(SectionKey key) const { return find(key) < size_; }
  /// Whether it holds a vehicle with these low bits of its id, in any section.
  [[nodiscard]] bool may_hold(AgentId id) const {
    return std::any_of(keys_.begin(), keys_.begin() + size_,
                       [low = section_key(id, 0, 0)](SectionKey key) { return (key ^ low) >> 16 == 0; });
  }
  /// Whether it has entered its section.
  [[nodiscard]] bool holds_entered(SectionKey key) const { return has(entered_, find(key)); }
  /// Whether it came in the same step as the driver.
  [[nodiscard]] bool holds_together(SectionKey key) const { return has(together_, find(key)); }
  /// When a vehicle stopped; where the list is full, all others count as earlier.
  [[nodiscard]] Arrival arrival_of(SectionKey key) const {
    auto const at = find(key);
    if (at == size_) return is_full() ? Arrival::earlier : Arrival::later;
    return has(together_, at) ? Arrival::together : Arrival::earlier;
  }
  /// Adds it, unless it is there or there is no room.
  void add(SectionKey key, bool has_entered, bool is_together) {
    if (holds(key)) return;
    std::size_t at = size_;
    if (is_full()) {
      at = 0;
      while (at < keys_.size() && has(entered_, at)) ++at;
      if (!has_entered || at == keys_.size()) return;
    } else {
      ++size_;
    }
    auto const bit = static_cast<std::uint8_t>(1u << at);
    entered_ = static_cast<std::uint8_t>(has_entered ? entered_ | bit : entered_ & ~bit);
    together_ = static_cast<std::uint8_t>(is_together ? together_ | bit : together_ & ~bit);
    keys_[at] = key;
  }
  static constexpr char const* name = "agents_before";
  static constexpr auto parameters() {
    using P = AgentsBefore;
    return parameter_list(
        parameter("keys", &P::keys_, "-", Range{0, 4294967295.0}, "low bits of their ids, sections, own sections"),
        parameter("size", &P::size_, "-", Range{0, 7}, "how many"),
        parameter("entered", &P::entered_, "-", Range{0, 127}, "bits: who has entered"),
        parameter("together", &P::together_, "-", Range{0, 127}, "bits: who came in the same step"));
  }

  friend bool operator==(AgentsBefore const&, AgentsBefore const&) = default;

 private:
  [[nodiscard]] bool is_full() const { return size_ == keys_.size(); }
  [[nodiscard]] std::size_t find(SectionKey key) const {
    return static_cast<std::size_t>(std::find(keys_.begin(), keys_.begin() + size_, key) - keys_.begin());
  }
  [[nodiscard]] bool has(std::uint8_t bits, std::size_t at) const { return at < size_ && (bits >> at & 1) != 0; }

  std::array<SectionKey, 7> keys_{};
  std::uint8_t size_{}, entered_{}, together_{};
};

/// Among the vehicles offered, the one that is next to enter the junction, at most `short_way` before its line.
struct NextToEnter {
  std::optional<RoadUser> user;
  double to_line = short_way;

  void offer(RoadUser const& other, double other_to_line) {
    if (other_to_line < -over_line || other_to_line > to_line) return;
    to_line = other_to_line;
    user = other;
  }
};

/// The own vehicle before a conflict.
struct ConflictAsker {
  double s{}, front{};           ///< corridor positions of its reference point and its front end [m]
  double speed{};                ///< [m/s]
  double waited{};               ///< time at a standstill there [s]
  double patience{};             ///< see `Conflicts::patience` [s]
  AgentsBefore const* before{};  ///< those that came before it, until the last step
  bool is_large = false;         ///< see `map::ConflictZones`
  bool may_meet_large = false;   ///< large vehicles are, or were, in the world
  double dt{};                   ///< length of the step [s]
  std::uint32_t section{};       ///< number of the conflict's section
  double place{};                ///< where it waits for that [m]
  bool has_entered = false;      ///< it has entered that
};

/// Whether neither priorities nor lights say who goes first.
template <class View>
[[nodiscard]] bool is_by_arrival(View const& view, map::Conflict const& conflict) {
  auto const is_off = [&](LightId light) { return !is_valid(light) || view.light(light) == map::LightColor::off; };
  if (conflict.is_signed) return false;
  return conflict.right_of_way == map::RightOfWay::equal || (is_off(conflict.light) && is_off(conflict.other_light));
}

/// Whether a light lets its traffic go: it is green, or yellow.
template <class View>
[[nodiscard]] bool lets_go(View const& view, LightId light) {
  if (!is_valid(light)) return false;
  auto const color = view.light(light);
  return color == map::LightColor::green || color == map::LightColor::yellow;
}

/// Whether a moving vehicle that can still stop may no longer be able to after this step, however it accelerates.
[[nodiscard]] inline bool is_about_to_enter(ConflictUser const& other, double dt) {
  double const v = other.user.speed, end = v + hardest_start * dt;
  return v >= standing_speed && has_entered(other.at + 0.5 * (v + end) * dt, end, other.place);
}

/// Whether a vehicle enters before the own one, where both may enter in this step: it is nearer to its place or, at
/// equal distance, its id is smaller (`is_smaller`: the own one's is).
[[nodiscard]] inline bool enters_first(ConflictUser const& other, ConflictAsker const& own, bool is_smaller) {
  double const nearer_by = own.place - own.s - (other.place - other.at);
  return is_about_to_enter(other, own.dt) && (std::abs(nearer_by) > 1e-6 ? nearer_by > 0.0 : !is_smaller);
}

/// Whether the own vehicle goes before `other`, where both can still stop before their sections, `own_way` and `way`
/// [m] before the zone. The first rule that applies decides:
/// - A vehicle before a red light waits.
/// - One by one: where neither priorities nor lights say who goes first, a driver does not leave its place to wait in
///   the same step as another that is nearer to its own.
/// - First come, first served: there, a driver that stands at its line goes before one that stopped there later or has
///   yet to stop. With right before left alone, four drivers would wait for each other again and again.
/// - Patience: a driver that has waited too long for a standing vehicle goes; sooner before one that has the right of
///   way but has stood all the while: something must be in its way. Else it lets those go who stopped before it.
/// - Where lights do not let both go, a standing driver lets a vehicle go that has just started close to its line.
/// - Right of way by map, signs and rules (`map::right_of_way`).
/// - Without right of way, the nearer vehicle goes; at about equal distance, the one with the smaller id.
///
/// Two drivers disagree only by the rules that ask how long a driver has stood, or whether it has just started. Where
/// both start at once, they enter together, and the smaller id goes first.
///
/// O(1).
template <class View>
[[nodiscard]] bool goes_first(View const& view, map::Conflict const& conflict, map::ConflictZone const& zone,
                              ConflictUser const& other, SectionKey key, double way, double own_way,
                              ConflictAsker const& own) {
  constexpr double spread = 8.0;      // [s] range over which ids spread the end of patience
  constexpr double later = 20.0;      // [s] more for the larger id
  constexpr double for_order = 10.0;  // [s] more where those who came earlier go first
  auto const& user = other.user;
  if (is_valid(conflict.other_light) && view.light(conflict.other_light) == map::LightColor::red) return true;
  bool const stands = user.speed < standing_speed, own_stands = own.speed < standing_speed;
  bool const is_smaller = view.id() < user.agent, is_patient = own.waited < own.patience;
  bool const in_order = is_by_arrival(view, conflict), is_decided = conflict.right_of_way != map::RightOfWay::equal;
  if (in_order && enters_first(other, own, is_smaller)) return false;
  bool const by_arrival = in_order && !is_patient;
  double const to_line = zone.other_line - other.at - user.front;
  // Without that order, all count as having come together.
  auto const arrival = by_arrival ? own.before->arrival_of(key) : Arrival::together;
  bool const has_to_stop = other.is_behind_slow || (user.speed < starting_speed && to_line < short_way);
  if (arrival == Arrival::later && has_to_stop) return true;
  if (stands && !is_patient) {
    // Two drivers must not lose their patience together. Of two that wait for each other, the smaller id goes long
    // before the other; the golden ratio spreads the ids of a ring of waiting drivers.
    double const share = 0.6180339887498949 * static_cast<double>(static_cast<std::uint32_t>(view.id()));
    bool const is_sooner = is_smaller || (is_decided && own.before->holds(key));
    double const turn = spread * (share - std::floor(share)) + (is_sooner ? 0.0 : later);  // [s]
    if (own.waited >= own.patience + turn + (arrival == Arrival::earlier ? for_order : 0.0)) return true;
  }
  if (arrival == Arrival::earlier && to_line < short_way) return false;
  bool const at_green = is_decided && lets_go(view, conflict.light) && lets_go(view, conflict.other_light);
  if (own_stands && !stands && !at_green && user.speed < starting_speed && to_line < short_way) return false;
  if (is_decided) return conflict.right_of_way == map::RightOfWay::first;
  return std::abs(own_way - way) > 2.0 ? own_way < way : is_smaller;
}

}  // namespace detail

}  // namespace cambium::inline v0_1
