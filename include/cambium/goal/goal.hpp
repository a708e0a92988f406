#pragma once

#include <cstddef>
#include <vector>

#include "cambium/core/one_of.hpp"
#include "cambium/goal/goal_situation.hpp"
#include "cambium/goal/own_goal.hpp"
#include "cambium/goal/simple_goals.hpp"

namespace cambium::inline v0_1 {

struct AllGoals;
struct AnyGoal;
struct GoalSequence;

/// An agent's goal; it also determines the route of an agent without one. A value: combinations hold their parts. Every
/// `GoalModel` struct of your own converts to it and can be a part of a combination.
using Goal = OneOf<NoGoal, ReachPolygon, ReachLane, StateLimits, LaneLimits, ReachLaneEnd, ReachLaneBeside, AllGoals,
                   AnyGoal, GoalSequence, OwnGoal>;

/// Reached when all parts are reached at the same time; never without parts.
struct AllGoals {
  std::vector<Goal> parts;

  static constexpr char const* name = "all_goals";
  static constexpr char const* summary = "all of its parts, at the same time";
  static constexpr auto parameters() {
    return cambium::parameter_list(cambium::parameter("parts", &AllGoals::parts, "goals"));
  }

  [[nodiscard]] bool at_goal(GoalSituation const& at) const;
};

/// Reached when at least one part is reached.
struct AnyGoal {
  std::vector<Goal> parts;

  static constexpr char const* name = "any_goal";
  static constexpr char const* summary = "one of its parts";
  static constexpr auto parameters() {
    return cambium::parameter_list(cambium::parameter("parts", &AnyGoal::parts, "goals"));
  }

  [[nodiscard]] bool at_goal(GoalSituation const& at) const;
};

/// Reached when its parts have been reached one after the other. The world tests the parts when the agent enters and at
/// the end of each step; one test may pass several parts. The agent's record counts the passed parts
/// (`AgentRecord::goals_passed`), so that copies and snapshots of a world continue from there. At most 255 parts.
/// Cannot be a part of another goal.
struct GoalSequence {
  std::vector<Goal> parts;

  static constexpr char const* name = "goal_sequence";
  static constexpr char const* summary = "its parts, one after the other";
  static constexpr auto parameters() {
    return cambium::parameter_list(cambium::parameter("parts", &GoalSequence::parts, "goals"));
  }

  [[nodiscard]] bool at_goal(GoalSituation const& at) const { return at.passed >= parts.size() && !parts.empty(); }

  /// The number of parts passed once the agent is at `at`.
  [[nodiscard]] std::size_t pass(GoalSituation const& at) const;
};

static_assert(GoalModel<NoGoal> && GoalModel<ReachPolygon> && GoalModel<ReachLane> && GoalModel<StateLimits> &&
              GoalModel<LaneLimits> && GoalModel<ReachLaneEnd> && GoalModel<ReachLaneBeside> && GoalModel<AllGoals> &&
              GoalModel<AnyGoal> && GoalModel<GoalSequence> && GoalModel<OwnGoal>);

/// True when the goal is reached. Pure.
[[nodiscard]] bool at_goal(Goal const& goal, GoalSituation const& situation);

}  // namespace cambium::inline v0_1

#ifndef CAMBIUM_COMPILED
#include "cambium/goal/goal_impl.hpp"
#endif
