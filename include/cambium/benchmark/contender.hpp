#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "cambium/behavior/behavior_set.hpp"
#include "cambium/benchmark/detail/prediction_judge.hpp"
#include "cambium/benchmark/detail/run_judge.hpp"
#include "cambium/benchmark/run_result.hpp"
#include "cambium/core/error.hpp"
#include "cambium/core/one_of.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/goal/goal.hpp"
#include "cambium/map/map.hpp"
#include "cambium/planner/planner_model.hpp"
#include "cambium/scenario/scenario_set.hpp"
#include "cambium/viewer/record_world.hpp"
#include "cambium/world/world.hpp"

namespace cambium::inline v0_1 {

/// How a scenario is run.
struct RunOptions {
  double time_step = 0.2;    ///< [s]
  double time_limit = 60.0;  ///< [s]
  /// Longest time that all plans of a run may take together, of the wall clock [s]. A run that exceeds it ends with an
  /// error after that plan. The outcome then depends on the machine.
  double plan_limit = std::numeric_limits<double>::infinity();
  std::string label{};                           ///< of the run, for notes: "merging, scenario 17"
  std::vector<Criterion> fails = usual_fails();  ///< what makes a run no success, besides a collision
  CriterionBounds bounds{};                      ///< of these
};

/// The outcome of a run: its result and times; if it was recorded, also the recording and, after a failure, the
/// snapshot that the contender keeps.
struct Run {
  RunResult result;
  RunTimes times;
  std::optional<Recording> recording;
  std::string snapshot{};  ///< empty: none
  std::string problem{};   ///< why there is no snapshot though one was wanted
};

/// A run in progress, apart from its world.
struct RunPosition {
  std::string contender{};
  AgentId ego = none<AgentId>;
  std::vector<AgentId> controlled{};
  double time_step = 0.2;
  double time_limit = 60.0;

  static constexpr char const* name = "run";
  static constexpr auto parameters() {
    using P = RunPosition;
    return parameter_list(parameter("contender", &P::contender, "who drives"),
                          parameter("ego", &P::ego, "the agent that the run is about"),
                          parameter("controlled", &P::controlled, "further agents that the contender drives"),
                          parameter("time_step", &P::time_step, "s", Range{1e-6, 1e6}, "of the run"),
                          parameter("time_limit", &P::time_limit, "s", Range{0, 1e12}, "of the run"));
  }
};

/// A failed run, for `freeze_run`: the worlds before and after the decisive cycle. That is the cycle that ended the run
/// by an error; without an error, it lies `freeze_lead` before the end, when that could still be averted. `after` is
/// null if the cycle threw an exception, or if the ego collided at the start.
template <class World>
struct FailedRun {
  World const& before;
  World const* after;
  RunPosition position;
  std::string map_file;
  std::string note;  ///< "merging, scenario 17: 15 cycles before collision"
};

/// How long before the end of a run its snapshot is taken [s].
inline constexpr double freeze_lead = 3.0;

/// Keeps nothing of failed runs.
struct KeepNothing {};

/// A behaviour under test: its name, its parameters as text and hash, and how it runs a scenario as the ego (and as
/// the other controlled agents). `run` throws nothing: what a behaviour throws is the result's error. Made by
/// `contender`.
template <class ScenarioWorld>
struct Contender {
  std::string name;
  std::string parameters;
  std::uint64_t parameters_hash = 0;
  std::function<Run(Scenario<ScenarioWorld> const& scenario, RunOptions const& options, bool records)> run;
};

namespace detail {

/// How long plans of the ego took, and those of other controlled agents; and what it expects of others.
struct PlanClock {
  PredictionJudge predictions{};
  RunTimes times{};
  double step_ms = 0.0, sum_ms = 0.0, others_ms = 0.0;

  void add(double ms, bool is_ego) {
    if (!is_ego) {
      others_ms += ms;
      return;
    }
    ++times.decisions;
    sum_ms += ms;
    times.longest_ms = std::max(times.longest_ms, ms);
    times.overruns += ms > step_ms;
  }
};

/// A behaviour whose plans are timed.
template <class Behavior>
struct Timed : Behavior {
  PlanClock* clock = nullptr;
  bool is_ego = false;

  Timed() = default;
  Timed(Behavior behavior, PlanClock* own, bool drives_ego)
      : Behavior(std::move(behavior)), clock(own), is_ego(drives_ego) {}

