#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

#include "cambium/behavior/heed/conflict_order.hpp"
#include "cambium/behavior/law/braking.hpp"
#include "cambium/behavior/law/constraint.hpp"
#include "cambium/behavior/view.hpp"
#include "cambium/core/described.hpp"

namespace cambium {

/// Crosses junctions by the rules of the road. The map knows where two ways through a junction conflict
/// (`map::Conflict`):
///
///                |other|
///          line  |  v  |
///            |   |     |
///    own ->  |   |/////|  ->     zone: where the two bodies could touch
///            |   |     |
///
/// For each conflict ahead, the driver predicts who comes (with its speed, or accelerating if that is worse, along the
/// ways that its turn signal permits) and derives a claim: the conflict is free, must be watched, must be yielded, or
/// is blocked. A vehicle inside the zone, or too fast to stop before it, blocks it unless it leaves in time. A vehicle
/// that goes first (`detail::goes_first`) has the zone if the two times in it are less than `time_margin` apart. The
/// strongest claim bounds the step so that the vehicle can stop at its line.
///
/// The driver enters a junction when it may go first in all its conflicts and there is room behind them; after 40 s
/// more than its patience, even without room. Once it has left its place to wait, maybe well before the edge of the
/// junction, it goes before all vehicles that are still outside. Of those that leave their places in the same step, the
/// nearest goes (`detail::leaves_first`). At green it also enters to turn left, and waits inside for oncoming traffic.
/// For lights, stop signs and bends it relies on `Bends` and `Signals`, to be heeded before this. Where neither
/// priorities nor lights say who goes first, those who have stopped go in the order in which they came. In a deadlock
/// one driver after the other loses its `patience` and goes. A driver that has waited 40 s more for others who go first
/// drives up to the conflict: then it is inside the junction, and those who can still stop let it go, so that nobody
/// waits forever.
///
/// Guarantee: as long as the vehicle can stop before a conflict, it does not enter while another vehicle is inside or
/// can no longer stop. Of two vehicles that can both stop, one goes first, or both until one of them can no longer
/// stop. So vehicles that all heed this do not collide. A collision remains possible with vehicles that change
/// lanes in a junction, ignore its rules, or are observed where they are not. Conflicts depend on the sizes of the two
/// vehicles, see `MapOptions::conflict_shape`.
struct Conflicts {
  double look_ahead = 80.0;
  double time_margin = 1.0;
  double assumed_acceleration = 1.5;
  double patience = 1.0;
  bool keep_clear = true;
  double stop_margin = 1.0;
  double safe_deceleration = 3.0;

  static constexpr bool heeds_conflicts = true;  ///< agents must not exceed the shapes of the map's conflicts
  static constexpr char const* name = "conflicts";
  static constexpr char const* summary =
      "gives way by priorities of the map, signs, order of arrival, right before left, oncoming before turning; stops "
      "for vehicles predicted to come too close in time; resolves deadlocks";
  static constexpr char const* source = "rules of the road (StVO sections 8 and 9); prediction: own";
  static constexpr auto parameters() {
    using P = Conflicts;
    return parameter_list(
        parameter("look_ahead", &P::look_ahead, "m", Range{0, 1000},
                  "conflicts within this distance, or within the comfortable braking distance, count"),
        parameter("time_margin", &P::time_margin, "s", Range{0, 20}, "between two vehicles in one place"),
        parameter("assumed_acceleration", &P::assumed_acceleration, "m/s^2", Range{0, 20},
                  "of others on their way to the conflict"),
        parameter(
            "patience", &P::patience, "s", Range{0, 600},
            "a driver that has stood for this time goes before those that stopped later where nobody has priority; "
            "after up to 58 s more, by its id, before any other one that stands"),
        parameter("keep_clear", &P::keep_clear, "do not stop within the junction"),
        parameter("stop_margin", &P::stop_margin, "m", Range{0, 20}, "from the front end to a line where it waits"),
        parameter("safe_deceleration", &P::safe_deceleration, "m/s^2", Range{0.1, 20},
                  "by which drivers judge who can still stop"));
  }

  struct Memory {
    float waited{};                           ///< time at a standstill before a junction, red lights apart [s]
    detail::StandingAgents stopped_before{};  ///< those that stood there when it stopped, or that stand there now

