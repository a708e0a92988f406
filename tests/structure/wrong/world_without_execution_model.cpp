// expect: cambium::World<Set, Execution, ...>: Execution must be an execution model such as cambium::InterpolateExecution
#include <cambium/world/world.hpp>
#include <cambium/behavior/constant_acceleration.hpp>

// The models are in the wrong order.
using Sim =
    cambium::World<cambium::BehaviorSet<cambium::ConstantAcceleration>, cambium::SingleTrack, cambium::SingleTrack>;
Sim world(nullptr);
