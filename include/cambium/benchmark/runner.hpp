#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "cambium/benchmark/contender.hpp"
#include "cambium/benchmark/result_store.hpp"
#include "cambium/benchmark/run_on_threads.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/scenario/scenario_set.hpp"

namespace cambium {

/// What to run of a benchmark, and how.
struct BenchmarkOptions {
  std::size_t threads = std::max(1u, std::thread::hardware_concurrency());
  std::size_t shard = 0, shards = 1;  ///< runs only the jobs number `shard`, `shard + shards`, ...
  bool again = false;                 ///< runs also what the store has already
  /// Called after each job with the numbers of jobs done and to do; one thread at a time.
  std::function<void(std::size_t done, std::size_t total)> progress{};
};

/// Runs each contender on each scenario of a set, and adds the results to `store` as they come. Jobs whose results the
/// store has are left out, so a benchmark that was killed goes on where it was. A run that throws, or whose step fails,
/// is a result with its `error`. Returns the number of jobs run. Throws `StoreError` if the store cannot be written,
/// `ParameterError` if the set is invalid, or if two contenders have the same name and parameters.
template <class World>
std::size_t run_benchmark(ScenarioSet<World> const& set, std::vector<Contender<World>> const& contenders,
                          ResultStore& store, BenchmarkOptions const& options = {}) {
  struct Job {
    ResultKey key;
    std::size_t contender;
  };
  check_parameters(set, "benchmark");
  auto const hash = set.hash();
  store.add_set(hash, set.title, set.scenarios.size());
  std::vector<Job> jobs;
  std::size_t number = 0;
  for (std::size_t c = 0; c < contenders.size(); ++c) {
    auto const& contender = contenders[c];
    for (std::size_t other = 0; other < c; ++other)
      if (contenders[other].name == contender.name && contenders[other].parameters_hash == contender.parameters_hash)
        throw ParameterError("contender " + contender.name, "is there twice with the same parameters", "leave one out");
    store.add_behavior(contender.name, contender.parameters_hash, contender.parameters);
    for (std::size_t i = 0; i < set.scenarios.size(); ++i) {
      bool const is_ours = number++ % options.shards == options.shard;
      ResultKey key{hash, static_cast<std::int64_t>(i), contender.name, contender.parameters_hash};
      if (is_ours && (options.again || !store.has(key))) jobs.push_back({std::move(key), c});
    }
  }
  store.commit();
  std::mutex mutex;
  std::size_t done = 0;
  RunOptions const run_options{set.time_step, set.time_limit};
  auto last_commit = std::chrono::steady_clock::now();
  run_on_threads(jobs.size(), options.threads, [&](std::size_t i) {
    auto const& job = jobs[i];
    auto const& scenario = set.scenarios[static_cast<std::size_t>(job.key.scenario)];
    auto const run = contenders[job.contender].run(scenario, run_options, false);
    std::lock_guard const lock(mutex);
    store.add({job.key, scenario.seed, run.result, run.times});
    auto const now = std::chrono::steady_clock::now();
    if (now - last_commit > std::chrono::milliseconds(250)) {
      store.commit();
      last_commit = now;
    }
    if (options.progress) options.progress(++done, jobs.size());
  });
  store.commit();
  return jobs.size();
}

}  // namespace cambium
