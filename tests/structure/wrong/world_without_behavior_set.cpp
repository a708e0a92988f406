// expect: cambium::World<Set, ...>: Set must be cambium::BehaviorSet<Models...>
#include <cambium/world/world.hpp>
#include <cambium/behavior/idm_classic.hpp>
#include <cambium/execution/interpolate.hpp>

// One behaviour alone is no set.
using Sim = cambium::World<cambium::IdmClassic, cambium::InterpolateExecution, cambium::SingleTrack>;
Sim world(nullptr);
