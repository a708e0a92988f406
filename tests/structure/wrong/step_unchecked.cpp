// expect: a step that is not valid may not have moved the world: check the result
#include <cambium/behavior/following/idm_classic.hpp>
#include <cambium/dynamics/single_track.hpp>
#include <cambium/execution/interpolate.hpp>
#include <cambium/world/world.hpp>

#pragma GCC diagnostic error "-Wunused-result"

using Sim =
    cambium::World<cambium::BehaviorSet<cambium::IdmClassic>, cambium::InterpolateExecution, cambium::SingleTrack>;

// Not a number, 0, a negative or a very long step: nothing happens, and nobody would know.
void advance(Sim& world) { world.step(-0.1); }
