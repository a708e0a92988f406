// The benchmark on the ranks of an MPI program: mpirun -n 9 build/examples/benchmark_on_ranks --db results.db
#include <boost/mpi/communicator.hpp>
#include <boost/mpi/environment.hpp>

#include "cambium/benchmark/benchmark_on_ranks.hpp"

#include "../program.hpp"

int main(int argc, char** argv) {
  boost::mpi::environment const environment(argc, argv);
  boost::mpi::communicator const ranks;
  return benchmark::run_program(
      argc, argv, [&ranks](auto const&... all) { return cambium::benchmark_on_ranks(ranks, all...); },
      ranks.rank() == 0);
}
