#pragma once

#include "cambium/behavior/behavior_model.hpp"
#include "cambium/behavior/behavior_set.hpp"
#include "cambium/core/plan.hpp"
#include "cambium/world/world.hpp"

/// A world type that many sources use, compiled once: `CAMBIUM_EXTERN_WORLD(MyWorld);` in the header that names the
/// type, `CAMBIUM_INSTANTIATE_WORLD(MyWorld);` in one source, both outside of any namespace. `MyWorld` is a
/// `cambium::World`, or an alias of one. Sources that include the header then do not compile stepping, adding or
/// observing.
#define CAMBIUM_EXTERN_WORLD(...)     \
  CAMBIUM_REQUIRE_WORLD(__VA_ARGS__); \
  extern CAMBIUM_INSTANCE_OF_WORLD(__VA_ARGS__)
#define CAMBIUM_INSTANTIATE_WORLD(...) \
  CAMBIUM_REQUIRE_WORLD(__VA_ARGS__);  \
  CAMBIUM_INSTANCE_OF_WORLD(__VA_ARGS__)
#define CAMBIUM_REQUIRE_WORLD(...)              \
  static_assert(                                \
      ::cambium::detail::is_world<__VA_ARGS__>, \
      "cambium: the argument of CAMBIUM_EXTERN_WORLD or CAMBIUM_INSTANTIATE_WORLD is no cambium::World<...>")
#define CAMBIUM_INSTANCE_OF_WORLD(...)                                                              \
  template class ::cambium::World<typename __VA_ARGS__::Behaviors, typename __VA_ARGS__::Execution, \
                                  typename __VA_ARGS__::Dynamics, typename __VA_ARGS__::Observer>

/// The same for the planning of a behaviour with a workspace, such as a tree search, in a world: it is compiled apart
/// from the world's other behaviours, in a source of its own. `WorldType` is an alias: a name without commas.
#define CAMBIUM_EXTERN_PLANNING(WorldType, ...) extern CAMBIUM_INSTANTIATE_PLANNING(WorldType, __VA_ARGS__)
#define CAMBIUM_INSTANTIATE_PLANNING(WorldType, ...)                                                  \
  template ::cambium::Plan<typename WorldType::View> cambium::detail::plan_apart(                     \
      __VA_ARGS__ const&, typename WorldType::View const&, ::cambium::MemoryOf<__VA_ARGS__>&, double, \
      ::cambium::WorkspaceOf<__VA_ARGS__>&)
