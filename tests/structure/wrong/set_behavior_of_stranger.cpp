// expect: cambium::World::set_behavior: this type is not one of the Models of the world's cambium::BehaviorSet<Models...>
#include "cambium/behavior/following/constant_acceleration.hpp"
#include "cambium/behavior/following/idm_classic.hpp"
#include "cambium/dynamics/single_track.hpp"
#include "cambium/execution/interpolate.hpp"
#include "cambium/world/world.hpp"

void f(cambium::World<cambium::BehaviorSet<cambium::IdmClassic>, cambium::InterpolateExecution, cambium::SingleTrack>&
           world) {
  world.set_behavior(cambium::AgentId{0}, cambium::ConstantAcceleration{});
}
