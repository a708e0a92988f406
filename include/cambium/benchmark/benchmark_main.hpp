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
#include "cambium/benchmark/detail/arguments.hpp"
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
#include "cambium/viewer/html_replay.hpp"

#if __has_include(<sys/wait.h>)
#define CAMBIUM_HAS_PROCESSES 1
#include "cambium/benchmark/run_on_processes.hpp"
#else
#define CAMBIUM_HAS_PROCESSES 0
#endif

namespace cambium {

/// Where `benchmark_main` looks for what the command line does not name.
struct BenchmarkDefaults {
  std::string command{};  ///< what runs the program, with the options that it has read itself; usual: the path of it
  std::filesystem::path sets = "sets";          ///< `--set NAME` means the files in `sets`/NAME
  std::string set = "examples";                 ///< used without `--set`
  std::filesystem::path out = "out/benchmark";  ///< the database is `out`/results.db
  Executor executor{};                          ///< where the jobs run, in place of threads; see `on_ranks`
};

/// `word` for a shell.
[[nodiscard]] std::string shell_word(std::string const& word);

namespace detail {

[[nodiscard]] std::vector<Option> benchmark_options();

/// The file of that name in a folder of `folder`; nothing if there is none, or several.
[[nodiscard]] std::optional<std::filesystem::path> nested_set(std::filesystem::path const& folder,
                                                              std::string const& name);

/// The scenario files that `--set` names: files, or in `folder` those of a folder, or one of the folder `usual`.
[[nodiscard]] std::vector<std::filesystem::path> set_files(std::vector<std::string> const& names,
                                                           std::filesystem::path const& folder,
                                                           std::string const& usual);

/// The results on the scenarios of a set that have one title; `traffic` is empty where that is no other than the set's.
struct TrafficGroup {
  std::string traffic{};
  ResultGroup results{};
};

/// The groups by titles of scenarios, in their order.
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
    auto const first = parts.size();
    for (auto const& row : group.rows) {
      std::string title = set.scenarios[static_cast<std::size_t>(row.scenario)].title;
      if (title == set.title) title.clear();
      auto part = std::find_if(parts.begin() + static_cast<std::ptrdiff_t>(first), parts.end(),
                               [&](auto const& one) { return one.traffic == title; });
      if (part == parts.end()) part = parts.insert(parts.end(), {title, whole});
      part->results.rows.push_back(row);
    }
  }
  return parts;
}

/// The table as JSON, a row a set, title of scenarios, and behaviour.
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

/// The contenders that `names` asks for, all without any.
template <class World>
[[nodiscard]] std::vector<Contender<World>> chosen(std::vector<Contender<World>> const& contenders,
                                                   std::vector<std::string> const& names) {
  if (names.empty()) return contenders;
  std::vector<std::string> known;
  for (auto const& contender : contenders) known.push_back(contender.name);
  std::vector<Contender<World>> found;
  for (auto const& name : names) {
    auto const at = std::find(known.begin(), known.end(), name);
    if (at == known.end())
      throw Error("behaviour " + name, "the program has none of that name", suggestion(name, known));
    found.push_back(contenders[static_cast<std::size_t>(at - known.begin())]);
  }
  return found;
}

