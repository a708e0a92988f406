// expect: cambium::ObservedWorld::predict needs a Prediction
#include <cambium/behavior/following/idm_classic.hpp>
#include <cambium/dynamics/single_track.hpp>
#include <cambium/execution/interpolate.hpp>
#include <cambium/world/world.hpp>

using World =
    cambium::World<cambium::BehaviorSet<cambium::IdmClassic>, cambium::InterpolateExecution, cambium::SingleTrack>;
void roll(World& world) { world.observe(cambium::AgentId{0}).predict(cambium::IdmClassic{}); }
