// A benchmark on the ranks of an MPI program, and on any number of threads: the same rows.
#include <cambium/benchmark/executor.hpp>
#include <cambium/benchmark/detail/job_process.hpp>
#include <cambium/benchmark/detail/outcome_bytes.hpp>
#include <cambium/benchmark/result_store.hpp>
#include <cambium/benchmark/run_on_ranks.hpp>
#include <cambium/core/error.hpp>
#include <doctest/doctest.h>

#include <algorithm>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <deque>
#include <filesystem>
#include <limits>
#include <memory>
#include <mutex>
#include <numeric>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "../examples/program.hpp"
#include "stored.hpp"

using namespace cambium;

namespace {

/// The outcome that a process for jobs gives.
JobOutcome outcome_in(detail::JobProcess& process, std::size_t job) {
  process.start(job);
  for (;;)
    if (auto const bytes = process.wait(100)) return detail::read_outcome(*bytes);
}

/// Ranks that are threads of this program, with the members of a boost::mpi::communicator that are used.
class ThreadRanks {
  struct Letter {
    int from, kind;
    std::string bytes;
    [[nodiscard]] int source() const { return from; }
    [[nodiscard]] int tag() const { return kind; }
    template <class T>
    [[nodiscard]] std::optional<int> count() const {
      return static_cast<int>(bytes.size() / sizeof(T));
    }
  };
  struct Post {
    explicit Post(int size) : boxes(static_cast<std::size_t>(size)) {}
    std::mutex door{};
    std::vector<std::deque<Letter>> boxes;
    std::optional<int> aborted{};
  };

 public:
  explicit ThreadRanks(int size) : post_(std::make_shared<Post>(size)) {}
  [[nodiscard]] ThreadRanks of(int rank) const {
    auto other = *this;
    other.rank_ = rank;
    return other;
  }

  [[nodiscard]] int rank() const { return rank_; }
  [[nodiscard]] int size() const { return static_cast<int>(post_->boxes.size()); }
  [[nodiscard]] std::optional<Letter> iprobe() const {
    std::lock_guard const lock(post_->door);
    return box(rank_).empty() ? std::nullopt : std::optional(box(rank_).front());
  }
  void recv(int, int, char* bytes, int) const {
    std::lock_guard const lock(post_->door);
    std::ranges::copy(box(rank_).front().bytes, bytes);
    box(rank_).pop_front();
  }
  void send(int to, int kind, char const* bytes, int count) const {
    std::lock_guard const lock(post_->door);
    box(to).push_back({rank_, kind, std::string(bytes, static_cast<std::size_t>(count))});
  }
  void abort(int code) const { post_->aborted = code; }
  [[nodiscard]] std::optional<int> aborted() const { return post_->aborted; }

 private:
  [[nodiscard]] std::deque<Letter>& box(int rank) const { return post_->boxes[static_cast<std::size_t>(rank)]; }

