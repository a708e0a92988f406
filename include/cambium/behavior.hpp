/// The room `behavior`: behaviour models that need no search, and sets of them.
#pragma once

#include "cambium/behavior/behavior_model.hpp"
#include "cambium/behavior/behavior_set.hpp"
#include "cambium/behavior/constant_acceleration.hpp"
#include "cambium/behavior/external_input.hpp"
#include "cambium/behavior/follow_lane.hpp"
#include "cambium/behavior/idm.hpp"
#include "cambium/behavior/idm_classic.hpp"
#include "cambium/behavior/macro_actions.hpp"
#include "cambium/behavior/motion_primitives.hpp"
#include "cambium/behavior/random_macro_actions.hpp"
#include "cambium/behavior/rss.hpp"
#include "cambium/behavior/rss_conformant.hpp"
#include "cambium/behavior/safety.hpp"
#include "cambium/behavior/static_trajectory.hpp"
#include "cambium/behavior/view.hpp"
