#pragma once

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <mutex>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

namespace examples {

/// Draws a bar on a terminal; silent elsewhere.
class Progress {
 public:
  explicit Progress(std::uint64_t total) : total_(total), shown_(isatty(STDERR_FILENO) == 1) {}
  void advance() {
    auto const done = ++done_;
    if (!shown_) return;
    std::unique_lock lock(mutex_, std::defer_lock);
    if (done == total_)
      lock.lock();
    else if (!lock.try_lock())
      return;
    constexpr std::uint64_t width = 40;
    auto const filled = done * width / total_;
    std::fprintf(stderr, "\r[%s%s] %llu/%llu%s", std::string(filled, '#').c_str(),
                 std::string(width - filled, ' ').c_str(), static_cast<unsigned long long>(done),
                 static_cast<unsigned long long>(total_), done == total_ ? "\r\033[K" : "");
    std::fflush(stderr);
  }

 private:
  std::uint64_t total_;
  std::atomic<std::uint64_t> done_{0};
  std::mutex mutex_;
  bool shown_;
};

/// Calls `run(i)` for all i below `count`; each thread takes the next one that nobody has. Where one throws, no further
/// one begins, and that comes out. Where the system gives fewer threads, those do the work.
template <class Run>
void run_on_threads(std::uint64_t count, std::uint64_t threads, Run const& run) {
  std::atomic<std::uint64_t> next{0};
  std::exception_ptr problem;
  std::mutex mutex;
  Progress progress(count);
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
