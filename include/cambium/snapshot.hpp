/// The room `snapshot`: the exact state of worlds and planners, as a car or a simulation left it, in a file; and back.
///
///     worlds, planners, memories, your own classes       --to_snapshot-->   bytes   --from_snapshot-->   the same
///
/// A snapshot holds everything that can influence the next step: roster, frame, what behaviours and observers remember,
/// and which map it belongs to. It does not hold the environment: logs, threads, scratch memory. After Minnerup et al.
/// 2016, "Debugging Autonomous Driving Systems Using Serialized Software Components".
#pragma once

// First: it says which language and flags cambium needs.
#include "cambium/core/macros.hpp"

#include "cambium/snapshot/archive_fields.hpp"
#include "cambium/snapshot/archive_workspace.hpp"
#include "cambium/snapshot/archive_world.hpp"
#include "cambium/snapshot/freeze_run.hpp"
#include "cambium/snapshot/snapshot.hpp"
#include "cambium/snapshot/snapshot_error.hpp"
#include "cambium/snapshot/snapshot_recorder.hpp"
