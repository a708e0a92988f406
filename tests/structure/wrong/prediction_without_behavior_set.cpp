// expect: cambium::Prediction<Set>: Set must be cambium::BehaviorSet<Models...>
// One behaviour alone is no set.
auto const prediction = cambium::predict_all_as<cambium::ConstantAcceleration>(cambium::ConstantAcceleration{});
