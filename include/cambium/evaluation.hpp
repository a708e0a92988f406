/// The room `evaluation`: what judges a world, one by one or put together at compile time.
#pragma once

#include "cambium/evaluation/collision.hpp"
#include "cambium/evaluation/drivable_area.hpp"
#include "cambium/evaluation/evaluators.hpp"
#include "cambium/evaluation/goal_reached.hpp"
