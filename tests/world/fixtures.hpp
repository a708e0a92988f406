#pragma once

#include "cambium/behavior/behavior_set.hpp"
#include "cambium/behavior/open_loop/constant_acceleration.hpp"
#include "cambium/behavior/drivers.hpp"
#include "cambium/behavior/open_loop/external_input.hpp"
#include "cambium/dynamics/single_track.hpp"
#include "cambium/execution/interpolate.hpp"
#include "cambium/world/world.hpp"

#include "../support/maps.hpp"

namespace fixtures {

namespace cb = cambium;

using Sim = cb::World<cb::BehaviorSet<cb::IdmClassic, cb::ConstantAcceleration, cb::ExternalInput>,
                      cb::InterpolateExecution, cb::SingleTrack>;

using support::corpus_map;
using support::own_map;
using support::straight_road;

/// A shape that reaches `front` and `rear` from its reference point, 1 m to either side.
inline cb::geometry::Shape box(double front, double rear) { return {front, rear, 1.0, 1.0}; }

}  // namespace fixtures