    static constexpr char const* name = "conflicts_memory";
    static constexpr auto parameters() {
      using P = Memory;
      return parameter_list(parameter("waited", &P::waited, "s", any_finite, "at a standstill before a junction"),
                            parameter("stopped_before", &P::stopped_before, "those that stood there"));
    }

    friend bool operator==(Memory const&, Memory const&) = default;
  };

  /// In junctions the right of way decides whether the driver follows those who merge into its lane.
  template <class View>
  [[nodiscard]] static Merging merging(View const&, Merging) {
    return Merging::by_rule;
  }

  template <class View, class Limits>
  void heed(View const& view, Memory& memory, Limits& limits, double dt) const {
    auto const& law = limits.law();
    Own own;
    own.speed = limits.response().speed();
    own.desired_speed = limits.desired_speed();
    own.s = view.place().s;
    own.front = own.s + view.shape().front;
    own.waited = memory.waited;
    own.stopped_before = &memory.stopped_before;
    own.minimum_gap = law.minimum_gap;
    own.maximum_acceleration = law.maximum_acceleration;
    own.comfortable = law.comfortable_deceleration;
    own.hardest = -law.lowest_acceleration;
    heed_conflicts(view, own, limits, dt);
    remember(memory, own, limits.is_at_light, dt);
    limits.bound(own.wait().bound);
  }

 private:
  using Other = detail::ConflictUser;

  static constexpr double at_line_within = 2.0;  // [m] from where a driver waits: it has arrived there
  static constexpr double air = 0.3;             // [m] distance kept to a conflict
  static constexpr double longest_wait = 40.0;   // [s] beyond its patience, until it drives up to the conflict
  static constexpr double infinite = std::numeric_limits<double>::infinity();

  /// Where one waits.
  struct Wait {
    LongitudinalMotion<double> bound{infinite, infinite};  ///< longest motion of this step
    bool at_line = false;                                  ///< has arrived there

    void heed(Wait const& other) {
      if (other.bound.distance < bound.distance) bound = other.bound;
      at_line = at_line || other.at_line;
    }
  };

  /// The own vehicle: its place, and its motion as bounded so far.
  struct Own : detail::ConflictAsker {
    double desired_speed{};                                                  ///< within the limits [m/s]
    double minimum_gap{}, maximum_acceleration{}, comfortable{}, hardest{};  ///< of its law [m, m/s^2]
    double highest{};                   ///< highest speed within `view_ahead`, unless `is_far` [m/s]
    std::array<Wait, 2> waits{};        ///< by whether it has to leave room for large vehicles
    bool may_meet_large = false;        ///< large vehicles are, or were, in the world
    bool meets_large = false;           ///< a large vehicle is next on its way to one of the conflicts, see `claims_of`
    detail::StandingAgents standing{};  ///< others that stand at their lines
    bool notes_standing = false;        ///< adds to `standing`
    bool is_near_line = false;          ///< comes to a line within `detail::short_way`; asked if it has waited
    bool is_inside_junction = false;    ///< asked if it has waited
    bool is_far = false;                ///< no claim on a conflict can bound this step
    bool is_settled = false;            ///< no claim on the conflict at hand can bound it further
    map::Conflict const* stop{};        ///< a conflict before whose line it stops
    double stop_line{};                 ///< that line [m]

    [[nodiscard]] Wait const& wait() const { return waits[meets_large]; }
  };

  /// Counts the time at a standstill, before the junction and within it. A driver that has begun to creep keeps its
  /// place in the order.
  static void remember(Memory& memory, Own const& own, bool is_red, double dt) {
    if (own.speed > detail::starting_speed && (own.is_inside_junction || !own.is_near_line)) memory.waited = 0.0f;
    bool const stands = own.speed < standing_speed && own.wait().at_line && !is_red;
    if (memory.waited == 0.0f) {
      auto const before = std::exchange(memory.stopped_before, own.standing);
      if (stands) memory.stopped_before.mark_new(before);
    }
    if (!stands) return;
    memory.waited += static_cast<float>(dt);
  }

  /// What a conflict demands, in ascending order.
  enum class Claim : std::uint8_t {
    free,
    watch,   ///< goes on such that it can still stop: the zone will be free in time
    yield,   ///< waits if it can still stop
    blocked  ///< does not enter
  };

