/// All rooms of cambium but what makes maps, pictures and pages: those headers are included by name, as
/// cambium/map/opendrive.hpp (files; needs pugixml), cambium/map/building/map_builder.hpp (maps in code),
/// cambium/viewer.hpp and cambium/benchmark.hpp (needs SQLite and nlohmann_json).
#pragma once

// First: it says which language and flags cambium needs.
#include "cambium/core/macros.hpp"

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
#include "cambium/tracking.hpp"
#include "cambium/world.hpp"
