// expect: cambium::World<Set, Execution, ...>: Execution must be an execution model such as cambium::InterpolateExecution
// The models are in the wrong order.
cambium::World<cambium::BehaviorSet<cambium::ConstantAcceleration>, cambium::SingleTrack, cambium::SingleTrack> world(
    nullptr);