  /// Times at which a vehicle enters and leaves a conflict [s from now].
  struct Window {
    double begin, end;
  };

  [[nodiscard]] bool can_stop(double speed, double distance) const {
    return cambium::can_stop(speed, distance, safe_deceleration);
  }

  /// Bounds the motion by all conflicts ahead, each with the zone that belongs to the sizes of the two vehicles.
  template <class View, class Limits>
  void heed_conflicts(View const& view, Own& own, Limits& limits, double dt) const {
    auto const& conflicts = view.corridor().conflicts;
    auto const is_behind = [&](map::Conflict const& c) { return c.farthest_end < own.s; };
    auto const first = std::partition_point(conflicts.begin(), conflicts.end(), is_behind);
    if (first == conflicts.end()) return;
    prepare(view, *first, own, limits.highest_speed, dt);
    double const farthest = own.front + view_ahead(own);
    auto end = first;
    for (; end != conflicts.end() && end->first_hold() <= farthest; ++end) {
      auto const& conflict = *end;
      if (conflict.hull().end < own.s) continue;
      auto const& zones = conflict.zones[own.is_large];
      if (own.waited > 0.0) {
        own.is_near_line = own.is_near_line || zones[0].line - own.front < detail::short_way;
        own.is_inside_junction = own.is_inside_junction || own.is_inside(conflict, zones[0]);
      }
      own.is_settled = own.is_far || stops_anyway(view, conflict, own);
      bool const may_skip = own.is_far || (own.is_settled && !own.may_meet_large);
      if (may_skip && !own.notes_standing && conflict.kind == map::OverlapKind::crossing) continue;
      auto const claims = claims_of(view, conflict, own, limits);
      for (std::size_t other = 0; other < 2; ++other)
        if (claims[other] != Claim::free) obey(claims[other], conflict, other, view, own, dt);
    }
    bool const has_waited = own.waited > own.patience + longest_wait;  // maybe for the end of its own queue
    if (own.is_far || !keep_clear || has_waited || !is_in_queue(limits.constraint())) return;
    for (auto at = first; at != end; ++at) {
      auto const& zone = at->zones[own.is_large][0];
      if (!zone.empty() && is_full_behind(view, zone, own, limits.constraint()))
        obey(Claim::yield, *at, 0, view, own, dt);
    }
  }

  /// Sets what is asked only where conflicts are ahead, `first` the nearest one.
  template <class View>
  void prepare(View const& view, map::Conflict const& first, Own& own, double highest, double dt) const {
    own.is_large = detail::is_large(view, view.shape());
    own.may_meet_large = detail::is_large(view, view.largest_shape());
    own.patience = patience;
    own.dt = dt;
    own.braking = safe_deceleration;
    own.notes_standing = own.waited == 0.0 && own.speed < detail::starting_speed;
    own.is_far = first.first_hold() - own.front > longest_stop(own, dt);
    own.highest = own.is_far ? own.desired_speed : std::min(own.desired_speed, highest);
  }

  /// How far it looks ahead [m].
  [[nodiscard]] double view_ahead(Own const& own) const {
    return std::max(look_ahead, own.speed * own.speed / (2.0 * own.comfortable) + 20.0);
  }

  [[nodiscard]] static bool is_in_queue(Constraint const& leader) {
    return leader.gap < infinite && leader.speed <= detail::starting_speed;
  }

  /// How hard it brakes for a place where it waits [m/s^2]: less than `safe_deceleration`, by which drivers judge who
  /// can no longer stop. Otherwise several that brake for their lines would seem to be beyond them, and meet in a ring
  /// inside the junction.
  [[nodiscard]] double waiting_deceleration(Own const& own) const {
    return std::min(own.comfortable, 0.8 * safe_deceleration);
  }

  /// Distance from the front end [m] beyond which a place to stop does not bound the step: a vehicle that accelerates
  /// as hard as it can over the step could still stop there, and is not at its line.
  [[nodiscard]] double longest_stop(Own const& own, double dt) const {
    double const end = own.speed + own.maximum_acceleration * dt;
    double const braking = std::min(waiting_deceleration(own), own.hardest);
    return end * (dt + end / (2.0 * braking)) + stop_margin + at_line_within + air;
  }

