// expect: cambium::World<Set, ...>: Set must be cambium::BehaviorSet<Models...>
#include <cambium/behavior/following/idm_classic.hpp>
#include <cambium/execution/interpolate.hpp>
#include <cambium/world/world.hpp>

// One behaviour alone is no set.
using Sim = cambium::World<cambium::IdmClassic, cambium::InterpolateExecution, cambium::SingleTrack>;
Sim world(nullptr);
