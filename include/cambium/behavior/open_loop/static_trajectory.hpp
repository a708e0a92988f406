#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "cambium/behavior/behavior_model.hpp"
#include "cambium/core/constants.hpp"
#include "cambium/core/error.hpp"
#include "cambium/geometry/angle.hpp"

namespace cambium::inline v0_1 {

/// Replays a recorded trajectory, which all copies share. A step ends at the recorded state of that time, or between
/// two of them by linear interpolation (of the heading along the shorter arc). The agent enters traffic at the first
/// recorded time and expires in the step that would pass the last one. Ignores all others.
struct StaticTrajectory {
  std::shared_ptr<std::vector<State> const> states;  ///< in order of time, at least one

  StaticTrajectory() = default;
  explicit StaticTrajectory(std::vector<State> recorded)
      : states(std::make_shared<std::vector<State> const>(std::move(recorded))) {}

  static constexpr char const* name = "static_trajectory";
  static constexpr char const* summary =
      "replays recorded states with linear interpolation; enters and leaves traffic with its recording";
  static constexpr char const* source = "interpolation";
  static constexpr auto parameters() {
    return parameter_list(parameter("states", &StaticTrajectory::states, "recorded, in order of time"));
  }

  /// Throws `ParameterError` if there are no states or their times do not ascend.
  void check(std::string const& where) const {
    if (!states || states->empty()) throw ParameterError(where, "has no recorded states", "give at least one");
    for (std::size_t i = 1; i < states->size(); ++i)
      if (!((*states)[i - 1].time < (*states)[i].time))
        throw ParameterError(where + ".states[" + std::to_string(i) + "]", "is not later than the one before",
                             "sort the recording by time");
  }

  /// Time of the first state [s].
  [[nodiscard]] double start_time() const {
    return states && !states->empty() ? states->front().time : std::numeric_limits<double>::infinity();
  }

  /// Recorded state at `time` [s]; the first or last one beyond the ends. Requires at least one state. O(log states).
  [[nodiscard]] State at(double time) const {
    auto const after = std::lower_bound(states->begin(), states->end(), time - same_time,
                                        [](State const& state, double t) { return state.time < t; });
    if (after == states->end()) return states->back();
    if (after == states->begin() || after->time <= time + same_time) return *after;
    State const &a = *(after - 1), &b = *after;
    double const u = (time - a.time) / (b.time - a.time);
    return {time, a.x + u * (b.x - a.x), a.y + u * (b.y - a.y),
            a.heading + u * geometry::angle_difference(b.heading, a.heading), a.speed + u * (b.speed - a.speed)};
  }

  template <class View>
  [[nodiscard]] Plan<View> plan(View const& view, NoMemory&, double dt) const {
    Plan<View> plan;
    double const end = view.time() + dt;
    if (!states || states->empty() || end > states->back().time + same_time) {
      plan.status = PlanStatus::expired;
      return plan;
    }
    if (end < states->front().time - same_time) {
      plan.status = PlanStatus::not_started;
      return plan;
    }
    State const recorded = at(end);
    auto next = view.state();
    next.time = end;
    next.x = recorded.x;
    next.y = recorded.y;
    next.heading = recorded.heading;
    next.speed = recorded.speed;
    plan.trajectory.push_back(next);
    plan.is_absolute = true;
    plan.action.acceleration = (recorded.speed - at(view.time()).speed) / dt;
    return plan;
  }
};
static_assert(BehaviorModel<StaticTrajectory>);

}  // namespace cambium::inline v0_1
