// expect: cambium::World::AgentSpec::id: this is no id; write cambium::AgentId{7}
void enter(Sim& world) { world.add({.position = {10, -1.75}, .id = 7}); }
