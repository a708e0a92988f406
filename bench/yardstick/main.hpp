#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <functional>
#include <initializer_list>
#include <iterator>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <regex.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <benchmark/benchmark.h>

#include "measure.hpp"

// The main program of a benchmark: options, table, JSON.

namespace yardstick {

/// What the repetitions of one benchmark gave.
struct Result {
  std::string counter;  ///< ns_per_agent_step, ns_per_copy, per_second, ms or ns; empty when the benchmark failed
  double best = 0.0;    ///< the minimum; of a rate, the maximum
  double median = 0.0;
  double allocations = 0.0;  ///< the most of any repetition, per step, copy or roll-out
  std::int64_t order = 0;    ///< of registration
  std::string message;       ///< of a failure
};

/// Results by the name of the benchmark.
using Results = std::map<std::string, Result>;

/// best(numerator) / best(denominator), or nothing where one is missing (filtered out, failed).
[[nodiscard]] inline std::optional<double> ratio(Results const& results, std::string const& numerator,
                                                 std::string const& denominator) {
  auto const above = results.find(numerator);
  auto const below = results.find(denominator);
  if (above == results.end() || below == results.end()) return std::nullopt;
  if (above->second.counter.empty() || below->second.counter.empty()) return std::nullopt;
  return above->second.best / below->second.best;
}

/// Whether more of it is better.
[[nodiscard]] inline bool is_rate(std::string const& counter) { return counter == rate || counter == search_rate; }

/// Prints what the best of each row is beside its target.
inline void print_targets(Results const& results, std::initializer_list<std::pair<char const*, double>> targets) {
  std::printf("\ntargets\n");
  for (auto const& [name, target] : targets) {
    auto const row = results.find(name);
    if (row == results.end() || row->second.counter.empty()) continue;
    auto const& [counter, best] = std::tie(row->second.counter, row->second.best);
    bool const is_kept = is_rate(counter) ? best >= target : best <= target;
    std::printf("  %-26s %12.1f   target %9.0f %-22s %s\n", name, best, target, counter.c_str(),
                is_kept ? "kept" : "MISSED");
  }
}

/// Collects the repetitions and prints a row for each benchmark at the end.
class TableReporter : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(Context const&) override { return true; }

  void ReportRuns(std::vector<Run> const& runs) override {
    if (runs.empty() || runs.front().run_type != Run::RT_Iteration) return;  // statistics come in a call of their own
    std::string name = runs.front().run_name.str();
    if (name.ends_with("/real_time")) name.resize(name.rfind('/'));  // targets name what was added
    results_[name] = summary(runs);
    if (isatty(STDERR_FILENO) != 0) std::fprintf(stderr, "\r%3zu done, last %-40s", results_.size(), name.c_str());
  }

  void Finalize() override {
    if (isatty(STDERR_FILENO) != 0) std::fprintf(stderr, "\r%60s\r", "");
    std::vector<Results::const_iterator> rows;
    for (auto row = results_.cbegin(); row != results_.cend(); ++row) rows.push_back(row);
    std::sort(rows.begin(), rows.end(), [](auto a, auto b) { return a->second.order < b->second.order; });
    std::printf("%-28s %14s %14s  %-18s %12s\n", "benchmark", "best", "median", "", "allocations");
    for (auto const& row : rows) print(row->first, row->second);
    std::fflush(stdout);
  }

  [[nodiscard]] Results const& results() const { return results_; }
  [[nodiscard]] bool failed() const {
    return std::any_of(results_.begin(), results_.end(), [](auto const& row) { return row.second.counter.empty(); });
  }

 private:
  [[nodiscard]] static Result summary(std::vector<Run> const& runs) {
    Result result;
    std::vector<double> values;
    for (auto const& run : runs) {
      result.order = run.family_index;
      result.message = run.report_label;
      for (char const* counter : {per_agent_step, per_copy, rate, search_rate, milliseconds, per_query}) {
        auto const found = run.counters.find(counter);
        if (found == run.counters.end()) continue;
        result.counter = counter;
        values.push_back(found->second.value);
      }
      auto const used = run.counters.find(allocation_counter);
      if (used != run.counters.end()) result.allocations = std::max(result.allocations, used->second.value);
    }
    if (values.empty()) return result;
    std::sort(values.begin(), values.end());
    std::size_t const middle = values.size() / 2;
    result.median = values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
    result.best = is_rate(result.counter) ? values.back() : values.front();
    return result;
  }

  static void print(std::string const& name, Result const& result) {
    if (result.counter.empty()) {
      std::printf("%-28s failed %s\n", name.c_str(), result.message.c_str());
      return;
    }
    int const digits = is_rate(result.counter) ? 0 : 2;
    std::printf("%-28s %14.*f %14.*f  %-18s %12.2f\n", name.c_str(), digits, result.best, digits, result.median,
                result.counter.c_str(), result.allocations);
  }

  Results results_;
};

