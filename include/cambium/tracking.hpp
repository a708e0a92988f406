/// The room `tracking`: a world in step with what the host's perception tracks.
///
///     lists of TrackedObject  --Tracker::update-->   a Verdict for each, and a world: plan in it, or in a copy
///                             --Tracker::predict-->  modes of each object, as an array of states
///
/// **Verdict.** How an object moves, in which lane, and how probable its way is; or why it was refused.
/// **Mode.** One of the ways in which an object may go on: along which lanes, by which maneuver, and how probable.
/// **`cambium::Predictor`** (cambium/predictor.hpp) is both behind a compiled firewall, `cambium.h` the same for C.
#pragma once

// First: it says which language and flags cambium needs.
#include "cambium/core/macros.hpp"

#include "cambium/tracking/predicted_modes.hpp"
#include "cambium/tracking/tracked_object.hpp"
#include "cambium/tracking/tracker.hpp"
#include "cambium/tracking/tracker_options.hpp"
#include "cambium/tracking/verdict.hpp"
