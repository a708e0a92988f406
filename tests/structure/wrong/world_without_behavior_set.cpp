// expect: cambium::World<Set, ...>: Set must be cambium::BehaviorSet<Models...>
// One behaviour alone is no set.
cambium::World<cambium::IdmClassic, cambium::InterpolateExecution, cambium::SingleTrack> world(nullptr);
