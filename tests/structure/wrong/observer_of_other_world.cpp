// expect: cambium::World::AgentSpec::observer: this type is not the Observer of the world
#include "cambium/behavior/idm_classic.hpp"
#include "cambium/dynamics/single_track.hpp"
#include "cambium/execution/interpolate.hpp"
#include "cambium/observer/parametric.hpp"
#include "cambium/world/world.hpp"

void f(cambium::World<cambium::BehaviorSet<cambium::IdmClassic>, cambium::InterpolateExecution, cambium::SingleTrack>&
           world) {
  world.add({.position = {0, 0}, .observer = cambium::ParametricObserver{}});
}
