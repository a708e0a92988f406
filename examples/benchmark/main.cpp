// Runs all shipped behaviours and planners on sets of scenarios, keeps the results in a database, prints a table.
#include "program.hpp"

int main(int argc, char** argv) {
  return benchmark::run_program(argc, argv, [](auto const&... all) { return cambium::benchmark_main(all...); });
}
