#pragma once

#if defined(__unix__) || defined(__APPLE__)
#include <unistd.h>
#endif

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <map>
#include <optional>
#include <string>
#include <system_error>
#include <type_traits>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "cambium/benchmark/benchmark_main.hpp"
#include "cambium/benchmark/detail/report_text.hpp"
#include "cambium/benchmark/executor.hpp"
#include "cambium/benchmark/html_report.hpp"
#include "cambium/benchmark/measure.hpp"
#include "cambium/benchmark/result_group.hpp"
#include "cambium/benchmark/run_result.hpp"
#include "cambium/benchmark/runner.hpp"
#include "cambium/core/error.hpp"
#include "cambium/core/json_document.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/core/nearest_names.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/core/text.hpp"
#include "cambium/core/write_file.hpp"
#include "cambium/scenario/scenario_set.hpp"
#include "cambium/viewer/html_replay.hpp"

#if __has_include(<sys/wait.h>)
#define CAMBIUM_HAS_PROCESSES 1
#include "cambium/benchmark/run_on_processes.hpp"
#else
#define CAMBIUM_HAS_PROCESSES 0
#endif

namespace cambium::inline v0_1 {

namespace detail {

/// Adds an option with a value: `take(word)` stores it, or throws `Error`.
template <class Take>
void add_text(CLI::App& app, char const* name, char const* kind, char const* sentence, Take const& take) {
  app.add_option_function<std::string>(name, take, sentence)->type_name(kind);
}

/// Adds an option whose value is a whole number from `low` to `high`.
template <class Take>
void add_whole(CLI::App& app, std::string const& name, char const* kind, std::uint64_t low, std::uint64_t high,
               char const* sentence, Take const& take) {
  add_text(app, name.c_str(), kind, sentence, [=](std::string const& word) {
    auto const value = parse_number<std::uint64_t>(word);
    if (!value || *value < low || *value > high)
      throw Error(name, "is '" + word + "'",
                  "give a whole number from " + std::to_string(low) + " to " + std::to_string(high));
    take(*value);
  });
}

/// "i/n": the i-th of n parts.
inline void take_shard(std::string const& word, BenchmarkOptions& options) {
  auto const parts = split(word, "/");
  auto const i = parse_number<std::size_t>(parts[0]), n = parse_number<std::size_t>(parts.back());
  if (parts.size() != 2 || !i || !n || *n == 0 || *i >= *n)
    throw Error("--shard", "is '" + word + "'", "write i/n with i from 0 to n - 1, as 0/4");
  options.shard = *i;
  options.shards = *n;
}

/// What is wrong with a command line that CLI11 refuses.
[[nodiscard]] inline Error command_error(CLI::App const& app, CLI::ParseError const& problem) {
  std::vector<std::string> names;
  for (auto const* const option : app.get_options()) {
    names.push_back(option->get_name());
    if (option->count() > 1) return {names.back(), "is given twice", "give it once"};
  }
  std::string const text = problem.what(), named = text.substr(0, text.find(':'));
  if (auto const* const option = app.get_option_no_throw(named))
    return {named, "lacks its value", "write " + named + " " + option->get_type_name()};
  auto const extra = app.remaining();
  if (extra.empty()) return {"command line", text, "--help lists the options"};
  auto const name = extra.front().substr(0, extra.front().find('='));
  return {extra.front(), "is no option",
          (nearest_names(name, names).empty() ? "" : suggestion(name, names) + " ") + "(--help lists them)"};
}

inline std::map<std::string, Replays> const replays_by_word{
    {"failures", Replays::failures}, {"all", Replays::all}, {"none", Replays::none}};

/// Adds the options, which fill `command`. Sets are held in memory, hence the limit of scenarios.
inline void add_benchmark_options(CLI::App& app, BenchmarkCommand& command) {
  auto& options = command.options;
  auto const store_in = [](auto& target) { return [&target](auto const& value) { target = value; }; };
  auto const list_in = [](std::vector<std::string>& names) {
    return [&names](std::string const& word) {
      for (auto const part : split(word, ",")) names.emplace_back(trimmed(part));
    };
  };
  add_text(app, "--set", "FILE|NAME", "scenario files (.json) or names of sets, separated by commas",
           list_in(command.sets));
  add_text(app, "--behaviors", "A,B,...", "the behaviours to run; default: all", list_in(command.behaviors));
  add_whole(app, "--scenarios", "N", 1, 100'000, "number of scenarios that each recipe draws, instead of its own",
            store_in(command.scenarios));
  add_whole(app, "--seed", "S", 0, ~std::uint64_t{0}, "seed of the recipes, instead of their own",
            store_in(command.seed));
  add_text(app, "--populations", "A,B,...",
           "who drives the others, of the populations that a recipe names: as_given, timid, aggressive, inattentive, "
           "mixed; default: all of these",
           [&](std::string const& word) {
             auto const known = split(population_names, "|");
             for (auto const part : split(word, ",")) {
               auto const at = std::ranges::find(known, trimmed(part));
               if (at == known.end())
                 throw Error("--populations", "is '" + word + "'", "name some of " + joined(known, ", "));
               command.populations.push_back(static_cast<TrafficPopulation>(at - known.begin()));
             }
           });
  add_text(app, "--split", "train|test",
           "train: other scenarios of the recipes, to tune a behaviour on; test (default): those to report",
           [&](auto const& word) {
             command.trains = word == "train";
             if (!command.trains && word != "test") throw Error("--split", "is '" + word + "'", "write train or test");
           });
  add_whole(app, "--threads", "T", 1, 4096, "number of threads; the results do not depend on it",
            [&](auto count) { options.executor = on_threads(static_cast<std::size_t>(count)); });
#if CAMBIUM_HAS_PROCESSES
  add_whole(app, "--processes", "N", 1, 4096,
            "in place of threads: each run in one of N processes. A behaviour that crashes then costs that run only",
            [&](auto count) { options.executor = on_processes(static_cast<std::size_t>(count)); });
#endif
  add_text(app, "--db", "FILE", "database of the results; what it has already is not run again",
           store_in(command.database));
  add_text(app, "--shard", "i/n",
           "run only the i-th of n parts, i from 0; merge the databases with examples/run report",
           [&](auto const& word) { take_shard(word, options); });
  add_text(
      app, "--plan-limit", "SECONDS",
      "ends a run whose plans take longer than that together: an error. With --processes, a plan that never returns "
      "is ended, too. Default: no limit, because the results then depend on the machine",
      [&](auto const& word) {
        options.plan_limit = parse_number<double>(word).value_or(0.0);
        if (!(options.plan_limit > 0.0))
          throw Error("--plan-limit", "is '" + word + "'", "give a number of seconds above 0");
      });
  add_text(app, "--replays", "failures|all|none",
           "the runs that leave a replay in a folder beside the database (results_replays beside results.db); failures "
           "(default): of those of each behaviour and set, the first 20. A failure leaves a snapshot, too",
           [&](auto const& word) {
             if (!replays_by_word.contains(word))
               throw Error("--replays", "is '" + word + "'", "write failures, all or none");
             options.replays = replays_by_word.at(word);
           });
  app.add_flag("--again", options.again, "run also what the database has already");
  add_text(app, "--only", "SET:NUMBER:BEHAVIOR", "run one scenario and print what came of it", store_in(command.only));
  add_text(app, "--replay", "FILE",
           "with --only: write a replay that opens in a browser, and beside it the snapshot of a failure",
           store_in(command.replay));
  add_text(app, "--json", "FILE",
           "write the table: a row for each set, title of its recipes, population, and behaviour",
           store_in(command.json));
  app.add_flag("--list", command.lists, "list behaviours and sets, and exit");
  app.set_help_flag("--help", "print this and exit");
}

/// Throws `Error` for options that do not go together.
inline void check_command(BenchmarkCommand const& command) {
  if (command.database.empty()) throw Error("--db", "is empty", "name a file, or leave the option out");
  if (command.replay && !command.only) throw Error("--replay", "needs --only", "say which scenario to replay");
  if (!command.json) return;
  if (command.only) throw Error("--json", "goes with runs of sets, not with --only", "leave it out");
  namespace fs = std::filesystem;
  if (command.json->empty() || fs::is_directory(*command.json) ||
      !fs::is_directory(fs::absolute(*command.json).parent_path()))
    throw Error("--json '" + *command.json + "'", "names no file in a folder that exists", "name one");
}

CAMBIUM_COLD std::optional<BenchmarkCommand> parse_benchmark_command(int argc, char const* const* argv,
                                                                     BenchmarkDefaults const& defaults) {
  BenchmarkCommand command{.database = defaults.out / "results.db"};
  CLI::App app("Runs behaviours on sets of scenarios.",
               argc > 0 ? std::filesystem::path(argv[0]).filename().string() : "benchmark");
  add_benchmark_options(app, command);
  try {
    app.parse(argc, argv);
  } catch (CLI::CallForHelp const&) {
    if (!defaults.executor.is_worker) std::cout << app.help();
    return std::nullopt;
  } catch (CLI::ParseError const& problem) {
    throw command_error(app, problem);
  }
  auto const is_given = [&](char const* name) {
    auto const* const option = app.get_option_no_throw(name);
    return option != nullptr && option->count() > 0;
  };
  for (char const* name : {"--threads", "--processes"})
    if (defaults.executor.execute && is_given(name))
      throw Error(name, "is given, but the jobs run on " + defaults.executor.name, "leave it out");
  if (is_given("--threads") && is_given("--processes"))
    throw Error("--processes", "is given beside --threads", "give one of them");
  if (defaults.executor.execute) command.options.executor = defaults.executor;
  if (command.sets.empty()) command.sets = {defaults.set};
  check_command(command);
  command.options.replay_folder = replay_folder(command.database);
  for (std::string const name : {"--scenarios", "--seed", "--populations", "--split", "--plan-limit"})
    if (is_given(name.c_str())) command.drawing += " " + name + " " + app.get_option(name)->as<std::string>();
  return command;
}

CAMBIUM_COLD std::string list_of(std::vector<std::string> const& behaviors, BenchmarkDefaults const& defaults) {
  std::string text = "behaviours:\n";
  for (auto const& name : behaviors) text += "  " + name + "\n";
  text += "sets:\n";
  std::error_code none_there;
  for (auto const& entry : std::filesystem::directory_iterator(defaults.sets, none_there)) {
    if (!entry.is_directory()) continue;
    auto const name = entry.path().filename().string();
    text += "  " + name + ":";
    for (auto const& file : set_files({name}, defaults)) text += " " + file.stem().string();
    text += "\n";
  }
  return text;
}

/// The file of that name in a folder of `folder`; nothing if there is none, or several.
[[nodiscard]] inline std::optional<std::filesystem::path> nested_set(std::filesystem::path const& folder,
                                                                     std::string const& name) {
  std::optional<std::filesystem::path> found;
  if (!std::filesystem::is_directory(folder)) return found;
  for (auto const& inner : std::filesystem::directory_iterator(folder)) {
    auto const file = inner.path() / (name + ".json");
    if (!inner.is_directory() || !std::filesystem::is_regular_file(file)) continue;
    if (found) return std::nullopt;
    found = file;
  }
  return found;
}

CAMBIUM_COLD std::vector<std::filesystem::path> set_files(std::vector<std::string> const& names,
                                                          BenchmarkDefaults const& defaults) {
  auto const& folder = defaults.sets;
  std::vector<std::filesystem::path> files;
  for (auto const& name : names) {
    std::filesystem::path const places[] = {name, folder / (name + ".json"), folder / defaults.set / (name + ".json")};
    auto const* const place =
        std::ranges::find_if(places, [](auto const& path) { return std::filesystem::is_regular_file(path); });
    std::filesystem::path const whole =
        std::filesystem::is_directory(folder / name) ? folder / name : std::filesystem::path(name);
    bool const is_folder = !name.empty() && std::filesystem::is_directory(whole);
    auto const nested = is_folder || name.empty() ? std::nullopt : nested_set(folder, name);
    if (place != std::end(places)) {
      files.push_back(*place);
    } else if (nested) {
      files.push_back(*nested);
    } else if (is_folder) {
      auto const first = static_cast<std::ptrdiff_t>(files.size());
      for (auto const& entry : std::filesystem::directory_iterator(whole))
        if (entry.path().extension() == ".json") files.push_back(entry.path());
      if (files.begin() + first == files.end())
        throw Error("--set " + name, "the folder " + whole.string() + " has no scenario files (.json)",
                    "--list names the sets that there are");
      std::sort(files.begin() + first, files.end());
    } else {
      throw Error("--set " + name, "is neither a scenario file nor a folder in " + folder.string(),
                  "--list names the sets that there are");
    }
  }
  return files;
}

/// The share of runs in which others had to brake hard because of the ego: harder than `CriterionBounds` permits where
/// a set does not say.
[[nodiscard]] inline double share_with_hard_braking(ResultGroup const& group) {
  auto const is_hard = [](auto const& row) { return row.result.imposed_braking > CriterionBounds{}.imposed_braking; };
  return static_cast<double>(std::ranges::count_if(group.rows, is_hard)) / static_cast<double>(group.rows.size());
}

CAMBIUM_COLD std::string summary_json(std::vector<TrafficGroup> const& parts) {
  std::vector<JsonValue> rows;
  for (auto const& [traffic, population, group] : parts) {
    std::map<std::string, double> means;
    for (auto const& measure : measures()) means[measure.key] = mean_of_measure(group, measure);
    auto successes = group;
    std::erase_if(successes.rows, [](auto const& row) { return !row.result.success; });
    means["mean_time_s"] = mean_of_measure(successes, measures()[measure_index("duration_s")]);
    means["imposed_hard_braking"] = share_with_hard_braking(group);
    std::vector<JsonValue::Member> row{{"planner", {group.behavior}},
                                       {"situation", {group.set}},
                                       {"traffic", traffic.empty() ? JsonValue{} : JsonValue{traffic}},
                                       {"population", population.empty() ? JsonValue{} : JsonValue{population}},
                                       {"set", {group.set}},
                                       {"set_hash", {hash_text(group.set_hash)}},
                                       {"behavior", {group.behavior}},
                                       {"parameters_hash", {hash_text(group.parameters_hash)}},
                                       {"scenarios", {std::uint64_t{group.rows.size()}}}};
    for (auto const& [name, key] : {std::pair{"success", "success"},
                                    {"collision", "collision"},
                                    {"collision_at_fault", "at_fault"},
                                    {"off_road", "off_road"},
                                    {"off_route", "off_route"},
                                    {"timed_out", "timed_out"},
                                    {"error", "error"},
                                    {"infeasible", "infeasible"},
                                    {"red_light", "red_light"},
                                    {"stop_sign", "stop_sign"},
                                    {"right_of_way", "right_of_way"},
                                    {"wrong_way", "wrong_way"},
                                    {"speeding", "speeding"},
                                    {"solid_line", "solid_line"},
                                    {"imposed_braking", "imposed_braking"},
                                    {"imposed_hard_braking", "imposed_hard_braking"},
                                    {"impact_speed", "impact_speed"},
                                    {"mean_time_s", "mean_time_s"},
                                    {"closed_loop_score", "closed_loop_score"},
                                    {"prediction_error_1s", "prediction_error_1s"},
                                    {"prediction_error_3s", "prediction_error_3s"},
                                    {"prediction_error_5s", "prediction_error_5s"},
                                    {"prediction_brier", "prediction_brier"},
                                    {"ms_per_decision", "mean_ms"}})
      row.push_back({name, std::isfinite(means.at(key)) ? JsonValue{means.at(key)} : JsonValue{}});
    rows.push_back({std::move(row)});
  }
  return print_json({std::move(rows)});
}

CAMBIUM_COLD std::string time_of_day() {
  auto const now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%d %H:%M:%S", std::gmtime(&now));
  return text;
}

CAMBIUM_COLD std::string source_of(BenchmarkCommand const& command, std::filesystem::path const& file,
                                   std::filesystem::path const& folder) {
  auto const below = file.lexically_relative(folder);
  bool const is_below = !below.empty() && *below.begin() != "..";
  auto const set = is_below ? below.parent_path() / below.stem() : std::filesystem::absolute(file);
  return "--set " + shell_word(set.string()) + command.drawing;
}

extern "C" inline void say_how_to_go_on(int signal) {
  constexpr char text[] = "\ninterrupted: the same command goes on where it was\n";
#if defined(__unix__) || defined(__APPLE__)
  [[maybe_unused]] auto const written = write(STDERR_FILENO, text, sizeof text - 1);
#else
  std::fputs(text, stderr);
#endif
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

/// The process whose runs go on; -1: none. (Processes for single runs have numbers of their own.)
inline long running_process = -1;

[[nodiscard]] inline long this_process() {
#if defined(__unix__) || defined(__APPLE__)
  return getpid();
#else
  return 0;
#endif
}

extern "C" inline void refuse_exit() {
  if (running_process != this_process()) return;
  std::fputs("a planner has ended the program: with --processes, this costs its own run only\n", stderr);
  std::_Exit(EXIT_FAILURE);
}

CAMBIUM_COLD SaysWhyItEnds::SaysWhyItEnds() : before_(std::signal(SIGINT, &say_how_to_go_on)) {
  if (before_ == SIG_IGN) std::signal(SIGINT, SIG_IGN);
  [[maybe_unused]] static int const registered = std::atexit(&refuse_exit);
  running_process = this_process();
}
CAMBIUM_COLD SaysWhyItEnds::~SaysWhyItEnds() {
  running_process = -1;
  std::signal(SIGINT, before_);
}

CAMBIUM_COLD void write_replay(std::filesystem::path const& replay, Run run) {
  if (!run.recording)
    throw Error("--replay " + replay.string(), "there is nothing to replay",
                "the run ended before it began: see its error");
  write_html_replay(replay, *run.recording);
  std::cout << "  " << replay.string() << " plays it in a browser\n";
  if (!run.problem.empty()) std::cout << "  there is no snapshot beside it: " << run.problem << "\n";
  auto const snapshot = std::filesystem::path(replay).replace_extension(".snapshot");
  if (run.snapshot.empty()) {
    std::error_code refused;
    std::filesystem::remove(snapshot, refused);  // of an earlier run
    return;
  }
  write_file(snapshot, run.snapshot);
  std::cout << "  " << snapshot.string() << " is its state before the end\n";
}

CAMBIUM_COLD std::string lines_of(RunResult const& result) {
  std::string text;
  for_each_parameter<RunResult>([&](auto const& entry) {
    using Field = std::remove_cvref_t<decltype(result.*entry.field)>;
    text += std::string("  ") + entry.name + ": ";
    if constexpr (std::is_same_v<Field, std::string>)
      text += result.*entry.field;
    else if (auto const value = PlainValue::at(&(result.*entry.field), type_info<Field>());
             type_info<Field>().is_real() && std::isnan(value.number))
      text += "undefined";
    else
      text += with_unit(value_text(entry, value), entry.unit);
    text += "\n";
  });
  return text;
}

}  // namespace detail

}  // namespace cambium::inline v0_1
