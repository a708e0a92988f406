#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <regex.h>
#include <unistd.h>

#include <benchmark/benchmark.h>

#include "measure.hpp"

// The main program of a benchmark: options, table, JSON.

namespace yardstick {

/// What the repetitions of one benchmark gave.
struct Result {
  std::string counter;  ///< ns_per_agent_step, ns_per_copy, per_second or ms; empty when the benchmark failed
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

/// Collects the repetitions and prints a row for each benchmark at the end.
class TableReporter : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(Context const&) override { return true; }

  void ReportRuns(std::vector<Run> const& runs) override {
    if (runs.empty() || runs.front().run_type != Run::RT_Iteration) return;  // statistics come in a call of their own
    std::string const name = runs.front().run_name.str();
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
      for (char const* counter : {per_agent_step, per_copy, rate, milliseconds}) {
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
    result.best = result.counter == rate ? values.back() : values.front();
    return result;
  }

  static void print(std::string const& name, Result const& result) {
    if (result.counter.empty()) {
      std::printf("%-28s failed %s\n", name.c_str(), result.message.c_str());
      return;
    }
    int const digits = result.counter == rate ? 0 : 2;
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

inline constexpr char const* benchmark_help =
    "usage: %s [options]\n"
    "  --filter REGEX     only benchmarks whose name contains a match\n"
    "  --list             print the names and stop\n"
    "  --json FILE        write Google Benchmark's JSON\n"
    "  --repetitions N    of each benchmark, shuffled among the others (default 7)\n"
    "  --min-time S       least time of one repetition in seconds (default 0.05)\n"
    "  --help             this text\n"
    "Times are CPU time of one thread. best: minimum of the repetitions, of a rate the maximum.\n"
    "Options that start with --benchmark_ go to Google Benchmark.\n";

struct Options {
  std::string filter = ".";
  std::string json;
  std::string repetitions = "7";
  std::string min_time = "0.05";
  bool list = false;
  bool help = false;
  std::vector<std::string> passed;
  std::string mistake;  // what is wrong with the options, empty when nothing
};

// Is `text` a number from `low` to `high`, with nothing behind it?
[[nodiscard]] inline bool is_number(std::string const& text, double low, double high, bool whole) {
  char* end = nullptr;
  double const value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !(value >= low && value <= high)) return false;
  return !whole || text.find_first_not_of("0123456789") == std::string::npos;
}

[[nodiscard]] inline bool is_regex(std::string const& text) {
  regex_t pattern;
  if (regcomp(&pattern, text.c_str(), REG_EXTENDED | REG_NOSUB) != 0) return false;
  regfree(&pattern);
  return true;
}

[[nodiscard]] inline std::string mistake_in(Options const& options) {
  if (!is_number(options.repetitions, 1, 1000, true)) return "--repetitions: give a whole number from 1 to 1000";
  if (!is_number(options.min_time, 1e-4, 100, false)) return "--min-time: give seconds from 0.0001 to 100";
  if (!is_regex(options.filter)) return "--filter: '" + options.filter + "' is not a regular expression";
  if (options.json.empty() || options.list) return "";
  // Opened without truncation: a run that stops before its end leaves an older file alone.
  if (!std::ofstream(options.json, std::ios::app)) return "--json: cannot write '" + options.json + "'";
  return "";
}

[[nodiscard]] inline Options parse(int argc, char** argv) {
  Options options;
  std::map<std::string_view, std::string*> const values{{"--filter", &options.filter},
                                                        {"--json", &options.json},
                                                        {"--repetitions", &options.repetitions},
                                                        {"--min-time", &options.min_time}};
  for (int i = 1; i < argc; ++i) {
    std::string_view const option = argv[i];
    auto const equals = std::min(option.find('='), option.size());
    auto const target = values.find(option.substr(0, equals));
    if (option == "--help" || option == "-h") {
      options.help = true;
      return options;
    }
    if (option == "--list") {
      options.list = true;
    } else if (option.substr(0, 12) == "--benchmark_") {
      options.passed.emplace_back(option);
    } else if (target == values.end()) {
      options.mistake = "unknown option '" + std::string(option) + "'; --help lists the options";
      return options;
    } else if (equals + 1 < option.size()) {
      *target->second = option.substr(equals + 1);
    } else if (equals == option.size() && i + 1 < argc) {
      *target->second = argv[++i];
    } else {
      options.mistake = std::string(option) + ": needs a value; --help lists the options";
      return options;
    }
  }
  options.mistake = mistake_in(options);
  return options;
}

// Hands the options to the library in its own words; true when it took them all.
[[nodiscard]] inline bool initialize(char* program, Options const& options) {
  std::vector<std::string> words{"--benchmark_repetitions=" + options.repetitions,
                                 "--benchmark_min_time=" + options.min_time, "--benchmark_filter=" + options.filter,
                                 "--benchmark_enable_random_interleaving=true"};
  if (options.list) words.emplace_back("--benchmark_list_tests=true");
  if (!options.json.empty() && !options.list) {
    words.push_back("--benchmark_out=" + options.json);
    words.emplace_back("--benchmark_out_format=json");
  }
  words.insert(words.end(), options.passed.begin(), options.passed.end());
  std::vector<char*> arguments{program};
  for (auto& word : words) arguments.push_back(word.data());
  int count = static_cast<int>(arguments.size());
  arguments.push_back(nullptr);
  benchmark::Initialize(&count, arguments.data());
  if (count > 1) std::fprintf(stderr, "%s: Google Benchmark does not know '%s'\n", program, arguments[1]);
  return count == 1;
}

}  // namespace detail

/// Runs the registered benchmarks, prints the table and calls `afterwards` with the results (for ratios, say).
/// Returns the exit code: 0; 1 when a benchmark failed; 2 for wrong options, in one line on the standard error.
inline int run_benchmarks(int argc, char** argv, std::function<void(Results const&)> const& afterwards = {}) {
  detail::Options const options = detail::parse(argc, argv);
  if (options.help) {
    std::printf(detail::benchmark_help, argv[0]);
    return 0;
  }
  if (!options.mistake.empty()) {
    std::fprintf(stderr, "%s: %s\n", argv[0], options.mistake.c_str());
    return 2;
  }
  if (!detail::initialize(argv[0], options)) return 2;
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
  if (!options.list && afterwards) afterwards(table.results());
  return table.failed() ? 1 : 0;
}

}  // namespace yardstick
