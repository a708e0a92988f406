#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <boost/container/static_vector.hpp>

#include "cambium/behavior/actions/idm_proposal.hpp"
#include "cambium/behavior/open_loop/constant_acceleration.hpp"
#include "cambium/core/constants.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/evaluation/driving.hpp"
#include "cambium/evaluation/terms.hpp"
#include "cambium/planner/candidate_planner.hpp"
#include "cambium/planner/search/search_budget.hpp"

namespace cambium::inline v0_1 {

/// How a `ProposalPlanner` scores a proposal: the weights of its marks, and the limits of comfort.
struct ProposalScoring {
  double progress = 5.0;
  double time_to_collision = 5.0;
  double speed_limit = 4.0;
  double comfort = 2.0;
  double route = 20.0;
  double look_ahead = 0.9;
  double lowest_acceleration = -comfort_deceleration;
  double highest_acceleration = comfort_acceleration;
  double lateral_acceleration = comfort_lateral_acceleration;
  double jerk = 8.37;
  double indifference = 0.01;

  static constexpr char const* name = "proposal_scoring";
  static constexpr char const* summary =
      "0 if it collides by its own fault or leaves the road, else the weighted mean of its marks, each from 0 to 1";
  static constexpr char const* source = "Dauner et al. 2023; Karnchanachari et al. 2024 (nuPlan)";
  static constexpr auto parameters() {
    using P = ProposalScoring;
    return parameter_list(
        parameter("progress", &P::progress, "-", non_negative,
                  "weight of the distance along the lane, relative to the longest"),
        parameter("time_to_collision", &P::time_to_collision, "-", non_negative,
                  "weight of no collision within look_ahead"),
        parameter("speed_limit", &P::speed_limit, "-", non_negative, "weight of the share of time within the limit"),
        parameter("comfort", &P::comfort, "-", non_negative, "weight of staying within the limits below"),
        parameter("route", &P::route, "-", non_negative, "weight of being in a lane that leads to the destination"),
        parameter("look_ahead", &P::look_ahead, "s", Range{0, 10},
                  "time to collision is tested this far, at constant velocities"),
        parameter("lowest_acceleration", &P::lowest_acceleration, "m/s^2", Range{-50, 0}, "limit of comfort"),
        parameter("highest_acceleration", &P::highest_acceleration, "m/s^2", Range{0, 50}, "limit of comfort"),
        parameter("lateral_acceleration", &P::lateral_acceleration, "m/s^2", Range{0, 50}, "limit of comfort"),
        parameter("jerk", &P::jerk, "m/s^3", non_negative, "limit of comfort, along the course"),
        parameter("indifference", &P::indifference, "-", Range{0, 1},
                  "a later proposal in the order of preference must score better by more than this"));
  }

  void check(std::string const& where) const {
    if (!(weights() > 0.0)) throw ParameterError(where, "has no weight above 0", "give one");
  }

  /// Their sum.
  [[nodiscard]] double weights() const { return progress + time_to_collision + speed_limit + comfort + route; }
};

/// A proposal and the outcome of its simulation.
struct ProposalScore {
  double speed_share{};                   ///< of the desired speed
  double offset{};                        ///< from the middle of the lane [m]
  CorridorId towards = none<CorridorId>;  ///< lane corridor beside its own into which it changes; none: it stays
  bool left = false;                      ///< that is on the left
  bool changes = false;                   ///< it gets there, or is on the way, before the horizon
  double progress{};                      ///< along the lane [m]
  bool collides = false;
  bool leaves_road = false;
  double time_to_infraction = std::numeric_limits<double>::infinity();  ///< until one of these [s]
  double time_to_collision = 1.0;                                       ///< mark, 0 or 1
  double comfort = 1.0;                                                 ///< mark: share of the time within its limits
  double speed_limit = 1.0;                                             ///< mark: share of the time within the limit
  double route = 1.0;  ///< mark: 1 - the present urgency of a change from the lane where it ends
  double terms{};      ///< sum of the planner's `terms`
  double score{};      ///< total of the marks, 0 to 1, plus `terms`

