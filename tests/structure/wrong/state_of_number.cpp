// expect: cambium::World::state: a number is no agent; keep the AgentId that World::add returned
double speed(Sim const& world, int i) { return world.state(i).speed; }
