#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iostream>
#include <map>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "cambium/benchmark/contender.hpp"
#include "cambium/benchmark/executor.hpp"
#include "cambium/benchmark/progress.hpp"
#include "cambium/benchmark/read_results.hpp"
#include "cambium/benchmark/report.hpp"
#include "cambium/benchmark/result_group.hpp"
#include "cambium/benchmark/result_store.hpp"
#include "cambium/benchmark/runner.hpp"
#include "cambium/core/error.hpp"
#include "cambium/core/nearest_names.hpp"
#include "cambium/core/text.hpp"
#include "cambium/core/write_file.hpp"
#include "cambium/scenario/scenario_file.hpp"

/// The command line of a benchmark program. It is parsed by CLI11: link cambium::benchmark_main.
namespace cambium::inline v0_1 {

/// Where `benchmark_main` looks for what the command line does not name.
struct BenchmarkDefaults {
  std::string command{};  ///< runs the program, with the options that it has read itself; default: the program's path
  std::filesystem::path sets = "sets";          ///< `--set NAME` means the file or the folder `sets`/NAME
  std::string set = "examples";                 ///< used without `--set`
  std::filesystem::path out = "out/benchmark";  ///< the database is `out`/results.db
  Executor executor{};                          ///< where the jobs run, in place of threads; see `on_ranks`
};

namespace detail {

/// What the command line says.
struct BenchmarkCommand {
  BenchmarkOptions options{.replays = Replays::failures};
  std::vector<std::string> sets{}, behaviors{};  ///< names; without behaviours all
  std::optional<std::uint64_t> scenarios{}, seed{};
  std::vector<TrafficPopulation> populations{};  ///< of those that recipes name; without any all
  bool trains = false;                           ///< draws the training split
  bool lists = false;
  std::filesystem::path database{};
  std::optional<std::string> only{}, replay{}, json{};
  std::string drawing{};  ///< the options that say which scenarios are drawn, and how they run: " --seed 3"
};

/// Parses a command line. Nothing after `--help`, which it prints where the process has the store. Throws `Error`.
[[nodiscard]] std::optional<BenchmarkCommand> parse_benchmark_command(int argc, char const* const* argv,
                                                                      BenchmarkDefaults const& defaults);

/// The behaviours and sets that a program has, for `--list`.
[[nodiscard]] std::string list_of(std::vector<std::string> const& behaviors, BenchmarkDefaults const& defaults);

/// The scenario files that `--set` names: files, all files in a folder, or files and folders of this name below
/// `defaults.sets`. Throws `Error` if there are none.
[[nodiscard]] std::vector<std::filesystem::path> set_files(std::vector<std::string> const& names,
                                                           BenchmarkDefaults const& defaults);

/// What names the set of a file on the command line, as in "--set examples/merging --seed 3".
[[nodiscard]] std::string source_of(BenchmarkCommand const& command, std::filesystem::path const& file,
                                    std::filesystem::path const& folder);

/// The results on the scenarios of a set with one title, which is empty where it is the set's own, and one population,
/// which is empty where they have none.
struct TrafficGroup {
  std::string traffic{};
  std::string population{};
  ResultGroup results{};
};

/// The groups by titles and populations of scenarios, in their order.
template <class World>
[[nodiscard]] std::vector<TrafficGroup> by_traffic(std::vector<ResultGroup> const& groups,
                                                   std::vector<ScenarioSet<World>> const& sets) {
  std::map<std::uint64_t, ScenarioSet<World> const*> by_hash;
  for (auto const& set : sets) by_hash.emplace(set.hash(), &set);
  std::vector<TrafficGroup> parts;
  for (auto const& group : groups) {
    auto const& set = *by_hash.at(group.set_hash);
    auto whole = group;
    whole.rows.clear();
    auto const first = static_cast<std::ptrdiff_t>(parts.size());
    for (auto const& row : group.rows) {
      auto const& scenario = set.scenarios[static_cast<std::size_t>(row.scenario)];
      auto const title = scenario.title == set.title ? std::string() : scenario.title;
      auto part = std::find_if(parts.begin() + first, parts.end(), [&](TrafficGroup const& one) {
        return one.traffic == title && one.population == scenario.population;
      });
      if (part == parts.end()) part = parts.insert(parts.end(), {title, scenario.population, whole});
      part->results.rows.push_back(row);
    }
  }
  return parts;
}

/// The table as JSON: a row for each set, title and population of scenarios, and behaviour.
[[nodiscard]] std::string summary_json(std::vector<TrafficGroup> const& parts);

/// The results that the database has of these sets and contenders, in their order.
template <class World>
[[nodiscard]] std::vector<ResultGroup> chosen_results(ResultStore& store, std::vector<ScenarioSet<World>> const& sets,
                                                      std::vector<Contender<World>> const& contenders) {
  auto all = read_results(store);
  std::vector<ResultGroup> chosen;
  for (auto const& set : sets) {
    auto const hash = set.hash();
    for (auto const& contender : contenders)
      for (auto& group : all)
        if (!group.rows.empty() && group.set_hash == hash && group.behavior == contender.name &&
            group.parameters_hash == contender.parameters_hash && group.version == library_version)
          chosen.push_back(std::exchange(group, {}));
  }
  return chosen;
}

[[nodiscard]] std::string time_of_day();

/// A line for each field.
[[nodiscard]] std::string lines_of(RunResult const& result);

template <class World>
[[nodiscard]] std::vector<std::string> names_of(std::vector<Contender<World>> const& contenders) {
  std::vector<std::string> names;
  for (auto const& contender : contenders) names.push_back(contender.name);
  return names;
}

/// The contenders of these names; all without any.
template <class World>
[[nodiscard]] std::vector<Contender<World>> chosen(std::vector<Contender<World>> const& contenders,
                                                   std::vector<std::string> const& names) {
  if (names.empty()) return contenders;
  std::vector<Contender<World>> found;
  for (auto const& name : names) {
    auto const at = std::ranges::find(contenders, name, &Contender<World>::name);
    if (at == contenders.end())
      throw Error("behaviour " + name, "the program has none of that name", suggestion(name, names_of(contenders)));
    found.push_back(*at);
  }
  return found;
}

/// The sets that the command names; their recipes draw what it says. Throws `Error` for a set without scenarios or
/// egos, or one that has nothing to draw though the command says how.
template <class World>
[[nodiscard]] std::vector<ScenarioSet<World>> read_sets(BenchmarkCommand const& command,
                                                        std::vector<std::filesystem::path> const& files) {
  constexpr std::uint32_t first_to_train = 1'000'000'000;  // beyond the scenarios of any recipe
  std::vector<ScenarioSet<World>> sets;
  for (auto const& file : files) {
    bool is_drawn = false;
    auto& set = sets.emplace_back(read_scenarios<World>(file, [&](ScenarioRecipe<World>& recipe) {
      is_drawn = true;
      if (command.scenarios) recipe.scenarios = static_cast<std::uint32_t>(*command.scenarios);
      if (command.seed) recipe.seed = *command.seed;
      if (!command.populations.empty() && !recipe.populations.empty()) {  // else `draw` says what is wrong
        std::erase_if(recipe.populations, [&](auto one) { return std::ranges::count(command.populations, one) == 0; });
        if (recipe.populations.empty())
          throw Error(file.string(), "has none of the populations of --populations",
                      "leave out the option, or name others");
      }
      if (!command.trains) return;
      if (recipe.first >= first_to_train)
        throw Error(file.string(), "a recipe begins at scenario " + std::to_string(recipe.first),
                    "give it a `first` below 1000000000: the scenarios beyond are the training split");
      recipe.first += first_to_train;
    }));
    if (set.title.empty()) set.title = file.stem().string();
    if (set.scenarios.empty()) throw Error(file.string(), "has no scenarios", "give it \"scenarios\" or \"recipes\"");
    for (std::size_t i = 0; i < set.scenarios.size(); ++i)
      if (!is_valid(set.scenarios[i].ego))
        throw Error(file.string() + ": scenario " + std::to_string(i), "has no ego",
                    "name the agent that the benchmark is about");
    if ((command.scenarios || command.seed || command.trains || !command.populations.empty()) && !is_drawn)
      throw Error(file.string(), "has no recipes to which --scenarios, --seed, --split and --populations could apply",
                  "leave them out");
  }
  return sets;
}

/// While it lives, Ctrl-C says that the same command goes on, and ends the program. A planner that calls `exit` ends it
/// with a word, too, and with status 1.
class SaysWhyItEnds {
 public:
  SaysWhyItEnds();
  ~SaysWhyItEnds();
  SaysWhyItEnds(SaysWhyItEnds const&) = delete;
  SaysWhyItEnds& operator=(SaysWhyItEnds const&) = delete;

