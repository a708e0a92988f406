// expect: cambium::World::truth shows what no agent knows: predict from World::observe
using Set = cambium::BehaviorSet<cambium::IdmClassic>;
using World = cambium::World<Set, cambium::InterpolateExecution, cambium::SingleTrack, cambium::ParametricObserver>;
auto predicted(World& world) {
  return world.truth(cambium::Slot{0}).predict(cambium::predict_all_as<Set>(cambium::IdmClassic{}));
}
