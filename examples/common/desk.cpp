#include "desk.hpp"

#include <utility>

#include "thawed_world.hpp"

CAMBIUM_INSTANTIATE_WORLD(desk::World);
CAMBIUM_INSTANTIATE_PLANNING(desk::World, desk::Planner);

std::unique_ptr<examples::Thawed> desk::thaw(std::shared_ptr<cb::Map const> map, std::string_view bytes,
                                             std::string const& where) {
  return examples::thaw<World, Cycle>(std::move(map), bytes, where);
}
