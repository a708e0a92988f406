// expect: cambium::World::truth brings the traffic index up to date: call it on a world that is neither const nor a temporary
#include <cambium/behavior/following/idm_classic.hpp>
#include <cambium/dynamics/single_track.hpp>
#include <cambium/execution/interpolate.hpp>
#include <cambium/world/world.hpp>

using World =
    cambium::World<cambium::BehaviorSet<cambium::IdmClassic>, cambium::InterpolateExecution, cambium::SingleTrack>;
struct Crowded {  // an evaluator
  bool operator()(World const& world, cambium::Slot slot) const { return world.truth(slot).ahead().has_value(); }
};
