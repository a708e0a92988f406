/// The room `behavior`: behaviour models that need no search, and sets of them.
#pragma once

#include "cambium/behavior/acc.hpp"
#include "cambium/behavior/adaptive_cruise_control.hpp"
#include "cambium/behavior/bark.hpp"
#include "cambium/behavior/behavior_model.hpp"
#include "cambium/behavior/behavior_set.hpp"
#include "cambium/behavior/constant_acceleration.hpp"
#include "cambium/behavior/external_input.hpp"
#include "cambium/behavior/follow_lane.hpp"
#include "cambium/behavior/idm.hpp"
#include "cambium/behavior/idm_classic.hpp"
#include "cambium/behavior/idm_lane_tracking.hpp"
#include "cambium/behavior/idm_stochastic.hpp"
#include "cambium/behavior/leader.hpp"
#include "cambium/behavior/presets.hpp"
#include "cambium/behavior/view.hpp"
