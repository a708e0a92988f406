#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include <boost/container/static_vector.hpp>

#include "cambium/behavior/driver/limits.hpp"
#include "cambium/behavior/heed/conflicts.hpp"
#include "cambium/behavior/heed/signals.hpp"
#include "cambium/behavior/open_loop/constant_acceleration.hpp"
#include "cambium/behavior/lateral/lane_change.hpp"
#include "cambium/behavior/law/acc.hpp"
#include "cambium/behavior/law/idm.hpp"
#include "cambium/behavior/law/lane_reach.hpp"
#include "cambium/behavior/law/lane_ends.hpp"
#include "cambium/core/described.hpp"
#include "cambium/core/stable_sort.hpp"
#include "cambium/evaluation/off_road.hpp"
#include "cambium/evaluation/terms.hpp"
#include "cambium/geometry/oriented_box.hpp"
#include "cambium/planner/candidate_planner.hpp"
#include "cambium/planner/frenet/frenet_candidate.hpp"
#include "cambium/planner/search/search_budget.hpp"

namespace cambium::inline v0_1 {

/// Acceleration and curvature where the last course has taken the vehicle, so that the next one continues smoothly, and
/// what it knows of signals and junctions.
struct FrenetMemory {
  float acceleration = 0.0f;  ///< [m/s^2]
  float curvature = 0.0f;     ///< [1/m]
  Signals::Memory signals{};
  Conflicts::Memory conflicts{};

  void fell_short(double, bool left_course) {
    if (left_course) acceleration = curvature = 0.0f;
  }
  static constexpr char const* name = "frenet_memory";
  static constexpr auto parameters() {
    using P = FrenetMemory;
    return parameter_list(parameter("acceleration", &P::acceleration, "m/s^2", any_finite, "at the start"),
                          parameter("curvature", &P::curvature, "1/m", any_finite, "likewise"),
                          parameter("signals", &P::signals, "the stop sign at which it has stopped"),
                          parameter("conflicts", &P::conflicts, "who came before it, and how long it has waited"));
  }

  friend bool operator==(FrenetMemory const&, FrenetMemory const&) = default;
};

/// Plans by sampling courses in the Frenet frames of its lane and the lanes beside it. A course is a quintic polynomial
/// across the lane and a quartic or quintic one along it, to one of several speeds or to a place behind the leader,
/// over one of several durations. The planner drives the cheapest course that is drivable, stays on the road, stops
/// where signals (`Signals`) and the right of way (`Conflicts`) ask for it, and keeps clear of the others, whose motion
/// it predicts once as `Others`. If there is none, it drives the cheapest that touches nobody, else it brakes.
/// `PredictionWorld` must have `Others` in its behaviour set. With own `terms`, all courses are checked, and the sum of
/// the terms over a valid course is deducted from its cost.
///
/// The candidates of its report are the courses, cheapest first without `terms`; a score is a negative cost. In the
/// frames of the report's course, ego's memory is that of the start.
template <class PredictionWorld, class Others = ConstantAcceleration, SearchBudget Budget = NoBudget,
          class Own = Terms<>>
struct FrenetPlanner {
  static_assert(detail::check_planner<PredictionWorld, Others>() && detail::check_terms<Own>());

  using World = PredictionWorld;
  using Memory = FrenetMemory;
  using Report = CandidateReport<World, Memory, FrenetCandidate>;

  /// Also holds a prediction of the other agents, made once: it does not depend on what ego does.
  struct Workspace : CandidateWorkspace<World, FrenetCandidate> {
    std::vector<typename World::FrameType> frames;  ///< now and after each step
    std::vector<geometry::OrientedBox> boxes;       ///< of the agents in `to_avoid`, step by step
    std::vector<Slot> to_avoid;                     ///< agents that ego has to keep clear of, see `agents_to_avoid`
    std::vector<FrenetTarget> targets;
    typename World::FrameType frame;
    double free_way{};  ///< to where it has to stop for a signal or another's right of way [m]