  template <class View, class... More>
  [[nodiscard]] Plan<View> plan(View const& view, MemoryOf<Behavior>& memory, double dt, More&... workspace) const {
    constexpr bool is_planner = PlannerModel<Behavior, View>;
    std::optional<MemoryOf<Behavior>> before;  // where the planner is to be asked
    if constexpr (is_planner)
      if (clock != nullptr && is_ego && clock->predictions.asks(view.time())) before = memory;
    auto const begin = std::chrono::steady_clock::now();
    auto plan = Behavior::plan(view, memory, dt, workspace...);
    if (clock == nullptr) return plan;
    clock->add(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count(), is_ego);
    if constexpr (is_planner)
      if (before && plan.status != PlanStatus::failed) note_prediction(view, *before, workspace...);
    return plan;
  }

 private:
  /// Notes what a planner expects of the others.
  template <class View, class Workspace>
  void note_prediction(View const& view, MemoryOf<Behavior> const& before, Workspace& workspace) const {
    Behavior const& planner = *this;
    auto& judge = clock->predictions;
    auto const course = planner.foresee(view, before, workspace, {});
    auto const& roster = workspace.predicted().roster();
    judge.note(roster, view.id(), course);
    if constexpr (requires { planner.alternatives(view, before, workspace, 1.0); }) {
      if (course.empty()) return;
      auto const asked = judge.nearby(roster, view.id(), course.front());
      judge.note(planner.alternatives(view, before, workspace, judge.span_of_alternatives), view.time(), asked);
    }
  }
};

template <class Set, class Behavior>
struct WithBehavior;
template <class... Models, class Behavior>
struct WithBehavior<BehaviorSet<Models...>, Behavior> {
  using type = BehaviorSet<Models..., Timed<Behavior>>;
};
template <class... Models, class... Behaviors>
struct WithBehavior<BehaviorSet<Models...>, OneOf<Behaviors...>> {
  using type = BehaviorSet<Models..., Timed<Behaviors>...>;
};

/// Keeps the last worlds of a run, in case it fails.
template <class World>
class LastWorlds {
 public:
  explicit LastWorlds(double time_step)
      : most_(static_cast<std::size_t>(std::clamp(std::round(freeze_lead / time_step), 1.0, 100.0))) {}

  void add(World const& world) {
    worlds_.push_back(world);
    if (worlds_.size() > most_ + 1) worlds_.pop_front();
  }

  /// Calls `keep` for the snapshot of `run`, which has failed; `threw`: its last cycle has no result.
  template <class Keep>
  void freeze(Run& run, bool threw, RunPosition position, std::string const& label, std::string const& map_file,
              Keep const& keep) const {
    if (worlds_.empty()) return;
    auto const& error = run.result.error;
    bool const is_error = !error.empty();
    std::size_t const left = threw ? 1 : std::min(worlds_.size() - 1, is_error ? std::size_t{1} : most_);
    std::size_t const before = worlds_.size() - 1 - (threw ? 0 : left);
    auto const note = label + (label.empty() ? "" : ": ") + std::to_string(left) + (left == 1 ? " cycle" : " cycles") +
                      " before " + (is_error ? "error: " + error : run_outcomes[outcome_of(run.result)]);
    try {
      run.snapshot =
          keep(FailedRun<World>{worlds_[before], before + 1 < worlds_.size() ? &worlds_[before + 1] : nullptr,
                                std::move(position), map_file, note});
    } catch (std::exception const& problem) {
      run.problem = problem.what();
    }
  }

