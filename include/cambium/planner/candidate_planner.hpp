#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <optional>
#include <variant>
#include <vector>

#include "cambium/behavior/behavior_model.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/planner/planner_model.hpp"
#include "cambium/planner/predicted.hpp"
#include "cambium/planner/search/search_result.hpp"

namespace cambium::inline v0_1 {

/// What a planner that compares candidates works with. The planner's own `Workspace` may derive from it.
template <class World, class Candidate>
struct CandidateWorkspace {
  using Frame = typename World::FrameType;

  std::optional<World> world;         ///< the predicted one
  Frame start;                        ///< its frame now
  Slot ego{};                         ///< in that world
  std::vector<Candidate> candidates;  ///< in the order of preference
  std::optional<std::size_t> chosen;  ///< among the candidates; empty: ego brakes
  bool is_cut_short = false;          ///< the budget has ended
  bool shows_all = false;             ///< for a report; a plan needs no candidate but the chosen one

  /// Begins to plan for the agent of `view`: it behaves as `behavior` in the predicted world, all others as `others`.
  /// Returns false if it is not in traffic. O(agents).
  template <class View, class Ego, class Others>
  [[nodiscard]] bool predict(View const& view, Ego const& behavior, Others const& others) {
    std::optional<Slot> slot;
    world = predicted_for<World>(view, behavior, others, slot);
    if (!slot) return false;
    ego = *slot;
    detail::expect_to_brake_on(*world, ego, others);
    start = world->frame();
    candidates.clear();
    chosen.reset();
    is_cut_short = false;
    return true;
  }

  /// The world to whose agents the frames of `foresee` belong. Throws `SearchError` before the first plan.
  [[nodiscard]] World const& predicted() const {
    if (!world) throw SearchError("workspace", "nothing has been planned yet", "call `think` first");
    return *world;
  }

  /// Throws as `PlannerModel` says of `foresee`, of the agent of `view`.
  template <class View>
  void check_foreseen(View const& view, std::optional<std::size_t> candidate) const {
    detail::check_foreseen(predicted().roster().agents[ego].id, view.id(), candidate, candidates.size());
  }

  /// How many candidates it has compared.
  [[nodiscard]] std::size_t compared() const { return candidates.size(); }

  /// Whether the budget lasts for another candidate after `done` of them; it always lasts for the first one.
  template <class Budget>
  [[nodiscard]] bool goes_on(Budget& clock, std::size_t done) {
    is_cut_short = is_cut_short || (done > 0 && !clock.goes_on(done));
    return !is_cut_short;
  }

  /// Steps the world `steps` times by `step` [s] until `judge(k)`, called after step k, says that ego's course is over.
  /// With a `course`, the world goes on to the horizon, and all its frames are appended. O(steps).
  template <class Judge>
  void simulate(int steps, double step, std::vector<Frame>* course, Judge&& judge) {
    bool goes_on = true;
    for (int k = 0; k < steps && (goes_on || course != nullptr); ++k) {
      (void)world->step(step);
      if (course != nullptr) course->push_back(world->frame());
      goes_on = goes_on && judge(k);
    }
  }

