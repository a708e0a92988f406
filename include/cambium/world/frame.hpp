#pragma once

#include <cstddef>
#include <cstdint>
#include <iterator>

#include "cambium/core/macros.hpp"
#include "cambium/core/plan.hpp"
#include "cambium/execution/execution_model.hpp"
#include "cambium/map/corridor/lane_place.hpp"
#include "cambium/observer/observer_model.hpp"

namespace cambium {

/// Whether an agent takes part in traffic, and if not, why not. Only those that drive are seen by others, and moved.
enum class AgentStatus : std::uint8_t {
  driving,
  not_started,  ///< its behaviour has not begun
  arrived,      ///< passed the end of its route
  off_route,    ///< passed the last place where its lane was beside the route, as at a fork; the road goes on
  left_map,     ///< passed the end of the road
  expired,      ///< its behaviour has nothing more to do
  failed,       ///< its behaviour or execution gave no valid next state; it keeps the last valid one
};

/// As in messages.
[[nodiscard]] constexpr char const* to_string(AgentStatus status) {
  constexpr char const* names[] = {"driving",      "not started", "arrived", "off its route",
                                   "left the map", "expired",     "failed"};
  auto const number = static_cast<std::size_t>(status);
  return number < std::size(names) ? names[number] : "unknown";
}

/// What a step changes of one agent. `ExecutionMemory`: what its execution model remembers; `Past`: what observers that
/// see late need of it.
template <MotionState S, class Memory, class ExecutionMemory = NoMemory, class Past = NoPast>
struct AgentRecord {
  S state;
  map::LanePlace lane;
  Action action;  ///< of the step that led here
  Memory memory;
  AgentStatus status = AgentStatus::driving;
  std::uint8_t goals_passed = 0;  ///< parts of its `GoalSequence` that it has reached
  [[no_unique_address]] ExecutionMemory execution{};
  [[no_unique_address]] Past past{};

  friend bool operator==(AgentRecord const&, AgentRecord const&) = default;
};

/// What a step changes: time and one record per agent, in the order of the roster, in one buffer.
template <MotionState S, class Memory, class ExecutionMemory = NoMemory, class Past = NoPast>
struct Frame {
  using Record = AgentRecord<S, Memory, ExecutionMemory, Past>;

  double time = 0.0;       ///< [s]
  std::uint64_t step = 0;  ///< steps made since the world began
  IdVector<Record, Slot> agents;
  std::uint32_t roster_revision = 0;  ///< of the roster that the records belong to: see `RosterBase::revision`

  /// Whether both show the same at the same time, however often their rosters have changed.
  friend bool operator==(Frame const& a, Frame const& b) {
    return a.time == b.time && a.step == b.step && a.agents == b.agents;
  }
};

}  // namespace cambium