namespace detail {

/// The library's JSON without the coefficient of variation: of counters that are 0 it is NaN, which is no JSON.
class JsonReporter : public benchmark::JSONReporter {
 public:
  void ReportRuns(std::vector<Run> const& runs) override {
    std::vector<Run> kept;
    std::copy_if(runs.begin(), runs.end(), std::back_inserter(kept),
                 [](Run const& run) { return run.aggregate_name != "cv"; });
    if (!kept.empty()) benchmark::JSONReporter::ReportRuns(kept);
  }

  void Finalize() override {
    benchmark::JSONReporter::Finalize();
    failed_ = !GetOutputStream().flush();
  }

  /// Did the file not take all that was written (a full disk, say)?
  [[nodiscard]] bool failed() const { return failed_; }

 private:
  bool failed_ = false;
};

struct Options {
  std::string filter = ".";
  std::string json;
  int repetitions = 7;
  double min_time = 0.05;
  bool list = false;
};

[[nodiscard]] inline std::string regex_mistake(std::string const& text) {
  regex_t pattern;
  if (regcomp(&pattern, text.c_str(), REG_EXTENDED | REG_NOSUB) != 0) return "'" + text + "' is no regular expression";
  regfree(&pattern);
  return "";
}

// Opened without truncation: a run that stops before its end leaves an older file alone.
[[nodiscard]] inline std::string file_mistake(std::string const& path) {
  return std::ofstream(path, std::ios::app) ? "" : "cannot write '" + path + "'";
}

inline void describe(CLI::App& program, Options& options) {
  program.add_option("--filter", options.filter, "only benchmarks whose name contains a match")
      ->type_name("REGEX")
      ->check(CLI::Validator(regex_mistake, ""));
  program.add_option("--json", options.json, "write Google Benchmark's JSON")
      ->type_name("FILE")
      ->check(CLI::Validator(file_mistake, ""));
  program.add_option("--repetitions", options.repetitions, "of each benchmark, shuffled among the others")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  program.add_option("--min-time", options.min_time, "least time of one repetition [s]")
      ->check(CLI::Range(1e-4, 100.0))
      ->capture_default_str();
  program.add_flag("--list", options.list, "print the names and stop");
  program.footer("Times are CPU time of one thread. best: minimum of the repetitions, of a rate the maximum.");
}

// Hands the options to the library in its own words.
inline void initialize(char* program, Options const& options) {
  std::vector<std::string> words{"--benchmark_repetitions=" + std::to_string(options.repetitions),
                                 "--benchmark_min_time=" + std::to_string(options.min_time),
                                 "--benchmark_filter=" + options.filter, "--benchmark_enable_random_interleaving=true"};
  if (options.list) words.emplace_back("--benchmark_list_tests=true");
  if (!options.json.empty() && !options.list) {
    words.push_back("--benchmark_out=" + options.json);
    words.emplace_back("--benchmark_out_format=json");
  }
  std::vector<char*> arguments{program};
  for (auto& word : words) arguments.push_back(word.data());
  int count = static_cast<int>(arguments.size());
  arguments.push_back(nullptr);
  benchmark::Initialize(&count, arguments.data());
}

}  // namespace detail

/// Runs the registered benchmarks, prints the table and calls `afterwards` with the results (for ratios, say).
/// Returns the exit code: 0; 1 when a benchmark failed; 2 for wrong options, in one line on the standard error.
inline int run_benchmarks(int argc, char** argv, std::string const& purpose,
                          std::function<void(Results const&)> const& afterwards) {
  detail::Options options;
  CLI::App program(purpose, argv[0]);
  detail::describe(program, options);
  try {
    program.parse(argc, argv);
  } catch (CLI::CallForHelp const&) {
    std::printf("%s", program.help().c_str());
    return 0;
  } catch (CLI::ParseError const& mistake) {
    std::fprintf(stderr, "%s: %s\n", argv[0], mistake.what());
    return 2;
  }
  detail::initialize(argv[0], options);
#ifdef CAMBIUM_BENCH_FLAGS
  if (!options.list) std::printf("compiled by %s, %s\n", __VERSION__, CAMBIUM_BENCH_FLAGS);
#endif
  if (!options.list && isatty(STDERR_FILENO) == 0) std::fprintf(stderr, "measuring, which takes a minute or two\n");
  TableReporter table;
  detail::JsonReporter json;
  bool const has_file = !options.json.empty() && !options.list;
  std::size_t const matching =
      has_file ? benchmark::RunSpecifiedBenchmarks(&table, &json) : benchmark::RunSpecifiedBenchmarks(&table);
  benchmark::Shutdown();
  if (matching == 0) return 2;  // the library has said so
  if (json.failed()) {
    std::fprintf(stderr, "%s: --json: cannot write all of '%s'\n", argv[0], options.json.c_str());
    return 2;
  }
  if (!options.list) afterwards(table.results());
  return table.failed() ? 1 : 0;
}

}  // namespace yardstick
