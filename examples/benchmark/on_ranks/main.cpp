// The benchmark on the ranks of an MPI program: mpirun -n 9 build/examples/benchmark_on_ranks --db results.db
#include <boost/mpi/communicator.hpp>
#include <boost/mpi/environment.hpp>

#include "cambium/benchmark/run_on_ranks.hpp"

#include "../traffic.hpp"

int main(int argc, char** argv) {
  using namespace benchmark;
  boost::mpi::environment const environment(argc, argv);
  examples::ParameterFile file;  // none: all as shipped
  return cb::benchmark_on_ranks(boost::mpi::communicator(), argc, argv, shipped(file),
                                {.sets = CAMBIUM_SOURCE_DIR "/examples/benchmark/sets"});
}
