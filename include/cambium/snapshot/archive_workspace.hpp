#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "cambium/core/described.hpp"
#include "cambium/planner/mcts/mcts_workspace.hpp"
#include "cambium/planner/search/parallel_tree_search.hpp"
#include "cambium/planner/search/search_domain.hpp"
#include "cambium/planner/search/selection_policy.hpp"
#include "cambium/planner/search/tree_search_parameters.hpp"
#include "cambium/snapshot/archive_fields.hpp"
#include "cambium/snapshot/archive_world.hpp"

namespace cambium::inline v0_1 {

namespace detail {

template <class Domain, class Options>
inline constexpr bool is_archived_by_fields<MctsWorkspace<Domain, Options>> = true;

/// Whether searches of `Domain` can keep a tree.
template <class Domain>
inline constexpr bool keeps_trees = is_deterministic<Domain> && !SamplesRoot<Domain>;

/// True. Else a compile error says that the description of a struct in a kept tree leaves out a field.
template <class T>
[[nodiscard]] constexpr bool check_all_described() {
  static_assert(
      describes_all<T>(),
      "cambium: the parameters() of an action or of a selection policy's Statistics leave out a field, or name "
      "the fields in another order than the struct does; a snapshot of a kept tree would lose it");
  return true;
}

/// True. Else a compile error says what a snapshot cannot hold of an arm.
template <class Action, class Statistics>
[[nodiscard]] constexpr bool check_arm(Arm<Action, Statistics> const*) {
  static_assert(std::is_arithmetic_v<Action> || std::is_enum_v<Action> || Described<Action>,
                "cambium: a snapshot of a kept tree holds its actions; let ActionSet<Actions>::Choice be a number, or "
                "describe its fields, see Described");
  static_assert(std::is_empty_v<Statistics> || Described<Statistics>,
                "cambium: a snapshot of a kept tree holds the Statistics of its selection policy; describe their "
                "fields: `static constexpr char const* name` and `static constexpr auto parameters()`, see Described");
  if constexpr (Described<Action>) static_assert(check_all_described<Action>());
  if constexpr (Described<Statistics>)
    static_assert(check_all_described<Statistics>() && check_all_described<Arm<Action, Statistics>>());
  return true;
}

/// What one agent did to come to a node, what that brought, and its arms there.
template <class Arm>
struct ArchivedChoice {
  std::uint16_t came_by = 0;  ///< arm of the parent
  AgentOutcome outcome{};
  std::vector<Arm> arms;

  static constexpr char const* name = "choice";
  static constexpr auto parameters() {
    using P = ArchivedChoice;
    return parameter_list(parameter("came_by", &P::came_by, "-", Range{0, 65535}, "arm of the parent"),
                          parameter("outcome", &P::outcome, "of the step that led here"),
                          parameter("arms", &P::arms, "to choose from; none before the first choice"));
  }
};

template <class Arm>
struct ArchivedNode {
  std::uint32_t parent = no_node, visits = 0;
  std::vector<ArchivedChoice<Arm>> agents;

  static constexpr char const* name = "node";
  static constexpr auto parameters() {
    using P = ArchivedNode;
    return parameter_list(
        parameter("parent", &P::parent, "-", Range{0, no_node}, "a smaller number; of the root the largest there is"),
        parameter("visits", &P::visits, "-", Range{0, 4294967295.0}, "courses through it"),
        parameter("agents", &P::agents, "those that choose, ego first"));
  }
};

/// What a search has kept: a subtree, by the numbers that its nodes get when the search goes on (`keep_below`).
template <class Search>
struct ArchivedTree {
  std::vector<ArchivedNode<typename Search::ArmType>> nodes;  ///< none: it has kept nothing
  std::vector<typename Search::State> states;                 ///< in the order of `by_depth`
  std::vector<ReturnScale> scales;

  static constexpr char const* name = "tree";
  static constexpr auto parameters() {
    using P = ArchivedTree;
    return parameter_list(parameter("nodes", &P::nodes, "parents first"),
                          parameter("states", &P::states, "of the nodes, level by level"),
                          parameter("scales", &P::scales, "of the agents that choose"));
  }
};

/// All that the next search needs to continue its trees: these, and what it compares to see whether they still hold.
template <class Search>
struct ArchivedSearch {
  using Domain = std::remove_cvref_t<decltype(std::declval<Search&>().domain())>;
  using World = typename Domain::World;

  ArchivedWorld<World> world;
  std::vector<Slot> slots;
  std::remove_cvref_t<decltype(std::declval<Domain&>().action_set())> actions{};
  std::remove_cvref_t<decltype(std::declval<Domain&>().reward())> reward{};
  double dt = 0.0, cooperation = 0.0;
  TreeSearchParameters parameters_of_search{};
  std::vector<ArchivedTree<Search>> trees;

