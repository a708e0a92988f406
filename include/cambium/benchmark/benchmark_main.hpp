#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <exception>
#include <filesystem>
#include <iostream>
#include <optional>
#include <string>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "cambium/benchmark/contender.hpp"
#include "cambium/benchmark/detail/arguments.hpp"
#include "cambium/benchmark/progress.hpp"
#include "cambium/benchmark/result_store.hpp"
#include "cambium/benchmark/runner.hpp"
#include "cambium/core/json_document.hpp"
#include "cambium/core/error.hpp"
#include "cambium/core/write_file.hpp"
#include "cambium/scenario/scenario_file.hpp"
#include "cambium/viewer/html_replay.hpp"

namespace cambium {

/// Where `benchmark_main` looks for what the command line does not name.
struct BenchmarkDefaults {
  std::string program = "benchmark";            ///< name of the program, for its messages
  std::filesystem::path sets = "sets";          ///< `--set NAME` means the files in `sets`/NAME
  std::string set = "examples";                 ///< used without `--set`
  std::filesystem::path out = "out/benchmark";  ///< the database is `out`/results.db
};

namespace detail {

[[nodiscard]] inline std::vector<Option> benchmark_options() {
  return {{"--set", "FILE|NAME", "scenario files (.json) or names of sets, separated by commas"},
          {"--behaviors", "A,B,...", "the behaviours to run; all without it"},
          {"--scenarios", "N", "number of scenarios that each recipe draws, instead of its own"},
          {"--seed", "S", "seed of the recipes, instead of their own"},
          {"--threads", "T", "number of threads; the results do not depend on it"},
          {"--db", "FILE", "database of the results; what it has already is not run again"},
          {"--shard", "i/n", "run only the i-th of n parts, i from 0; merge the databases with examples/run report"},
          {"--again", "", "run also what the database has already"},
          {"--only", "SET:NUMBER:BEHAVIOR", "run one scenario and print what came of it"},
          {"--replay", "FILE", "with --only: write a replay that opens in a browser"},
          {"--json", "FILE", "write the table, a row a set and behaviour"},
          {"--list", "", "list behaviours and sets, and exit"},
          {"--help", "", "print this and exit"}};
}

/// The scenario files that `--set` names: files, or in `folder` those of a folder, or one of the folder `usual`.
[[nodiscard]] inline std::vector<std::filesystem::path> set_files(std::vector<std::string> const& names,
                                                                  std::filesystem::path const& folder,
                                                                  std::string const& usual) {
  std::vector<std::filesystem::path> files;
  for (auto const& name : names) {
    std::filesystem::path const places[] = {name, folder / (name + ".json"), folder / usual / (name + ".json")};
    auto const* const place =
        std::ranges::find_if(places, [](auto const& path) { return std::filesystem::is_regular_file(path); });
    if (place != std::end(places)) {
      files.push_back(*place);
      continue;
    }
    if (name.empty() || !std::filesystem::is_directory(folder / name))
      throw Error("--set " + name, "is neither a scenario file nor a folder in " + folder.string(),
                  "--list names the sets that there are");
    std::vector<std::filesystem::path> found;
    for (auto const& entry : std::filesystem::directory_iterator(folder / name))
      if (entry.path().extension() == ".json") found.push_back(entry.path());
    std::sort(found.begin(), found.end());
    files.insert(files.end(), found.begin(), found.end());
  }
  return files;
}

/// Numbers of the results of one behaviour on one set.
struct Tally {
  std::string set, behavior;
  std::uint64_t parameters_hash = 0;
  std::size_t scenarios = 0, success = 0, collision = 0, at_fault = 0, off_road = 0, timed_out = 0, error = 0;
  double success_time = 0.0, ms = 0.0, score = 0.0;

