// expect: make one of an evaluator that returns a number by cambium::Exceeds
#include "cambium/behavior/behavior_set.hpp"
#include "cambium/behavior/following/idm_classic.hpp"
#include "cambium/dynamics/single_track.hpp"
#include "cambium/evaluation/driving.hpp"
#include "cambium/evaluation/rules.hpp"
#include "cambium/execution/interpolate.hpp"
#include "cambium/world/world.hpp"

using namespace cambium;

void watch(World<BehaviorSet<IdmClassic>, InterpolateExecution, SingleTrack>& world) {
  RuleMonitor monitor(TrafficRule<OneOf<Acceleration>>{.formula = "G acceleration", .labels = {Acceleration{}}});
  monitor(world, Slot{0});
}
