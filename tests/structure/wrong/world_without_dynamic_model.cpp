// expect: cambium::World<Set, Execution, Dynamics>: Dynamics must be a vehicle model such as cambium::SingleTrack
#include <cambium/behavior/following/constant_acceleration.hpp>
#include <cambium/execution/interpolate.hpp>
#include <cambium/world/world.hpp>

struct Rocket {};
using Sim = cambium::World<cambium::BehaviorSet<cambium::ConstantAcceleration>, cambium::InterpolateExecution, Rocket>;
Sim world(nullptr);
