// expect: cambium::BehaviorSet<...>: a behaviour must be a copyable struct, named without const
#include "cambium/behavior/behavior_set.hpp"
#include "cambium/behavior/following/idm_classic.hpp"

cambium::BehaviorSet<cambium::IdmClassic const> set;
