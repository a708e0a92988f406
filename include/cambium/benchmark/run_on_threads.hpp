#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace cambium {

/// Calls `run(i)` for all i below `count` on several threads; each takes the next free i. If a call throws, no further
/// call starts, and the exception is rethrown. Makes do with fewer threads if the system gives fewer.
inline void run_on_threads(std::size_t count, std::size_t threads, std::function<void(std::size_t)> const& run) {
  std::atomic<std::size_t> next{0};
  std::exception_ptr problem;
  std::mutex mutex;
  auto const work = [&] {
    try {
      for (auto i = next++; i < count; i = next++) run(i);
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
    } catch (std::system_error const&) {  // fewer will do
    }
    work();
  }
  if (problem) std::rethrow_exception(problem);
}

}  // namespace cambium
