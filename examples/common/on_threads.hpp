#pragma once

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <string>

#include "cambium/benchmark/progress.hpp"
#include "cambium/benchmark/run_on_threads.hpp"

namespace examples {

/// `cambium::run_on_threads` with a progress bar on a terminal. `what`: the start of its line, as "cell 2 of 12".
template <class Run>
void run_on_threads(std::uint64_t count, std::uint64_t threads, Run const& run, std::string const& what = "runs") {
  cambium::ProgressBar bar(what);
  std::mutex mutex;
  std::size_t done = 0;
  cambium::run_on_threads(count, threads, [&](std::size_t i) {
    run(i);
    std::lock_guard const lock(mutex);
    bar(++done, count);
  });
}

}  // namespace examples