  void add(ResultRow const& row) {
    auto const& r = row.result;
    ++scenarios;
    success += r.success;
    collision += r.collision;
    at_fault += r.at_fault;
    off_road += r.off_road;
    timed_out += r.timed_out;
    error += !r.error.empty();
    if (r.success) success_time += r.duration_s;
    ms += row.times.mean_ms;
    score += r.closed_loop_score;
  }
  [[nodiscard]] double share(std::size_t count) const {
    return scenarios > 0 ? static_cast<double>(count) / static_cast<double>(scenarios) : 0.0;
  }
  [[nodiscard]] double mean(double sum, std::size_t count) const {
    return count > 0 ? sum / static_cast<double>(count) : 0.0;
  }
};

inline void print_tallies(std::vector<Tally> const& tallies) {
  std::size_t wide = 9;
  for (auto const& t : tallies) wide = std::max(wide, t.behavior.size());
  std::string last;
  for (auto const& t : tallies) {
    if (t.set != last)
      std::printf("\n  %s, %zu scenarios\n  %-*s %8s %9s %8s %8s %8s %6s %9s %6s %10s\n", t.set.c_str(), t.scenarios,
                  static_cast<int>(wide), "behaviour", "success", "collision", "at fault", "off-road", "time-out",
                  "error", "mean time", "score", "ms a plan");
    last = t.set;
    std::printf("  %-*s %6.1f %% %7.1f %% %6.1f %% %6.1f %% %6.1f %% %6zu %7.1f s %6.2f %10.3g\n",
                static_cast<int>(wide), t.behavior.c_str(), 100 * t.share(t.success), 100 * t.share(t.collision),
                100 * t.share(t.at_fault), 100 * t.share(t.off_road), 100 * t.share(t.timed_out), t.error,
                t.mean(t.success_time, t.success), t.mean(t.score, t.scenarios), t.mean(t.ms, t.scenarios));
  }
}

[[nodiscard]] inline std::string tallies_json(std::vector<Tally> const& tallies) {
  std::vector<JsonValue> rows;
  for (auto const& t : tallies)
    rows.push_back({std::vector<JsonValue::Member>{{"set", {t.set}},
                                                   {"behavior", {t.behavior}},
                                                   {"parameters_hash", {hash_text(t.parameters_hash)}},
                                                   {"scenarios", {std::uint64_t{t.scenarios}}},
                                                   {"success", {t.share(t.success)}},
                                                   {"collision", {t.share(t.collision)}},
                                                   {"collision_at_fault", {t.share(t.at_fault)}},
                                                   {"off_road", {t.share(t.off_road)}},
                                                   {"timed_out", {t.share(t.timed_out)}},
                                                   {"error", {t.share(t.error)}},
                                                   {"mean_time_s", {t.mean(t.success_time, t.success)}},
                                                   {"closed_loop_score", {t.mean(t.score, t.scenarios)}},
                                                   {"ms_per_decision", {t.mean(t.ms, t.scenarios)}}}});
  return print_json({std::move(rows)});
}

[[nodiscard]] inline std::string time_of_day() {
  auto const now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%d %H:%M:%S", std::gmtime(&now));
  return text;
}

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
             std::string const& only, std::optional<std::string> const& replay) {
  auto const parts = split(only, ":");
  if (parts.size() != 3) throw Error("--only " + only, "is no key", "write SET:NUMBER:BEHAVIOR, as merging:17:mobil");
  auto const set = std::find_if(sets.begin(), sets.end(), [&](auto const& s) { return s.title == parts[0]; });
  if (set == sets.end()) throw Error("--only " + only, "there is no such set", "--list names them; --set reads others");
  auto const number = parse_number<std::uint64_t>(parts[1]);
  if (!number || *number >= set->scenarios.size())
    throw Error("--only " + only, "there is no such scenario",
                "give a number from 0 to " + std::to_string(set->scenarios.size() - 1));
  auto const contender = chosen(contenders, {std::string(parts[2])}).front();
  auto run = contender.run(set->scenarios[*number], {set->time_step, set->time_limit}, replay.has_value());
  std::cout << only << "\n  " << contender.parameters << "\n";
  for_each_parameter<RunResult>([&](auto const& entry) {
    using Field = std::remove_cvref_t<decltype(run.result.*entry.field)>;
    std::cout << "  " << entry.name << ": ";
    if constexpr (std::is_same_v<Field, std::string>)
      std::cout << (run.result.*entry.field).c_str() << "\n";
    else
      std::cout << with_unit(value_text(entry, ParameterValue(run.result.*entry.field)), entry.unit) << "\n";
  });
  if (replay && run.recording) {
    run.recording->title = set->title + ", scenario " + std::to_string(*number) + ", " + contender.name;
    run.recording->notes = {run.result.error.empty() ? (run.result.success     ? "success"
                                                        : run.result.collision ? "collision"
                                                        : run.result.timed_out ? "time-out"
                                                                               : "left the road")
                                                     : run.result.error};
    write_html_replay(*replay, *run.recording);
    std::cout << "  " << *replay << " plays it in a browser\n";
  }
  return 0;
}

template <class World>
int run_benchmark_program(Arguments const& arguments, std::vector<Contender<World>> const& all,
                          std::string const& command, BenchmarkDefaults const& defaults) {
  auto const contenders = chosen(all, arguments.list("--behaviors"));
  BenchmarkOptions options;
  options.threads = static_cast<std::size_t>(arguments.whole("--threads", 1, 4096).value_or(options.threads));
  options.again = arguments.has("--again");
  if (auto const shard = arguments.text("--shard")) {
    auto const parts = split(*shard, "/");
    auto const i = parse_number<std::size_t>(parts[0]), n = parse_number<std::size_t>(parts.back());
    if (parts.size() != 2 || !i || !n || *n == 0 || *i >= *n)
      throw Error("--shard", "is '" + *shard + "'", "write i/n with i from 0 to n - 1, as 0/4");
    options.shard = *i;
    options.shards = *n;
  }
  auto const count = arguments.whole("--scenarios", 1, 10'000'000),
             seed = arguments.whole("--seed", 0, ~std::uint64_t{0});
  std::vector<ScenarioSet<World>> sets;
  auto names = arguments.list("--set");
  if (names.empty()) names = {defaults.set};
  for (auto const& file : set_files(names, defaults.sets, defaults.set)) {
    sets.push_back(read_scenarios<World>(file, [&](ScenarioRecipe<World>& recipe) {
      if (count) recipe.scenarios = static_cast<std::uint32_t>(*count);
      if (seed) recipe.seed = *seed;
    }));
    if (sets.back().title.empty()) sets.back().title = file.stem().string();
  }
  if (auto const only = arguments.text("--only")) return run_only(sets, contenders, *only, arguments.text("--replay"));
  if (arguments.has("--replay")) throw Error("--replay", "needs --only", "say which scenario to replay");

  std::filesystem::path const file = arguments.text("--db").value_or((defaults.out / "results.db").string());
  std::error_code refused;  // then the store says what is wrong
  if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path(), refused);
  ResultStore store(file);
  store.begin_run(time_of_day(), command);
  std::size_t jobs = 0;
  auto const begin = std::chrono::steady_clock::now();
  for (auto const& set : sets) {
    ProgressBar bar(set.title);
    options.progress = [&bar](std::size_t done, std::size_t total) { bar(done, total); };
    jobs += run_benchmark(set, contenders, store, options);
  }
  double const seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();

