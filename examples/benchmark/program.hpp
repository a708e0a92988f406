#pragma once

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "../common/command_line.hpp"
#include "cambium/benchmark/benchmark_main.hpp"
#include "traffic.hpp"

namespace benchmark {

/// Reads `--parameters FILE` and calls `run(argc, argv, contenders, defaults)` with the rest of the command line.
/// `prints`: whether it prints what is asked for, as one of several processes.
template <class Run>
int run_program(int argc, char** argv, Run const& run, bool prints = true) {
  CLI::App program("Runs behaviours on sets of scenarios.", "benchmark");
  examples::ParameterFile file;
  file.add_options(program);
  program.allow_extras();  // for `run`
  program.set_help_flag();
  return examples::run_program(program, argc, argv, [&] {
    auto const contenders = shipped(file);
    if (file.prints() && !prints) return 0;
    if (file.finish()) return 0;
    auto const rest = program.remaining();
    std::vector<char const*> words{argv[0]};
    for (auto const& word : rest) words.push_back(word.c_str());
    cb::BenchmarkDefaults defaults{.command = "examples/run benchmark",
                                   .sets = CAMBIUM_SOURCE_DIR "/examples/benchmark/sets"};
    if (!file.path().empty())
      defaults.command += " --parameters " + cb::shell_word(std::filesystem::absolute(file.path()));
    int const code = run(static_cast<int>(words.size()), words.data(), contenders, defaults);
    if (prints && std::find(rest.begin(), rest.end(), "--help") != rest.end())
      for (auto const* option : program.get_options())
        std::printf("  %-32s %s\n", (option->get_name() + " " + option->get_type_name()).c_str(),
                    option->get_description().c_str());
    return code;
  });
}

}  // namespace benchmark
