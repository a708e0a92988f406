#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "cambium/core/constants.hpp"
#include "cambium/core/error.hpp"
#include "cambium/core/ids.hpp"
#include "cambium/geometry/collision.hpp"
#include "cambium/geometry/oriented_box.hpp"
#include "cambium/planner/predicted.hpp"
#include "cambium/planner/search/search_result.hpp"
#include "cambium/world/frame.hpp"

namespace cambium::inline v0_1 {

/// Adds to each candidate of a report its path, and the agent because of whom it can be no better: the one that is
/// soonest before or after ego in one place, up to 3 s apart, as the planner foresees it (deviations that it also
/// considers do not count). Where ego is includes the 5 m ahead of it, so that it may also
/// stand before somebody. Those who start behind ego in its own strip of road do not count. Call it after the `think`
/// that made the report, with the same arguments. Throws `SearchError` if that was not the last use of the workspace.
/// O(candidates x steps^2 x agents).
template <class Planner, class View>
void explain(Planner const& planner, View const& view, typename Planner::Memory const& memory,
             typename Planner::Workspace& workspace, typename Planner::Report& report) {
  constexpr double farthest = 3.0, ahead = 5.0;  // [s], [m]
  auto const& roster = workspace.predicted().roster();
  auto const ego = roster.slot_of(view.id());
  if (!ego || report.course.empty() || report.agents != detail::ids_of(workspace.predicted()) ||
      report.candidates.size() != workspace.compared() || report.course != planner.foresee(view, memory, workspace, {}))
    throw SearchError("explain", "the workspace was not used last for this report", "call it right after `think`");
  std::vector<Slot> others;
  agents_to_avoid(roster, report.course.front(), *ego, others);
  for (std::size_t number = 0; number < report.candidates.size(); ++number) {
    auto const course = planner.foresee(view, memory, workspace, number);
    auto& candidate = report.candidates[number];
    candidate.path.clear();
    candidate.because = none<AgentId>;
    candidate.time_apart = std::numeric_limits<double>::infinity();
    for (auto const& frame : course) candidate.path.push_back(plain_state(frame.agents[*ego].state));
    for (auto const& frame : course) {
      auto const& own = frame.agents[*ego].state;
      auto box = geometry::box_of(roster.agents[*ego].shape, own);
      box.x += 0.5 * ahead * box.cos;
      box.y += 0.5 * ahead * box.sin;
      box.half_length += 0.5 * ahead;
      for (auto const& then : course)
        for (Slot const slot : others) {
          auto const& other = then.agents[slot];
          double const apart = std::abs(other.state.time - own.time);
          if (other.status != AgentStatus::driving || apart > farthest + same_time || apart >= candidate.time_apart ||
              !geometry::intersects(box, geometry::box_of(roster.agents[slot].shape, other.state)))
            continue;
          candidate.because = roster.agents[slot].id;
          candidate.time_apart = apart;
        }
    }
  }
}

}  // namespace cambium::inline v0_1
