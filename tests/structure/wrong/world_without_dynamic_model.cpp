// expect: cambium::World<Set, Execution, Dynamics>: Dynamics must be a vehicle model such as cambium::SingleTrack
struct Rocket {};
cambium::World<cambium::BehaviorSet<cambium::ConstantAcceleration>, cambium::InterpolateExecution, Rocket> world(
    nullptr);
