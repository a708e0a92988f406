#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <deque>
#include <functional>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <unordered_set>
#include <utility>
#include <vector>

#include "cambium/benchmark/detail/job_process.hpp"
#include "cambium/benchmark/detail/outcome_bytes.hpp"
#include "cambium/benchmark/executor.hpp"
#include "cambium/core/binary.hpp"
#include "cambium/core/error.hpp"

/// A benchmark on the ranks of an MPI program: rank 0 has the store and hands out jobs, the others run them, each in a
/// forked process. For POSIX systems. This header includes nothing of MPI: `Communicator` is a boost::mpi::communicator
/// (link cambium::mpi), or has its members rank, size, iprobe, recv and send
/// (and abort, for `benchmark_on_ranks`).
namespace cambium::inline v0_1 {

/// How long ranks wait for each other.
struct RankOptions {
  /// A rank that is silent for longer counts as lost, and others take its jobs; before its first word, when it may
  /// still read scenarios, ten times as long [s].
  double patience = 30.0;
  /// Called on rank 0 with a sentence about each rank that was lost.
  std::function<void(std::string const& sentence)> warn = [](auto const& sentence) { std::cerr << sentence << "\n"; };
};

namespace detail {

enum RankMessageKind : int { job_message = 1, end_message, outcome_message, alive_message };

struct RankMessage {
  int rank, kind;
  std::uint64_t session;  ///< number of the call of the executor
  std::size_t job;
  std::string content;
};

template <class Communicator>
[[nodiscard]] std::optional<RankMessage> receive(Communicator const& ranks) {
  auto const status = ranks.iprobe();
  if (!status) return std::nullopt;
  std::string bytes(static_cast<std::size_t>(*status->template count<char>()), '\0');
  ranks.recv(status->source(), status->tag(), bytes.data(), static_cast<int>(bytes.size()));
  ByteSource source(bytes, "message");
  RankMessage message{status->source(), status->tag(), source.integer("session", 8, false), 0, {}};
  message.job = static_cast<std::size_t>(source.integer("job", 8, false));
  message.content = source.rest();
  return message;
}

template <class Communicator>
void send(Communicator const& ranks, int to, int kind, std::uint64_t session, std::size_t job = 0,
          std::string_view content = {}) {
  std::string bytes;
  ByteSink sink(bytes);
  sink.integer("session", session, 8, false);
  sink.integer("job", job, 8, false);
  bytes += content;
  ranks.send(to, kind, bytes.data(), static_cast<int>(bytes.size()));
}

/// True once a second.
class EverySecond {
 public:
  [[nodiscard]] bool operator()() {
    auto const now = std::chrono::steady_clock::now();
    if (now < next_) return false;
    next_ = now + std::chrono::seconds(1);
    return true;
  }

 private:
  std::chrono::steady_clock::time_point next_{};
};

/// Rank 0 in one call of the executor: gives each rank a job, and one more to begin with at once as long as there are
/// many. Each job's outcome is taken once, also if a rank that counted as lost comes back.
template <class Communicator>
class JobDispatcher {
 public:
  JobDispatcher(Communicator const& ranks, RankOptions const& options, std::uint64_t session,
                std::vector<std::size_t> const& jobs)
      : ranks_(ranks),
        options_(options),
        session_(session),
        open_(jobs.begin(), jobs.end()),
        left_(jobs.begin(), jobs.end()),
        workers_(static_cast<std::size_t>(ranks.size() - 1)) {}