    /// Steps the world for `time` [s] in steps of `length` [s].
    void predict_others(double time, double length) {
      auto& predicted = *this->world;
      agents_to_avoid(predicted.roster(), this->start, this->ego, to_avoid);
      auto const steps = static_cast<std::size_t>(std::max(1L, std::lround(time / length)));
      frames.resize(steps + 1);
      boxes.clear();
      for (std::size_t k = 0; k <= steps; ++k) {
        if (k > 0) (void)predicted.step(length);
        frames[k] = predicted.frame();
        for (auto const i : to_avoid) {
          auto box = box_at(predicted, i);
          if (!in_traffic(predicted, i)) box.half_length = -1e9;  // touches nobody
          boxes.push_back(box);
        }
      }
    }

    /// Whether `box` touches an object, or, after step `k`, an agent in `to_avoid`. O(agents + objects).
    [[nodiscard]] bool touched(geometry::OrientedBox const& box, std::size_t k) const {
      for (std::size_t i = 0; i < to_avoid.size(); ++i)
        if (geometry::intersects(box, boxes[k * to_avoid.size() + i])) return true;
      return std::ranges::any_of(this->world->roster().objects,
                                 [&](auto const& object) { return geometry::intersects(box, object.outline); });
    }
  };

  // Not lists in braces: g++ 12 takes these for uninitialised at -O2.
  static constexpr double usual_speed_shares[] = {1.0, 0.8, 0.6, 0.4, 0.2, 0.0},
                          usual_durations[] = {2.0, 3.0, 4.0, 5.0}, usual_offsets[] = {0.0, -0.7, 0.7};

  Others others{};
  double desired_speed = 15.0;
  boost::container::static_vector<double, 16> speed_shares{std::begin(usual_speed_shares),
                                                           std::end(usual_speed_shares)};
  boost::container::static_vector<double, 8> durations{std::begin(usual_durations), std::end(usual_durations)};
  boost::container::static_vector<double, 8> offsets{std::begin(usual_offsets), std::end(usual_offsets)};
  FrenetCosts costs{};
  FrenetLimits limits{};
  double minimum_gap = 2.0;
  double time_headway = 1.2;
  double horizon = 5.0;
  double step = 0.2;
  double low_speed = 4.0;
  double route_horizon = 300.0;
  double room_to_change = 32.0;
  double comfortable_deceleration = 2.0;
  Budget budget{};
  Own terms{};
  Signals signals{};
  Conflicts conflicts{};
  double safe_deceleration = 4.0;

