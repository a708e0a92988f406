#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>

#include "cambium/core/parameters.hpp"

namespace cambium::inline v0_1 {

namespace detail {

/// The action as text: a number, its `to_string`, or else "#" and the arm's number. Escaped for a quoted string.
template <class Action>
[[nodiscard]] std::string action_text(Action const& action, std::size_t place) {
  std::string text;
  if constexpr (std::is_arithmetic_v<Action>)
    text = std::to_string(action);
  else if constexpr (requires { std::string(to_string(action)); })
    text = to_string(action);
  else
    text = "#" + std::to_string(place);
  std::string quoted;
  for (char const c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return quoted;
}

/// Calls `f(number, node)` for the root and every node with at least `least` visits, parents first.
template <class Tree, class F>
void for_each_visited(Tree const& tree, std::uint32_t least, F&& f) {
  for (std::uint32_t n = 0; n < tree.size(); ++n)
    if (n == 0 || tree.node(n).visits >= least) f(n, tree.node(n));
}

/// The arm by which an agent came to a node from its parent.
template <class Tree>
[[nodiscard]] auto const& arm_to(Tree const& tree, std::uint32_t node, std::size_t agent) {
  return tree.arms(tree.node(node).parent, agent)[tree.joint(node)[agent]];
}

}  // namespace detail

/// A search's tree as JSON: `{"seed", "iterations", "nodes": [{"id", "parent", "visits", "terminal", "agents":
/// [{"action", "reward", "cost", "visits", "return"}]}]}`. An agent's visits and mean return belong to its action at
/// the parent. Leaves out nodes with fewer than `least_visits` visits. Actions are named by their `to_string`.
template <class Search>
[[nodiscard]] std::string tree_as_json(Search const& search, std::uint32_t least_visits = 1) {
  auto const& tree = search.tree();
  std::string text = "{\"seed\": " + std::to_string(search.result().seed) +
                     ", \"iterations\": " + std::to_string(search.result().iterations) + ", \"nodes\": [";
  detail::for_each_visited(tree, least_visits, [&](std::uint32_t n, auto const& node) {
    text += (n == 0 ? "\n" : ",\n") + ("{\"id\": " + std::to_string(n));
    text += ", \"parent\": " + (n == 0 ? "null" : std::to_string(node.parent));
    text += ", \"visits\": " + std::to_string(node.visits);
    text += std::string(", \"terminal\": ") + (node.terminal ? "true" : "false") + ", \"agents\": [";
    for (std::size_t k = 0; n != 0 && k < tree.agents(); ++k) {
      auto const& arm = detail::arm_to(tree, n, k);
      text += (k == 0 ? "" : ", ") + ("{\"action\": \"" + detail::action_text(arm.action, tree.joint(n)[k]));
      text += "\", \"reward\": " + detail::number_text(tree.outcomes(n)[k].reward);
      text += ", \"cost\": " + detail::number_text(tree.outcomes(n)[k].cost);
      text += ", \"visits\": " + std::to_string(arm.visits);
      text += ", \"return\": " + detail::number_text(arm.mean_return()) + "}";
    }
    text += "]}";
  });
  return text + "\n]}\n";
}

/// The same tree as a graph for Graphviz (`dot -Tsvg`). Nodes show their visits, edges the actions of all agents.
template <class Search>
[[nodiscard]] std::string tree_as_dot(Search const& search, std::uint32_t least_visits = 1) {
  auto const& tree = search.tree();
  std::string text = "digraph search {\n  node [shape=circle];\n";
  detail::for_each_visited(tree, least_visits, [&](std::uint32_t n, auto const& node) {
    auto const name = "n" + std::to_string(n);
    text += "  " + name + " [label=\"" + std::to_string(node.visits) + "\"" +
            (node.terminal ? ", shape=doublecircle" : "") + "];\n";
    if (n == 0) return;
    text += "  n" + std::to_string(node.parent) + " -> " + name + " [label=\"";
    for (std::size_t k = 0; k < tree.agents(); ++k)
      text += (k == 0 ? "" : ", ") + detail::action_text(detail::arm_to(tree, n, k).action, tree.joint(n)[k]);
    text += "\"];\n";
  });
  return text + "}\n";
}

}  // namespace cambium::inline v0_1
