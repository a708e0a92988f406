// expect: cambium::ObservedWorld::predict needs a Prediction
void roll(Sim& world) { world.observe(cambium::AgentId{0}).predict(cambium::IdmClassic{}); }
