/// The room `tracking`: a world in step with what the host's perception tracks.
///
///     lists of TrackedObject  --Tracker::update-->  a Verdict for each, and a world: predict and plan in it, or in a
///     copy
///
/// **Verdict.** How an object moves, in which lane, and how probable its way is; or why it was refused.
#pragma once

// First: it says which language and flags cambium needs.
#include "cambium/core/macros.hpp"

#include "cambium/tracking/tracked_object.hpp"
#include "cambium/tracking/tracker.hpp"
#include "cambium/tracking/verdict.hpp"
