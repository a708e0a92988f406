// expect: cambium::BehaviorSet<...>: name at least one behaviour
#include <cambium/behavior/behavior_set.hpp>

cambium::BehaviorSet<> set;
