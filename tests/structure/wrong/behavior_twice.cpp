// expect: cambium::BehaviorSet<...>: name each behaviour once
#include <cambium/behavior/behavior_set.hpp>
#include <cambium/behavior/following/idm_classic.hpp>

using Set = cambium::BehaviorSet<cambium::IdmClassic, cambium::IdmClassic>;
Set::Any const behavior{};
