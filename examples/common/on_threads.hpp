#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <exception>
#include <mutex>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

namespace examples {

/// Progress after `seconds` of work: "  120 of 600, 14.2/s, 34 s left".
[[nodiscard]] std::string progress_text(std::uint64_t done, std::uint64_t total, double seconds);

/// Shows a progress line on a terminal; silent elsewhere. `what` is the start of the line, such as "cell 2 of 12:".
class Progress {
 public:
  explicit Progress(std::uint64_t total, std::string what = {});
  ~Progress();
  void advance();

 private:
  using Clock = std::chrono::steady_clock;

  std::uint64_t total_;
  std::string what_;
  std::atomic<std::uint64_t> done_{0};
  std::mutex mutex_;
  Clock::time_point begin_ = Clock::now(), shown_at_ = begin_;
  bool shown_, drawn_ = false;
};

/// Calls `run(i)` for all i below `count`; each thread takes the next free i. If a call throws, no further call starts,
/// and the exception is rethrown. Makes do with fewer threads if the system gives fewer. `what`: see `Progress`.
template <class Run>
void run_on_threads(std::uint64_t count, std::uint64_t threads, Run const& run, std::string const& what = {}) {
  std::atomic<std::uint64_t> next{0};
  std::exception_ptr problem;
  std::mutex mutex;
  Progress progress(count, what);
  auto const work = [&] {
    try {
      for (auto i = next++; i < count; i = next++) {
        run(i);
        progress.advance();
      }
    } catch (...) {
      std::lock_guard const lock(mutex);
      if (!problem) problem = std::current_exception();
      next = count;
    }
  };
  {
    std::vector<std::jthread> others;
    try {
      while (others.size() + 1 < std::min(threads, count)) others.emplace_back(work);
    } catch (std::system_error const&) {
    }
    work();
  }
  if (problem) std::rethrow_exception(problem);
}

}  // namespace examples