  [[nodiscard]] bool fails() const { return collides || leaves_road; }
};

/// PDM-Closed (Dauner, Hallgarten, Geiger, Chitta 2023, "Parting with misconceptions about learning-based vehicle
/// motion planning"): simulates IDM drivers at several speeds and offsets from the middle of its lane, closed loop,
/// while the others behave as `Others`. It scores them and drives like the best. It brakes if that one collides or
/// leaves the road within `emergency_time`. Beyond the paper, with `lane_changes`, drivers who change into a lane
/// beside are proposed, too. It drives on at its goal. `PredictionWorld` must have `IdmProposal` and `Others` in its
/// behaviour set. `Own` are a user's own terms, which count beside the marks.
///
/// The candidates of its report are the proposals, in order of preference.
template <class PredictionWorld, class Others = ConstantAcceleration, SearchBudget Budget = NoBudget,
          class Own = Terms<>>
struct ProposalPlanner {
  static_assert(detail::check_planner<PredictionWorld, Others>() && detail::check_terms<Own>());
  static_assert(PredictionWorld::Behaviors::template contains<IdmProposal>,
                "cambium::ProposalPlanner<PredictionWorld>: the behaviour set of PredictionWorld must contain "
                "cambium::IdmProposal, the driver that is simulated");

  using World = PredictionWorld;
  using Memory = IdmProposal::Memory;  ///< the proposal that is driven
  using Report = CandidateReport<World, Memory, ProposalScore>;

  struct Workspace : CandidateWorkspace<World, ProposalScore> {
    std::vector<Slot> to_avoid;  ///< see `agents_to_avoid`
    std::size_t best{};          ///< among the proposals; if it soon fails, none is chosen
  };

  // Not lists in braces: g++ 12 takes these for uninitialised at -O2.
  static constexpr double usual_speed_shares[] = {1.0, 0.8, 0.6, 0.4, 0.2, 0.0}, usual_offsets[] = {0.0, -1.0, 1.0};

  IdmProposal driver{};
  Others others{};
  boost::container::static_vector<double, 8> speed_shares{std::begin(usual_speed_shares), std::end(usual_speed_shares)};
  boost::container::static_vector<double, 8> offsets{std::begin(usual_offsets), std::end(usual_offsets)};
  ProposalScoring scoring{};
  double horizon = 6.0;
  double step = 0.1;
  double emergency_time = 2.0;
  double emergency_deceleration = 6.0;
  bool lane_changes = true;
  Budget budget{};
  Own terms{};

  static constexpr bool heeds_conflicts = true;
  static constexpr char const* name = "proposal_planner";
  static constexpr char const* summary =
      "simulates IDM drivers at several speeds, at lateral offsets and into the lanes beside, and drives like the one "
      "that scores best; brakes if that one soon collides";
  static constexpr char const* source = "Dauner, Hallgarten, Geiger, Chitta 2023 (PDM-Closed)";
  static constexpr auto parameters() {
    using P = ProposalPlanner;
    return parameter_list(
        parameter("driver", &P::driver, "the driver that is simulated"),
        parameter("others", &P::others, "how the others are expected to behave"),
        parameter("speed_shares", &P::speed_shares, "-", Range{0, 2},
                  "shares of the desired speed, in order of preference"),
        parameter("offsets", &P::offsets, "m", Range{-10, 10}, "from the lane's middle, in order of preference"),
        parameter("scoring", &P::scoring, "what makes a proposal good"),
        parameter("horizon", &P::horizon, "s", Range{0.1, 60}, "duration of the simulations"),
        parameter("step", &P::step, "s", Range{0.01, 1}, "time step of the simulations"),
        parameter("emergency_time", &P::emergency_time, "s", non_negative,
                  "it brakes if the best proposal fails sooner than this"),
        parameter("emergency_deceleration", &P::emergency_deceleration, "m/s^2", Range{0.01, 50},
                  "with which it then brakes"),
        parameter("lane_changes", &P::lane_changes, "also proposes to change into the lanes beside, at each speed"),
        parameter("budget", &P::budget, "how many proposals are simulated, in order of preference"),
        parameter("terms", &P::terms, "evaluators whose sum over a proposal is added to its score"));
  }