  static constexpr char const* name = "search";
  static constexpr auto parameters() {
    using P = ArchivedSearch;
    return parameter_list(parameter("world", &P::world, "in which it predicts"),
                          parameter("slots", &P::slots, "of the agents that choose, ego first"),
                          parameter("actions", &P::actions, "to choose from"),
                          parameter("reward", &P::reward, "of each of them"),
                          parameter("dt", &P::dt, "s", positive, "time step"),
                          parameter("cooperation", &P::cooperation, "-", Range{0, 1}, "weight of the others' rewards"),
                          parameter("parameters", &P::parameters_of_search, "of the trees"),
                          parameter("trees", &P::trees, "one a thread"));
  }
};

/// The numbers of nodes by depth, then by parent: the states of neighbours in this order differ least. Throws
/// `SnapshotError` unless parents come first.
template <class Node>
[[nodiscard]] std::vector<std::uint32_t> by_depth(std::vector<Node> const& nodes) {
  std::vector<std::uint32_t> depths(nodes.size(), 0), order(nodes.size());
  for (std::uint32_t n = 0; n < nodes.size(); ++n) {
    auto const parent = nodes[n].parent;
    require_consistent(n == 0 ? parent == no_node : parent < n, "a node of a tree comes before its parent");
    if (n > 0) depths[n] = depths[parent] + 1;
    order[n] = n;
  }
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::tuple(depths[a], nodes[a].parent, a) < std::tuple(depths[b], nodes[b].parent, b);
  });
  return order;
}

template <class Search>
[[nodiscard]] ArchivedTree<Search> archived_tree(Search const& search) {
  ArchivedTree<Search> parts;
  if (search.kept() == no_node) return parts;
  auto const& tree = search.tree();
  std::vector<std::uint32_t> number(tree.size(), no_node), nodes;
  for (auto n = search.kept(); n < tree.size(); ++n) {
    auto const& node = tree.node(n);
    bool const is_root = n == search.kept();
    if (!is_root && number[node.parent] == no_node) continue;
    number[n] = static_cast<std::uint32_t>(nodes.size());
    nodes.push_back(n);
    auto& archived = parts.nodes.emplace_back();
    archived.parent = is_root ? no_node : number[node.parent];
    archived.visits = node.visits;
    for (std::size_t k = 0; k < tree.agents(); ++k) {
      auto const arms = tree.arms(n, k);
      archived.agents.push_back({tree.joint(n)[k], tree.outcomes(n)[k], {arms.begin(), arms.end()}});
    }
  }
  for (auto const n : by_depth(parts.nodes)) parts.states.push_back(tree.state(nodes[n]));
  parts.scales.assign(search.scales().begin(), search.scales().end());
  return parts;
}

/// What the archive holds of trees that have been kept.
template <class Search>
[[nodiscard]] ArchivedSearch<Search> archived_trees(ParallelTreeSearch<Search> const& trees) {
  static_assert(check_arm(static_cast<typename Search::ArmType const*>(nullptr)));
  static_assert(check_all_described<ReturnScale>() && check_all_described<AgentOutcome>() &&
                check_all_described<typename Search::State>());
  ArchivedSearch<Search> parts;
  auto const& first = trees.searches().front();
  auto const& domain = first.domain();
  parts.world = archived(domain.world());
  parts.slots.assign(domain.slots().begin(), domain.slots().end());
  parts.actions = domain.action_set();
  parts.reward = domain.reward();
  parts.dt = domain.dt();
  parts.cooperation = domain.cooperation();
  parts.parameters_of_search = first.parameters();
  for (auto const& search : trees.searches()) parts.trees.push_back(archived_tree(search));
  return parts;
}

/// Whether the actions of the arms are those of the state, if these are a list. A number that is none of them would
/// address nothing.
template <class Domain, class Arm>
[[nodiscard]] bool are_actions(Domain& domain, typename Domain::State const& state, std::size_t agent,
                               std::vector<Arm> const& arms) {
  if constexpr (ListsActions<Domain>) {
    std::vector<typename Domain::Action> options(Domain::max_actions);
    options.resize(std::min<std::size_t>(options.size(), domain.actions(state, agent, options)));
    return std::equal(arms.begin(), arms.end(), options.begin(), options.end(),
                      [](Arm const& arm, auto const& action) { return arm.action == action; });
  } else {
    return arms.size() <= WideningSchedule::longest;
  }
}

/// Throws `SnapshotError` unless the frame belongs to the roster.
template <class Frame, class Roster>
void place_on_roads(Frame& frame, Roster const& roster) {
  require_consistent(frame.agents.size() == roster.agents.size() && frame.roster_revision == roster.revision,
                     "a state of a tree has other agents than its world");
  for (Slot slot{}; index_of(slot) < frame.agents.size(); ++slot)
    place_on(*roster.agents[slot].road, roster.agents[slot].behavior, frame.agents[slot], frame.time);
}

