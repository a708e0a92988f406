// expect: cambium::BehaviorSet<...>: a behaviour must be a copyable struct, named without const
#include "cambium/behavior/idm_classic.hpp"
#include "cambium/behavior/behavior_set.hpp"

cambium::BehaviorSet<cambium::IdmClassic const> set;
