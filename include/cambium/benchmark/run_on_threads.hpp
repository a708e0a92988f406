#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <functional>
#include <future>
#include <system_error>
#include <vector>

namespace cambium::inline v0_1 {

/// Calls `run(i)` for all i below `count` on several threads; each takes the next free i. If a call throws, no further
/// call starts, and the exception is rethrown. Makes do with fewer threads if the system gives fewer.
inline void run_on_threads(std::size_t count, std::size_t threads, std::function<void(std::size_t)> const& run) {
  std::atomic<std::size_t> next{0};
  auto const work = [&] {
    try {
      for (auto i = next++; i < count; i = next++) run(i);
    } catch (...) {
      next = count;
      throw;
    }
  };
  std::vector<std::future<void>> others;  // wait when they are destroyed
  try {
    while (others.size() + 1 < std::min(threads, count)) others.push_back(std::async(std::launch::async, work));
  } catch (std::system_error const&) {  // fewer will do
  }
  work();
  for (auto& other : others) other.get();
}

}  // namespace cambium::inline v0_1
