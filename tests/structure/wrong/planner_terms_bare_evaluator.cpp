// expect: cambium: a planner's own terms must be cambium::Terms<Evaluators...>
#include <cambium/behavior/following/idm_classic.hpp>
#include <cambium/evaluation/driving.hpp>
#include <cambium/execution/interpolate.hpp>
#include <cambium/planner/frenet/frenet_planner.hpp>
#include <cambium/world/world.hpp>

using Predicted =
    cambium::World<cambium::BehaviorSet<cambium::IdmClassic>, cambium::InterpolateExecution, cambium::SingleTrack>;
cambium::FrenetPlanner<Predicted, cambium::IdmClassic, cambium::NoBudget, cambium::Progress> planner;
