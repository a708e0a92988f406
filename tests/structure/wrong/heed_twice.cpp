// expect: cambium::Driver<Law, Lateral, Heeds...>: name each heed once
void step(WorldOf<cambium::Mobil::Also<cambium::Bends>>& world) { (void)world.step(0.1); }
