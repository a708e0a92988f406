// expect: cambium::Driver<Law, Lateral, Heeds...>: the lateral part, after the law, must be
void step(WorldOf<cambium::Driver<cambium::Idm, cambium::MobilRule<>>>& world) { (void)world.step(0.1); }
