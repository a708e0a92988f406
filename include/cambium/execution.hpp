/// The room `execution`: what turns a plan into motion.
#pragma once

#include "cambium/execution/execution_model.hpp"
#include "cambium/execution/execution_set.hpp"
#include "cambium/execution/interpolate.hpp"
#include "cambium/execution/lqr.hpp"
#include "cambium/execution/lqr_gain.hpp"
#include "cambium/execution/stanley.hpp"
#include "cambium/execution/steering.hpp"
#include "cambium/execution/tracking.hpp"
