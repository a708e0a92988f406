#pragma once

#include "cambium/evaluation/collision.hpp"
#include "cambium/evaluation/course_end.hpp"
#include "cambium/evaluation/driving.hpp"
#include "cambium/evaluation/evaluator.hpp"
#include "cambium/evaluation/off_road.hpp"
#include "cambium/evaluation/terms.hpp"
