#pragma once

#if !__has_include(<poll.h>)
#error \
    "cambium/benchmark/run_on_processes.hpp needs a POSIX system, for fork(): here include run_on_threads.hpp instead"
#endif
#include <poll.h>

#include <algorithm>
#include <cstddef>
#include <deque>
#include <string>
#include <vector>

#include "cambium/benchmark/detail/job_process.hpp"
#include "cambium/benchmark/detail/outcome_bytes.hpp"
#include "cambium/benchmark/executor.hpp"

namespace cambium::inline v0_1 {

/// Runs jobs in forked processes of this machine, for behaviours that may crash or never return: such a run becomes
/// that job's error, and nothing else is lost. For POSIX systems. Call it while no other thread of the program runs.
[[nodiscard]] inline Executor on_processes(std::size_t processes) {
  return {.execute =
              [processes](auto const& jobs, auto const& run, auto const& take, double job_limit) {
                std::deque<detail::JobProcess> all;
                while (all.size() < std::min(processes, jobs.size())) all.emplace_back(run, job_limit);
                std::size_t next = 0, done = 0;
                std::vector<pollfd> sockets(all.size());
                while (done < jobs.size()) {
                  for (std::size_t i = 0; i < all.size(); ++i) {
                    if (!all[i].is_busy() && next < jobs.size()) all[i].start(jobs[next++]);
                    sockets[i] = {all[i].is_busy() ? all[i].socket() : -1, POLLIN, 0};
                  }
                  poll(sockets.data(), sockets.size(), 100);
                  for (auto& process : all) {
                    auto const outcome = process.wait(0);
                    if (!outcome) continue;
                    ++done;
                    take(process.job(), detail::read_outcome(*outcome));
                  }
                }
              },
          .is_worker = false,
          .name = std::to_string(processes) + (processes == 1 ? " process" : " processes")};
}

}  // namespace cambium::inline v0_1
