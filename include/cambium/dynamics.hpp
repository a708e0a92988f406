/// The room `dynamics`: vehicle models and integration schemes.
#pragma once

#include "cambium/dynamics/dynamic_model.hpp"
#include "cambium/dynamics/dynamic_set.hpp"
#include "cambium/dynamics/integration.hpp"
#include "cambium/dynamics/kinematic_point.hpp"
#include "cambium/dynamics/single_track.hpp"
#include "cambium/dynamics/single_track_steering.hpp"
#include "cambium/dynamics/triple_integrator.hpp"
