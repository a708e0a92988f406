// expect: cambium::World<Set, Execution, Dynamics, Observer>: Observer must be an observer model such as cambium::PerfectObserver
#include <cambium/behavior/following/constant_acceleration.hpp>
#include <cambium/execution/interpolate.hpp>
#include <cambium/world/world.hpp>

struct Blind {};
using Sim = cambium::World<cambium::BehaviorSet<cambium::ConstantAcceleration>, cambium::InterpolateExecution,
                           cambium::SingleTrack, Blind>;
Sim world(nullptr);
