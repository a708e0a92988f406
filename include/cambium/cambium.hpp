/// All rooms of cambium; needs Eigen and Boost headers only. OpenDRIVE files are read by cambium/map/opendrive.hpp.
#pragma once

#include "cambium/behavior.hpp"
#include "cambium/core.hpp"
#include "cambium/dynamics.hpp"
#include "cambium/evaluation.hpp"
#include "cambium/execution.hpp"
#include "cambium/geometry.hpp"
#include "cambium/goal.hpp"
#include "cambium/map.hpp"
#include "cambium/observer.hpp"
#include "cambium/planner.hpp"
#include "cambium/scenario.hpp"
#include "cambium/viewer.hpp"
#include "cambium/world.hpp"