  void run(Executor::Take const& take) {
    EverySecond is_time;
    while (!left_.empty()) {
      bool is_idle = true;
      while (auto const message = receive(ranks_)) {
        is_idle = false;
        hear(*message, take);
      }
      bool const says_alive = is_time();
      for (std::size_t w = 0; w < workers_.size(); ++w) look_after(w, says_alive);
      if (std::ranges::all_of(workers_, &Worker::is_lost))
        throw Error("ranks", "none that runs jobs is heard from any more", "the same command runs what is missing");
      if (is_idle) std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
    for (std::size_t w = 0; w < workers_.size(); ++w)
      if (!workers_[w].is_lost) send(ranks_, rank_of(w), end_message, session_);
  }

 private:
  using Clock = std::chrono::steady_clock;
  struct Worker {
    Clock::time_point heard = Clock::now();
    std::vector<std::size_t> jobs{};
    bool is_ready = false, is_lost = false;  ///< ready: it has said something in this call
  };

  [[nodiscard]] static int rank_of(std::size_t worker) { return static_cast<int>(worker) + 1; }

  void hear(RankMessage const& message, Executor::Take const& take) {
    auto& worker = workers_[static_cast<std::size_t>(message.rank - 1)];
    worker.heard = Clock::now();
    if (message.session < session_)  // it was silent when an earlier call ended
      return send(ranks_, message.rank, end_message, message.session);
    worker.is_lost = false;
    worker.is_ready = true;
    if (message.kind != outcome_message) return;
    std::erase(worker.jobs, message.job);
    if (left_.erase(message.job) > 0) take(message.job, read_outcome(message.content));
  }

  void look_after(std::size_t number, bool says_alive) {
    auto& worker = workers_[number];
    if (worker.is_lost) return;
    double const patience = (worker.is_ready ? 1.0 : 10.0) * options_.patience;  // it may still read its scenarios
    if (std::chrono::duration<double>(Clock::now() - worker.heard).count() > patience) {
      worker.is_lost = true;
      if (options_.warn)
        options_.warn("rank " + std::to_string(rank_of(number)) + " has not been heard from for " +
                      rounded_text(patience) + " s: others take its jobs");
      open_.insert(open_.begin(), worker.jobs.begin(), worker.jobs.end());
      worker.jobs.clear();
      return;
    }
    if (says_alive) send(ranks_, rank_of(number), alive_message, session_);
    while (worker.is_ready && !open_.empty() && worker.jobs.size() < (open_.size() > workers_.size() ? 2u : 1u)) {
      auto const job = open_.front();
      open_.pop_front();
      if (!left_.contains(job)) continue;
      worker.jobs.push_back(job);
      send(ranks_, rank_of(number), job_message, session_, job);
    }
  }

  Communicator const& ranks_;
  RankOptions const& options_;
  std::uint64_t session_;
  std::deque<std::size_t> open_;          ///< given to nobody
  std::unordered_set<std::size_t> left_;  ///< without an outcome
  std::vector<Worker> workers_;
};

/// A rank other than 0 in one call of the executor.
template <class Communicator>
void work_for_rank_0(Communicator const& ranks, RankOptions const& options, std::uint64_t session,
                     Executor::Run const& run, double job_limit) {
  using Clock = std::chrono::steady_clock;
  JobProcess process(run, job_limit);
  std::deque<std::size_t> jobs;
  auto heard = Clock::now();
  EverySecond is_time;
  for (;;) {
    while (auto const message = receive(ranks)) {
      heard = Clock::now();
      if (message->session != session) continue;
      if (message->kind == end_message) return;
      if (message->kind == job_message) jobs.push_back(message->job);
    }
    if (std::chrono::duration<double>(Clock::now() - heard).count() > 10.0 * options.patience)
      throw Error("rank " + std::to_string(ranks.rank()),
                  "rank 0 has not been heard from for " + rounded_text(10.0 * options.patience) + " s",
                  "the same command runs what is missing");
    if (!process.is_busy() && !jobs.empty()) {
      process.start(jobs.front());
      jobs.pop_front();
    }
    if (auto const outcome = process.wait(1)) send(ranks, 0, outcome_message, session, process.job(), *outcome);
    if (is_time()) send(ranks, 0, alive_message, session);
  }
}

/// The exit code of a rank; not reached where others have to be ended, too.
template <class Communicator>
int end_program(Communicator const& ranks, int code, bool is_lost) {
  if (code == 0 && !is_lost) return 0;
  std::cout.flush();
  std::fflush(nullptr);
  ranks.abort(code);
  return code;
}

}  // namespace detail

/// Runs jobs on the ranks of a communicator; with one rank, in this process. All ranks make the same calls with it, and
/// nobody else uses the communicator meanwhile. What a job throws, and what kills its process (it has two tries), is
/// that job's error. A rank that dies is reported, and others take its jobs, where MPI lets the rest live (Open MPI:
/// `mpirun --enable-recovery`; then end with `abort`, because MPI_Finalize waits for the dead). Throws `Error` if no
/// rank is left.
template <class Communicator>
[[nodiscard]] Executor on_ranks(Communicator const& ranks, RankOptions options = {}) {
  if (ranks.size() == 1) return on_threads(1);
  auto const session = std::make_shared<std::uint64_t>(0);
  return {.execute =
              [ranks, options = std::move(options), session](auto const& jobs, auto const& run, auto const& take,
                                                             double job_limit) {
                ++*session;
                if (ranks.rank() == 0)
                  detail::JobDispatcher(ranks, options, *session, jobs).run(take);
                else
                  detail::work_for_rank_0(ranks, options, *session, run, job_limit);
              },
          .is_worker = ranks.rank() != 0,
          .name = std::to_string(ranks.size() - 1) + (ranks.size() == 2 ? " rank" : " ranks")};
}

}  // namespace cambium::inline v0_1
