#pragma once

#include <cstddef>
#include <variant>
#include <vector>

#include "cambium/goal/goal_situation.hpp"
#include "cambium/goal/own_goal.hpp"
#include "cambium/goal/simple_goals.hpp"

namespace cambium {

struct AllGoals;
struct AnyGoal;
struct GoalSequence;

/// What an agent wants to reach; decides its route where none is given. A value: combinations hold their parts. Any
/// struct of your own that is a `GoalModel` converts to it, and can be a part like any other.
using Goal = std::variant<NoGoal, ReachPolygon, ReachLane, StateLimits, LaneLimits, ReachLaneEnd, ReachLaneBeside,
                          AllGoals, AnyGoal, GoalSequence, OwnGoal>;

/// Reached when all of its parts are, at the same time; without parts never.
struct AllGoals {
  std::vector<Goal> parts;

  static constexpr char const* name = "all_goals";
  static constexpr char const* summary = "all of its parts, at the same time";

  [[nodiscard]] bool at_goal(GoalSituation const& at) const;
};

/// Reached when one of its parts is.
struct AnyGoal {
  std::vector<Goal> parts;

  static constexpr char const* name = "any_goal";
  static constexpr char const* summary = "one of its parts";

  [[nodiscard]] bool at_goal(GoalSituation const& at) const;
};

/// Reached when its parts have been, one after the other; a part is reached where the agent is at the end of a step, or
/// where it enters, and several may be there. How many it has passed is in its record (`AgentRecord::goals_passed`), so
/// that copies and snapshots of a world go on from there. At most 255 parts, and not within another goal.
struct GoalSequence {
  std::vector<Goal> parts;

  static constexpr char const* name = "goal_sequence";
  static constexpr char const* summary = "its parts, one after the other";

  [[nodiscard]] bool at_goal(GoalSituation const& at) const { return at.passed >= parts.size() && !parts.empty(); }

  /// How many parts are passed, the agent being at `at`.
  [[nodiscard]] std::size_t pass(GoalSituation const& at) const;
};

static_assert(GoalModel<NoGoal> && GoalModel<ReachPolygon> && GoalModel<ReachLane> && GoalModel<StateLimits> &&
              GoalModel<LaneLimits> && GoalModel<ReachLaneEnd> && GoalModel<ReachLaneBeside> && GoalModel<AllGoals> &&
              GoalModel<AnyGoal> && GoalModel<GoalSequence> && GoalModel<OwnGoal>);

/// True when the goal is reached. Pure.
[[nodiscard]] bool at_goal(Goal const& goal, GoalSituation const& situation);

}  // namespace cambium

#ifndef CAMBIUM_COMPILED
#include "cambium/goal/goal_impl.hpp"
#endif
