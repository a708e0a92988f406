#pragma once

#include "cambium/evaluation/rules/agent_labels.hpp"
#include "cambium/evaluation/rules/formula.hpp"
#include "cambium/evaluation/rules/formula_automaton.hpp"
#include "cambium/evaluation/rules/imposed_braking.hpp"
#include "cambium/evaluation/rules/junction_labels.hpp"
#include "cambium/evaluation/rules/label.hpp"
#include "cambium/evaluation/rules/pair_labels.hpp"
#include "cambium/evaluation/rules/relative_place.hpp"
#include "cambium/evaluation/rules/rule_monitor.hpp"
#include "cambium/evaluation/rules/rule_sets.hpp"
#include "cambium/evaluation/rules/safe_distance.hpp"
