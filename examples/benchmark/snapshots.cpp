#include "cambium/snapshot/freeze_run.hpp"

#include "../common/thawed_world.hpp"
#include "traffic.hpp"

std::string benchmark::freeze(cb::FailedRun<TestedWorld> const& run) { return cb::freeze_run(run); }

std::unique_ptr<examples::Thawed> benchmark::thaw(std::shared_ptr<cb::Map const> map, std::string_view bytes,
                                                  std::string const& where) {
  return examples::thaw<TestedWorld, cb::RunPosition>(std::move(map), bytes, where);
}
