// expect: cambium::World<Set, Execution, ...>: Execution must be an execution model such as cambium::InterpolateExecution
#include <cambium/behavior/following/constant_acceleration.hpp>
#include <cambium/world/world.hpp>

// The models are in the wrong order.
using Sim =
    cambium::World<cambium::BehaviorSet<cambium::ConstantAcceleration>, cambium::SingleTrack, cambium::SingleTrack>;
Sim world(nullptr);