  /// Whether it stops anyway where a claim on this conflict would stop it, at the latest: before another conflict with
  /// the same line and holds.
  template <class View>
  [[nodiscard]] static bool stops_anyway(View const& view, map::Conflict const& conflict, Own const& own) {
    auto const& hold = conflict.hold[own.is_large];
    if (!own.stop || own.stop->hold[own.is_large] != hold || may_wait_inside(view, conflict)) return false;
    double const farthest = way_to_line(own, own.stop_line, hold[0]);
    for (auto const& zone : conflict.zones[own.is_large])
      if (!zone.empty() && (zone.line != own.stop_line || zone.begin - air - own.s < farthest)) return false;
    return true;
  }

  /// Distance [m] to where it waits outside of the junction.
  [[nodiscard]] static double way_to_line(Own const& own, double line, double hold) {
    return std::min(line - own.front, hold - own.s);
  }

  template <class View>
  [[nodiscard]] static bool may_wait_inside(View const& view, map::Conflict const& conflict) {
    return conflict.right_of_way == map::RightOfWay::yields && detail::go_together(view, conflict);
  }

  /// Bounds the step's motion by the claim of vehicles of the size `others` on a conflict.
  template <class View>
  void obey(Claim claim, map::Conflict const& conflict, std::size_t others, View const& view, Own& own,
            double dt) const {
    auto const& zone = conflict.zones[own.is_large][others];
    double const to_conflict = zone.begin - air - own.s;
    if (to_conflict + air < 0.0) return;  // it is inside already
    if (claim == Claim::yield && !can_stop(own.speed, to_conflict + air)) return;
    bool const is_outside = !may_wait_inside(view, conflict);
    double const inside = is_outside ? -infinite : place_inside(view, zone, own) - own.s;
    double const braking = claim == Claim::watch ? safe_deceleration : waiting_deceleration(own);
    auto const wait_at = [&](double hold) -> Wait {
      double const to_hold = std::max(way_to_line(own, zone.line, hold), inside);
      double const to_stop = distance_to_stop(view, claim, to_hold, own, to_conflict);
      return {motion_before_stop(own.speed, to_stop, braking, own.hardest, dt), to_stop < at_line_within};
    };
    auto const& hold = conflict.hold[own.is_large];
    auto const wait = wait_at(hold[0]);
    own.waits[0].heed(wait);
    own.waits[1].heed(hold[1] == hold[0] ? wait : wait_at(hold[1]));
    double const nearer = way_to_line(own, zone.line, hold[1]), farther = way_to_line(own, zone.line, hold[0]);
    bool const stops_at_line =
        claim != Claim::watch && is_outside && nearer >= 0.0 && can_stop(own.speed, nearer) && farther <= to_conflict;
    if (!stops_at_line) return;
    own.stop = &conflict;
    own.stop_line = zone.line;
  }

  /// Where the vehicle waits at green for oncoming traffic that has green too: inside the junction, before the zones of
  /// all who go before it now [corridor position, m].
  template <class View>
  [[nodiscard]] static double place_inside(View const& view, map::ConflictZone const& zone, Own const& own) {
    double place = zone.begin - air;
    auto const covers = [&place](map::ConflictZone const& z) { return z.begin - air < place && place <= z.end; };
    auto const& conflicts = view.corridor().conflicts;
    for (bool is_covered = true; is_covered;) {
      is_covered = false;
      for (auto const& c : conflicts)
        for (std::size_t const other : {0u, 1u}) {
          auto const& z = c.zones[own.is_large][other];
          if ((other == 1 && !own.meets_large) || !covers(z) || c.right_of_way != map::RightOfWay::yields ||
              !detail::go_together(view, c))
            continue;
          place = z.begin - air;
          is_covered = true;
        }
    }
    return place;
  }

  /// Distance to where it waits [m]: before the line if it can still stop there, otherwise before the first zone ahead
  /// of it, so that it stands in nobody's way. Up to the conflict itself if that will be free in time.
  template <class View>
  [[nodiscard]] double distance_to_stop(View const& view, Claim claim, double to_hold, Own const& own,
                                        double to_conflict) const {
    if (claim == Claim::watch) return to_conflict;
    double const to_line = std::min(to_hold, to_conflict);
    if (to_line < 0.0 || !can_stop(own.speed, to_line)) return distance_to_zone(view, own, to_conflict);
    for (double const margin : {stop_margin, air})
      if (can_stop(own.speed, to_line - margin)) return std::max(0.0, to_line - margin);
    return to_line;
  }

