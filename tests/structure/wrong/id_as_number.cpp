// expect: cambium::World::AgentSpec::id: this is no id; write cambium::AgentId{7}
#include <cambium/behavior/following/idm_classic.hpp>
#include <cambium/dynamics/single_track.hpp>
#include <cambium/execution/interpolate.hpp>
#include <cambium/world/world.hpp>

using Sim =
    cambium::World<cambium::BehaviorSet<cambium::IdmClassic>, cambium::InterpolateExecution, cambium::SingleTrack>;
void enter(Sim& world) { world.add({.position = {10, -1.75}, .id = 7}); }
