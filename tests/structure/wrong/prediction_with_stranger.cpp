// expect: cambium::Prediction<Set>: the assumed behaviour must be one of the Models of Set
using Set = cambium::BehaviorSet<cambium::ConstantAcceleration>;
auto const prediction = cambium::predict_as<Set>(cambium::ConstantAcceleration{}, cambium::ExternalInput{});
