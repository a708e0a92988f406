// expect: the behaviour set of a planner's PredictionWorld must contain its Others
#include <cambium/behavior/open_loop/external_input.hpp>
#include <cambium/execution/interpolate.hpp>
#include <cambium/planner/frenet/frenet_planner.hpp>
#include <cambium/world/world.hpp>

using Predicted =
    cambium::World<cambium::BehaviorSet<cambium::ExternalInput>, cambium::InterpolateExecution, cambium::SingleTrack>;
// It predicts others of constant acceleration.
cambium::FrenetPlanner<Predicted> planner;
