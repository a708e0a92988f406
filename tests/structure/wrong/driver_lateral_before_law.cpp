// expect: cambium::Driver<Law, Lateral, Heeds...>: the law must be
void step(WorldOf<cambium::Driver<cambium::KeepLane, cambium::Idm>>& world) { (void)world.step(0.1); }
