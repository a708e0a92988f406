// expect: cambium::World::memory<B>: B must be one of the Models of the world's cambium::BehaviorSet<Models...>
void steer(Sim& world) { world.memory<cambium::ExternalInput>(cambium::AgentId{0}).acceleration = 1.0; }
