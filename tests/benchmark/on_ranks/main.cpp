// A benchmark on ranks with behaviours that go wrong, for ranks_test.cpp. In the environment, DYING_RANK=2 makes rank 2
// die in its first run of IDM; ON_THREADS=1 runs the jobs on threads of one process.
#include <boost/mpi/communicator.hpp>
#include <boost/mpi/environment.hpp>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <vector>

#include "cambium/behavior/behavior_set.hpp"
#include "cambium/behavior/drivers.hpp"
#include "cambium/benchmark/benchmark_on_ranks.hpp"
#include "cambium/dynamics/single_track.hpp"
#include "cambium/execution/interpolate.hpp"
#include "cambium/world/world.hpp"

namespace cb = cambium;

namespace {

using World = cb::World<cb::BehaviorSet<cb::IdmClassic>, cb::InterpolateExecution, cb::SingleTrack>;

/// Crashes or throws in its first plan.
struct Fails {
  bool crashes = false;
  template <class View>
  cb::Plan<View> plan(View const&, cb::NoMemory&, double) const {
    if (crashes) std::raise(SIGSEGV);
    throw std::runtime_error("out of ideas");
  }
};

/// IDM; the dying rank is killed by its process for jobs.
cb::Contender<World> idm(int rank) {
  auto idm = cb::contender<World>(cb::IdmClassic{.law = {.desired_speed = 22.0}});
  char const* const dying = std::getenv("DYING_RANK");
  if (rank == 0 || dying == nullptr || std::to_string(rank) != dying) return idm;
  idm.run = [run = idm.run, rank = getpid()](auto const& scenario, auto const& options, bool records) {
    kill(rank, SIGKILL);
    return run(scenario, options, records);
  };
  return idm;
}

}  // namespace

int main(int argc, char** argv) {
  boost::mpi::environment const environment(argc, argv);
  boost::mpi::communicator const ranks;
  std::vector const contenders{
      idm(ranks.rank()),
      cb::contender_by<World>("crashes", "", 1, [](auto const&, auto const&) { return Fails{.crashes = true}; }),
      cb::contender_by<World>("throws", "", 2, [](auto const&, auto const&) { return Fails{}; })};
  if (std::getenv("ON_THREADS") != nullptr) return cb::benchmark_main(argc, argv, contenders);
  return cb::benchmark_on_ranks(ranks, argc, argv, contenders, {}, {.patience = 3.0});
}