 private:
  void (*before_)(int);
};

/// Writes the replay of a run, and its snapshot beside it.
void write_replay(std::filesystem::path const& replay, Run run);

/// Runs one scenario again, "SET:NUMBER:BEHAVIOR", and prints what came of it.
template <class World>
void run_only(std::vector<ScenarioSet<World>> const& sets, std::vector<Contender<World>> const& contenders,
              BenchmarkCommand const& command) {
  auto const& only = *command.only;
  auto const fail = [&](char const* what, std::string const& remedy) { throw Error("--only " + only, what, remedy); };
  auto const parts = split(only, ":");  // a title may have colons
  if (parts.size() < 3) fail("is no key", "write SET:NUMBER:BEHAVIOR, as merging:17:mobil");
  auto const behavior = parts.back(), number_word = parts[parts.size() - 2];
  auto const title = only.substr(0, only.size() - behavior.size() - number_word.size() - 2);
  auto const set = std::ranges::find(sets, title, &ScenarioSet<World>::title);
  if (set == sets.end()) fail("there is no such set", "--list names them; --set reads others");
  if (std::ranges::count(sets, title, &ScenarioSet<World>::title) > 1)
    fail("several sets have this title", "name one of them by --set FILE");
  auto const number = parse_number<std::size_t>(number_word);
  if (!number || *number >= set->scenarios.size())
    fail("there is no such scenario", "give a number from 0 to " + std::to_string(set->scenarios.size() - 1));
  if (command.replay && !command.replay->ends_with(".html"))
    throw Error("--replay", "is '" + *command.replay + "'", "give a name that ends in .html");
  SaysWhyItEnds const at_end;
  auto const contender = chosen(contenders, {std::string(behavior)}).front();
  auto const& scenario = set->scenarios[*number];
  auto run = contender.run(scenario, run_options(*set, *number, command.options), command.replay.has_value());
  std::cout << only << "\n  " << contender.parameters << "\n  seed: " << scenario.seed << "\n" << lines_of(run.result);
  if (run.recording) run.recording = titled(std::move(*run.recording), title, *number, contender.name, run.result);
  if (command.replay) write_replay(*command.replay, std::move(run));
}

/// Runs the sets and prints their tables.
template <class World>
void run_sets(std::vector<ScenarioSet<World>> const& sets, std::vector<std::filesystem::path> const& files,
              std::vector<Contender<World>> const& contenders, BenchmarkCommand& command, std::string const& words,
              BenchmarkDefaults const& defaults) {
  auto& options = command.options;
  std::error_code refused;  // then the store says what is wrong
  if (command.database.has_parent_path()) std::filesystem::create_directories(command.database.parent_path(), refused);
  ResultStore store(command.database);
  store.begin_run(time_of_day(), words);
  std::size_t jobs = 0, results = 0;
  auto const begin = std::chrono::steady_clock::now();
  {
    SaysWhyItEnds const at_end;
    ProgressBar bar;  // one for all sets: each may take less than a minute
    options.progress = [&bar](std::size_t done, std::size_t total) { bar(done, total); };
    for (std::size_t s = 0; s < sets.size(); ++s) {
      bar.begin(sets[s].title + " (" + std::to_string(s + 1) + " of " + std::to_string(sets.size()) + ")");
      options.source = source_of(command, files[s], defaults.sets);
      options.command = defaults.command;
      jobs += run_benchmark(sets[s], contenders, store, options);
    }
    options.progress = {};
  }
  double const seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  auto const groups = chosen_results(store, sets, contenders);
  for (auto const& table : summary_of(groups)) std::printf("\n%s", text_of(table).c_str());
  std::printf("\n");
  for (auto const& line : errors_of(groups)) std::printf("  %s\n", line.c_str());
  std::printf("  %zu runs in %.1f s on %s; results in %s\n", jobs, seconds, options.executor.name.c_str(),
              command.database.string().c_str());
  for (auto const& group : groups) results += group.rows.size();
  if (results > jobs)
    std::printf("  %zu results were there already; --again runs all anew, as after a change of a planner's code\n",
                results - jobs);
  if (command.json) write_file(*command.json, summary_json(by_traffic(groups, sets)));
}

}  // namespace detail

/// The `main` of a benchmark program: reads scenario sets whose behaviours are those of `World`, runs `contenders` on
/// them, keeps the results in a database, and prints a table. `--help` lists the options. Returns the exit code: 0, or
/// 2 after an error, which it prints in one line. A planner that calls `exit` makes it 1.
template <class World>
int benchmark_main(int argc, char const* const* argv, std::vector<Contender<World>> const& contenders,
                   BenchmarkDefaults defaults = {}) {
  std::filesystem::path const path(argc > 0 ? argv[0] : "benchmark");
  try {
    if (defaults.command.empty())
      defaults.command = shell_word((path.has_parent_path() ? std::filesystem::absolute(path) : path).string());
    std::string words = defaults.command;
    for (int i = 1; i < argc; ++i) words += " " + shell_word(argv[i]);
    auto command = detail::parse_benchmark_command(argc, argv, defaults);
    bool const is_worker = defaults.executor.is_worker;
    if (!command || (is_worker && (command->lists || command->only))) return 0;  // the process with the store does that
    if (command->lists) {
      std::cout << detail::list_of(detail::names_of(contenders), defaults);
      return 0;
    }
    auto const tested = detail::chosen(contenders, command->behaviors);
    auto const files = detail::set_files(command->sets, defaults);
    auto const sets = detail::read_sets<World>(*command, files);
    if (is_worker)
      for (auto const& set : sets) serve_benchmark(set, tested, command->options);
    else if (command->only)
      detail::run_only(sets, tested, *command);
    else
      detail::run_sets(sets, files, tested, *command, words, defaults);
    return 0;
  } catch (std::exception const& problem) {
    std::cerr << path.stem().string() << ": " << problem.what() << "\n";
    return 2;
  }
}

}  // namespace cambium::inline v0_1

#ifndef CAMBIUM_COMPILED
#include "cambium/benchmark/benchmark_main_impl.hpp"
#endif
