/// The room `planner`: tree search over copied worlds, and over any game.
#pragma once

#include "cambium/planner/belief.hpp"
#include "cambium/planner/exp3.hpp"
#include "cambium/planner/parallel_tree_search.hpp"
#include "cambium/planner/puct.hpp"
#include "cambium/planner/regret_matching.hpp"
#include "cambium/planner/rollout.hpp"
#include "cambium/planner/search_budget.hpp"
#include "cambium/planner/search_domain.hpp"
#include "cambium/planner/search_result.hpp"
#include "cambium/planner/selection_policy.hpp"
#include "cambium/planner/tree_export.hpp"
#include "cambium/planner/tree_search.hpp"
#include "cambium/planner/tree_search_parameters.hpp"
#include "cambium/planner/ucb1.hpp"