  /// Distance [m] to the first zone ahead before which the vehicle can still stop, at most `to_conflict`; to the
  /// conflict where that is far, maybe in another junction.
  template <class View>
  [[nodiscard]] double distance_to_zone(View const& view, Own const& own, double to_conflict) const {
    double nearest = to_conflict;
    if (to_conflict > detail::short_way) return nearest;
    for (auto const& c : view.corridor().conflicts)
      for (std::size_t const other : {0u, 1u}) {
        double const way = c.zones[own.is_large][other].begin - air - own.s;
        if (c.kind == map::OverlapKind::split || (other == 1 && !own.meets_large) || way < 0.0) continue;
        if (way < nearest && can_stop(own.speed, way)) nearest = way;
      }
    return nearest;
  }

  /// The strongest claims of the normal and of the large vehicles on their way to the conflict, if they can bound the
  /// step. Adds merging leaders to the constraints.
  template <class View, class Limits>
  [[nodiscard]] std::array<Claim, 2> claims_of(View const& view, map::Conflict const& conflict, Own& own,
                                               Limits& limits) const {
    std::array<Claim, 2> claims{Claim::free, Claim::free};
    detail::NextToEnter noted, asked;
    bool is_known = own.speed >= detail::starting_speed;
    auto const first = [&]() -> std::optional<RoadUser> const& {
      if (!std::exchange(is_known, true)) asked = first_before(view, conflict, own);
      return asked.user;
    };
    for (auto const& way : conflict.ways)
      view.on_lane(way.index_begin, way.index_end, [&](RoadUser const& user) {
        if (user.s < way.index_begin || user.s > way.index_end || !is_valid(user.agent)) return;
        bool const large = is_large(view, user, own);
        auto const& zone = conflict.zones[own.is_large][large];
        double const at = way.begin + user.s - way.index_begin;
        if (own.notes_standing) noted.offer(user, zone.other_line - at - user.front);
        if (zone.empty()) return;
        // Where all go in the order in which they came, a truck in the queue of another way comes later.
        auto const comes_next = [&] {
          if (own.is_large || at > zone.other_begin || !detail::is_by_arrival(view, conflict)) return true;
          return !first() || first()->agent == user.agent;
        };
        own.meets_large = own.meets_large || (large && comes_next());
        auto const is_behind_slow = [&] {
          return first() && first()->speed < detail::starting_speed && first()->agent != user.agent;
        };
        Other const other{user, at, detail::extra_reach(view, large, user.front, user.rear),
                          own.waited >= own.patience && is_behind_slow()};
        claims[large] = std::max(claims[large], claim_of(view, conflict, large, other, own, limits, claims[large]));
      });
    note_standing(view, conflict, noted.user, own);
    return claims;
  }

  template <class View>
  [[nodiscard]] static bool is_large(View const& view, RoadUser const& user, Own const& own) {
    return own.may_meet_large && detail::is_large(view, view.shape(user));
  }

  /// Notes the vehicle that is next to enter the junction on the conflict's way if it stands, or has stood, at its
  /// line.
  template <class View>
  static void note_standing(View const& view, map::Conflict const& conflict, std::optional<RoadUser> const& first,
                            Own& own) {
    if (first && (first->speed < standing_speed || own.stopped_before->holds(first->agent)) &&
        view.signals_way(*first, conflict.other))
      own.standing.add(first->agent);
  }

  /// The vehicle that is next to enter the junction on a conflict's way.
  template <class View>
  [[nodiscard]] static detail::NextToEnter first_before(View const& view, map::Conflict const& conflict,
                                                        Own const& own) {
    detail::NextToEnter first;
    for (auto const& way : conflict.ways)
      view.on_lane(way.index_begin, way.index_end, [&](RoadUser const& user) {
        if (user.s < way.index_begin || user.s > way.index_end || !is_valid(user.agent)) return;
        double const line = conflict.zones[own.is_large][is_large(view, user, own)].other_line;
        first.offer(user, line - (way.begin + user.s - way.index_begin) - user.front);
      });
    return first;
  }

