#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "cambium/benchmark/run_on_threads.hpp"
#include "cambium/benchmark/run_result.hpp"

namespace cambium::inline v0_1 {

/// The outcome of a benchmark's job: a contender's run of a scenario.
struct JobOutcome {
  RunResult result{};
  RunTimes times{};
  std::string replay{};     ///< page for browsers; empty: none
  std::string snapshot{};   ///< as in `Run`
  std::string problem{};    ///< why one of them is missing though it was wanted
  std::uint64_t setup = 0;  ///< hash of set and contender, as the process that ran it has them

  static constexpr char const* name = "outcome";
  static constexpr auto parameters() {
    using P = JobOutcome;
    return parameter_list(
        parameter("result", &P::result, "of the run"), parameter("times", &P::times, "how long its plans took"),
        parameter("replay", &P::replay, "page for browsers"), parameter("snapshot", &P::snapshot, "as in Run"),
        parameter("problem", &P::problem, "why one of them is missing"),
        parameter("setup", &P::setup, "-", Range{0, 1.9e19}, "hash of set and contender"));
  }
};

/// Where a benchmark's jobs run: on threads of this process (`on_threads`), in processes of their own
/// (`on_processes`), or on the ranks of an MPI program (`on_ranks`).
struct Executor {
  using Run = std::function<JobOutcome(std::size_t job)>;
  using Take = std::function<void(std::size_t job, JobOutcome outcome)>;

  /// Calls `run(job)` for each of `jobs`, in any order and at the same time, and `take(job, outcome)` for each outcome,
  /// one call at a time. An exception from either ends it. Where jobs run in other processes, one that takes longer
  /// than `job_limit` [s] is ended, and that is its error. In a worker, it runs the jobs that the process with the
  /// store hands out, until none are left: `jobs` is ignored, and `take` is not called.
  std::function<void(std::vector<std::size_t> const& jobs, Run const& run, Take const& take, double job_limit)>
      execute{};
  bool is_worker = false;  ///< works for another process, which has the store
  std::string name{};      ///< "4 threads"
};

/// Runs jobs on threads of this process; one thread: in order.
[[nodiscard]] inline Executor on_threads(std::size_t threads) {
  return {.execute =
              [threads](auto const& jobs, auto const& run, auto const& take, double) {
                std::mutex mutex;
                run_on_threads(jobs.size(), threads, [&](std::size_t i) {
                  auto outcome = run(jobs[i]);
                  std::lock_guard const lock(mutex);
                  take(jobs[i], std::move(outcome));
                });
              },
          .name = std::to_string(threads) + (threads == 1 ? " thread" : " threads")};
}

}  // namespace cambium::inline v0_1