  void check(std::string const& where) const {
    if (speed_shares.empty() || offsets.empty())
      throw ParameterError(where, "has no speed share or no offset", "give 1 to 8 of each");
    detail::refuse_costs(terms, where);
  }

  template <class View>
  [[nodiscard]] Plan<View> plan(View const& view, Memory& memory, double dt, Workspace& workspace) const {
    return plan_by_candidates(*this, view, memory, dt, workspace);
  }

  /// See `PlannerModel`.
  template <class View>
  [[nodiscard]] Report think(View const& view, Memory const& memory, Workspace& workspace) const {
    return think_by_candidates(*this, view, memory, workspace);
  }

  /// See `CandidatePlanner`.
  [[nodiscard]] static bool begin_alike(ProposalScore const& a, ProposalScore const& b) {
    return a.towards == b.towards && a.speed_share == b.speed_share;
  }

  /// See `CandidatePlanner`, also for `drive`, `foresee` and `entry`.
  template <class View>
  [[nodiscard]] SearchProblem compare(View const& view, Memory const& memory, Workspace& workspace,
                                      Budget& clock) const {
    auto simulated = driver;
    simulated.lateral.leaves_room = driver.lateral.leaves_room && lane_changes;
    if (!workspace.predict(view, simulated, others)) return SearchProblem::not_in_world;
    agents_to_avoid(workspace.world->roster(), workspace.start, workspace.ego, workspace.to_avoid);
    double const urgency_here = LaneChangeUrgency{}.at(view, view.place());
    auto const propose_at = [&](double offset, CorridorId towards, bool left) {
      double const urgency_there = is_valid(towards) ? LaneChangeUrgency{}.at(view, view.place(towards)) : urgency_here;
      for (double const share : speed_shares) {
        if (!workspace.goes_on(clock, workspace.candidates.size())) return;
        auto& proposal = workspace.candidates.emplace_back();
        proposal.speed_share = share;
        proposal.offset = offset;
        proposal.towards = towards;
        proposal.left = left;
        simulate(workspace, proposal, memory, nullptr);
        proposal.route = 1.0 - (proposal.changes ? urgency_there : urgency_here);
      }
    };
    auto const& at = workspace.start.agents[workspace.ego].lane;
    auto const& piece = workspace.world->roster().agents[workspace.ego].road->corridors[at.corridor].pieces[at.piece];
    auto const propose_change = [&](CorridorId towards, bool left) {
      if (lane_changes && is_valid(towards)) propose_at(0.0, towards, left);
    };
    // The change under way first: among equals, it goes on.
    auto const under_way =
        memory.lateral.change.target != at.corridor ? memory.lateral.change.target : none<CorridorId>;
    if (is_valid(under_way)) propose_change(under_way, view.place(under_way).lateral < 0.0);
    for (double const offset : offsets) propose_at(offset, none<CorridorId>, false);
    for (bool const left : {true, false})
      if (piece.beside(left) != under_way && driver.lateral.marks_permit(view, view.place(), left))
        propose_change(piece.beside(left), left);
    return choose(workspace);
  }

  template <class View>
  [[nodiscard]] Plan<View> drive(View const& view, Memory& memory, double dt, Workspace& workspace) const {
    if (!workspace.chosen) return brake(view, memory, dt, workspace);
    begin(workspace, workspace.candidates[*workspace.chosen], memory);
    return workspace.template drive<IdmProposal>(view, dt, step, memory);
  }

  template <class View>
  [[nodiscard]] auto foresee(View const& view, Memory const& memory, Workspace& workspace,
                             std::optional<std::size_t> candidate) const {
    workspace.check_foreseen(view, candidate);
    std::vector course{workspace.start};
    auto again = workspace.candidates[candidate.value_or(workspace.best)];
    simulate(workspace, again, memory, &course);
    if (!candidate && !workspace.chosen)
      replace_course(*workspace.world, workspace.ego, course, [&](std::size_t k) {
        auto after = memory;
        return brake(view, after, static_cast<double>(k) * step, workspace).trajectory.back();
      });
    return course;
  }

