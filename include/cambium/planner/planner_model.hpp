#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cambium/core/ids.hpp"

namespace cambium {

/// One of the courses that a planner has weighed.
struct PlannerCandidate {
  std::string name;       ///< what ego would do, in words
  double score = 0.0;     ///< by the planner's own measure; the higher, the better
  std::string refused{};  ///< why ego may not drive it; empty where it may
};

/// What every planner reports: what it plans, and why. `World` is the world that it predicts with, `Memory` what it
/// remembers from one plan to the next. The report of a planner adds what only that planner knows.
template <class World, class MemoryType>
struct PlannerReport {
  using Memory = MemoryType;

  std::vector<PlannerCandidate> candidates;
  std::optional<std::size_t> chosen;  ///< among the candidates; none: none may be driven, and ego brakes
  /// By how much the choice stands out, from 0 (another candidate is as good) to 1 (nothing comes close).
  double decidedness = 0.0;
  bool is_cut_short = false;                      ///< the budget was over before all candidates were weighed
  std::vector<typename World::FrameType> course;  ///< all agents, now and step by step up to the horizon, as planned
  std::vector<AgentId> agents;                    ///< of the frames' records
  Memory memory{};                                ///< after the first step of the course: for the next `think`
};

/// A planner: a behaviour that searches, and that can be asked. `think(view, memory, workspace)` plans for the agent
/// that `view` belongs to, and reports the plan and why. It is pure: `memory` is that of the last report, or {}, and
/// `workspace` holds only what is worth using again, such as buffers. It takes as long as its budget says (see
/// `SearchBudget`). Throws `SearchError` where there is nothing to plan, `ParameterError` where a parameter is out of
/// its range.
template <class P, class View>
concept PlannerModel = std::copyable<P> && std::default_initializable<typename P::Memory> &&
    std::default_initializable<typename P::Workspace> &&
    requires(P const planner, View const& view, typename P::Memory const& memory, typename P::Workspace& workspace) {
  planner.think(view, memory, workspace).course;
  planner.think(view, memory, workspace).agents;
  { planner.think(view, memory, workspace).memory } -> std::convertible_to<typename P::Memory>;
  { planner.think(view, memory, workspace).candidates } -> std::convertible_to<std::vector<PlannerCandidate>>;
  { planner.think(view, memory, workspace).chosen } -> std::convertible_to<std::optional<std::size_t>>;
  { planner.think(view, memory, workspace).decidedness } -> std::convertible_to<double>;
};

/// How far the chosen candidate's score is above the best of the others that may be driven, as a part of the range of
/// their scores; 1 where there is no other, 0 where none is chosen. O(candidates).
[[nodiscard]] inline double decidedness(std::span<PlannerCandidate const> candidates,
                                        std::optional<std::size_t> chosen) {
  if (!chosen) return 0.0;
  double const score = candidates[*chosen].score;
  double second = -std::numeric_limits<double>::infinity(), lowest = score;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (i == *chosen || !candidates[i].refused.empty()) continue;
    second = std::max(second, candidates[i].score);
    lowest = std::min(lowest, candidates[i].score);
  }
  if (second < lowest) return 1.0;  // there is no other
  double const range = std::max(score, second) - lowest;
  return range > 0.0 ? std::clamp((score - second) / range, 0.0, 1.0) : 0.0;
}

}  // namespace cambium
