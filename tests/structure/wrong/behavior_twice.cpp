// expect: cambium::BehaviorSet<...>: name each behaviour once
using Set = cambium::BehaviorSet<cambium::IdmClassic, cambium::IdmClassic>;
Set::Any const behavior{};
