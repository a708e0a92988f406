#pragma once

#include <cstddef>
#include <cstdint>
#include <iterator>

#include "cambium/core/described.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/core/plan.hpp"
#include "cambium/execution/execution_model.hpp"
#include "cambium/map/corridor/lane_place.hpp"
#include "cambium/observer/observer_model.hpp"

namespace cambium::inline v0_1 {

/// Whether an agent takes part in traffic, and if not, why. Only driving agents move and are visible to others.
enum class AgentStatus : std::uint8_t {
  driving,
  not_started,  ///< its behaviour has not begun
  arrived,      ///< passed the end of its route
  off_route,    ///< its lane has left the route for good, as at a fork, and the road goes on
  left_map,     ///< passed the end of the road
  expired,      ///< its behaviour has nothing more to do
  failed,       ///< its behaviour or execution returned no valid next state; it keeps its last valid state
};

/// Whether an agent drove in a step before and after which it has these statuses. At its end it may have left traffic.
[[nodiscard]] constexpr bool drove(AgentStatus before, AgentStatus after) {
  using S = AgentStatus;
  return before == S::driving &&
         (after == S::driving || after == S::arrived || after == S::off_route || after == S::left_map);
}

/// The status as text for messages.
[[nodiscard]] constexpr char const* to_string(AgentStatus status) {
  constexpr char const* names[] = {"driving",      "not started", "arrived", "off its route",
                                   "left the map", "expired",     "failed"};
  auto const number = static_cast<std::size_t>(status);
  return number < std::size(names) ? names[number] : "unknown";
}

/// The part of an agent that a step changes. `ExecutionMemory` is the memory of its execution model; `Past` holds the
/// earlier states that delayed observers read.
template <MotionState S, class Memory, class ExecutionMemory = NoMemory, class Past = NoPast>
struct AgentRecord {
  S state;
  map::LanePlace lane;
  Action action;  ///< that its behaviour chose for the last step: the agent's own affair
  Memory memory;
  AgentStatus status = AgentStatus::driving;
  std::uint8_t goals_passed = 0;  ///< number of parts of its `GoalSequence` already reached
  float acceleration = 0.0f;      ///< that it drove in the last step, by its speeds [m/s^2]: what others see and judge
  [[no_unique_address]] ExecutionMemory execution{};
  [[no_unique_address]] Past past{};

  static constexpr char const* name = "agent_record";
  static constexpr auto parameters() {
    using P = AgentRecord;
    return parameter_list(
        parameter("state", &P::state, "where it is, and how fast"),
        parameter("lane", &P::lane, "its place on its road"),
        parameter("action", &P::action, "that its behaviour chose"),
        parameter("memory", &P::memory, "what its behaviour remembers"),
        choice("status", &P::status, "driving|not_started|arrived|off_route|left_map|expired|failed",
               "whether it takes part in traffic"),
        parameter("goals_passed", &P::goals_passed, "-", Range{0, 255}, "parts of its goal already reached"),
        parameter("execution", &P::execution, "what its execution model remembers"),
        parameter("past", &P::past, "for delayed observers"),
        parameter("acceleration", &P::acceleration, "m/s^2", any_finite, "that it drove in the last step"));
  }
  static constexpr unsigned version = 1;
  /// Records without an acceleration of their own have that which was planned.
  void upgrade(unsigned) { acceleration = static_cast<float>(action.acceleration); }

  friend bool operator==(AgentRecord const&, AgentRecord const&) = default;
};

/// The part of a world that a step changes: time and one record per agent, in the order of the roster, in one buffer.
template <MotionState S, class Memory, class ExecutionMemory = NoMemory, class Past = NoPast>
struct Frame {
  using Record = AgentRecord<S, Memory, ExecutionMemory, Past>;

  double time = 0.0;       ///< [s]
  std::uint64_t step = 0;  ///< steps made since the world began
  IdVector<Record, Slot> agents;
  std::uint32_t roster_revision = 0;  ///< revision of the matching roster: see `RosterBase::revision`

  static constexpr char const* name = "frame";
  static constexpr auto parameters() {
    using P = Frame;
    return parameter_list(parameter("time", &P::time, "s", any_finite, "of the states"),
                          parameter("step", &P::step, "-", Range{0, 1.9e19}, "steps made since the world began"),
                          parameter("agents", &P::agents, "their records, in the order of the roster"),
                          parameter("roster_revision", &P::roster_revision, "-", Range{0, 4294967295.0},
                                    "revision of the matching roster"));
  }

  /// Compares time, step and records; ignores the roster revision.
  friend bool operator==(Frame const& a, Frame const& b) {
    return a.time == b.time && a.step == b.step && a.agents == b.agents;
  }
};

}  // namespace cambium::inline v0_1
