// expect: cambium::World::truth shows what no agent knows: predict from World::observe
#include <cambium/behavior/following/idm_classic.hpp>
#include <cambium/dynamics/single_track.hpp>
#include <cambium/execution/interpolate.hpp>
#include <cambium/observer/parametric.hpp>
#include <cambium/world/world.hpp>

using Set = cambium::BehaviorSet<cambium::IdmClassic>;
using World = cambium::World<Set, cambium::InterpolateExecution, cambium::SingleTrack, cambium::ParametricObserver>;
auto predicted(World& world) {
  return world.truth(cambium::Slot{0}).predict(cambium::predict_all_as<Set>(cambium::IdmClassic{}));
}
