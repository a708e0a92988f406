// expect: cambium::BehaviorSet<...>: a behaviour's plan must take (View const& view, Memory& memory, double dt)
#include "cambium/behavior/behavior_set.hpp"

struct Final final {};
cambium::BehaviorSet<Final> set;
