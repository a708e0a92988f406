/// The room `execution`: what turns a plan into motion.
#pragma once

#include "cambium/execution/execution_model.hpp"
#include "cambium/execution/interpolate.hpp"
