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

namespace cambium::inline v0_1 {

/// Crosses junctions by the rules of the road. The map knows where two ways conflict (`map::Conflict`), and which
/// conflicts form a section that a vehicle passes as a whole, for nobody can stand between them:
///
///                |other|
///         place  |  v  |
///            |   |     |
///    own ->  |   |/////|  ->     zone: where the two bodies could touch
///            |   |     |
///
/// A vehicle has entered a section once it is beyond the place where it waits for it, or can no longer stop there. For
/// each conflict ahead, the driver predicts who comes (with its speed, or accelerating if that is worse, along the ways
/// that its turn signal permits) and derives a claim: the conflict is free, must be watched, must be yielded, or is
/// blocked. The strongest claim bounds the step so that the vehicle can stop at its place or before the zone.
///
/// - Outside, a driver waits for all who have entered a section that conflicts with its own, unless they leave the zone
///   in time, and for those who go first (`detail::goes_first`) and would be in the zone less than `time_margin` before
///   or after it, on a minor road less than `minor_road_margin` more after it. It enters when it waits for nobody and
///   there is room behind the section once all before it have closed up to the end of a queue. Behind a merge at which
///   it goes first, without lights, it needs none: the others would only stand behind it. If only vehicles inside
///   keep it out, and it can no longer stop softly before its place, it enters and waits before the zone.
/// - Inside, it waits only for those who entered before it; of those who entered in the same step, for smaller ids. It
///   remembers who these are. It lets those through who will not stop, whoever came first.
///
/// So nobody waits forever. Order all vehicles inside by the step in which they entered, then by their ids. Each waits
/// only for earlier ones, or drives behind a leader, which entered before it or is behind the section, where there was
/// room, or behind a merge. So the earliest waits for nobody and leaves, and then the next one is the earliest. Queues
/// do not close to a ring, for those who have to yield never fill it. Nor do those outside wait for each other in a
/// ring: of those who stand, each loses its patience at a time of its own. One whom all others keep outside, for they
/// do not stand, goes before those who can stop with ease after 80 s more. One case is open: a queue may form behind a
/// section while a driver is in it, if the next section begins close behind. So a driver inside that has stood for 10 s
/// (20 s if its id is larger) passes an earlier one that stands and is not in the zone.
///
/// And nobody collides whom all see and who heeds this: a driver enters only if it can stop before a zone until those
/// before it have left that, and those after it can stop before theirs, for they were outside. A collision remains
/// possible with vehicles that change lanes in a junction, ignore its rules, or are observed where they are not.
///
/// At green one enters to turn left, too, and waits inside for oncoming traffic (`map::ConflictSection::refuge`). For
/// lights, stop signs and bends it relies on `Bends` and `Signals`, to be heeded before this. Conflicts depend on the
/// sizes of the two vehicles, see `MapOptions::conflict_shape`.
struct Conflicts {
  double look_ahead = 80.0;
  double time_margin = 0.5;
  double assumed_acceleration = 1.5;
  double patience = 1.0;
  bool keep_clear = true;
  double stop_margin = 1.0;
  double safe_deceleration = 3.0;
  double minor_road_margin = 3.0;
  bool insists = false;

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
                  "conflicts within this distance, or within the comfortable braking distance, count; 0: none"),
        parameter("time_margin", &P::time_margin, "s", Range{0, 20}, "between two vehicles in one place"),
        parameter("assumed_acceleration", &P::assumed_acceleration, "m/s^2", Range{0, 20},
                  "of others on their way to the conflict"),
        parameter(
            "patience", &P::patience, "s", Range{0, 600},
            "a driver that has stood for this time goes before those that stopped later where nobody has priority; "
            "after up to 38 s more, by its id, before any other one that stands"),
        parameter("keep_clear", &P::keep_clear, "do not stop within the junction"),
        parameter("stop_margin", &P::stop_margin, "m", Range{0, 20}, "from the front end to a line where it waits"),
        parameter("safe_deceleration", &P::safe_deceleration, "m/s^2", Range{0.1, 20},
                  "by which it can stop before a conflict until that is free"),
        parameter("minor_road_margin", &P::minor_road_margin, "s", Range{0, 20},
                  "more before one that goes first, for a driver that comes from a minor road"),
        parameter("insists", &P::insists,
                  "does not let those through who have to let it go first, unless they stand in its way: a planner's "
                  "worst case"));
  }

  struct Memory {
    float waited{};                 ///< time at a standstill before a section or in it, red lights apart [s]
    std::uint16_t entered{};        ///< sections of the corridor that it has entered, and those before them
    detail::AgentsBefore before{};  ///< those that came before it

    static constexpr char const* name = "conflicts_memory";
    static constexpr auto parameters() {
      using P = Memory;
      return parameter_list(parameter("waited", &P::waited, "s", any_finite, "at a standstill before a junction"),
                            parameter("entered", &P::entered, "-", Range{0, 65535},
                                      "sections that it has entered, and those before them"),
                            parameter("before", &P::before, "those that came before it"));
    }

    friend bool operator==(Memory const&, Memory const&) = default;
  };

  /// In junctions the right of way decides whether the driver follows those who merge into its lane; elsewhere, what
  /// the driver is set to.
  template <class View>
  [[nodiscard]] static Merging merging(View const& view, Merging counted) {
    if (counted == Merging::counts) return Merging::by_rule;
    auto const& feeders = view.corridor().feeders;
    double const front = view.place().s + view.shape().front;
    auto const next =
        std::ranges::find_if(feeders, [&](map::Feeder const& feeder) { return feeder.free_until > front; });
    return next != feeders.end() && next->by_rule ? Merging::by_rule : counted;
  }

  template <class View, class Limits>
  void heed(View const& view, Memory& memory, Limits& limits, double dt) const {
    if (look_ahead == 0.0) return;
    auto const& law = limits.law();
    Own own;
    own.speed = limits.response().speed();
    own.desired_speed = limits.desired_speed();
    own.s = view.place().s;
    own.front = own.s + view.shape().front;
    own.waited = memory.waited;
    own.before = &memory.before;
    own.entered = memory.entered;
    own.minimum_gap = law.minimum_gap;
    own.maximum_acceleration = law.maximum_acceleration;
    own.comfortable = law.comfortable_deceleration;
    own.hardest = -law.lowest_acceleration;
    own.jerk_bound = limits.jerk_bound;
    heed_conflicts(view, own, limits, dt);
    remember(memory, own, limits.is_at_light, dt);
    limits.bound(own.wait.bound);
    limits.place_to_wait = {own.stops_at + detail::over_line - own.s, detail::judged_deceleration};
  }

 private:
  using Other = detail::ConflictUser;

  static constexpr double at_line_within = 2.0;  // [m] from where a driver waits: it has arrived there
  static constexpr double air = 0.3;             // [m] distance kept to a conflict
  static constexpr double longest_wait = 80.0;   // [s] beyond its patience: see `claim_in_time`
  static constexpr double intruders_deceleration =
      1.5 * detail::judged_deceleration;  // it will not stop, see `claim_of`
  static constexpr double infinite = std::numeric_limits<double>::infinity();

  /// Where one waits.
  struct Wait {
    LongitudinalMotion<double> bound{infinite, infinite};  ///< longest motion of this step
    bool at_line = false;                                  ///< has arrived there
  };

  /// The own vehicle: its place, and its motion as bounded so far.
  struct Own : detail::ConflictAsker {
    double desired_speed{};                                                  ///< within the limits [m/s]
    double minimum_gap{}, maximum_acceleration{}, comfortable{}, hardest{};  ///< of its law [m, m/s^2]
    JerkBound jerk_bound{};                                                  ///< of its acceleration
    double highest{};             ///< highest speed within `view_ahead`, unless `is_far` [m/s]
    Wait wait{};                  ///< by all claims
    detail::AgentsBefore now{};   ///< those that came before it, as from now on
    std::uint32_t entered{};      ///< `Memory::entered`, of the step before
    std::uint32_t entered_now{};  ///< and of this one
    bool notes_standing = false;  ///< adds those that stand to `now`
    bool is_near_line = false;    ///< comes to its place within `detail::short_way`
    bool is_far = false;          ///< no claim on a conflict can bound this step
    bool is_settled = false;      ///< no claim on the conflict at hand can bound it further
    double stops_at = infinite;   ///< a place before which it stops [m]

    /// Whether it still adds to `now`, although no claim can bound it.
    [[nodiscard]] bool notes() const { return notes_standing && !now.is_full_of_entered(); }
    /// Whether it has entered the section in this step.
    [[nodiscard]] bool enters_now() const { return has_entered && section >= entered; }
  };

  /// Counts the time at a standstill, before a section and within it. A driver that has begun to creep keeps its place
  /// in the order.
  static void remember(Memory& memory, Own const& own, bool is_red, double dt) {
    bool const is_inside = own.entered_now > 0;
    if (own.entered_now > own.entered || (own.speed > detail::starting_speed && (is_inside || !own.is_near_line)))
      memory.waited = 0.0f;
    memory.entered = static_cast<std::uint16_t>(std::min(own.entered_now, 65535u));
    memory.before = own.now;
    if (own.speed < standing_speed && own.wait.at_line && !is_red) memory.waited += static_cast<float>(dt);
  }

  /// What a conflict demands, in ascending order.
  enum class Claim : std::uint8_t {
    free,
    watch,   ///< goes on such that it can still stop: the zone will be free in time
    wait,    ///< waits for one inside: at its place or, if it cannot stop there softly, before the zone
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
      come_to(view, conflict, own);
      own.is_settled = own.is_far || (!own.has_entered && own.stops_at <= own.place);
      bool const is_over = own.is_settled && !own.notes();
      if (conflict.kind == map::OverlapKind::crossing && (is_over || is_in_zone(conflict, own))) continue;
      auto const claims = claims_of(view, conflict, own, limits);
      for (std::size_t other = 0; other < 2; ++other)
        if (claims[other] != Claim::free) obey(claims[other], conflict, other, own, view, dt);
    }
    if (own.is_far || !keep_clear) return;
    std::optional<double> end_of_road;
    for (auto at = first; at != end; ++at) {
      if (at->kind == map::OverlapKind::merge && at->right_of_way == map::RightOfWay::first && !is_valid(at->light))
        continue;
      auto const& zone = at->zones[own.is_large][own.may_meet_large];
      come_to(view, *at, own);
      if (zone.empty() || own.section == map::ConflictSection::none || own.has_entered || own.stops_at <= own.place)
        continue;
      if (!end_of_road) end_of_road = front_in_queue(view, own, limits.constraint());
      if (is_full_behind(view, zone, own, *end_of_road)) obey(Claim::yield, *at, own.may_meet_large, own, view, dt);
    }
  }

  /// Sets what the own vehicle knows of the section that holds a conflict.
  template <class View>
  static void come_to(View const& view, map::Conflict const& conflict, Own& own) {
    auto const& section = conflict.section[own.is_large][own.may_meet_large];
    own.section = section.number;
    own.place = section.place_to_wait(own.front - own.s, detail::lets_go(view, conflict.light));
    own.has_entered = false;
    if (own.section == map::ConflictSection::none) return;
    own.has_entered = detail::has_entered(own.s, own.speed, own.place);
    if (own.has_entered) own.entered_now = std::max(own.entered_now, own.section + 1);
    own.is_near_line = own.is_near_line || own.place - own.s < detail::short_way;
  }

  /// Whether the own vehicle is in the zone, or beyond it, whatever the size of the other.
  [[nodiscard]] static bool is_in_zone(map::Conflict const& conflict, Own const& own) {
    auto const& [normal, large] = conflict.zones[own.is_large];
    auto const is_before = [&](map::ConflictZone const& zone) {
      return !zone.empty() && zone.begin - own.s > -detail::over_line;
    };
    return !is_before(normal) && !(own.may_meet_large && is_before(large));
  }

  /// Sets what is asked only where conflicts are ahead, `first` the nearest one.
  template <class View>
  void prepare(View const& view, map::Conflict const& first, Own& own, double highest, double dt) const {
    own.is_large = detail::is_large(view, view.shape());
    own.may_meet_large = detail::is_large(view, view.largest_shape());
    own.patience = patience;
    own.dt = dt;
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

  /// How hard it brakes for a place where it waits [m/s^2]: less than what drivers judge by, so that one who brakes for
  /// its place does not seem to have entered.
  [[nodiscard]] static double waiting_deceleration(Own const& own) {
    return std::min(own.comfortable, 0.8 * detail::judged_deceleration);
  }

  /// Distance from the front end [m] beyond which a place to stop does not bound the step: a vehicle that accelerates
  /// as hard as it can over the step could still stop there, and is not at its line.
  [[nodiscard]] double longest_stop(Own const& own, double dt) const {
    double const end = own.speed + own.maximum_acceleration * dt;
    double const braking = std::min(waiting_deceleration(own), own.hardest);
    return end * dt + stopping_distance(end, own.maximum_acceleration, braking, own.jerk_bound) + stop_margin +
           at_line_within + air;
  }

  /// Bounds the step's motion by the claim of vehicles of the size `others` on a conflict.
  template <class View>
  void obey(Claim claim, map::Conflict const& conflict, std::size_t others, Own& own, View const& view,
            double dt) const {
    auto const& zone = conflict.zones[own.is_large][others];
    double const to_conflict = zone.begin - air - own.s;
    if (to_conflict + air < -detail::over_line) return;  // it is inside already
    double to_stop = to_conflict, braking = safe_deceleration;
    if (claim != Claim::watch) {
      braking = waiting_deceleration(own);
      auto const to_zone = [&] { return distance_to_zone(view, own, to_conflict); };
      bool const goes_in = own.has_entered || (claim == Claim::wait && !stops_softly(own, own.place - own.s) &&
                                               stops_softly(own, to_zone()));
      to_stop = goes_in ? to_zone() : distance_to_place(own);
      if (!goes_in) own.stops_at = std::min(own.stops_at, own.place);
    }
    auto const bound = motion_before_stop(own.speed, to_stop, braking, own.hardest, dt, own.jerk_bound);
    if (bound.distance < own.wait.bound.distance) own.wait.bound = bound;
    own.wait.at_line = own.wait.at_line || to_stop < at_line_within;
  }

  /// Whether the driver can stop within `distance` [m] without braking harder than `jerk_bound` permits.
  [[nodiscard]] bool stops_softly(Own const& own, double distance) const {
    constexpr double tolerance = 0.02;  // [m] beyond where it stops, by rounding
    return own.speed < standing_speed || stopping_distance(own.speed, own.jerk_bound.acceleration, safe_deceleration,
                                                           own.jerk_bound) <= distance + tolerance;
  }

  /// Distance to where it stops before a section that it has not entered: before its place if it still can [m].
  [[nodiscard]] double distance_to_place(Own const& own) const {
    double const way = own.place - own.s;
    for (double const margin : {stop_margin, air})
      if (can_stop(own.speed, way - margin)) return std::max(0.0, way - margin);
    return std::max(0.0, way);
  }

  /// Distance [m] to the first zone ahead before which the vehicle can still stop, or to where its front end would be
  /// in a merge, so that others follow it; at most `to_conflict`, and that where it is far, maybe in another junction.
  template <class View>
  [[nodiscard]] double distance_to_zone(View const& view, Own const& own, double to_conflict) const {
    double nearest = to_conflict;
    if (to_conflict > detail::short_way) return nearest;
    auto const offer = [&](double way) {
      if (way >= 0.0 && way < nearest && can_stop(own.speed, way)) nearest = way;
    };
    for (auto const& c : view.corridor().conflicts)
      for (std::size_t const other : {0u, 1u})
        if (c.kind != map::OverlapKind::split && (other == 0 || own.may_meet_large))
          offer(c.zones[own.is_large][other].begin - air - own.s);
    for (auto const& feeder : view.corridor().feeders)
      if (feeder.by_rule) offer(feeder.free_until - air - own.front);
    return nearest;
  }

  /// The strongest claims of the normal and of the large vehicles on their way to the conflict, if they can bound the
  /// step. Adds merging leaders to the constraints, and those who come first to `Own::now`.
  template <class View, class Limits>
  [[nodiscard]] std::array<Claim, 2> claims_of(View const& view, map::Conflict const& conflict, Own& own,
                                               Limits& limits) const {
    std::array<Claim, 2> claims{Claim::free, Claim::free};
    bool is_known = own.speed >= detail::starting_speed || own.has_entered;
    detail::NextToEnter asked;
    auto const first = [&]() -> std::optional<RoadUser> const& {
      if (!std::exchange(is_known, true)) asked = first_before(view, conflict, own);
      return asked.user;
    };
    for (auto const& way : conflict.ways)
      view.on_lane(way.index_begin, way.index_end, [&](RoadUser const& user) {
        if (user.s < way.index_begin || user.s > way.index_end || !is_valid(user.agent)) return;
        bool const large = is_large(view, user, own);
        if (conflict.zones[own.is_large][large].empty()) return;
        Other other{.user = user,
                    .at = way.begin + user.s - way.index_begin,
                    .reach = detail::extra_reach(view, large, user.front, user.rear)};
        claims[large] = std::max(claims[large], claim_of(view, conflict, way, large, other, own, limits, first));
      });
    return claims;
  }

  template <class View>
  [[nodiscard]] static bool is_large(View const& view, RoadUser const& user, Own const& own) {
    return own.may_meet_large && detail::is_large(view, view.shape(user));
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

  /// The claim of one vehicle on its way. `first()`: the vehicle that is next to enter, known only to one that hardly
  /// moves.
  template <class View, class Limits, class First>
  [[nodiscard]] Claim claim_of(View const& view, map::Conflict const& conflict, map::ConflictWay const& on, bool large,
                               Other& other, Own& own, Limits& limits, First const& first) const {
    auto const& zone = conflict.zones[own.is_large][large];
    auto const& user = other.user;
    auto const& reach = other.reach;
    double const at = other.at;
    if (at > zone.other_end + reach.rear) return Claim::free;
    double const way = zone.other_begin - reach.front - at, own_way = zone.begin - own.s;
    bool const is_in = way < -detail::over_line, own_is_in = own_way <= -detail::over_line,
               splits = conflict.kind == map::OverlapKind::split;
    bool const may_lead = conflict.kind != map::OverlapKind::crossing && (is_in || splits);
    if (!may_lead && (own_is_in || (own.is_settled && !own.notes()) || lets_wait(other, way, own))) return Claim::free;
    if (at < 0.0 && !view.signals_way(user, conflict.other)) return Claim::free;
    if (may_lead) {
      double const there = at + conflict.shift, gap = there - user.rear - own.front;
      if (there > own.s && (gap > 0.0 || own_is_in)) {
        auto leader = detail::constraint_beside<typename Limits::Response>(view, user);
        leader.gap = gap;
        // One ahead that pulls away counts where it is after a headway.
        if (gap > 0.0) leader.gap += limits.law().time_headway * std::max(0.0, user.speed - own.speed);
        limits.heed(leader);
      }
      if (gap > 0.0 || splits) return Claim::free;
    }
    if (own_is_in) return Claim::free;
    if (insists && conflict.right_of_way == map::RightOfWay::first && !(is_in && user.speed < standing_speed))
      return Claim::free;
    if (!own.has_entered && own.now.is_full_of_entered()) return own.is_settled ? Claim::free : Claim::blocked;
    auto const section = view.section(user, conflict, large, own.is_large, own.may_meet_large);
    other.place = section ? section->place_to_wait(user.front, detail::lets_go(view, conflict.other_light))
                          : zone.other_begin - reach.front;
    double const place = other.place;
    bool const has_entered = detail::has_entered(at, user.speed, place);
    auto const key = detail::section_key(user.agent, section ? section->number : 0, own.section);
    bool const is_first = comes_first(view, user, key, has_entered, own, first);
    if (own.is_settled) return Claim::free;
    if (own.has_entered) {
      // Those who come later wait; whoever does not is let through. One at its place is not in the zone: the two sides
      // may round that differently.
      double const until = std::max(way, place - reach.front - at) + detail::over_line;
      bool const intrudes = until < 0.0 || !cambium::can_stop(user.speed, until, intruders_deceleration);
      if (!is_first && !intrudes) return Claim::free;
      bool const stands = user.speed < standing_speed && !is_in;
      if (stands && own.waited > (view.id() < user.agent ? 10.0 : 20.0)) return Claim::free;
      return claim_until_left(view, conflict, zone, other, has_entered, own_way, own);
    }
    if (own.now.is_full_of_entered()) return Claim::blocked;  // by this one
    bool const yields = conflict.right_of_way == map::RightOfWay::yields && !detail::is_by_arrival(view, conflict);
    bool const is_red = is_valid(conflict.other_light) && view.light(conflict.other_light) == map::LightColor::red;
    if (has_entered || (yields && !is_red && detail::is_about_to_enter(other, own.dt)))
      return claim_until_left(view, conflict, zone, other, has_entered, own_way, own);
    other.is_behind_slow = own.waited >= own.patience && first() && first()->speed < detail::starting_speed &&
                           first()->agent != user.agent;
    if (detail::goes_first(view, conflict, zone, other, key, way, own_way, own)) return Claim::free;
    other.earliest = on.time_from(at);
    return claim_in_time(view, conflict, zone, other, way, own_way, own);
  }

  /// Whether the own vehicle, which has entered, surely lets another one wait that is `way` [m] before the zone: that
  /// did not come before it, and can stop. Asks for nothing that costs much.
  [[nodiscard]] static bool lets_wait(Other const& other, double way, Own const& own) {
    return own.has_entered && !own.enters_now() && way >= -detail::over_line &&
           cambium::can_stop(other.user.speed, way + detail::over_line, intruders_deceleration) &&
           !own.before->may_hold(other.user.agent);
  }

  /// Whether another vehicle has entered before the own one. Notes it in `Own::now` if it has, or if it stands where
  /// it waits and the own one has just stopped, too.
  template <class View, class First>
  [[nodiscard]] static bool comes_first(View const& view, RoadUser const& user, detail::SectionKey key,
                                        bool has_entered, Own& own, First const& first) {
    if (!has_entered) {
      if (own.has_entered) return false;
      bool const was_there = own.before->holds(key);
      auto const is_next = [&] { return own.notes_standing && first() && first()->agent == user.agent; };
      bool const stays = own.waited == 0.0 ? (user.speed < standing_speed || was_there) && is_next() : was_there;
      bool const together = own.waited == 0.0 ? !was_there : own.before->holds_together(key);
      if (stays) own.now.add(key, false, together);
      return false;
    }
    bool const had_entered = own.before->holds_entered(key);
    if (!own.has_entered) {
      own.now.add(key, true, false);
      return true;
    }
    bool const together = own.enters_now() ? !had_entered : own.before->holds_together(key);
    if (!own.enters_now() && !had_entered) return false;
    own.now.add(key, true, together);
    return !together || user.agent < view.id();
  }

  /// The claim of a vehicle that has entered its section: until it has left the zone, or leads where the two merge.
  template <class View>
  [[nodiscard]] Claim claim_until_left(View const& view, map::Conflict const& conflict, map::ConflictZone const& zone,
                                       Other const& other, bool has_entered, double own_way, Own const& own) const {
    auto const& user = other.user;
    if (!has_entered) return Claim::blocked;
    if (user.speed < standing_speed) return Claim::wait;
    double end = zone.other_end + other.reach.rear;  // where it leaves room for the own vehicle
    if (conflict.kind == map::OverlapKind::merge)
      end = std::min(end, zone.begin + view.shape().front + own.minimum_gap + user.rear - conflict.shift);
    double const gap = std::max(0.0, end - other.at), latest = arrival(own, own_way) - 0.5 * time_margin;
    // Cars pull away faster than lorries.
    double const gains = detail::is_large(view, view.shape(user)) ? detail::pull_away : 1.5 * detail::pull_away;
    if (time_to_cover(gap, user.speed, gains, infinite) >= latest) return Claim::wait;
    // It leaves in time even if it brakes.
    double const b = detail::judged_deceleration, end_speed = user.speed * user.speed - 2.0 * b * gap;  // squared
    return end_speed > 0.0 && (user.speed - std::sqrt(end_speed)) / b < latest ? Claim::free : Claim::watch;
  }

  /// The claim of a vehicle that goes first, has not entered yet, and arrives at the zone after `way` [m]. Who has
  /// waited long takes a gap up to a second shorter, and after `longest_wait` any before one that can stop with
  /// ease.
  template <class View>
  [[nodiscard]] Claim claim_in_time(View const& view, map::Conflict const& conflict, map::ConflictZone const& zone,
                                    Other const& other, double way, double own_way, Own const& own) const {
    auto const& [user, at, reach, behind_slow, place, earliest] = other;
    double const impatience = std::clamp((own.waited - own.patience) / 30.0, 0.0, 1.0);
    double const behind = std::max(0.0, time_margin - impatience);
    double const before =
        std::max(0.0, time_margin + (conflict.from_minor_road ? minor_road_margin : 0.0) - impatience);
    double const soonest =
        time_to_cover(way, user.speed, assumed_acceleration, std::max(user.speed, own.desired_speed));
    Window const theirs{
        std::max(earliest, soonest),
        (way + zone.other_end - zone.other_begin + reach.front + reach.rear) / std::max(user.speed, standing_speed)};
    double const leaves =
        conflict.kind == map::OverlapKind::merge ? merged_at(view, conflict, zone, user, own) : zone.end;
    Window const ours{arrival(own, own_way), arrival(own, leaves - own.s) + build_up(own)};
    if (theirs.end + behind < ours.begin || ours.end + before < theirs.begin) return Claim::free;
    bool const stops_with_ease = cambium::can_stop(user.speed, place - at, 2.0);
    return own.waited > own.patience + longest_wait && stops_with_ease ? Claim::free : Claim::yield;
  }

  /// Earliest time [s] at which the own vehicle has driven `distance` [m].
  [[nodiscard]] double arrival(Own const& own, double distance) const {
    return time_to_cover(distance, own.speed, own.maximum_acceleration, std::max(own.speed, own.highest));
  }

  /// By how much later [s] it arrives because its acceleration builds up.
  [[nodiscard]] static double build_up(Own const& own) {
    if (!own.jerk_bound.matters() || own.speed >= own.highest) return 0.0;
    double const missing = own.maximum_acceleration - own.jerk_bound.acceleration;
    return std::max(0.0, 0.5 * missing / own.jerk_bound.jerk);
  }

  /// Corridor position of the own vehicle [m] from which on one that comes to the merge then follows it with ease.
  template <class View>
  [[nodiscard]] static double merged_at(View const& view, map::Conflict const& conflict, map::ConflictZone const& zone,
                                        RoadUser const& user, Own const& own) {
    double const speed =
        std::min(std::max(own.speed, own.highest),
                 std::sqrt(own.speed * own.speed + 2.0 * own.maximum_acceleration * (zone.end - own.s)));
    double const closing = std::max(0.0, user.speed - speed);
    double const gap = own.minimum_gap + closing * closing / (2.0 * own.comfortable);
    double const behind = zone.other_begin + conflict.shift + user.front + gap + view.shape().rear;
    return std::clamp(behind, zone.begin, zone.end);
  }

  /// How far the vehicle's front end may come, up to the vehicle before it, once all before it have closed up to the
  /// next one that stands or creeps: corridor position [m]; infinite where nobody does. O(vehicles on the way there).
  template <class View>
  [[nodiscard]] static double front_in_queue(View const& view, Own const& own, Constraint const& leader) {
    if (is_in_queue(leader)) return own.front + leader.gap;
    double closed_up = 0.0;  // [m] of those that move
    auto at = view.place();
    for (int vehicles = 0; vehicles < 16; ++vehicles) {
      auto const next = view.ahead(at, {.merging = Merging::by_rule, .distance = detail::queue_view});
      if (!next) break;
      if (next->speed <= detail::starting_speed) return next->s - next->rear - closed_up;
      closed_up += next->length() + own.minimum_gap;
      at.s = next->s + 0.01;
      at.piece = view.corridor().piece_at(at.s, at.piece);
    }
    return infinite;
  }

  /// Whether the room behind the conflict, up to `front` [m], is too small for the vehicle.
  template <class View>
  [[nodiscard]] static bool is_full_behind(View const& view, map::ConflictZone const& zone, Own const& own,
                                           double front) {
    double const end = zone.end - view.shape().rear;  // end of the conflict for a rear end
    return front - end < view.shape().length() + own.minimum_gap;
  }
};
}  // namespace cambium::inline v0_1
