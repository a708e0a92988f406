#pragma once

#include <cmath>
#include <cstdint>

#include "cambium/behavior/behavior_set.hpp"
#include "cambium/core/ids.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/core/plan.hpp"
#include "cambium/core/random.hpp"
#include "cambium/execution/execution_model.hpp"
#include "cambium/world/detail/on_lanes.hpp"
#include "cambium/world/detail/refusals.hpp"
#include "cambium/world/detail/seen.hpp"
#include "cambium/world/detail/situation.hpp"
#include "cambium/world/detail/upcoming.hpp"
#include "cambium/world/frame.hpp"
#include "cambium/world/prediction.hpp"
#include "cambium/world/step_result.hpp"

namespace cambium::inline v0_1::detail {

/// One step of a world: fills the records of the next frame from those of the current one.
template <class World>
class WorldStep {
  using Set = typename World::Behaviors;
  using Observer = typename World::Observer;
  using Record = typename World::Record;
  using Workspaces = typename Set::Workspaces;

 public:
  /// `next` has one record per agent; `dt` is in [s].
  WorldStep(World const& world, double dt, IdVector<Record, Slot>& next, Workspaces& workspaces)
      : world_(world), dt_(dt), end_(world.time() + dt), next_(next), workspaces_(workspaces) {}

  [[nodiscard]] StepResult run() {
    if constexpr (Observer::perfect)
      advance_all_inlined();
    else
      advance_all();
    place_all();
    return result_;
  }

 private:
  /// Inlines the whole step into one function. With other observers, whose views are large, this would take minutes to
  /// compile.
  CAMBIUM_FLATTEN void advance_all_inlined() { advance_all(); }

  void advance_all() {
    auto const& roster = world_.roster();
    auto const& frame = world_.frame();
    auto const count = next_.size();
    for (Slot slot{}; index_of(slot) < count; ++slot) {
      if (count > 256 && index_of(slot) + 6 < count) {
        auto const soon = static_cast<Slot>(index_of(slot) + 6);
        auto const* const segment = road_under(roster, frame, soon);
        CAMBIUM_PREFETCH(segment);
        CAMBIUM_PREFETCH(segment + 1);
        if constexpr (Set::looks_beside) {
          CAMBIUM_PREFETCH(road_beside(roster, frame, soon, true));
          CAMBIUM_PREFETCH(road_beside(roster, frame, soon, false));
        }
      }
      advance(slot, next_[slot]);
    }
  }

  static constexpr double rounding = 1e-6;  ///< tolerance below zero speed [m/s]
  static constexpr double farthest = 1e9;   ///< position that a state may have [m]

  /// Plans and executes: fills the agent's next record except for its place on the road, which `place_all` finds.
  void advance(Slot slot, Record& next) {
    Record const& now = world_.frame().agents[slot];
    next = now;
    if (now.status != AgentStatus::driving && now.status != AgentStatus::not_started) return;
    auto const& agent = world_.roster().agents[slot];
    typename World::View const view(world_, slot);
    auto plan = Set::template plan<Observer::perfect>(agent.behavior, view, next.memory, dt_, workspaces_);
    if (plan.status != PlanStatus::valid) return stop_planning(plan.status, agent.id, next);
    if constexpr (!Observer::perfect)
      if (!plan.is_absolute) carry_over(plan, view.state(), now.state);
    auto const random = [&] {
      return RandomStream(world_.roster().seed, static_cast<std::uint32_t>(agent.id),
                          static_cast<std::uint32_t>(world_.frame().step), execution_purpose);
    };
    auto const executed = execute(agent.execution, plan, now.state, agent.dynamics, end_, next.execution, random);
    if (!executed.valid) return fail(StepProblem::no_execution, agent.id, next);
    if (!is_finite(executed.state) || !std::isfinite(plan.action.acceleration + plan.action.steering))
      return fail(StepProblem::not_finite, agent.id, next);
    if (!(executed.state.speed >= -rounding && executed.state.speed <= fastest)) [[unlikely]]
      return fail(StepProblem::bad_speed, agent.id, next);
    if (!(std::abs(executed.state.x) <= farthest && std::abs(executed.state.y) <= farthest)) [[unlikely]]
      return fail(StepProblem::too_far, agent.id, next);
    if constexpr (past_steps_of < Observer >> 0) next.past.push(now.state, static_cast<double>(now.acceleration));
    next.status = AgentStatus::driving;
    next.state = executed.state;
    next.action = plan.action;
    double const driven = (executed.state.speed - now.state.speed) / dt_;
    next.acceleration = now.status == AgentStatus::driving ? static_cast<float>(driven) : 0.0f;
    if (now.status != AgentStatus::driving) [[unlikely]]
      forget_past(next);
    else if (plan.action.acceleration == 0.0) [[unlikely]]  // the behaviour may not have said it
      next.action.acceleration = driven;
  }

  /// Finds the new places of the driving agents on their roads. A separate loop, because its short body lets the
  /// processor overlap several agents.
  CAMBIUM_FLATTEN void place_all() {
    auto const& roster = world_.roster();
    auto const count = next_.size();
    for (Slot slot{}; index_of(slot) < count; ++slot) {
      auto& record = next_[slot];
      if (record.status != AgentStatus::driving) continue;
      double const mean_speed = 0.5 * (world_.frame().agents[slot].state.speed + record.state.speed);
      move_on_lane(world_.map(), *roster.agents[slot].road, mean_speed * dt_, record);
      if (record.status != AgentStatus::driving) ++result_.left;
      if (roster.has_sequences) pass_goals(roster.agents[slot], roster.goals[slot], record);
    }
  }

  void stop_planning(PlanStatus status, AgentId id, Record& next) {
    if (status == PlanStatus::failed) return fail(StepProblem::no_plan, id, next);
    if (status == PlanStatus::expired) ++result_.left;
    next.status = status == PlanStatus::expired ? AgentStatus::expired : AgentStatus::not_started;
    next.state.time = end_;
  }

  void fail(StepProblem problem, AgentId id, Record& next) {
    next.status = AgentStatus::failed;
    next.action = {};
    next.acceleration = 0.0f;
    if (result_.failed++ > 0) return;
    result_.problem = problem;
    result_.agent = id;
  }

  World const& world_;
  double const dt_, end_;  ///< [s]
  IdVector<Record, Slot>& next_;
  Workspaces& workspaces_;
  StepResult result_{};
};

}  // namespace cambium::inline v0_1::detail
