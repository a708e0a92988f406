/// The room `behavior`: behaviour models that need no search, and sets of them.
#pragma once

#include "cambium/behavior/behavior_model.hpp"
#include "cambium/behavior/behavior_set.hpp"
#include "cambium/behavior/constant_acceleration.hpp"
#include "cambium/behavior/corridor_filters.hpp"
#include "cambium/behavior/external_input.hpp"
#include "cambium/behavior/follow_lane.hpp"
#include "cambium/behavior/idm.hpp"
#include "cambium/behavior/idm_classic.hpp"
#include "cambium/behavior/lane_change.hpp"
#include "cambium/behavior/lane_change_rule_based.hpp"
#include "cambium/behavior/lane_changing.hpp"
#include "cambium/behavior/lane_ends.hpp"
#include "cambium/behavior/mobil.hpp"
#include "cambium/behavior/view.hpp"
#include "cambium/behavior/zip_merge.hpp"