/// Runs one scenario again: `only` is "SET:NUMBER:BEHAVIOR".
template <class World>
int run_only(std::vector<ScenarioSet<World>> const& sets, std::vector<Contender<World>> const& contenders,
             double plan_limit, std::string const& only, std::optional<std::string> const& replay) {
  auto const parts = split(only, ":");  // a title may have colons
  if (parts.size() < 3) throw Error("--only " + only, "is no key", "write SET:NUMBER:BEHAVIOR, as merging:17:mobil");
  auto const title = only.substr(0, only.size() - parts.back().size() - parts[parts.size() - 2].size() - 2);
  auto const is_meant = [&](auto const& one) { return one.title == title; };
  auto const set = std::find_if(sets.begin(), sets.end(), is_meant);
  if (std::count_if(sets.begin(), sets.end(), is_meant) > 1)
    throw Error("--only " + only, "several sets have this title", "name one of them by --set FILE");
  if (set == sets.end()) throw Error("--only " + only, "there is no such set", "--list names them; --set reads others");
  auto const number = parse_number<std::uint64_t>(parts[parts.size() - 2]);
  if (!number || *number >= set->scenarios.size())
    throw Error("--only " + only, "there is no such scenario",
                "give a number from 0 to " + std::to_string(set->scenarios.size() - 1));
  if (replay && !replay->ends_with(".html"))
    throw Error("--replay", "is '" + *replay + "'", "give a name that ends in .html");
  auto const contender = chosen(contenders, {std::string(parts.back())}).front();
  auto const label = set->title + ", scenario " + std::to_string(*number);
  auto run =
      contender.run(set->scenarios[*number], {set->time_step, set->time_limit, plan_limit, label}, replay.has_value());
  std::cout << only << "\n  " << contender.parameters << "\n  seed: " << set->scenarios[*number].seed << "\n";
  std::cout << lines_of(run.result);
  if (replay && !run.recording)
    throw Error("--replay " + *replay, "there is nothing to replay", "the run ended before it began: see its error");
  if (replay) {
    write_html_replay(*replay, titled(std::move(*run.recording), set->title, *number, contender.name, run.result));
    std::cout << "  " << *replay << " plays it in a browser\n";
    if (!run.problem.empty()) std::cout << "  there is no snapshot beside it: " << run.problem << "\n";
    auto const snapshot = std::filesystem::path(*replay).replace_extension(".snapshot");
    if (!run.snapshot.empty()) {
      write_file(snapshot, run.snapshot);
      std::cout << "  " << snapshot.string() << " is its state before the end\n";
    } else {
      std::error_code refused;
      std::filesystem::remove(snapshot, refused);  // of an earlier run
    }
  }
  return 0;
}

/// The options of the command line; `database`: replays go beside it.
[[nodiscard]] BenchmarkOptions options_of(Arguments const& arguments, std::filesystem::path const& database,
                                          Executor const& executor);

/// What names the set of a file on the command line, as in "--set examples/merging --seed 3".
[[nodiscard]] std::string source_of(Arguments const& arguments, std::filesystem::path const& file,
                                    std::filesystem::path const& folder);

template <class World>
int run_benchmark_program(Arguments const& arguments, std::vector<Contender<World>> const& all,
                          std::string const& command, BenchmarkDefaults const& defaults) {
  std::filesystem::path const database = arguments.text("--db").value_or((defaults.out / "results.db").string());
  if (database.empty()) throw Error("--db", "is empty", "name a file, or leave the option out");
  auto options = options_of(arguments, database, defaults.executor);
  auto const contenders = chosen(all, arguments.list("--behaviors"));
  auto const count = arguments.whole("--scenarios", 1, 100'000),  // of each recipe; all are held in memory
      seed = arguments.whole("--seed", 0, ~std::uint64_t{0});
  auto const split = arguments.text("--split").value_or("test");
  if (split != "train" && split != "test") throw Error("--split", "is '" + split + "'", "write train or test");
  constexpr std::uint32_t first_to_train = 1'000'000'000;  // beyond the scenarios of any recipe
  std::vector<ScenarioSet<World>> sets;
  std::vector<std::string> sources;
  auto names = arguments.list("--set");
  if (names.empty()) names = {defaults.set};
  for (auto const& file : set_files(names, defaults.sets, defaults.set)) {
    bool is_drawn = false;
    sets.push_back(read_scenarios<World>(file, [&](ScenarioRecipe<World>& recipe) {
      is_drawn = true;
      if (count) recipe.scenarios = static_cast<std::uint32_t>(*count);
      if (seed) recipe.seed = *seed;
      if (split != "train") return;
      if (recipe.first >= first_to_train)
        throw Error(file.string(), "a recipe begins at scenario " + std::to_string(recipe.first),
                    "give it a `first` below 1000000000: those beyond are the training split");
      recipe.first += first_to_train;
    }));
    if (sets.back().title.empty()) sets.back().title = file.stem().string();
    if (sets.back().scenarios.empty())
      throw Error(file.string(), "has no scenarios", "give it \"scenarios\" or \"recipes\"");
    for (std::size_t i = 0; i < sets.back().scenarios.size(); ++i)
      if (!is_valid(sets.back().scenarios[i].ego))
        throw Error(file.string() + ": scenario " + std::to_string(i), "has no ego",
                    "name the agent that the benchmark is about");
    if ((count || seed || split == "train") && !is_drawn)
      throw Error(file.string(), "has no recipes to which --scenarios, --seed and --split could apply",
                  "leave them out");
    sources.push_back(source_of(arguments, file, defaults.sets));
  }
  if (options.executor.is_worker) {
    for (auto const& set : sets) serve_benchmark(set, contenders, options);
    return 0;
  }
  if (auto const json = arguments.text("--json")) {
    if (arguments.has("--only")) throw Error("--json", "goes with runs of sets, not with --only", "leave it out");
    if (json->empty() || std::filesystem::is_directory(*json) ||
        !std::filesystem::is_directory(std::filesystem::absolute(*json).parent_path()))
      throw Error("--json '" + *json + "'", "names no file in a folder that exists", "name one");
  }
  if (auto const only = arguments.text("--only"))
    return run_only(sets, contenders, options.plan_limit, *only, arguments.text("--replay"));
  if (arguments.has("--replay")) throw Error("--replay", "needs --only", "say which scenario to replay");

  std::error_code refused;  // then the store says what is wrong
  if (database.has_parent_path()) std::filesystem::create_directories(database.parent_path(), refused);
  ResultStore store(database);
  store.begin_run(time_of_day(), command);
  std::size_t jobs = 0;
  auto const begin = std::chrono::steady_clock::now();
  for (std::size_t s = 0; s < sets.size(); ++s) {
    ProgressBar bar(sets[s].title + " (" + std::to_string(s + 1) + " of " + std::to_string(sets.size()) + ")");
    options.progress = [&bar](std::size_t done, std::size_t total) { bar(done, total); };
    options.source = sources[s];
    options.command = defaults.command;
    jobs += run_benchmark(sets[s], contenders, store, options);
  }
  double const seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  auto const groups = chosen_results(store, sets, contenders);
  for (auto const& table : summary_of(groups)) std::printf("\n%s", text_of(table).c_str());
  std::printf("\n");
  for (auto const& words : errors_of(groups)) std::printf("  %s\n", words.c_str());
  std::printf("  %zu runs in %.1f s on %s; results in %s\n", jobs, seconds, options.executor.name.c_str(),
              database.string().c_str());
  std::size_t results = 0;
  for (auto const& group : groups) results += group.rows.size();
  if (results > jobs)
    std::printf("  %zu results were there already; --again runs all anew, as after a change of a planner's code\n",
                results - jobs);
  if (auto const json = arguments.text("--json")) write_file(*json, summary_json(by_traffic(groups, sets)));
  return 0;
}

}  // namespace detail

