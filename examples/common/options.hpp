#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "parameter_file.hpp"

/// Shared code of the example programs; here the command line of those that sample scenarios.
namespace examples {

/// Settings from the command line.
struct Settings {
  std::string map_file, out;
  std::uint64_t scenarios = 200, seed = 1, steps = 300, trajectories = 10;
  std::uint64_t threads = std::max(1u, std::thread::hardware_concurrency());
  std::optional<std::uint64_t> replay{};  ///< the scenario to replay; none: the most interesting one
  ParameterFile parameters{};
};

/// An event that the scenarios count, such as "lane changes", and an optional explanation.
struct Count {
  std::string name, meaning{};
};

/// Words of an example for titles and tables.
struct Words {
  std::string title;    ///< of the replay: "Merging"
  std::string success;  ///< "the ego merged"
  std::vector<Count> counts{};
};

/// Explains the words of the results table.
[[nodiscard]] std::string explained(Words const& words);

/// A program's name, its description, and the description of its option `--map`.
struct Program {
  std::string name, sentence, map_sentence;
};

/// Adds the options that all of these programs have. `map_sentence` describes the maps that the program takes.
void add_options(CLI::App& program, Settings& settings, std::string const& map_sentence);

/// Parses a command line with these options, then runs `body` (see `run_program`). Returns the exit code.
int run_sampled(Program const& program, Settings& settings, int argc, char** argv, std::function<void()> const& body);

}  // namespace examples
