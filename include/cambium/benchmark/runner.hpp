#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <functional>
#include <iostream>
#include <limits>
#include <memory>
#include <string>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "cambium/benchmark/contender.hpp"
#include "cambium/benchmark/executor.hpp"
#include "cambium/benchmark/html_report.hpp"
#include "cambium/benchmark/result_store.hpp"
#include "cambium/core/error.hpp"
#include "cambium/core/hash.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/core/write_file.hpp"
#include "cambium/scenario/scenario_set.hpp"
#include "cambium/viewer/html_replay.hpp"

namespace cambium::inline v0_1 {

/// Which runs leave a replay.
enum class Replays {
  none,
  failures,  ///< runs that are no success
  all,
};

/// Which jobs of a benchmark to run, and how.
struct BenchmarkOptions {
  Executor executor = on_threads(std::max(1u, std::thread::hardware_concurrency()));
  std::size_t shard = 0, shards = 1;  ///< runs only the jobs number `shard`, `shard + shards`, ...
  bool again = false;                 ///< runs also what the store has already
  /// See `RunOptions`. Where jobs run in other processes, a plan that never returns is ended, too: when its run takes
  /// twice this time and 20 times the set's `time_limit` by the clock [s].
  double plan_limit = std::numeric_limits<double>::infinity();
  Replays replays = Replays::none;
  std::filesystem::path replay_folder = "replays";  ///< replays are `replay_folder`/`replay_file_name(...)`
  /// Of failures, the first of each contender and set in a call leave a replay, so that they do not fill the disk. The
  /// snapshot that a contender keeps of a failure lies beside its replay, as .snapshot.
  std::size_t most_replays = 20;
  std::string source{};   ///< what names the set on the command line, for reports: "--set merging --seed 3"
  std::string command{};  ///< what runs these contenders there: "examples/run benchmark --parameters FILE"
  /// Called after each job with the numbers of jobs done and to do; one thread at a time.
  std::function<void(std::size_t done, std::size_t total)> progress{};
  /// Called with a sentence about a problem that does not end the benchmark; one thread at a time.
  std::function<void(std::string const& sentence)> warn = [](auto const& sentence) { std::cerr << sentence << "\n"; };
};

namespace detail {

/// "merging, scenario 17".
[[nodiscard]] inline std::string label_of(std::string const& set, std::size_t scenario) {
  return set + ", scenario " + std::to_string(scenario);
}

/// A recording with what names its run.
[[nodiscard]] inline Recording titled(Recording recording, std::string const& set, std::size_t scenario,
                                      std::string const& contender, RunResult const& result) {
  recording.title = label_of(set, scenario) + ", " + contender;
  recording.notes = {result.error.empty() ? run_outcomes[outcome_of(result)] : "error: " + result.error};
  return recording;
}

/// The time headway [s] of a driver, or of the one that it wraps; the shortest if it is drawn; infinity if it has none.
template <class Behavior>
[[nodiscard]] double time_headway_of(Behavior const& behavior) {
  if constexpr (requires { behavior.law.time_headway; })
    return static_cast<double>(behavior.law.time_headway);
  else if constexpr (requires { behavior.nominal; })
    return time_headway_of(behavior.nominal);
  else if constexpr (requires { behavior.time_headway.low; })  // drawn
    return behavior.time_headway.low;
  else
    return std::numeric_limits<double>::infinity();
}

/// A sentence about the drivers of a set for whom its step is too long, see behavior/README.md; empty without any.
template <class World>
[[nodiscard]] std::string warning_of_step(ScenarioSet<World> const& set) {
  std::size_t count = 0;
  std::string first;
  for (std::size_t i = 0; i < set.scenarios.size(); ++i)
    for (auto const& agent : set.scenarios[i].agents) {
      double const headway = agent.behavior.visit([](auto const& behavior) { return time_headway_of(behavior); });
      if (!(set.time_step > headway) || count++ > 0) continue;
      first = label_of(set.title, i) + (agent.id ? ", agent " + to_string(*agent.id) : std::string()) +
              ": its time headway is " + rounded_text(headway) + " s";
    }
  if (count == 0) return {};
  return first + ", the step " + rounded_text(set.time_step) + " s; drivers may collide in steps longer than that (" +
         std::to_string(count) + " in the set): choose a shorter time_step";
}

/// How scenario `number` of a set is run.
template <class World>
[[nodiscard]] RunOptions run_options(ScenarioSet<World> const& set, std::size_t number,
                                     BenchmarkOptions const& options) {
  return {set.time_step, set.time_limit, options.plan_limit, label_of(set.title, number), set.fails, set.bounds};
}

/// Hash of what a process has read: scenarios of hash `set`, and a contender.
template <class World>
[[nodiscard]] std::uint64_t setup_of(std::uint64_t set, Contender<World> const& contender) {
  return detail::mixed(detail::mixed(set, contender.parameters_hash), detail::checksum_of(contender.name));
}

/// Longest time of a job [s]: generous, because it ends only what never returns. A job runs its scenario twice if it
/// leaves a replay.
template <class World>
[[nodiscard]] double job_limit(ScenarioSet<World> const& set, BenchmarkOptions const& options) {
  return 2.0 * (options.plan_limit + 10.0 * set.time_limit);
}

/// Runs jobs of a benchmark; job number = number of the contender × scenarios + number of the scenario. `hash`: of the
/// set.
template <class World>
[[nodiscard]] Executor::Run job_runner(ScenarioSet<World> const& set, std::uint64_t hash,
                                       std::vector<Contender<World>> const& contenders,
                                       BenchmarkOptions const& options) {
  auto const replays = std::make_shared<std::vector<std::atomic<std::size_t>>>(contenders.size());
  return [&set, hash, &contenders, &options, replays](std::size_t job) {
    if (job >= contenders.size() * set.scenarios.size()) return JobOutcome{.setup = 1};  // a worker that has other ones
    auto const c = job / set.scenarios.size(), i = job % set.scenarios.size();
    auto const& scenario = set.scenarios[i];
    auto const how = run_options(set, i, options);
    bool const all = options.replays == Replays::all;
    auto run = contenders[c].run(scenario, how, all);
    JobOutcome outcome{run.result, run.times, {}, {}, {}, setup_of(hash, contenders[c])};
    bool const wanted =
        options.replays == Replays::failures && !run.result.success && (*replays)[c]++ < options.most_replays;
    if (wanted) run = contenders[c].run(scenario, how, true);  // it is cheaper to run a failure again than to film all
    if (wanted && run.result.success) {                        // for example, its time to plan ran out only once
      outcome.problem = "run again for its replay, a failure was a success";
      return outcome;
    }
    outcome.snapshot = std::move(run.snapshot);
    outcome.problem = std::move(run.problem);
    if (!run.recording) return outcome;
    try {
      outcome.replay = html_replay(titled(std::move(*run.recording), set.title, i, contenders[c].name, run.result));
    } catch (std::exception const& problem) {
      outcome.problem = problem.what();
    }
    return outcome;
  };
}

/// Writes replays; warns of the first that cannot be written.
class ReplayFolder {
 public:
  ReplayFolder(BenchmarkOptions const& options, std::size_t contenders) : options_(options), written_(contenders) {}