  std::vector<Tally> tallies;
  for (auto const& set : sets)
    for (auto const& contender : contenders)
      tallies.push_back({.set = set.title, .behavior = contender.name, .parameters_hash = contender.parameters_hash});
  std::vector<std::uint64_t> hashes;
  for (auto const& set : sets) hashes.push_back(set.hash());
  store.for_each([&](ResultRow const& row) {
    for (std::size_t s = 0; s < sets.size(); ++s)
      for (std::size_t c = 0; c < contenders.size(); ++c)
        if (row.key.set_hash == hashes[s] && row.key.behavior == contenders[c].name &&
            row.key.parameters_hash == contenders[c].parameters_hash && row.key.version == library_version)
          tallies[s * contenders.size() + c].add(row);
  });
  print_tallies(tallies);
  std::printf("\n  %zu runs in %.1f s on %zu threads; results in %s\n", jobs, seconds, options.threads,
              file.string().c_str());
  if (auto const json = arguments.text("--json")) write_file(*json, tallies_json(tallies));
  return 0;
}

}  // namespace detail

/// The `main` of a benchmark program: reads scenario sets whose behaviours are those of `World`, runs `contenders` on
/// them, keeps the results in a database, and prints a table. `--help` lists the options. Returns the exit code: 0, or
/// 2 after an error, which it prints in one line.
template <class World>
int benchmark_main(int argc, char const* const* argv, std::vector<Contender<World>> const& contenders,
                   BenchmarkDefaults const& defaults = {}) {
  auto const options = detail::benchmark_options();
  try {
    detail::Arguments const arguments(argc, argv, options);
    if (arguments.has("--help")) {
      std::cout << "Runs behaviours on sets of scenarios.\n\n";
      for (auto const& option : options)
        std::printf("  %-32s %s\n", (option.name + " " + option.value).c_str(), option.sentence.c_str());
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
    std::string command = defaults.program;
    for (int i = 1; i < argc; ++i) command += std::string(" ") + argv[i];
    return detail::run_benchmark_program(arguments, contenders, command, defaults);
  } catch (std::exception const& problem) {
    std::cerr << defaults.program << ": " << problem.what() << "\n";
    return 2;
  }
}

}  // namespace cambium