  template <class View>
  [[nodiscard]] PlannerCandidate entry(View const&, Workspace const& workspace, ProposalScore const& p) const {
    double const latest = workspace.candidates[workspace.best].time_to_infraction;
    bool const is_acceptable = p.time_to_infraction >= emergency_time && p.time_to_infraction >= latest;
    return {detail::rounded_text(p.speed_share) + " of the desired speed " +
                (is_valid(p.towards) ? p.left ? "to the left" : "to the right"
                                     : "at " + detail::rounded_text(p.offset) + " m"),
            p.score,
            is_acceptable ? ""
            : p.collides  ? "collision"
                          : "off road"};
  }

 private:
  /// An emergency stop over the next `dt` [s], in the lane change or at the offset of the best proposal.
  template <class View>
  [[nodiscard]] Plan<View> brake(View const& view, Memory& memory, double dt, Workspace const& workspace) const {
    auto const motion = ConstantAcceleration{-emergency_deceleration}.motion(std::max(0.0, view.state().speed), dt);
    auto const& proposal = workspace.candidates[workspace.best];
    memory.lateral = lane_memory(workspace, proposal, memory);
    if (memory.lateral.change.active()) return plan_lane_change(view, memory.lateral.change, motion, dt);
    return plan_to_center(view, memory.lateral.change.bend, motion, dt, proposal.offset);
  }

  /// Resets the prediction world to its start, with ego about to drive the proposal.
  void begin(Workspace& workspace, ProposalScore const& proposal, Memory const& memory) const {
    auto& world = *workspace.world;
    world.restore(workspace.start);
    world.template memory<IdmProposal>(world.roster().agents[workspace.ego].id) = {
        static_cast<float>(proposal.speed_share), static_cast<float>(proposal.offset), proposal.towards,
        lane_memory(workspace, proposal, memory), memory.heeds};
  }

  /// The driver's memory with which a proposal begins: a change under way goes on only if it leads where the proposal
  /// does. No rest between changes: whether to change is the planner's choice.
  [[nodiscard]] static IdmProposal::Lateral::Memory lane_memory(Workspace const& workspace,
                                                                ProposalScore const& proposal, Memory const& memory) {
    auto const home = workspace.start.agents[workspace.ego].lane.corridor;
    auto const wanted = is_valid(proposal.towards) ? proposal.towards : home;
    auto lane = memory.lateral;
    if (lane.change.target != wanted || proposal.offset != 0.0)
      lane.change = {none<CorridorId>, 0.0f, lane.change.bend};
    if (!lane.change.active()) lane.rest = 0.0f;
    return lane;
  }

  /// Simulates a proposal until it collides, leaves the road or ends; with a `course`, see `simulate` of its workspace.
  void simulate(Workspace& workspace, ProposalScore& proposal, Memory const& memory,
                std::vector<typename World::FrameType>* course) const {
    auto& world = *workspace.world;
    auto const ego = workspace.ego;
    begin(workspace, proposal, memory);
    int const steps = std::max(1, static_cast<int>(std::lround(horizon / step)));
    int too_fast = 0, driven = 0;
    double last_acceleration = std::numeric_limits<double>::quiet_NaN();  // none yet
    auto before = world.frame().agents[ego];
    workspace.simulate(steps, step, course, [&](int k) {
      auto const& now = world.frame().agents[ego];
      proposal.progress += 0.5 * step * (before.state.speed + now.state.speed) *
                           portable::cos(0.5 * (before.lane.heading_error + now.lane.heading_error));
      auto const own = terms.judge(world, ego, step);
      proposal.terms += own.reward;
      auto const end = course_end(
          world, ego, [&](auto const& predicted, Slot slot) { return collides(predicted, slot, workspace.to_avoid); });
      proposal.collides = end == CourseEnd::collision;
      proposal.leaves_road = end == CourseEnd::off_road;
      if (proposal.fails()) proposal.time_to_infraction = (k + 1) * step;
      if (end != CourseEnd::none || own.ends) return false;
      judge(workspace, before.state, last_acceleration, proposal);
      too_fast += SpeedLimitExcess{}(world, ego) > 1e-3 ? 1 : 0;
      ++driven;
      before = now;
      return true;
    });
    proposal.speed_limit = 1.0 - static_cast<double>(too_fast) / std::max(1, driven);
    auto const& memory_then = world.template memory<IdmProposal>(world.roster().agents[ego].id);
    proposal.changes = is_valid(proposal.towards) && (world.frame().agents[ego].lane.corridor == proposal.towards ||
                                                      memory_then.lateral.change.target == proposal.towards);
  }

