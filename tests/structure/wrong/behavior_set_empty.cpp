// expect: cambium::BehaviorSet<...>: name at least one behaviour
cambium::BehaviorSet<> set;
