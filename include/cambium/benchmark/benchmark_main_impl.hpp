#pragma once

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <iterator>
#include <map>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "cambium/benchmark/benchmark_main.hpp"
#include "cambium/benchmark/detail/arguments.hpp"
#include "cambium/benchmark/detail/report_text.hpp"
#include "cambium/benchmark/executor.hpp"
#include "cambium/benchmark/html_report.hpp"
#include "cambium/benchmark/measure.hpp"
#include "cambium/benchmark/run_result.hpp"
#include "cambium/benchmark/runner.hpp"
#include "cambium/core/error.hpp"
#include "cambium/core/json_document.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/core/text.hpp"

namespace cambium {

CAMBIUM_COLD std::string shell_word(std::string const& word) {
  auto const is_plain = [](unsigned char c) { return std::isalnum(c) != 0 || std::strchr("_-./,:=+", c) != nullptr; };
  if (!word.empty() && std::ranges::all_of(word, is_plain)) return word;
  std::string quoted = "'";
  for (char const c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

namespace detail {

CAMBIUM_COLD std::vector<Option> benchmark_options() {
  std::vector<Option> options{
      {"--set", "FILE|NAME", "scenario files (.json) or names of sets, separated by commas"},
      {"--behaviors", "A,B,...", "the behaviours to run; all without it"},
      {"--scenarios", "N", "number of scenarios that each recipe draws, instead of its own"},
      {"--seed", "S", "seed of the recipes, instead of their own"},
      {"--split", "train|test",
       "train: other scenarios of the recipes than usual, to tune a behaviour on; test: the usual ones, to report"},
      {"--threads", "T", "number of threads; the results do not depend on it"},
      {"--db", "FILE", "database of the results; what it has already is not run again"},
      {"--shard", "i/n", "run only the i-th of n parts, i from 0; merge the databases with examples/run report"},
      {"--plan-limit", "SECONDS",
       "ends a run whose plans take longer than that together: an error. With --processes, a plan that never "
       "returns is ended, too. Off without it, because the results then depend on the machine"},
      {"--replays", "failures|all|none",
       "the runs that leave a replay in a folder beside the database (results_replays beside results.db); failures "
       "(usual): of those of each behaviour and set, the first 20. A failure leaves a snapshot, too"},
      {"--again", "", "run also what the database has already"},
      {"--only", "SET:NUMBER:BEHAVIOR", "run one scenario and print what came of it"},
      {"--replay", "FILE",
       "with --only: write a replay that opens in a browser, and beside it the snapshot of a failure"},
      {"--json", "FILE", "write the table, a row a set, title of its recipes, and behaviour"},
      {"--list", "", "list behaviours and sets, and exit"},
      {"--help", "", "print this and exit"}};
  if (CAMBIUM_HAS_PROCESSES)
    options.insert(options.begin() + 6, {"--processes", "N",
                                         "in place of threads: each run in one of N processes. A behaviour that "
                                         "crashes then costs that run only"});
  return options;
}

CAMBIUM_COLD std::optional<std::filesystem::path> nested_set(std::filesystem::path const& folder,
                                                             std::string const& name) {
  std::optional<std::filesystem::path> found;
  if (name.empty() || !std::filesystem::is_directory(folder)) return found;
  for (auto const& inner : std::filesystem::directory_iterator(folder)) {
    auto const file = inner.path() / (name + ".json");
    if (!inner.is_directory() || !std::filesystem::is_regular_file(file)) continue;
    if (found) return std::nullopt;
    found = file;
  }
  return found;
}

CAMBIUM_COLD std::vector<std::filesystem::path> set_files(std::vector<std::string> const& names,
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
    if (auto const nested = nested_set(folder, name); nested && !std::filesystem::is_directory(folder / name)) {
      files.push_back(*nested);
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

CAMBIUM_COLD std::string summary_json(std::vector<TrafficGroup> const& parts) {
  std::vector<JsonValue> rows;
  for (auto const& [traffic, group] : parts) {
    std::map<std::string, double> means;
    for (auto const& measure : measures()) means[measure.key] = mean_of_measure(group, measure);
    auto successes = group;
    std::erase_if(successes.rows, [](auto const& row) { return !row.result.success; });
    for (auto const& measure : measures())
      if (measure.key == "duration_s") means["mean_time_s"] = mean_of_measure(successes, measure);
    std::vector<JsonValue::Member> row{{"planner", {group.behavior}},
                                       {"situation", {group.set}},
                                       {"traffic", traffic.empty() ? JsonValue{} : JsonValue{traffic}},
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
                                    {"mean_time_s", "mean_time_s"},
                                    {"closed_loop_score", "closed_loop_score"},
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

CAMBIUM_COLD BenchmarkOptions options_of(Arguments const& arguments, std::filesystem::path const& database,
                                         Executor const& executor) {
  BenchmarkOptions options;
  auto const threads = arguments.whole("--threads", 1, 4096);
  if (threads) options.executor = on_threads(static_cast<std::size_t>(*threads));
#if CAMBIUM_HAS_PROCESSES
  if (auto const processes = arguments.whole("--processes", 1, 4096)) {
    if (threads) throw Error("--processes", "is given beside --threads", "give one of them");
    options.executor = on_processes(static_cast<std::size_t>(*processes));
  }
#endif
  if (executor.execute) {
    if (threads || arguments.has("--processes"))
      throw Error(threads ? "--threads" : "--processes", "is given, but the jobs run on " + executor.name,
                  "leave it out");
    options.executor = executor;
  }
  options.again = arguments.has("--again");
  options.plan_limit = arguments.seconds("--plan-limit").value_or(options.plan_limit);
  options.replay_folder = replay_folder(database);
  auto const replays = arguments.text("--replays").value_or("failures");
  if (replays != "failures" && replays != "all" && replays != "none")
    throw Error("--replays", "is '" + replays + "'", "write failures, all or none");
  options.replays = replays == "failures" ? Replays::failures : replays == "all" ? Replays::all : Replays::none;
  if (auto const shard = arguments.text("--shard")) {
    auto const parts = split(*shard, "/");
    auto const i = parse_number<std::size_t>(parts[0]), n = parse_number<std::size_t>(parts.back());
    if (parts.size() != 2 || !i || !n || *n == 0 || *i >= *n)
      throw Error("--shard", "is '" + *shard + "'", "write i/n with i from 0 to n - 1, as 0/4");
    options.shard = *i;
    options.shards = *n;
  }
  return options;
}

CAMBIUM_COLD std::string source_of(Arguments const& arguments, std::filesystem::path const& file,
                                   std::filesystem::path const& folder) {
  auto const below = file.lexically_relative(folder);
  bool const is_below = !below.empty() && *below.begin() != "..";
  std::string source =
      "--set " + shell_word(is_below ? below.parent_path() / below.stem() : std::filesystem::absolute(file));
  for (char const* option : {"--scenarios", "--seed", "--split", "--plan-limit"})
    if (auto const value = arguments.text(option)) source += std::string(" ") + option + " " + *value;
  return source;
}

CAMBIUM_COLD std::string lines_of(RunResult const& result) {
  std::string text;
  for_each_parameter<RunResult>([&](auto const& entry) {
    using Field = std::remove_cvref_t<decltype(result.*entry.field)>;
    text += std::string("  ") + entry.name + ": ";
    if constexpr (std::is_same_v<Field, std::string>)
      text += (result.*entry.field).c_str();
    else
      text += with_unit(value_text(entry, PlainValue::at(&(result.*entry.field), type_info<Field>())), entry.unit);
    text += "\n";
  });
  return text;
}

}  // namespace detail

}  // namespace cambium
