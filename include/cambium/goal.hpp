/// The room `goal`: what an agent wants to reach.
#pragma once

#include "cambium/goal/goal.hpp"