template <class Search, class Domain>
[[nodiscard]] typename Search::Tree restored_tree(Domain& domain, ArchivedTree<Search>& parts) {
  auto const order = by_depth(parts.nodes);
  auto const agents = domain.agents();
  require_consistent(parts.states.size() == order.size() && parts.scales.size() == agents,
                     "a tree has more nodes than states, or other agents that choose");
  std::vector<std::size_t> place(order.size());  // of a node's state
  for (std::size_t i = 0; i < order.size(); ++i) place[order[i]] = i;
  typename Search::Tree tree;
  tree.reset({.agents = agents,
              .nodes = order.size(),
              .bytes = std::numeric_limits<std::size_t>::max(),
              .state_bytes = sizeof(typename Search::State)});
  std::vector<std::uint16_t> joint(agents);
  std::vector<AgentOutcome> outcomes(agents);
  for (std::uint32_t n = 0; n < order.size(); ++n) {
    auto const& node = parts.nodes[n];
    auto& state = parts.states[place[n]];
    require_consistent(node.agents.size() == agents, "a node of a tree has other agents that choose");
    for (std::size_t k = 0; k < agents; ++k) {
      joint[k] = node.agents[k].came_by;
      outcomes[k] = node.agents[k].outcome;
      require_consistent(n == 0 || joint[k] < tree.arms(node.parent, k).size(), "a node of a tree comes by no arm");
    }
    require_consistent(n == 0 || (!tree.node(node.parent).terminal && tree.find(node.parent, joint) == no_node),
                       "a node of a tree is there twice, or after the end");
    require_consistent(problem_of(outcomes) == SearchProblem::none, "a node of a tree has no valid outcome");
    place_on_roads(state.frame, domain.world().roster());
    tree.node(tree.add(node.parent, joint, outcomes, state.over, state)).visits = node.visits;
    for (std::size_t k = 0; k < agents; ++k) {
      auto const& arms = node.agents[k].arms;
      require_consistent(arms.empty() || are_actions(domain, state, k, arms), "a node of a tree has other actions");
      for (auto const& arm : arms) tree.add_arm(n, k, arms.size()) = arm;
    }
  }
  return tree;
}

/// The trees of `parts`, which share map and free corridors with one of `scenes`. Throws `SnapshotError` if there is
/// none, or if the parts contradict each other.
template <class Search>
[[nodiscard]] ParallelTreeSearch<Search> restored_trees(ArchivedSearch<Search>&& parts, ArchivedScenes const& scenes) {
  using Domain = typename ArchivedSearch<Search>::Domain;
  auto const* const scene = scenes.on_map(parts.world.map_hash);
  if (scene == nullptr) throw SnapshotError("snapshot", "a kept tree needs its world", "restore the world before it");
  auto world = restored<typename Domain::World>(scene->map, std::move(parts.world), scene->free_roads);
  require_consistent(!parts.slots.empty() && parts.slots.size() <= world.size(), "a search has no agents that choose");
  for (auto const slot : parts.slots)
    require_consistent(
        index_of(slot) < world.size() && world.frame().agents[slot].memory.index() == Domain::behavior_index,
        "an agent that chooses has another model");
  require_consistent(parts.dt > 0.0 && parts.dt < 1e3, "a search has no time step");
  constexpr std::size_t most_trees = 1024;  // see ParallelTreeSearch::set
  require_consistent(!parts.trees.empty() && parts.trees.size() <= most_trees, "a search has no trees");
  // With longer decisions than a step there is no tree to keep, see MctsWorkspace::keep.
  Domain domain(std::move(world), parts.slots, parts.actions, parts.reward, parts.dt, 1, parts.cooperation);
  ParallelTreeSearch<Search> trees;
  for (auto& tree : parts.trees) {
    auto& search = trees.searches().emplace_back(domain, parts.parameters_of_search);
    if (tree.nodes.empty()) continue;
    auto kept = restored_tree(domain, tree);
    search.restore_kept(std::move(kept), std::move(tree.scales));
  }
  return trees;
}

}  // namespace detail

}  // namespace cambium::inline v0_1

namespace boost::serialization {

/// The trees that an `MctsWorkspace` has kept. When they are loaded, a world on the same map must have come before them
/// in the archive: they share its map and its free corridors. Without a call of `keep` it loads as a new workspace.
template <class Archive, class Domain, class Options>
void serialize(Archive& archive, cambium::MctsWorkspace<Domain, Options>& workspace, unsigned) {
  using Workspace = cambium::MctsWorkspace<Domain, Options>;
  if constexpr (!cambium::detail::keeps_trees<Domain>) {
    if constexpr (!Archive::is_saving::value) workspace = Workspace();
  } else if constexpr (Archive::is_saving::value) {
    std::optional<cambium::detail::ArchivedSearch<typename Workspace::Search>> kept;
    if (auto const* trees = workspace.kept(); trees != nullptr) kept = cambium::detail::archived_trees(*trees);
    cambium::detail::archive_fields(archive, "kept", kept);
  } else {
    std::optional<cambium::detail::ArchivedSearch<typename Workspace::Search>> kept;
    cambium::detail::archive_fields(archive, "kept", kept);
    Workspace restored;
    if (kept)
      restored.restore_kept(cambium::detail::restored_trees(std::move(*kept), cambium::detail::scenes_of(archive)));
    workspace = std::move(restored);
  }
}

}  // namespace boost::serialization
