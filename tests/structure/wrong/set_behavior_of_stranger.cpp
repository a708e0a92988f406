// expect: cambium::World::set_behavior: this type is not one of the Models of the world's cambium::BehaviorSet<Models...>
void f(Sim& world) { world.set_behavior(cambium::AgentId{0}, cambium::ConstantAcceleration{}); }
