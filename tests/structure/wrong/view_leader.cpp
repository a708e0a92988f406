// expect: cambium::ObservedWorld::leader: say ahead()
double gap(Sim& world, cambium::AgentId id) { return world.observe(id).leader()->gap; }
