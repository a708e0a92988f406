// expect: a step that is not valid may not have moved the world: check the result
#pragma GCC diagnostic error "-Wunused-result"

// Not a number, 0, a negative or a very long step: nothing happens, and nobody would know.
void advance(Sim& world) { world.step(-0.1); }