  void take(JobOutcome const& outcome, std::string const& file, std::size_t contender) {
    bool const is_enough = options_.replays == Replays::failures && written_[contender] >= options_.most_replays;
    auto const path = options_.replay_folder / file;
    auto const snapshot = std::filesystem::path(path).replace_extension(".snapshot");
    std::error_code refused;                // then the file says what is wrong
    if (options_.replays != Replays::none)  // those of an earlier result
      for (auto const& old : {path, snapshot}) std::filesystem::remove(old, refused);
    if ((outcome.replay.empty() && outcome.problem.empty()) || is_enough) return;
    ++written_[contender];
    auto problem = outcome.problem;
    try {
      std::filesystem::create_directories(options_.replay_folder, refused);
      if (!outcome.replay.empty()) write_file(path, outcome.replay);
      if (!outcome.snapshot.empty()) write_file(snapshot, outcome.snapshot);
    } catch (std::exception const& failure) {
      problem = failure.what();
    }
    if (problem.empty() || has_warned_) return;
    has_warned_ = true;
    if (options_.warn) options_.warn("a replay or a snapshot is missing, and perhaps others: " + problem);
  }

 private:
  BenchmarkOptions const& options_;
  std::vector<std::size_t> written_;
  bool has_warned_ = false;
};

}  // namespace detail

/// Runs each contender on each scenario of a set, and adds the results to `store` as they come. Jobs whose results the
/// store has are left out, so a benchmark that was killed continues. A run that throws, or whose step fails,
/// is a result with its `error`. Returns the number of jobs run. Throws `StoreError` if the store cannot be written,
/// `ParameterError` if the set is invalid, if there is no such shard, or if two contenders have the same name and
/// parameters.
template <class World>
std::size_t run_benchmark(ScenarioSet<World> const& set, std::vector<Contender<World>> const& contenders,
                          ResultStore& store, BenchmarkOptions const& options = {}) {
  check_parameters(set, "benchmark");
  if (options.shard >= options.shards)
    throw ParameterError("benchmark",
                         "has no shard " + std::to_string(options.shard) + " of " + std::to_string(options.shards),
                         "give at least 1 shard, and one of 0 to shards - 1");
  if (auto const sentence = detail::warning_of_step(set); !sentence.empty() && options.warn) options.warn(sentence);
  auto const hash = set.hash();
  auto const count = set.scenarios.size();
  store.add_set(hash, set.title, count, options.source);
  auto const key_of = [&](std::size_t job) {
    auto const& contender = contenders[job / count];
    return ResultKey{hash, static_cast<std::int64_t>(job % count), contender.name, contender.parameters_hash};
  };
  std::vector<std::size_t> jobs;
  for (std::size_t c = 0; c < contenders.size(); ++c) {
    auto const& contender = contenders[c];
    for (std::size_t other = 0; other < c; ++other)
      if (contenders[other].name == contender.name && contenders[other].parameters_hash == contender.parameters_hash)
        throw ParameterError("contender " + contender.name, "is there twice with the same parameters", "leave one out");
    store.add_behavior(contender.name, contender.parameters_hash, contender.parameters, options.command);
    for (std::size_t job = c * count; job < (c + 1) * count; ++job)
      if (job % options.shards == options.shard && (options.again || !store.has(key_of(job)))) jobs.push_back(job);
  }
  store.commit();
  detail::ReplayFolder replays(options, contenders.size());
  std::size_t done = 0;
  auto const take = [&](std::size_t job, JobOutcome outcome) {
    if (outcome.setup != 0 && outcome.setup != detail::setup_of(hash, contenders[job / count]))
      throw Error("benchmark", "a process that runs jobs has read other scenarios or parameters",
                  "give all of them the same files");
    auto key = key_of(job);
    replays.take(outcome, replay_file_name(set.title, key.behavior, key.set_hash, key.parameters_hash, key.scenario),
                 job / count);
    auto const& scenario = set.scenarios[job % count];
    store.add({.key = std::move(key),
               .seed = scenario.seed,
               .result = std::move(outcome.result),
               .times = outcome.times,
               .population = scenario.population});
    store.commit();
    if (options.progress) options.progress(++done, jobs.size());
  };
  options.executor.execute(jobs, detail::job_runner(set, hash, contenders, options), take,
                           detail::job_limit(set, options));
  return jobs.size();
}

/// In a worker of an executor: runs jobs for the process that calls `run_benchmark` with the same set, contenders and
/// options, until none are left.
template <class World>
void serve_benchmark(ScenarioSet<World> const& set, std::vector<Contender<World>> const& contenders,
                     BenchmarkOptions const& options) {
  options.executor.execute({}, detail::job_runner(set, set.hash(), contenders, options), {},
                           detail::job_limit(set, options));
}

}  // namespace cambium::inline v0_1
