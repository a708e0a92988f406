// Runs all shipped behaviours and planners on sets of scenarios, keeps the results in a database, prints a table.
#include "cambium/benchmark/benchmark_main.hpp"

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "../common/command_line.hpp"
#include "traffic.hpp"

int main(int argc, char** argv) {
  using namespace benchmark;
  CLI::App program("Runs behaviours on sets of scenarios.", "benchmark");
  examples::ParameterFile file;
  file.add_options(program);
  program.allow_extras();  // for `benchmark_main`
  program.set_help_flag();
  return examples::run_program(program, argc, argv, [&] {
    auto const contenders = shipped(file);
    if (file.finish()) return 0;
    auto const rest = program.remaining();
    std::vector<char const*> words{argv[0]};
    for (auto const& word : rest) words.push_back(word.c_str());
    int const code = cb::benchmark_main<Traffic>(static_cast<int>(words.size()), words.data(), contenders,
                                                 {.sets = CAMBIUM_SOURCE_DIR "/examples/benchmark/sets"});
    if (std::find(rest.begin(), rest.end(), "--help") != rest.end())
      for (auto const* option : program.get_options())
        std::printf("  %-32s %s\n", (option->get_name() + " " + option->get_type_name()).c_str(),
                    option->get_description().c_str());
    return code;
  });
}
