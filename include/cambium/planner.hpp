/// # The planner room
///
/// A planner is a behaviour that predicts. It tries out in copies of the world what its own vehicle, *ego*, could do,
/// and drives the best of it. A *course* is what all agents do from now to the planner's horizon, step by step.
///
///                  now            +0.2 s          +0.4 s            horizon
///
///     what   predict     keep_gap        keep_gap
///     ego  --------> [node]----------[node]----------[node] . . roll-out . . > return 12.3
///     sees              \               \   change_left
///                        \               '-----------[node] . . . . . . . . > return  9.1
///                         \ change_left
///                          '---------[node] . . . . . . . . . . . . . . . . > return  8.7
///
///     report:  candidates keep_gap (score 10.7, chosen) and change_left (8.7), the course, the memory
///
/// **Prediction world.** The world that the planner steps instead of the true one (`PredictionWorld`). `view.predict`
/// fills it with what ego sees. In it, ego carries out the actions under test and all others follow the model that the
/// planner assumes (`Others`), because nobody sees another agent's behaviour. A planner makes it once per plan; from
/// then on it only copies frames.
///
/// **Node.** A point of the search tree: the frame after all actions on the way from the root. The arms of a node are
/// the actions that an agent can choose there, each with its visits and its mean return. Where the tree ends, a
/// roll-out continues the course to the horizon. If the others' parameters are drawn anew in every iteration
/// (`HeadwayHypotheses`), a node has no frame of its own and stands only for the actions.
///
/// **Macro action** (`MacroAction`). What an agent chooses at a node: keep the gap to the leader, stay in the lane at
/// some acceleration, change left or right. A behaviour of the prediction world, `MacroActions`, carries it out. A lane
/// change takes longer than one step, so that behaviour's memory says how far it has come.
///
/// **Candidate** (`PlannerCandidate`). One option that the planner compares, with its score, or the reason why it is
/// refused. These are ego's actions at the root for `Mcts`, IDM drivers for `ProposalPlanner`, sequences of actions for
/// `PolicyTreePlanner`, and polynomial courses for `FrenetPlanner`.
///
/// **Think and plan.** Every planner has both. `think` explains, for a stack that calls the planner itself; `plan` is
/// what a world calls when the planner is an agent's behaviour.
///
///     view (what ego sees now) --------.
///     workspace (buffers, the tree) ---+--> think --> report --> decide, draw, log
///     memory ({} at first) ------------'                |
///        ^------------------- report.memory ------------'
///
/// The memory is a small value: the lane change under way, or what it has learnt about others. The workspace only saves
/// allocations, except after `MctsWorkspace::keep`: then the next search continues the tree.
///
/// **Report** (`PlannerReport`). All candidates, the chosen one, how clearly it won, the course, and the memory for the
/// next call. Every planner adds what only it knows.
///
/// **Ring** (`candidate_planner.hpp`). What planners that compare a list of candidates share: prediction, budget, plan
/// and report.
///
/// The folders: `search/` is tree search for any game and knows no traffic; `mcts/` makes a game of traffic
/// (`TrafficDomain`); `policy/` simulates a list of candidates; `frenet/` samples polynomials. Start with
/// `planner_model.hpp`, `candidate_planner.hpp`, `search/search_domain.hpp` and `mcts/traffic_domain.hpp`.
#pragma once

// First: it says which language and flags cambium needs.
#include "cambium/core/macros.hpp"

#include "cambium/planner/candidate_planner.hpp"
#include "cambium/planner/explain.hpp"
#include "cambium/planner/frenet/frenet_candidate.hpp"
#include "cambium/planner/frenet/frenet_motion.hpp"
#include "cambium/planner/frenet/frenet_planner.hpp"
#include "cambium/planner/frenet/quintic.hpp"
#include "cambium/planner/mcts/action_set.hpp"
#include "cambium/planner/mcts/belief.hpp"
#include "cambium/planner/mcts/mcts.hpp"
#include "cambium/planner/mcts/mcts_workspace.hpp"
#include "cambium/planner/mcts/traffic_domain.hpp"
#include "cambium/planner/mcts/traffic_reward.hpp"
#include "cambium/planner/planner_model.hpp"
#include "cambium/planner/policy/policy_tree.hpp"
#include "cambium/planner/policy/policy_tree_planner.hpp"
#include "cambium/planner/policy/proposal_planner.hpp"
#include "cambium/planner/predicted.hpp"
#include "cambium/planner/search/exp3.hpp"
#include "cambium/planner/search/parallel_tree_search.hpp"
#include "cambium/planner/search/puct.hpp"
#include "cambium/planner/search/regret_matching.hpp"
#include "cambium/planner/search/rollout.hpp"
#include "cambium/planner/search/search_budget.hpp"
#include "cambium/planner/search/search_domain.hpp"
#include "cambium/planner/search/search_result.hpp"
#include "cambium/planner/search/selection_policy.hpp"
#include "cambium/planner/search/tree_export.hpp"
#include "cambium/planner/search/tree_search.hpp"
#include "cambium/planner/search/tree_search_parameters.hpp"
#include "cambium/planner/search/ucb1.hpp"