  /// The claim of one vehicle on its way, if it is stronger than `known`.
  template <class View, class Limits>
  [[nodiscard]] Claim claim_of(View const& view, map::Conflict const& conflict, bool large, Other other, Own const& own,
                               Limits& limits, Claim known) const {
    auto const& zone = conflict.zones[own.is_large][large];
    auto const& [user, at, reach, behind_slow, hold] = other;
    if (at > zone.other_end + reach.rear) return Claim::free;
    double const way = zone.other_begin - reach.front - at, own_way = zone.begin - own.s;
    bool const is_in = way <= 0.0, own_is_in = own_way <= 0.0, splits = conflict.kind == map::OverlapKind::split;
    bool const may_lead = conflict.kind != map::OverlapKind::crossing && (is_in || splits);
    if (own.is_settled && !may_lead) return Claim::free;
    if (at < 0.0 && !view.signals_way(user, conflict.other)) return Claim::free;
    if (may_lead) {
      double const place = at + conflict.shift, gap = place - user.rear - own.front;
      if (place > own.s && (gap > 0.0 || own_is_in)) {
        auto leader = detail::constraint_beside<typename Limits::Response>(view, user);
        leader.gap = gap;
        limits.heed(leader);
      }
      if (gap > 0.0 || splits || own.is_settled) return Claim::free;
    }
    if (own_is_in) return Claim::free;
    bool const enters = is_in || !can_stop(user.speed, way);
    if (!enters && known >= Claim::yield) return Claim::free;
    other.hold = view.waiting_place(user, conflict.other, large);
    if (enters) {
      double end = zone.other_end + reach.rear;  // where it leaves room for the own vehicle
      if (conflict.kind == map::OverlapKind::merge)
        end = std::min(end, zone.begin + view.shape().front + own.minimum_gap + user.rear - conflict.shift);
      // One that is in the zone, but has yet to enter the junction, may stop where it is.
      bool const goes = other.has_entered(zone) || !can_stop(user.speed, zone.other_line - at - user.front);
      bool const leaves = goes && user.speed >= standing_speed;
      double const out = leaves ? time_to_cover(end - at, user.speed, detail::pull_away, infinite) : infinite;
      return out + 0.5 * time_margin < arrival(own, own_way) ? Claim::watch : Claim::blocked;
    }
    if (detail::goes_first(view, conflict, zone, other, way, own_way, own)) return Claim::free;
    return claim_in_time(conflict, zone, other, way, own_way, own);
  }

  /// The claim of a vehicle that goes first and arrives at the zone after `way` [m].
  [[nodiscard]] Claim claim_in_time(map::Conflict const& conflict, map::ConflictZone const& zone, Other const& other,
                                    double way, double own_way, Own const& own) const {
    auto const& [user, at, reach, behind_slow, hold] = other;
    Window const theirs{
        time_to_cover(way, user.speed, assumed_acceleration, std::max(user.speed, own.desired_speed)),
        (way + zone.other_end - zone.other_begin + reach.front + reach.rear) / std::max(user.speed, standing_speed)};
    Window const ours{arrival(own, own_way), arrival(own, zone.end - own.s)};
    bool const is_in = other.is_inside(conflict, zone);
    if (theirs.end + time_margin < ours.begin) return is_in ? Claim::watch : Claim::free;
    double const length = way + zone.other_end - zone.other_begin + reach.front + reach.rear;
    if (is_in && user.speed >= standing_speed &&
        time_to_cover(length, user.speed, detail::pull_away, infinite) + 0.5 * time_margin < ours.begin)
      return Claim::watch;
    if (ours.end + time_margin < theirs.begin && !is_in) return Claim::free;
    return own.waited > own.patience + longest_wait ? Claim::watch : Claim::yield;
  }

  /// Earliest time [s] at which the own vehicle has driven `distance` [m].
  [[nodiscard]] double arrival(Own const& own, double distance) const {
    return time_to_cover(distance, own.speed, own.maximum_acceleration, std::max(own.speed, own.highest));
  }

  /// Whether the room behind the conflict is too small for the vehicle, as in a queue.
  template <class View>
  [[nodiscard]] bool is_full_behind(View const& view, map::ConflictZone const& zone, Own const& own,
                                    Constraint const& leader) const {
    double const end = zone.end - view.shape().rear;  // end of the conflict for a rear end
    double const room = own.front + leader.gap - end;
    return room < view.shape().length() + own.minimum_gap;
  }
};
}  // namespace cambium
