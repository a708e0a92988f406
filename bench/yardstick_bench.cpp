// Measures the yardstick kernels alone: what car following, lane changing, a planner-grade step, a copy and a flat
// roll-out cost on this machine with nothing around them.

#include "yardstick/main.hpp"
#include "yardstick/register.hpp"

int main(int argc, char** argv) {
  yardstick::register_yardsticks();
  return yardstick::run_benchmarks(argc, argv);
}
