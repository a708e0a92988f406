// expect: cambium::World::memory<B>: B must be one of the Models of the world's cambium::BehaviorSet<Models...>
#include <cambium/behavior/following/idm_classic.hpp>
#include <cambium/behavior/open_loop/external_input.hpp>
#include <cambium/dynamics/single_track.hpp>
#include <cambium/execution/interpolate.hpp>
#include <cambium/world/world.hpp>

using World =
    cambium::World<cambium::BehaviorSet<cambium::IdmClassic>, cambium::InterpolateExecution, cambium::SingleTrack>;
void steer(World& world) { world.memory<cambium::ExternalInput>(cambium::AgentId{0}).acceleration = 1.0; }