  /// Whether ego touches an object, or touched one that it has to avoid in the last step, whoever is to blame.
  [[nodiscard]] static bool collides(World const& world, Slot ego, std::vector<Slot> const& to_avoid) {
    auto const own = motion_at(world, ego);
    return AtFaultCollision{}.among(world, ego, {}) || std::ranges::any_of(to_avoid, [&](Slot other) {
             return in_traffic(world, other) && geometry::intersects(own, motion_at(world, other));
           });
  }

  /// Sets the marks for time to collision and comfort after a step from `before`.
  template <class State>
  void judge(Workspace const& workspace, State const& before, double& last_acceleration,
             ProposalScore& proposal) const {
    auto const& world = *workspace.world;
    auto const ego = workspace.ego;
    auto const& now = world.frame().agents[ego].state;
    AtFaultCollision at_fault;
    for (double const part : {1.0 / 3, 2.0 / 3, 1.0}) {
      at_fault.look_ahead = part * scoring.look_ahead;
      if (now.speed > at_fault.blameless_speed && at_fault.among(world, ego, workspace.to_avoid))
        proposal.time_to_collision = 0.0;
    }
    double const along = (now.speed - before.speed) / step;
    double const across = LateralAcceleration::between(before, now);
    bool const jerks = std::abs(along - last_acceleration) > scoring.jerk * step;  // false in the first step (NaN)
    if (along < scoring.lowest_acceleration || along > scoring.highest_acceleration || jerks ||
        std::abs(across) > scoring.lateral_acceleration)
      proposal.comfort = std::max(0.0, proposal.comfort - step / horizon);  // the last step may reach beyond it
    last_acceleration = along;
  }

  [[nodiscard]] SearchProblem choose(Workspace& workspace) const {
    constexpr double least_progress = 0.1;  // [m] proposals that get no farther all stand
    auto& proposals = workspace.candidates;
    double farthest = 0.0;
    for (auto const& p : proposals)
      if (!p.fails()) farthest = std::max(farthest, p.progress);
    double const weights = scoring.weights();
    workspace.best = 0;
    for (std::size_t i = 0; i < proposals.size(); ++i) {
      auto& p = proposals[i];
      double const progress = farthest > least_progress ? std::clamp(p.progress / farthest, 0.0, 1.0) : 1.0;
      double const sum = scoring.progress * progress + scoring.time_to_collision * p.time_to_collision +
                         scoring.speed_limit * p.speed_limit + scoring.comfort * p.comfort + scoring.route * p.route;
      p.score = (p.fails() ? 0.0 : sum / weights) + p.terms;
      if (!std::isfinite(p.score)) return SearchProblem::not_finite;
      auto const& best = proposals[workspace.best];
      // First whoever stays clear, or fails last; then the better score.
      bool const both_free = std::isinf(p.time_to_infraction) && std::isinf(best.time_to_infraction);
      if (both_free ? p.score > best.score + scoring.indifference : p.time_to_infraction > best.time_to_infraction)
        workspace.best = i;
    }
    if (proposals[workspace.best].time_to_infraction >= emergency_time) workspace.chosen = workspace.best;
    return SearchProblem::none;
  }
};

}  // namespace cambium::inline v0_1
