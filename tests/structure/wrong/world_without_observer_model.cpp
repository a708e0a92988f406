// expect: cambium::World<Set, Execution, Dynamics, Observer>: Observer must be an observer model such as cambium::PerfectObserver
#include <cambium/world/world.hpp>
#include <cambium/behavior/constant_acceleration.hpp>
#include <cambium/execution/interpolate.hpp>

struct Blind {};
using Sim = cambium::World<cambium::BehaviorSet<cambium::ConstantAcceleration>, cambium::InterpolateExecution,
                           cambium::SingleTrack, Blind>;
Sim world(nullptr);
