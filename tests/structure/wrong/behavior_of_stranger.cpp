// expect: cambium::World::AgentSpec::behavior: this type is not one of the Models of the world's cambium::BehaviorSet<Models...>
#include <cambium/behavior/following/constant_acceleration.hpp>
#include <cambium/behavior/following/idm_classic.hpp>
#include <cambium/dynamics/single_track.hpp>
#include <cambium/execution/interpolate.hpp>
#include <cambium/world/world.hpp>

using Sim =
    cambium::World<cambium::BehaviorSet<cambium::IdmClassic>, cambium::InterpolateExecution, cambium::SingleTrack>;

// The world's agents are IDM drivers.
void enter(Sim& world) { world.add({.position = {10, -1.75}, .behavior = cambium::ConstantAcceleration{}}); }
