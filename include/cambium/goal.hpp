/// The room `goal`: what an agent wants to reach.
#pragma once

#include "cambium/goal/goal.hpp"
#include "cambium/goal/goal_situation.hpp"
#include "cambium/goal/own_goal.hpp"
#include "cambium/goal/simple_goals.hpp"
