#pragma once

#include <concepts>

namespace cambium {

/// A planner: a behaviour of parameters that can be asked, too. `think(view, memory, workspace)` says what it thinks of
/// what `view` shows: a report with a `course` up to its horizon, and what it has weighed. `memory` is what it
/// remembers from one question to the next (as a behaviour: in the frame), `workspace` what it works with. Throws
/// `SearchError` where there is nothing to plan, `ParameterError` where a parameter is out of its range.
template <class P, class View>
concept PlannerModel = std::copyable<P> && std::default_initializable<typename P::Workspace> &&
    requires(P const planner, View const& view, typename P::Memory& memory, typename P::Workspace& workspace) {
  planner.think(view, memory, workspace).course;
};

}  // namespace cambium
