// expect: cambium::World::observe brings the traffic index up to date: call it on a world that is neither const nor a temporary
double time_of(Sim const& world) { return world.observe(cambium::AgentId{0}).time(); }