/// The `main` of a benchmark program: reads scenario sets whose behaviours are those of `World`, runs `contenders` on
/// them, keeps the results in a database, and prints a table. `--help` lists the options. Returns the exit code: 0, or
/// 2 after an error, which it prints in one line.
template <class World>
int benchmark_main(int argc, char const* const* argv, std::vector<Contender<World>> const& contenders,
                   BenchmarkDefaults defaults = {}) {
  auto const options = detail::benchmark_options();
  std::filesystem::path const path(argc > 0 ? argv[0] : "benchmark");
  try {
    detail::Arguments const arguments(argc, argv, options);
    if (defaults.executor.is_worker && (arguments.has("--help") || arguments.has("--list") || arguments.has("--only")))
      return 0;  // that is the task of the process with the store
    if (arguments.has("--help")) {
      std::cout << "Runs behaviours on sets of scenarios.\n\n";
      for (auto const& option : options) std::cout << detail::help_of(option);
      return 0;
    }
    if (arguments.has("--list")) {
      std::cout << "behaviours:\n";
      for (auto const& contender : contenders) std::cout << "  " << contender.name << "\n";
      std::cout << "sets:\n";
      std::error_code none_there;
      for (auto const& entry : std::filesystem::directory_iterator(defaults.sets, none_there)) {
        if (!entry.is_directory()) continue;
        auto const name = entry.path().filename().string();
        std::cout << "  " << name << ":";
        for (auto const& file : detail::set_files({name}, defaults.sets, defaults.set))
          std::cout << " " << file.stem().string();
        std::cout << "\n";
      }
      return 0;
    }
    if (defaults.command.empty())
      defaults.command = shell_word(path.has_parent_path() ? std::filesystem::absolute(path) : path);
    std::string command = defaults.command;
    for (int i = 1; i < argc; ++i) command += " " + shell_word(argv[i]);
    return detail::run_benchmark_program(arguments, contenders, command, defaults);
  } catch (std::exception const& problem) {
    std::cerr << path.stem().string() << ": " << problem.what() << "\n";
    return 2;
  }
}

}  // namespace cambium

#ifndef CAMBIUM_COMPILED
#include "cambium/benchmark/benchmark_main_impl.hpp"
#endif
