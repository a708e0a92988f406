/// The room `dynamics`: vehicle models and integration schemes.
#pragma once

#include "cambium/dynamics/dynamic_model.hpp"
#include "cambium/dynamics/integration.hpp"
#include "cambium/dynamics/single_track.hpp"
