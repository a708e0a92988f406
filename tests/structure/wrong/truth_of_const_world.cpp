// expect: cambium::World::truth brings the traffic index up to date: call it on a world that is neither const nor a temporary
struct Crowded {  // an evaluator
  bool operator()(Sim const& world, cambium::Slot slot) const { return world.truth(slot).ahead().has_value(); }
};
