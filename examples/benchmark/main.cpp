// Runs all shipped behaviours and planners on sets of scenarios, keeps the results in a database, prints a table.
#include "cambium/benchmark/benchmark_main.hpp"

#include "traffic.hpp"

int main(int argc, char** argv) {
  using namespace benchmark;
  return cb::benchmark_main<Traffic>(argc, argv, shipped(), {.sets = CAMBIUM_SOURCE_DIR "/examples/benchmark/sets"});
}
