#pragma once

#include <string>

#include "cambium/snapshot/snapshot.hpp"

namespace cambium::inline v0_1 {

/// Keeps a snapshot with each failed run of a benchmark: the last argument of `contender` or `contender_by`. Its parts
/// are the world, a `ContenderWorld<ScenarioWorld, Behavior>`, and the `RunPosition`; its component is the contender's
/// name, and its map the file that the scenario names.
struct FreezeRun {
  template <class FailedRun>
  [[nodiscard]] std::string operator()(FailedRun const& run) const {
    SnapshotOptions options{.map_file = run.map_file, .component = run.position.contender, .note = run.note};
    if (run.after != nullptr) options.result = snapshot_hash(*run.after);
    return to_snapshot(options, run.before, run.position);
  }
};
/// The `FreezeRun` to pass to a benchmark.
inline constexpr FreezeRun freeze_run{};

}  // namespace cambium::inline v0_1
