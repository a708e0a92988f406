// expect: cambium::BehaviorSet<...>: a behaviour must be a copyable struct, named without const
cambium::BehaviorSet<cambium::IdmClassic const> set;
