// expect: cambium::Prediction<Set>: Set must be cambium::BehaviorSet<Models...>
#include <cambium/behavior/following/constant_acceleration.hpp>
#include <cambium/world/prediction.hpp>

// One behaviour alone is no set.
auto const prediction = cambium::predict_all_as<cambium::ConstantAcceleration>(cambium::ConstantAcceleration{});