  static constexpr bool heeds_conflicts = true;
  static constexpr char const* name = "frenet_planner";
  static constexpr char const* summary =
      "samples quintic courses in the Frenet frames of its lane and the lanes beside it, and drives the cheapest valid "
      "one";
  static constexpr char const* source = "Werling, Ziegler, Kammel, Thrun 2010";
  static constexpr auto parameters() {
    using P = FrenetPlanner;
    return parameter_list(
        parameter("others", &P::others, "how the others are expected to behave"),
        parameter("desired_speed", &P::desired_speed, "m/s", Range{0.1, 100}, "on a free road"),
        parameter("speed_shares", &P::speed_shares, "-", Range{0, 2},
                  "shares of the desired speed that courses end with"),
        parameter("durations", &P::durations, "s", Range{0.5, 30},
                  "of the polynomials; then a course keeps its speed and offset"),
        parameter("offsets", &P::offsets, "m", Range{-10, 10}, "from the lane's middle, at which courses end"),
        parameter("costs", &P::costs, "weights that make a course cheap"),
        parameter("limits", &P::limits, "what makes a course valid"),
        parameter("minimum_gap", &P::minimum_gap, "m", Range{0, 100}, "gap to a standing leader"),
        parameter("time_headway", &P::time_headway, "s", Range{0, 20}, "additional gap to a moving leader"),
        parameter("horizon", &P::horizon, "s", Range{0.1, 60}, "time for which courses are checked"),
        parameter("step", &P::step, "s", Range{0.01, 2}, "time between two checks"),
        parameter("low_speed", &P::low_speed, "m/s", Range{0.1, 50},
                  "below this speed, offsets depend on the distance driven"),
        parameter("route_horizon", &P::route_horizon, "m", Range{1, 10'000},
                  "length for each lane change still needed over which its cost grows"),
        parameter("room_to_change", &P::room_to_change, "m", Range{0, 1000},
                  "kept for each lane change still needed where it must stop before the end of a lane"),
        parameter("comfortable_deceleration", &P::comfortable_deceleration, "m/s^2", Range{0.1, 20},
                  "with which it stops for rules; at the end of a lane twice that"),
        parameter("budget", &P::budget, "how many courses are checked, the cheapest first"),
        parameter("terms", &P::terms, "evaluators whose sum over a course is deducted from its cost"),
        parameter("signals", &P::signals, "how it stops at lights and stop signs"),
        parameter("conflicts", &P::conflicts, "how it gives way"),
        parameter("safe_deceleration", &P::safe_deceleration, "m/s^2", Range{0, 50},
                  "it enters no lane where a follower would have to brake harder"));
  }

  void check(std::string const& where) const {
    if (speed_shares.empty() || durations.empty() || offsets.empty())
      throw ParameterError(where, "has no speed share, duration or offset", "give at least one of each");
    detail::refuse_costs(terms, where);
  }

  template <class View>
  [[nodiscard]] Plan<View> plan(View const& view, Memory& memory, double dt, Workspace& workspace) const {
    return plan_by_candidates(*this, view, memory, dt, workspace);
  }

  /// See `PlannerModel`. Unlike `plan`, it checks all courses.
  template <class View>
  [[nodiscard]] Report think(View const& view, Memory const& memory, Workspace& workspace) const {
    return think_by_candidates(*this, view, memory, workspace);
  }

  /// See `CandidatePlanner`, also for `drive`, `foresee` and `entry`. It chooses the first valid course, or with
  /// `terms` or for a report the best of the valid ones.
  template <class View>
  [[nodiscard]] SearchProblem compare(View const& view, Memory const& memory, Workspace& workspace,
                                      Budget& clock) const {
    if (!workspace.predict(view, others, others)) return SearchProblem::not_in_world;
    workspace.predict_others(horizon, step);
    auto known = memory;
    workspace.free_way = free_way(view, known, step);
    auto& candidates = workspace.candidates;
    auto const& at = view.place();
    auto const& piece = view.corridor().pieces[at.piece];
    for (auto const number : {at.corridor, piece.left, piece.right})
      if (number != none<CorridorId>) sample_lane(view, number, memory, workspace);
    for (auto& candidate : candidates)
      if (std::isnan(candidate.cost)) candidate.cost = std::numeric_limits<double>::infinity();
    detail::stable_sort(candidates, &FrenetCandidate::cost);
    bool const all = has_terms || workspace.shows_all;
    auto& best = workspace.chosen;
    std::optional<std::size_t> close;
    for (std::size_t i = 0; i < candidates.size() && (all || !best) && workspace.goes_on(clock, i); ++i) {
      auto& found = candidates[i].verdict;
      if (found == FrenetVerdict::unchecked) found = verdict(view, candidates[i], workspace);
      if (found == FrenetVerdict::close && !close) close = i;
      if (found != FrenetVerdict::valid) continue;
      if constexpr (has_terms) {
        candidates[i].cost -= sum_of_terms(view, candidates[i], workspace);
        if (!std::isfinite(candidates[i].cost)) found = FrenetVerdict::not_finite;
        if (found != FrenetVerdict::valid) continue;
      }
      if (!best || candidates[i].cost < candidates[*best].cost) best = i;
    }
    if (!best) best = close;  // rather than to brake on beside somebody
    return SearchProblem::none;
  }

  template <class View>
  [[nodiscard]] Plan<View> drive(View const& view, Memory& memory, double dt, Workspace const& workspace) const {
    static_cast<void>(free_way(view, memory, dt));  // remembers where it has waited
    if (!workspace.chosen) {
      memory.acceleration = static_cast<float>(view.state().speed > 0.0 ? limits.lowest_acceleration : 0.0);
      memory.curvature = 0.0f;
      return brake(view, dt);
    }
    auto const& candidate = workspace.candidates[*workspace.chosen];
    Plan<View> plan;
    int const parts = std::max(1, static_cast<int>(std::ceil(dt / step - 1e-9)));
    for (int i = 1; i <= parts; ++i) {
      auto const driven = state_at(view, candidate, dt * i / parts);
      plan.trajectory.push_back(driven.state);
      memory.acceleration = static_cast<float>(driven.course.acceleration);
      memory.curvature = static_cast<float>(driven.course.curvature);
    }
    plan.action.acceleration = (plan.trajectory.front().speed - view.state().speed) * parts / dt;
    return plan;
  }

  template <class View>
  [[nodiscard]] auto foresee(View const& view, Memory const&, Workspace const& workspace,
                             std::optional<std::size_t> candidate) const {
    workspace.check_foreseen(view, candidate);
    auto course = workspace.frames;
    if (!candidate) candidate = workspace.chosen;
    replace_course(*workspace.world, workspace.ego, course, [&](std::size_t k) {
      double const time = static_cast<double>(k) * step;
      return candidate ? state_at(view, workspace.candidates[*candidate], time).state
                       : brake(view, time).trajectory.back();
    });
    return course;
  }

  /// See `CandidatePlanner`.
  [[nodiscard]] static bool begin_alike(FrenetCandidate const& a, FrenetCandidate const& b) {
    return a.corridor == b.corridor && a.kind == b.kind && a.speed == b.speed;
  }

  /// "follow in 3 s, 12 m/s at 0.7 m, left lane".
  template <class View>
  [[nodiscard]] PlannerCandidate entry(View const& view, Workspace const& workspace, FrenetCandidate const& c) const {
    auto const& piece = view.corridor().pieces[view.place().piece];
    std::string words = c.kind == FrenetCandidate::Kind::follow ? "follow" : "keep speed";
    words += " in " + detail::rounded_text(c.duration) + " s, " + detail::rounded_text(c.speed) + " m/s at " +
             detail::rounded_text(c.offset) + " m";
    if (c.corridor != view.place().corridor) words += c.corridor == piece.left ? ", left lane" : ", right lane";
    if (c.tight) words += ", tight";
    bool const is_driven = workspace.chosen && workspace.candidates[*workspace.chosen].verdict == c.verdict;
    return {words, -c.cost, is_driven || c.verdict == FrenetVerdict::valid ? "" : to_string(c.verdict)};
  }

 private:
  static constexpr double look_ahead = 150.0;   ///< for signals [m]
  static constexpr double least_to_turn = 1.0;  ///< sideways, for which it also tries to steer as hard as it can [m]
  static constexpr bool has_terms = !std::is_same_v<Own, Terms<>>;

  /// A state on a course, with its motion along the course and in the Frenet frame.
  template <class State>
  struct Driven {
    State state;
    CourseMotion<double> course;
    FrenetMotion<double> frenet;
  };

  /// How far it may drive before it has to stop by the rules [m].
  template <class View>
  [[nodiscard]] double free_way(View const& view, Memory& memory, double dt) const {
    Idm const law{.desired_speed = desired_speed,
                  .time_headway = time_headway,
                  .minimum_gap = minimum_gap,
                  .comfortable_deceleration = comfortable_deceleration,
                  .lowest_acceleration = limits.lowest_acceleration};
    Limits<Idm> rules(law, std::max(0.0, view.state().speed), desired_speed);
    double const signal = signals.free_way(view, memory.signals, look_ahead);
    rules.is_at_light = std::isfinite(signal) && view.state().speed < standing_speed;
    conflicts.heed(view, memory.conflicts, rules, dt);
    return std::max(0.0, std::min(signal, rules.place_to_wait.distance));
  }

  /// The plan for the next `dt` [s] if no course is valid: it brakes and returns to the middle of its lane.
  template <class View>
  [[nodiscard]] Plan<View> brake(View const& view, double dt) const {
    float bend = 0.0f;
    double const speed = std::max(0.0, view.state().speed);
    return plan_to_center(view, bend, ConstantAcceleration{limits.lowest_acceleration}.motion(speed, dt), dt);
  }

  template <class View>
  void sample_lane(View const& view, CorridorId number, Memory const& memory, Workspace& workspace) const {
    auto const at = view.place(number);
    if (std::abs(at.heading_error) > detail::most_aslant) return;
    auto const& corridor = view.road().corridors[number];
    CourseMotion<double> const now{at.heading_error, static_cast<double>(memory.curvature),
                                   std::max(0.0, view.state().speed), static_cast<double>(memory.acceleration)};
    auto const start = frenet_motion(now, at.s, at.lateral, {corridor.center.segments()[at.segment].curvature, 0.0});
    double const end = lane_end(view, number, at.piece);
    int lanes = view.has_goal() ? lanes_to_destination(view.road(), number, at.piece) : 0;
    double way = end - at.s;
    if (number == view.place().corridor)
      if (double const free = detail::free_until_parked(view); std::isfinite(free)) {
        lanes += 2;  // there and back
        way = std::min(way, free);
      }
    double const closeness = lanes > 0 ? std::clamp(1.0 - way / (lanes * route_horizon), 0.0, 1.0) : 0.0;
    double const route = costs.route * lanes * (1.0 + costs.route_urgency * closeness);
    double const wanted =
        std::min(desired_speed, detail::permitted_speed(corridor, at.s, now.speed, comfortable_deceleration));
    constexpr double late = 2.0;  // who slows down early is too slow for the lane beside
    double fastest = wanted;
    auto stop = std::numeric_limits<double>::infinity();
    if (std::isfinite(end) && is_dead_end(corridor, end)) {
      double const last = end - view.shape().front - minimum_gap;
      stop = last - lanes * room_to_change;
      if (number != view.place().corridor)
        stop = std::max(stop, std::min(last, at.s + room_to_change));  // else it waits
      if (!corridor.reaches_destination)
        fastest = std::min(wanted, std::sqrt(2.0 * late * comfortable_deceleration * std::max(0.0, stop - at.s)));
    }
    if (at.s + workspace.free_way < stop) {
      stop = at.s + workspace.free_way;
      fastest = std::min(fastest, std::sqrt(2.0 * comfortable_deceleration * workspace.free_way));
    }
    if (lanes > 0)
      fastest = std::min(fastest, speed_to_change(view, corridor.pieces[at.piece], lanes) +
                                      std::max(0.0, 1.0 - 2.0 * closeness) * desired_speed);
    auto const known = may_enter(view, number) ? FrenetVerdict::unchecked : FrenetVerdict::follower;
    for (double const duration : durations) {
      set_targets(view, number, at, fastest, fastest < wanted, stop, duration, workspace);
      for (auto const& target : workspace.targets)
        for (double const offset : offsets)
          for (bool const tight : {false, true}) {
            bool const turns =
                std::min(start.speed, target.speed) < low_speed && std::abs(offset - start.offset) > least_to_turn;
            if (tight && !turns) continue;
            auto& c = workspace.candidates.emplace_back(
                frenet_candidate(start, target, offset, duration, wanted, low_speed, costs, tight));
            c.corridor = number;
            c.cost += route;
            c.verdict = known;
          }
    }
  }

  /// How fast to drive at most in order to change lanes soon [m/s]: so that it may slow down to the next one in a lane
  /// beside that leads to the destination, or around one that is parked, and slower than those who are beside there.
  /// From `piece` it needs `lanes` changes. Those who stand do not count. Infinite if nobody is there.
  template <class View, class Piece>
  [[nodiscard]] double speed_to_change(View const& view, Piece const& piece, int lanes) const {
    constexpr double infinite = std::numeric_limits<double>::infinity();
    constexpr double close = 0.3, slower = 3.0;  // [s], [m/s]
    double const enough = minimum_gap + close * std::max(0.0, view.state().speed);
    auto const moves = [](std::optional<RoadUser> const& user) {
      return user && is_valid(user->agent) && user->speed >= standing_speed;
    };
    double fastest = 0.0;
    bool is_known = false;
    for (auto const side : {piece.left, piece.right}) {
      if (side == none<CorridorId>) continue;
      auto const there = view.place(side);
      if (lanes_to_destination(view.road(), side, there.piece) >= lanes) continue;
      double there_fastest = infinite;
      Look const look{.merging = Merging::by_rule};
      auto const slowed_to = [&](double speed) { there_fastest = std::min(there_fastest, std::max(0.0, speed)); };
      if (auto const next = view.ahead(there, look); moves(next)) {
        double const spare = next->gap - enough;
        slowed_to(spare < 0.0 ? next->speed - slower
                              : std::sqrt(next->speed * next->speed + 2.0 * comfortable_deceleration * spare));
      }
      if (auto const rear = view.behind(there, look); moves(rear) && rear->gap < enough)
        slowed_to(rear->speed - slower);
      fastest = std::max(fastest, there_fastest);
      is_known = true;
    }
    return is_known ? fastest : infinite;
  }

  /// Whether no follower on a corridor has to brake hard for ego. It is assumed to drive by `Acc`: by IDM, which brakes
  /// hard for gaps that people accept, dense traffic has none. Who is beside is left to the check for collisions.
  template <class View>
  [[nodiscard]] bool may_enter(View const& view, CorridorId number) const {
    if (number == view.place().corridor) return true;
    auto const rear = view.behind(view.place(number), {.merging = Merging::by_rule});
    if (!rear || !is_valid(rear->agent) || !(rear->gap > 0.0)) return true;
    double const speed = std::max(0.0, rear->speed), desired = std::max(Acc{}.desired_speed, speed);
    return Acc{}.acceleration(speed, desired, {rear->gap, std::max(0.0, view.state().speed)}) >= -safe_deceleration;
  }

  /// Behind whom it would drive on a corridor. Those that merge in a junction are no leaders: where they are, and where
  /// they will be, counts.
  template <class View>
  [[nodiscard]] static std::optional<RoadUser> leader_of(View const& view, CorridorId number) {
    return view.ahead(view.place(number), {.merging = Merging::by_rule});
  }

  /// Sets the targets of courses of `duration` [s]: speeds up to `fastest` [m/s]; a place behind the leader, unless ego
  /// is slowed below its speed for something else; and `stop` [m] if it is finite.
  template <class View>
  void set_targets(View const& view, CorridorId number, map::LanePlace const& at, double fastest, bool is_slowed,
                   double stop, double duration, Workspace& workspace) const {
    constexpr double rounding = 0.1;  // [m/s]
    auto& targets = workspace.targets;
    targets.clear();
    for (double const share : speed_shares)
      targets.push_back({std::numeric_limits<double>::infinity(), share * fastest});
    if (auto const leader = leader_of(view, number)) {
      auto const place = behind(workspace, *leader, at.s, duration);
      if (!is_slowed || place.speed <= fastest + rounding) targets.push_back(place);
    }
    if (std::isfinite(stop)) targets.push_back({stop, 0.0});
  }

  /// The place and speed at which ego follows `leader` with the desired gap, `time` [s] from now.
  [[nodiscard]] FrenetTarget behind(Workspace const& workspace, RoadUser const& leader, double s, double time) const {
    double const contact = s + leader.gap;
    auto const slot = workspace.world->roster().slot_of(leader.agent);
    if (!slot) return {contact - minimum_gap, 0.0};
    auto const& frames = workspace.frames;  // beyond the last one the leader keeps its speed
    double way = 0.0, speed = frames[0].agents[*slot].state.speed, left = time;
    for (std::size_t k = 1; k < frames.size() && left > 0.0; ++k, left -= step) {
      double const next = frames[k].agents[*slot].state.speed;
      way += 0.5 * (speed + next) * std::min(step, left);
      speed = next;
    }
    way += speed * std::max(0.0, left);
    return {contact + way - minimum_gap - time_headway * speed, speed};
  }

  template <class View>
  [[nodiscard]] Driven<typename View::State> state_at(View const& view, FrenetCandidate const& candidate,
                                                      double time) const {
    auto const& corridor = view.road().corridors[candidate.corridor];
    auto const frenet = candidate.at(time);
    auto hint = view.place(candidate.corridor).segment;
    auto const& segment = corridor.center.segment_at(frenet.s, hint);
    auto const course = course_motion(frenet, {segment.curvature, 0.0});
    auto state = view.state();
    place_on_lane(corridor, frenet.s, frenet.offset, course.heading_error, hint, state);
    state.time = view.time() + time;
    state.speed = std::max(0.0, course.speed);
    return {state, course, frenet};
  }

  template <class View>
  [[nodiscard]] FrenetVerdict verdict(View const& view, FrenetCandidate const& candidate,
                                      Workspace const& workspace) const {
    if (!std::isfinite(candidate.cost)) return FrenetVerdict::not_finite;
    if (candidate.kind == FrenetCandidate::Kind::keep_speed && comes_too_near(view, candidate, workspace))
      return FrenetVerdict::gap;
    constexpr double rounding = 0.1;  // [m]
    double const line = view.place(candidate.corridor).s + workspace.free_way + rounding;
    bool is_close = false;
    auto record = workspace.frames[0].agents[workspace.ego];
    double const fastest = std::max(view.state().speed, 1.1 * desired_speed) + 0.1;
    for (std::size_t k = 1; k < workspace.frames.size(); ++k) {
      auto const driven = state_at(view, candidate, static_cast<double>(k) * step);
      auto const verdict = drivable(limits, driven.course, driven.frenet, fastest);
      if (verdict != FrenetVerdict::valid) return verdict;
      if (driven.frenet.s > line) return FrenetVerdict::stop;
      record = driven_to(*workspace.world, workspace.ego, record, driven.state);
      if (record.status == AgentStatus::off_route) return FrenetVerdict::road;
      if (record.status == AgentStatus::driving &&
          (OffRoad::leaves(view.map(), view.road(), record.lane, record.state, view.shape()) ||
           OncomingLane::enters(view.map(), view.road(), record.lane, record.state, view.shape())))
        return FrenetVerdict::road;
      auto const box = geometry::box_of(view.shape(), driven.state);
      auto grown = box;
      grown.half_length += limits.clearance;
      grown.half_width += limits.clearance;
      if (!workspace.touched(grown, k)) continue;
      if (workspace.touched(box, k)) return FrenetVerdict::collision;
      is_close = true;
    }
    return is_close ? FrenetVerdict::close : FrenetVerdict::valid;
  }

  /// The sum of the terms over a course; not finite if one of them is not.
  template <class View>
  [[nodiscard]] double sum_of_terms(View const& view, FrenetCandidate const& candidate, Workspace& workspace) const {
    auto& world = *workspace.world;
    auto record = workspace.frames[0].agents[workspace.ego];
    double sum = 0.0;
    for (std::size_t k = 1; k < workspace.frames.size(); ++k) {
      record = driven_to(world, workspace.ego, record, state_at(view, candidate, static_cast<double>(k) * step).state);
      workspace.frame = workspace.frames[k];
      workspace.frame.agents[workspace.ego] = record;
      world.restore(workspace.frame);
      auto const judged = terms.judge(world, workspace.ego, step);
      sum += judged.reward;
      if (judged.ends) break;
    }
    return sum;
  }

  /// Whether the course ends nearer to the leader than following would, and the leader leaves no room to pass.
  template <class View>
  [[nodiscard]] bool comes_too_near(View const& view, FrenetCandidate const& candidate,
                                    Workspace const& workspace) const {
    auto const leader = leader_of(view, candidate.corridor);
    if (!leader) return false;
    double const s = view.place(candidate.corridor).s;
    if (candidate.at(horizon).s <= behind(workspace, *leader, s, horizon).position) return false;
    return !leaves_room(view, candidate.corridor, *leader, candidate.offset, limits.clearance);
  }
};

}  // namespace cambium::inline v0_1
