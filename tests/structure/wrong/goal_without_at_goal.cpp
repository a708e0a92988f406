// expect: cambium::World::AgentSpec::goal: this type is no goal; give one
struct Home {
  bool at_goal(cambium::geometry::Pose const&) const { return true; }
};
void enter(Sim& world) { world.add({.position = {10, -1.75}, .goal = Home{}}); }