  std::shared_ptr<Post> post_;
  int rank_ = 0;
};

#ifdef CAMBIUM_MPIEXEC
std::size_t lines_in(std::string const& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

/// Runs a program under MPI, also as root and on few cores; once more if it does not end, as happens to Open MPI 4.1
/// where a rank dies or the machine is busy.
program::Run run_mpi(std::string const& words, std::filesystem::path const& folder) {
  auto const out = folder / "out", err = folder / "err";
  auto const command =
      "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1 timeout -k 5 90 "
      "env " +
      words + " --set " + browser::quoted(CAMBIUM_SOURCE_DIR "/examples/benchmark/sets/examples/merging.json") + " >" +
      browser::quoted(out.string()) + " 2>" + browser::quoted(err.string());
  constexpr int out_of_time = 124, killed = 137;
  std::string said;
  for (int tries = 0;; ++tries) {
    int const status = std::system(command.c_str());
    int const code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    said += program::content_of(err);
    if (tries == 2 || (code != out_of_time && code != killed)) return {code, program::content_of(out), said};
  }
}

bool is_open_mpi() { return std::system(CAMBIUM_MPIEXEC " --version 2>&1 | grep -qE 'Open MPI|OpenRTE'") == 0; }
#endif

}  // namespace

TEST_CASE("outcomes are the same after a message, bit by bit") {
  JobOutcome outcome;
  outcome.result.success = true;
  outcome.result.error = std::string("a\0b, \xC3\xA4", 7);
  outcome.result.steps = 3;
  outcome.result.mean_speed = 0.1 + 0.2;
  outcome.result.progress_m = -0.0;
  outcome.result.hit = AgentId{7};
  outcome.times = {.decisions = 4, .mean_ms = std::numeric_limits<double>::denorm_min(), .longest_ms = 2.5};
  outcome.replay = "<html>";
  outcome.snapshot = std::string("a\0b", 3);
  outcome.problem = "none";
  auto const bytes = detail::outcome_bytes(outcome);
  auto const same = detail::read_outcome(bytes);
  CHECK(detail::outcome_bytes(same) == bytes);
  CHECK(to_string(same.result) == to_string(outcome.result));
  CHECK(same.times.mean_ms == outcome.times.mean_ms);
  CHECK(same.replay == "<html>");
  CHECK(same.snapshot == outcome.snapshot);
  CHECK(same.problem == "none");
  CHECK(same.result.hit == AgentId{7});
  CHECK_FALSE(is_valid(detail::read_outcome(detail::outcome_bytes({})).result.hit));
  for (std::size_t size = 0; size < bytes.size(); ++size)
    CHECK_THROWS_AS(static_cast<void>(detail::read_outcome(std::string_view(bytes).substr(0, size))), Error);
}

TEST_CASE("a job that kills its process is an error, and the next one runs") {
  browser::TemporaryFolder const folder;
  auto const once = folder.path() / "once";
  auto const jobs = [&](std::size_t job) {
    if (job == 1) std::raise(SIGKILL);
    if (job == 2) std::exit(3);
    if (job == 3 && !std::filesystem::exists(once)) {
      std::filesystem::create_directory(once);
      std::raise(SIGTERM);
    }
    JobOutcome outcome;
    outcome.result.steps = static_cast<std::int64_t>(job);
    outcome.replay = std::string(job * 1'000'000, 'x');  // more than a socket holds
    return outcome;
  };
  detail::JobProcess process(jobs, 60.0);
  CHECK(outcome_in(process, 0).result.steps == 0);
  CHECK(outcome_in(process, 1).result.error.find("the process that ran it died, twice: signal 9") == 0);
  CHECK(outcome_in(process, 2).result.error == "the process that ran it died, twice: exit code 3");
  CHECK(outcome_in(process, 3).result.error == "");
  auto const last = outcome_in(process, 4);
  CHECK(last.result.steps == 4);
  CHECK(last.replay.size() == 4'000'000);
  process.start(1);  // and is ended in the middle
}

TEST_CASE("each job is taken once, in every call, also where one rank of four takes some and is never heard of again") {
  ThreadRanks const ranks(4);
  std::vector<std::string> warnings;
  RankOptions const options{.patience = 0.3, .warn = [&](auto const& sentence) { warnings.push_back(sentence); }};
  auto const run = [](std::size_t job) {
    JobOutcome outcome;
    outcome.result.steps = static_cast<std::int64_t>(10 * job);
    return outcome;
  };
  std::vector<std::size_t> jobs(40);
  std::iota(jobs.begin(), jobs.end(), 0u);
  std::vector<std::thread> workers;
  for (int const rank : {1, 3})
    workers.emplace_back([&, rank] {
      auto const worker = on_ranks(ranks.of(rank), options);
      CHECK(worker.is_worker);
      for (int call = 0; call < 2; ++call) worker.execute(jobs, run, {}, 60.0);
    });
  detail::send(ranks.of(2), 0, detail::alive_message, 1);  // its last word
  auto const first = on_ranks(ranks.of(0), options);
  CHECK_FALSE(first.is_worker);
  CHECK(first.name == "3 ranks");
  for (int call = 0; call < 2; ++call) {
    std::multiset<std::size_t> taken;
    first.execute(
        jobs, run,
        [&](std::size_t job, JobOutcome const& outcome) {
          taken.insert(job);
          CHECK(outcome.result.steps == static_cast<std::int64_t>(10 * job));
        },
        60.0);
    CHECK(taken == std::multiset<std::size_t>(jobs.begin(), jobs.end()));
  }
  for (auto& worker : workers) worker.join();
  REQUIRE(!warnings.empty());
  CHECK(warnings.front() == "rank 2 has not been heard from for 0.3 s: others take its jobs");

  CHECK(detail::end_program(ranks, 0, false) == 0);
  CHECK_FALSE(ranks.aborted());
  CHECK(detail::end_program(ranks, 2, false) == 2);
  CHECK(ranks.aborted() == 2);
  CHECK(detail::end_program(ranks, 0, true) == 0);
  CHECK(ranks.aborted() == 0);
}

TEST_CASE("3 ranks give the rows of 1 thread and 8 threads, and a job that crashes costs itself only") {
#ifdef CAMBIUM_MPIEXEC
  browser::TemporaryFolder const folder;
  std::string const mpi = CAMBIUM_MPIEXEC " -n 3 ";
  auto const file = [&](char const* name) { return browser::quoted((folder.path() / name).string()); };
  auto const run = run_mpi(mpi + CAMBIUM_BUILD_DIR "/test_on_ranks --scenarios 20 --db " + file("3.db"), folder.path());
  CAPTURE(run.err);
  REQUIRE(run.code == 0);
  CHECK(run.out.find("60 runs in ") != std::string::npos);
  CHECK(run.out.find(" on 2 ranks; results in ") != std::string::npos);
  auto const rows = stored::results_in(folder.path() / "3.db");
  CHECK(lines_in(rows) == 60);
  CHECK(rows.find("idm_classic 0 ") != std::string::npos);
  CHECK(rows.find("the process that ran it died, twice: signal 11") != std::string::npos);
  CHECK(rows.find("out of ideas") != std::string::npos);
  CHECK(stored::files_in(folder.path() / "3_replays").size() ==
        20);  // those that throw; a process that crashes leaves none
  for (char const* threads : {"1", "8"}) {
    auto const name = std::string(threads) + "_threads.db";
    auto const other =
        run_mpi(std::string("ON_THREADS=1 " CAMBIUM_BUILD_DIR "/test_on_ranks --scenarios 20 ") +
                    "--behaviors idm_classic,throws --threads " + threads + " --db " + file(name.c_str()),
                folder.path());
    CAPTURE(other.err);
    REQUIRE(other.code == 0);
    CHECK(stored::results_in(folder.path() / name) ==
          rows.substr(rows.find("idm_classic 0")));  // without those that crash
  }
#else
  support::skip("no MPI");
#endif
}

TEST_CASE("a benchmark goes on without a rank that dies, or is finished by the same command") {
#ifdef CAMBIUM_MPIEXEC
  if (!is_open_mpi()) return support::skip("another MPI than Open MPI");
  browser::TemporaryFolder const folder;
  auto const command = [&](char const* options, char const* name) {
    return std::string(CAMBIUM_MPIEXEC) + options + " -n 4 " CAMBIUM_BUILD_DIR "/test_on_ranks --scenarios 20 --db " +
           browser::quoted((folder.path() / name).string());
  };
  auto const going_on = run_mpi("DYING_RANK=2 " + command(" --enable-recovery", "on.db"), folder.path());
  CAPTURE(going_on.err);
  CHECK(going_on.code == 0);
  // On a busy machine the others may have done all jobs before rank 2 gets one and dies.
  WARN(going_on.err.find("rank 2 has not been heard from for 3 s: others take its jobs") != std::string::npos);
  CHECK(lines_in(stored::results_in(folder.path() / "on.db")) == 60);

  auto const ended = run_mpi("DYING_RANK=2 " + command("", "off.db"), folder.path());
  WARN(ended.code != 0);  // likewise
  CHECK(run_mpi(command("", "off.db"), folder.path()).code == 0);
  CHECK(stored::results_in(folder.path() / "off.db") == stored::results_in(folder.path() / "on.db"));

  program::Program const example("benchmark_on_ranks");
  if (example.is_there()) {
    auto const run =
        run_mpi(CAMBIUM_MPIEXEC " -n 2 " CAMBIUM_EXAMPLES_DIR "/benchmark_on_ranks --behaviors idm,mobil --db " +
                    browser::quoted((folder.path() / "example.db").string()),
                folder.path());
    CHECK(run.code == 0);
    CHECK(run.out.find("16 runs in ") != std::string::npos);
  }

  auto const refused = run_mpi(command("", "no/where.db/r.db") + " --behaviors nobody", folder.path());
  CHECK(refused.code != 0);  // and does not wait for ranks that wait for jobs
  CHECK(refused.err.find("the program has none of that name") != std::string::npos);
#else
  support::skip("no MPI");
#endif
}
