// expect: cambium::World<Set, Execution, Dynamics, Observer>: Observer must be an observer model such as cambium::PerfectObserver
struct Blind {};
cambium::World<cambium::BehaviorSet<cambium::ConstantAcceleration>, cambium::InterpolateExecution, cambium::SingleTrack,
               Blind>
    world(nullptr);
