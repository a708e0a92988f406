#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cambium/behavior/behavior_model.hpp"
#include "cambium/core/ids.hpp"
#include "cambium/core/state.hpp"
#include "cambium/planner/search/search_result.hpp"

namespace cambium::inline v0_1 {

/// One of the options that a planner compares.
struct PlannerCandidate {
  std::string name;       ///< what ego would do, in words
  double score = 0.0;     ///< on the planner's own scale; higher is better
  std::string refused{};  ///< why ego may not drive it; empty if it may

  // Filled in by `explain`.
  std::vector<State> path{};        ///< of ego: now, and step by step to the horizon
  AgentId because = none<AgentId>;  ///< who is soonest before or after ego in one place; none: nobody within 3 s
  double time_apart = std::numeric_limits<double>::infinity();  ///< of the two; 0 if they touch [s]
};

/// One of the ways in which a planner thinks that another agent may go on. The probabilities of an agent's add up to 1.
struct Alternative {
  AgentId agent = none<AgentId>;
  double probability = 0.0;
  State after{};  ///< where it then is
};

/// What every planner reports: its plan and the reasons. `World` is its prediction world, `Memory` what it remembers
/// from one plan to the next. Each planner's report adds what only that planner knows.
template <class World, class MemoryType>
struct PlannerReport {
  using Memory = MemoryType;

  std::vector<PlannerCandidate> candidates;
  std::optional<std::size_t> chosen;  ///< among the candidates; empty if none may be driven: ego brakes
  /// How clearly the choice wins, from 0 (another candidate is as good) to 1 (nothing comes close). Candidates that
  /// lead to the same lane at the same speed, or begin with the same action, are one choice.
  double decidedness = 0.0;
  bool is_cut_short = false;                      ///< the budget ended before all candidates were scored
  std::vector<typename World::FrameType> course;  ///< all agents as planned, step by step from now to the horizon
  std::vector<AgentId> agents;                    ///< to whom the records of each frame belong
  Memory memory{};                                ///< after the first step of the course: for the next `think`

  /// Whether the plan of `ego` begins with an emergency stop: it brakes harder than `deceleration` [m/s^2].
  [[nodiscard]] bool is_emergency(AgentId ego, double deceleration = 4.0) const {
    auto const found = std::ranges::find(agents, ego);
    if (found == agents.end() || course.size() < 2) return false;
    auto const slot = static_cast<Slot>(found - agents.begin());
    auto const &now = course[0].agents[slot].state, &next = course[1].agents[slot].state;
    return now.speed - next.speed > deceleration * (next.time - now.time);
  }
};

namespace detail {
template <class World, class Memory>
void is_report(PlannerReport<World, Memory> const&);
}

/// A planner: a behaviour that can also be called directly. `think(view, memory, workspace)` plans for the agent of
/// `view` and returns a `PlannerReport`: the plan and its reasons. It is pure: pass the `memory` of the last report, or
/// {} at first; the `workspace` only holds what is worth reusing, such as buffers. Its budget limits how long it takes
/// (see `SearchBudget`). Throws `SearchError` if there is nothing to plan, and `ParameterError` if a parameter is out
/// of range.
///
/// `foresee(view, memory, workspace, candidate)`, called after `plan` or `think` with the same arguments, returns what
/// it expects: the frames of all agents, now and after each step to the horizon, if ego drives that candidate (by its
/// number), or as the planner has decided. It throws `SearchError` before the first plan, for a view of another agent,
/// and for a candidate that there is not. `workspace.predicted()` is the world to which the frames belong,
/// `workspace.compared()` the number of candidates.
/// A planner that expects more than one course of the others may have `alternatives(view, memory, workspace,
/// duration)`: where they may be after `duration` [s] then, as a list of `Alternative`.
template <class P, class View>
concept PlannerModel = BehaviorModel<P> && std::default_initializable<typename P::Memory> &&
    std::default_initializable<typename P::Workspace> &&
    requires(P const planner, View const& view, typename P::Memory const& memory, typename P::Workspace& workspace) {
  detail::is_report(planner.think(view, memory, workspace));
  { planner.think(view, memory, workspace).memory } -> std::convertible_to<typename P::Memory>;
  {
    planner.foresee(view, memory, workspace, std::optional<std::size_t>())
    } -> std::same_as<decltype(P::Report::course)>;
  workspace.predicted().roster();
  { workspace.compared() } -> std::convertible_to<std::size_t>;
};

namespace detail {
/// Throws `SearchError` where `foresee` has no answer: the plan was one for another agent than `asked`, or of fewer
/// candidates.
inline void check_foreseen(AgentId planned_for, AgentId asked, std::optional<std::size_t> candidate,
                           std::size_t compared) {
  if (planned_for != asked)
    throw SearchError(
        "foresee", "the workspace was used last for agent " + to_string(planned_for) + ", not for " + to_string(asked),
        "pass the view of the agent that has planned");
  if (candidate && *candidate >= compared)
    throw SearchError("foresee",
                      "there is no candidate " + std::to_string(*candidate) + " among " + std::to_string(compared),
                      "give a smaller number, or none");
}
}  // namespace detail

/// The lead of the chosen candidate's score over the best of its rivals that may be driven, as a share of the range of
/// all scores, and of at least a twentieth of its score: where all are about as bad, none is clearly best. 1 if there
/// is no rival, 0 if none is chosen. `is_rival(i)`: whether to drive candidate i would be
/// another decision. O(candidates).
template <class IsRival>
[[nodiscard]] double decidedness(std::span<PlannerCandidate const> candidates, std::optional<std::size_t> chosen,
                                 IsRival const& is_rival) {
  if (!chosen) return 0.0;
  double const score = candidates[*chosen].score;
  double second = -std::numeric_limits<double>::infinity(), lowest = score;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (i == *chosen || !candidates[i].refused.empty()) continue;
    if (is_rival(i)) second = std::max(second, candidates[i].score);
    lowest = std::min(lowest, candidates[i].score);
  }
  if (second < lowest) return 1.0;  // there is no rival
  double const range = std::max(std::max(score, second) - lowest, 0.05 * std::abs(score));
  return range > 0.0 ? std::clamp((score - second) / range, 0.0, 1.0) : 0.0;
}

}  // namespace cambium::inline v0_1
