// expect: cambium::World::AgentSpec::goal: this type is no goal; give one
#include <cambium/behavior/following/idm_classic.hpp>
#include <cambium/dynamics/single_track.hpp>
#include <cambium/execution/interpolate.hpp>
#include <cambium/world/world.hpp>

struct Home {
  bool at_goal(cambium::geometry::Pose const&) const { return true; }
};
using Sim =
    cambium::World<cambium::BehaviorSet<cambium::IdmClassic>, cambium::InterpolateExecution, cambium::SingleTrack>;
void enter(Sim& world) { world.add({.position = {10, -1.75}, .goal = Home{}}); }