 private:
  std::size_t most_;
  std::deque<World> worlds_{};
};

/// Which agent of `own` drove before the last step and has a plan that ends it or has not begun, so that nobody sees it
/// any more; empty if none.
template <class World>
[[nodiscard]] std::string vanished(World const& world, std::span<AgentId const> own) {
  auto const* const before = world.before_step();
  for (auto const id : own) {
    auto const slot = world.slot_of(id);
    if (before == nullptr || (*before)[slot].status != AgentStatus::driving) continue;
    auto const now = world.frame().agents[slot].status;
    if (now == AgentStatus::not_started || now == AgentStatus::expired)
      return "agent " + to_string(id) + ": its plan says that it " +
             (now == AgentStatus::expired ? "has nothing more to do" : "has not started") + ", but it drives";
  }
  return {};
}

/// Why a run cannot go on after a step with a problem: the behaviour under test, which drives `own` (the ego first),
/// has failed. Empty if only others have failed.
template <class World>
[[nodiscard]] std::string failure_of(World const& world, StepResult const& step, std::span<AgentId const> own) {
  if (step.problem == StepProblem::bad_duration) return to_string(step.problem);
  for (auto const id : own) {
    if (world.frame().agents[world.slot_of(id)].status != AgentStatus::failed) continue;
    auto const who = "agent " + to_string(id) + (id == own.front() ? " (the ego)" : " (controlled)");
    if (id == step.agent) return who + ": " + to_string(step.problem);
    return who + " failed in a step in which others did, the first agent " + to_string(step.agent) + ": " +
           to_string(step.problem);
  }
  return {};
}

/// Throws `ParameterError` if a criterion asks what the map cannot answer.
inline void require_answers(Map const& map, std::span<Criterion const> fails) {
  bool const asks = std::ranges::find(fails, Criterion::speeding) != fails.end();
  if (asks && std::ranges::all_of(map.lanes(), [](auto const& lane) { return lane.speed_limits.empty(); }))
    throw ParameterError("the set", "fails runs by \"speeding\", but no lane of the map has a speed limit",
                         "leave it out of \"fails\", or give the map limits");
}

/// Runs a world until its ego is at its goal, collides, or leaves its route or the map, time is up, or an agent of
/// `own` (the ego first) fails. Without a goal, the ego succeeds at the end of its route. Calls
/// `after_step(world, result)`, which may add an error.
template <class World, class AfterStep>
[[nodiscard]] RunResult run_world(World& world, std::span<AgentId const> own, RunOptions const& options,
                                  AfterStep const& after_step) {
  auto const slot = world.slot_of(own.front());
  bool const has_goal = !std::holds_alternative<NoGoal>(world.roster().goals[slot]);
  world.keep_history(1);
  RunJudge<World> judge(world, own, options.bounds);
  auto& result = judge.result();
  auto const most = static_cast<std::uint64_t>(std::ceil(options.time_limit / options.time_step - 1e-9));
  bool is_over = result.collision;
  while (!is_over) {
    auto const step = world.step(options.time_step);
    auto const status = world.frame().agents[slot].status;
    result.error = step ? vanished(world, own) : failure_of(world, step, own);
    if (result.error.empty()) result.others_failed += step.failed;
    judge.observe(world, options.time_step);
    after_step(world, result);
    bool const is_away = status != AgentStatus::driving && status != AgentStatus::not_started;
    bool const done =
        has_goal ? world.reached_goal(slot) : status == AgentStatus::arrived || status == AgentStatus::left_map;
    result.success = done && !result.collision && result.error.empty();
    bool const is_lost = has_goal ? !done && is_away : status == AgentStatus::off_route;
    result.off_route = is_lost && !result.collision && result.error.empty();
    is_over = !result.error.empty() || result.collision || done || is_away;
    result.timed_out = !is_over && world.frame().step >= most;
    is_over = is_over || result.timed_out;
  }
  return judge.finished(world, options.fails);
}

/// The scenario with `choose(spec, scenario)` as the behaviour of the agents `own`, the ego first; `clock` times them.
template <class World, class ScenarioWorld, class Choose>
[[nodiscard]] Scenario<World> with_timed_behaviors(Scenario<ScenarioWorld> const& scenario,
                                                   std::vector<AgentId> const& own, Choose const& choose,
                                                   PlanClock& clock) {
  using Behavior = typename World::Behavior;
  return with_behaviors<World>(scenario, [&](auto const& spec) -> Behavior {
    auto const id = spec.id.given().value_or(none<AgentId>);
    if (std::ranges::find(own, id) == own.end())
      return std::visit([](auto const& driver) -> Behavior { return driver; }, spec.behavior);
    auto const timed = [&]<class B>(B const& chosen) { return Behavior(Timed<B>(chosen, &clock, id == own.front())); };
    auto const chosen = choose(spec, scenario);
    if constexpr (Variant<std::remove_const_t<decltype(chosen)>>)
      return chosen.visit(timed);
    else
      return timed(chosen);
  });
}

}  // namespace detail

/// What a contender drives with in its world: its behaviour, whose plans are timed.
template <class Behavior>
using ContenderBehavior = detail::Timed<Behavior>;

/// The world that a contender with this behaviour, or `OneOf` several, drives in: the type of its snapshots.
template <class ScenarioWorld, class Behavior>
using ContenderWorld =
    World<typename detail::WithBehavior<typename ScenarioWorld::Behaviors, Behavior>::type,
          typename ScenarioWorld::Execution, typename ScenarioWorld::Dynamics, typename ScenarioWorld::Observer>;

/// A contender from a function that says, for the spec of an agent to be controlled, what drives it:
/// `choose(spec, scenario)` returns a behaviour, or `OneOf` several: contenders that choose from the same ones share a
/// world, which is then compiled once. `name`: for tables and the database; `parameters`: what tells it from
/// contenders of that name. `keep(FailedRun)` returns the snapshot of a failure that is recorded: `freeze_run`.
template <class ScenarioWorld, class Choose, class Keep = KeepNothing>
[[nodiscard]] Contender<ScenarioWorld> contender_by(std::string name, std::string parameters,
                                                    std::uint64_t parameters_hash, Choose choose, Keep keep = {}) {
  using Behavior =
      std::invoke_result_t<Choose const&, typename ScenarioWorld::AgentSpec const&, Scenario<ScenarioWorld> const&>;
  using World = ContenderWorld<ScenarioWorld, Behavior>;
  constexpr bool keeps = !std::is_same_v<Keep, KeepNothing>;
  auto drive = [choose = std::move(choose), keep = std::move(keep), name](Scenario<ScenarioWorld> const& scenario,
                                                                          RunOptions const& options, bool records) {
    static_cast<void>(keep);  // unused by `KeepNothing`
    Run run;
    detail::PlanClock clock{.step_ms = 1e3 * options.time_step};
    std::optional<WorldRecorder> film;
    detail::LastWorlds<World> last(options.time_step);
    bool threw = true;
    auto const begin = std::chrono::steady_clock::now();
    try {
      if (!is_valid(scenario.ego))
        throw WorldError("scenario", "has no ego", "name the agent that the benchmark is about");
      std::vector<AgentId> own{scenario.ego};
      own.insert(own.end(), scenario.controlled.begin(), scenario.controlled.end());
      auto const ours = detail::with_timed_behaviors<World>(scenario, own, choose, clock);
      auto world = ours.make_world();
      detail::require_answers(world.map(), options.fails);
      if (records) {
        film.emplace(world);
        film->show_as(scenario.ego, RecordedAgentKind::ego, "ego");
        if constexpr (keeps) last.add(world);
      }
      run.result = detail::run_world(world, own, options, [&](World const& now, RunResult& result) {
        clock.predictions.compare(now);
        if (film) film->record(now);
        if constexpr (keeps)
          if (film) last.add(now);
        double const planned = 1e-3 * (clock.sum_ms + clock.others_ms);
        if (!result.error.empty() || !(planned > options.plan_limit)) return;
        result.error_kind = RunErrorKind::plans_too_long;
        result.error = "its plans took longer than " + detail::rounded_text(options.plan_limit) + " s together";
      });
      clock.predictions.write(run.result);
      threw = false;
    } catch (std::exception const& problem) {
      run.result = {};
      run.result.error = problem.what();
      if (run.result.error.empty()) run.result.error = "threw an exception without words";
    } catch (...) {
      run.result = {};
      run.result.error = "threw what is no std::exception";
    }
    if (film) run.recording = std::move(film->recording());
    if constexpr (keeps)
      if (!run.result.success)
        last.freeze(run, threw, {name, scenario.ego, scenario.controlled, options.time_step, options.time_limit},
                    options.label, scenario.map_file, keep);
    run.times = clock.times;
    run.times.mean_ms = clock.times.decisions > 0 ? clock.sum_ms / static_cast<double>(clock.times.decisions) : 0.0;
    run.times.run_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return run;
  };
  return {std::move(name), std::move(parameters), parameters_hash, std::move(drive)};
}

/// A contender that drives with the same parameters everywhere. `name`: by default that of the model; `keep` as for
/// `contender_by`.
template <class ScenarioWorld, class Behavior, class Keep = KeepNothing>
[[nodiscard]] Contender<ScenarioWorld> contender(Behavior const& behavior, std::string name = Behavior::name,
                                                 Keep keep = {}) {
  static_assert(Described<Behavior>,
                "cambium::contender: describe the behaviour's parameters, so that results can be told apart: `static "
                "constexpr auto parameters() { return cambium::parameter_list(); }`");
  return contender_by<ScenarioWorld>(
      std::move(name), to_string(behavior), hash_parameters(behavior),
      [behavior](typename ScenarioWorld::AgentSpec const&, Scenario<ScenarioWorld> const&) { return behavior; },
      std::move(keep));
}

}  // namespace cambium::inline v0_1
