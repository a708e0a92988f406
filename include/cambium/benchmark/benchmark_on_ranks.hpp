#pragma once

#include <string>
#include <utility>
#include <vector>

#include "cambium/benchmark/benchmark_main.hpp"
#include "cambium/benchmark/contender.hpp"
#include "cambium/benchmark/run_on_ranks.hpp"

namespace cambium::inline v0_1 {

/// `benchmark_main` on all ranks of an MPI program:
///
///     int main(int argc, char** argv) {
///       boost::mpi::environment const environment(argc, argv);
///       return cambium::benchmark_on_ranks(boost::mpi::communicator(), argc, argv, contenders);
///     }
///
/// After an error, or if a rank was lost, it ends the program by `abort`, which ends all other ranks, too.
template <class Communicator, class World>
int benchmark_on_ranks(Communicator const& ranks, int argc, char const* const* argv,
                       std::vector<Contender<World>> const& contenders, BenchmarkDefaults defaults = {},
                       RankOptions options = {}) {
  bool is_lost = false;
  options.warn = [&is_lost, warn = std::move(options.warn)](std::string const& sentence) {
    is_lost = true;
    if (warn) warn(sentence);
  };
  defaults.executor = on_ranks(ranks, std::move(options));
  return detail::end_program(ranks, benchmark_main(argc, argv, contenders, defaults), is_lost);
}

}  // namespace cambium::inline v0_1
