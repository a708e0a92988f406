// expect: cambium::Prediction<Set>: the assumed behaviour must be one of the Models of Set
#include <cambium/behavior/following/constant_acceleration.hpp>
#include <cambium/behavior/open_loop/external_input.hpp>
#include <cambium/world/prediction.hpp>

using Set = cambium::BehaviorSet<cambium::ConstantAcceleration>;
auto const prediction = cambium::predict_as<Set>(cambium::ConstantAcceleration{}, cambium::ExternalInput{});
