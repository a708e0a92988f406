#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace CLI {
class App;
}

/// The command line of programs that sample scenarios.
namespace examples {

/// What a user sets on the command line.
struct Settings {
  std::string map_file, out;
  std::uint64_t scenarios = 200, seed = 1, steps = 300, trajectories = 10;
  std::uint64_t threads = std::max(1u, std::thread::hardware_concurrency());
  std::optional<std::uint64_t> replay{};  ///< the scenario to be replayed; none: the most telling one
};

/// Something that the scenarios count: "lane changes"; `meaning` may be left out.
struct Count {
  std::string name, meaning{};
};

/// What a program of sampled scenarios calls things.
struct Words {
  std::string title;    ///< of the replay: "Merging"
  std::string success;  ///< "the ego merged"
  std::vector<Count> counts{};
};

/// What the words of the table mean.
[[nodiscard]] std::string explained(Words const& words);

/// What a program is called and says of itself.
struct Program {
  std::string name, sentence, map_sentence;
};

/// The options that all of these programs have. `map_sentence` says what map it takes.
void add_options(CLI::App& program, Settings& settings, std::string const& map_sentence);

/// Reads a command line of these options, then runs `body` (see `run_program`). The exit code.
int run_sampled(Program const& program, Settings& settings, int argc, char** argv, std::function<void()> const& body);

}  // namespace examples
