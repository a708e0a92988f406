// expect: cambium::World::AgentSpec::behavior: this type is not one of the Models of the world's cambium::BehaviorSet<Models...>
// The world's agents are IDM drivers.
void enter(Sim& world) { world.add({.position = {10, -1.75}, .behavior = cambium::ConstantAcceleration{}}); }