  /// The plan for the next `dt` [s]: what ego does in the predicted world, in equal steps of at most `step` [s]; where
  /// it has left traffic there, straight on at its speed. Ego's behaviour there must be `Model`; its memory is read
  /// into `memory`. O(steps).
  template <class Model, class View>
  [[nodiscard]] Plan<View> drive(View const&, double dt, double step, MemoryOf<Model>& memory) {
    Plan<View> plan;
    auto const steps = std::max(1, static_cast<int>(std::ceil(dt / step - 1e-9)));
    double const begin = world->time();
    for (int i = 0; i < steps; ++i) {
      auto const was = world->frame().agents[ego].status;
      (void)world->step(dt / steps);
      auto const& record = world->frame().agents[ego];
      if (i == 0) plan.action = record.action;
      auto next = record.state;
      if (i > 0 && was != AgentStatus::driving && was != AgentStatus::failed) {
        next = plan.trajectory.back();
        auto const along = portable::sin_cos(next.heading);
        next.x += next.speed * dt / steps * along.cos;
        next.y += next.speed * dt / steps * along.sin;
      }
      plan.trajectory.push_back(next);
      plan.trajectory.back().time = i + 1 == steps ? begin + dt : world->time();
    }
    auto const* const after = std::get_if<World::Behaviors::template index<Model>>(&world->frame().agents[ego].memory);
    CAMBIUM_ASSERT(after != nullptr, "CandidateWorkspace::drive: ego's behaviour in the predicted world is no Model");
    memory = *after;
    return plan;
  }
};

/// What a planner of candidates reports.
template <class World, class Memory, class Candidate>
struct CandidateReport : PlannerReport<World, Memory> {
  std::vector<Candidate> details;  ///< of each candidate: what only this planner knows
};

/// A planner that compares candidates, from which `plan_by_candidates` and `think_by_candidates` make `plan` and
/// `think`. It has `step` [s], a `budget`, a `Workspace` and a `Report` (`CandidateWorkspace`, `CandidateReport`), and
///
/// - `compare(view, memory, workspace, clock)`: predicts, and fills in `candidates`, as many as the clock permits, and
///   `chosen`. `clock` is a copy of `budget` that has been started; ask `workspace.goes_on(clock, done)` before each
///   candidate.
/// - `drive(view, memory, dt, workspace)`: the plan for the next `dt` [s] by the chosen candidate, and the memory then.
///   It brakes if none is chosen.
/// - `foresee(view, memory, workspace, candidate)`: the frames of all agents, now and after each `step`, if ego drives
///   that candidate; without one, if it drives as chosen.
/// - `entry(view, workspace, candidate)`: the candidate in words, its score, and why it may not be driven;
/// - optionally `begin_alike(a, b)`: whether two candidates are the same for now, see `PlannerReport::decidedness`.
template <class P, class View>
concept CandidatePlanner = requires(P const planner, View const& view, typename P::Memory& memory,
                                    typename P::Workspace& workspace, decltype(P::budget)& clock) {
  { planner.compare(view, memory, workspace, clock) } -> std::same_as<SearchProblem>;
  { planner.drive(view, memory, planner.step, workspace) } -> std::same_as<Plan<View>>;
  {
    planner.foresee(view, memory, workspace, std::optional<std::size_t>())
    } -> std::same_as<decltype(P::Report::course)>;
  { planner.entry(view, workspace, workspace.candidates[0]) } -> std::same_as<PlannerCandidate>;
};

/// The `plan` of a planner of candidates: what it does in the next `dt` [s]. O(candidates compared).
template <class Planner, class View>
[[nodiscard]] Plan<View> plan_by_candidates(Planner const& planner, View const& view, typename Planner::Memory& memory,
                                            double dt, typename Planner::Workspace& workspace) {
  if constexpr (detail::Predicts<View, typename Planner::World>) {
    static_assert(CandidatePlanner<Planner, View>,
                  "cambium::plan_by_candidates: the planner needs compare, drive, foresee and entry, see "
                  "CandidatePlanner");
    auto clock = planner.budget;
    clock.start();
    workspace.shows_all = false;
    if (planner.compare(view, memory, workspace, clock) == SearchProblem::none)
      return planner.drive(view, memory, dt, workspace);
  }
  Plan<View> failed;
  failed.status = PlanStatus::failed;
  return failed;
}

/// The `think` of a planner of candidates, see `PlannerModel`. O(candidates compared).
template <class Planner, class View>
[[nodiscard]] typename Planner::Report think_by_candidates(Planner const& planner, View const& view,
                                                           typename Planner::Memory const& memory,
                                                           typename Planner::Workspace& workspace) {
  static_assert(CandidatePlanner<Planner, View>,
                "cambium::think_by_candidates: the planner needs compare, drive, foresee and entry, see "
                "CandidatePlanner");
  check_parameters(planner);
  auto clock = planner.budget;
  clock.start();
  workspace.shows_all = true;
  throw_if(planner.compare(view, memory, workspace, clock));
  typename Planner::Report report;
  report.details = workspace.candidates;
  report.chosen = workspace.chosen;
  report.is_cut_short = workspace.is_cut_short;
  for (auto const& candidate : workspace.candidates)
    report.candidates.push_back(planner.entry(view, workspace, candidate));
  report.decidedness = decidedness(report.candidates, report.chosen, [&](std::size_t number) {
    auto const& all = workspace.candidates;
    if constexpr (requires { planner.begin_alike(all[number], all[number]); })
      return !planner.begin_alike(all[number], all[*report.chosen]);
    else
      return true;
  });
  report.agents = detail::ids_of(*workspace.world);
  report.course = planner.foresee(view, memory, workspace, {});
  report.memory = memory;
  (void)planner.drive(view, report.memory, planner.step, workspace);
  return report;
}

}  // namespace cambium::inline v0_1
