#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "cambium/core/macros.hpp"
#include "cambium/evaluation/rules/formula_automaton.hpp"

namespace cambium::inline v0_1 {

namespace detail {

/// Boolean functions as reduced ordered binary decision diagrams (Bryant 1986): equal functions have equal numbers.
class Diagrams {
 public:
  using Ref = std::uint32_t;
  static constexpr Ref no = 0, yes = 1;
  static constexpr std::size_t most_nodes = 1u << 20;

  struct Node {
    std::uint32_t variable;
    Ref low, high;  ///< the function where the variable is false, and where it is true
  };

  [[nodiscard]] Ref variable(std::uint32_t number) { return make(number, no, yes); }
  [[nodiscard]] Node const& node(Ref ref) const { return nodes_[ref]; }

  /// `f ? g : h`.
  [[nodiscard]] Ref choose(Ref f, Ref g, Ref h) {
    if (f == yes || g == h) return g;
    if (f == no) return h;
    if (g == yes && h == no) return f;
    std::array const key{f, g, h};
    if (auto const known = chosen_.find(key); known != chosen_.end()) return known->second;
    auto const top = std::min({nodes_[f].variable, nodes_[g].variable, nodes_[h].variable});
    auto const half = [&](Ref ref, bool high) {
      return nodes_[ref].variable != top ? ref : high ? nodes_[ref].high : nodes_[ref].low;
    };
    Ref const low = choose(half(f, false), half(g, false), half(h, false));
    Ref const result = make(top, low, choose(half(f, true), half(g, true), half(h, true)));
    return chosen_[key] = result;
  }

 private:
  [[nodiscard]] Ref make(std::uint32_t variable, Ref low, Ref high) {
    if (low == high) return low;
    auto const [at, is_new] = known_.try_emplace({variable, low, high}, static_cast<Ref>(nodes_.size()));
    if (is_new) {
      if (nodes_.size() >= most_nodes)
        throw FormulaError("formula", "it is too complex to monitor", "split it into several rules");
      nodes_.push_back({variable, low, high});
    }
    return at->second;
  }

  static constexpr std::uint32_t leaf = ~0u;
  std::vector<Node> nodes_{{leaf, no, no}, {leaf, yes, yes}};
  std::map<std::array<std::uint32_t, 3>, Ref> known_, chosen_;
};

/// Formula progression: what the formula demands of the rest of a trace behind its first step. The rest may be empty.
/// Variable i is the obligation that subformula i, or the operand of a `next`, holds on the rest.
class Progression {
 public:
  using Ref = Diagrams::Ref;
  using Kind = Formula::Kind;

  Progression(Formula const& formula, std::vector<std::string> const& labels) : nodes_(formula.postfix()) {
    std::vector<std::size_t> roots;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      Children children{};
      if (nodes_[i].arity() > 0) children.last = take(roots);
      if (nodes_[i].arity() > 1) children.first = take(roots);
      if (nodes_[i].kind == Kind::label)
        children.label =
            static_cast<std::size_t>(std::find(labels.begin(), labels.end(), nodes_[i].label) - labels.begin());
      children_.push_back(children);
      std::size_t same = 0;  // the first subformula like it, which stands for all
      while (same < i && !is_like(same, i)) ++same;
      roots.push_back(same);
    }
  }

  /// What remains of the formula after the first step, by its letter. Must be called for each letter before `rest`.
  [[nodiscard]] Ref begin(std::uint32_t letter) {
    std::vector<Ref> after;
    for (std::size_t i = 0; i < nodes_.size(); ++i) after.push_back(progress(i, letter, after));
    after_.resize(std::max<std::size_t>(after_.size(), letter + 1));
    memo_.resize(after_.size());
    after_[letter] = std::move(after);
    return after_[letter].back();
  }

  /// What remains of `state` after a step.
  [[nodiscard]] Ref rest(Ref state, std::uint32_t letter) {
    if (state <= Diagrams::yes) return state;
    if (auto const known = memo_[letter].find(state); known != memo_[letter].end()) return known->second;
    auto const node = diagrams_.node(state);
    Ref const low = rest(node.low, letter), high = rest(node.high, letter);
    auto const then = after_[letter][what_holds(node.variable)];
    return memo_[letter][state] = diagrams_.choose(then, high, low);
  }

  /// Whether the empty trace meets `state`: there, an obligation holds only if it may do without a next step.
  [[nodiscard]] bool holds_at_end(Ref state) const {
    while (state > Diagrams::yes) {
      auto const& node = diagrams_.node(state);
      auto const kind = nodes_[node.variable].kind;
      bool const is_weak = kind == Kind::weak_next || kind == Kind::always || kind == Kind::weak_until;
      state = is_weak ? node.high : node.low;
    }
    return state == Diagrams::yes;
  }

 private:
  struct Children {
    std::size_t first{}, last{}, label{};
  };

  [[nodiscard]] bool is_like(std::size_t a, std::size_t b) const {
    return nodes_[a] == nodes_[b] && children_[a].first == children_[b].first && children_[a].last == children_[b].last;
  }

  [[nodiscard]] static std::size_t take(std::vector<std::size_t>& roots) {
    auto const root = roots.back();
    roots.pop_back();
    return root;
  }

  /// The subformula that obligation `variable` demands of the next step: the operand of a `next`, or the operator
  /// again.
  [[nodiscard]] std::size_t what_holds(std::size_t variable) const {
    auto const kind = nodes_[variable].kind;
    return kind == Kind::next || kind == Kind::weak_next ? children_[variable].last : variable;
  }

  [[nodiscard]] Ref progress(std::size_t i, std::uint32_t letter, std::vector<Ref> const& after) {
    auto& d = diagrams_;
    constexpr Ref no = Diagrams::no, yes = Diagrams::yes;
    auto const& [first, last, label] = children_[i];
    auto const again = [&] { return d.variable(static_cast<std::uint32_t>(i)); };
    switch (nodes_[i].kind) {
      case Kind::falsum:
        return no;
      case Kind::verum:
        return yes;
      case Kind::label:
        return (letter >> label & 1u) != 0 ? yes : no;
      case Kind::negation:
        return d.choose(after[last], no, yes);
      case Kind::conjunction:
        return d.choose(after[first], after[last], no);
      case Kind::disjunction:
        return d.choose(after[first], yes, after[last]);
      case Kind::implication:
        return d.choose(after[first], after[last], yes);
      case Kind::next:
      case Kind::weak_next:
        return again();
      case Kind::eventually:
        return d.choose(after[last], yes, again());
      case Kind::always:
        return d.choose(after[last], again(), no);
      case Kind::until:
      case Kind::weak_until:
        return d.choose(after[last], yes, d.choose(after[first], again(), no));
    }
    return no;
  }

  std::vector<Formula::Node> nodes_;
  std::vector<Children> children_;
  Diagrams diagrams_;
  std::vector<std::vector<Ref>> after_;   ///< by letter, then subformula
  std::vector<std::map<Ref, Ref>> memo_;  ///< by letter
};

/// Marks the states from which a marked one can be reached.
inline void mark_origins(std::vector<FormulaAutomaton::State> const& next, std::size_t letters,
                         std::vector<bool>& marked) {
  for (bool has_changed = true; has_changed;) {
    has_changed = false;
    for (std::size_t state = 0; state < marked.size(); ++state) {
      if (marked[state]) continue;
      auto const begin = next.begin() + static_cast<std::ptrdiff_t>(state * letters);
      marked[state] =
          std::any_of(begin, begin + static_cast<std::ptrdiff_t>(letters), [&](auto const to) { return marked[to]; });
      has_changed = has_changed || marked[state];
    }
  }
}

}  // namespace detail

CAMBIUM_COLD FormulaAutomaton::FormulaAutomaton(Formula const& formula) : labels_(formula.labels()) {
  auto const refuse = [&](std::string const& what) {
    throw FormulaError("formula '" + to_string(formula) + "'", what, "split it into several rules");
  };
  if (labels_.size() > most_labels)
    refuse("it has " + std::to_string(labels_.size()) + " labels; a monitor takes at most " +
           std::to_string(most_labels));
  std::size_t const letters = std::size_t{1} << labels_.size();
  detail::Progression progression(formula, labels_);
  std::vector<detail::Diagrams::Ref> states{detail::Diagrams::no};  // the start, which no reference stands for
  std::map<detail::Diagrams::Ref, State> numbers;
  for (std::size_t state = 0; state < states.size(); ++state)
    for (std::uint32_t letter = 0; letter < letters; ++letter) {
      auto const to = state == start ? progression.begin(letter) : progression.rest(states[state], letter);
      auto const [at, is_new] = numbers.try_emplace(to, static_cast<State>(states.size()));
      if (is_new) states.push_back(to);
      if (states.size() > most_states) refuse("its automaton has more than " + std::to_string(most_states) + " states");
      next_.push_back(at->second);
    }
  std::vector<bool> can_hold(states.size()), can_fail(states.size());
  at_end_.push_back(RuleVerdict::open);
  for (std::size_t state = 1; state < states.size(); ++state) {
    can_hold[state] = progression.holds_at_end(states[state]);
    can_fail[state] = !can_hold[state];
    at_end_.push_back(can_hold[state] ? RuleVerdict::satisfied : RuleVerdict::violated);
  }
  detail::mark_origins(next_, letters, can_hold);
  detail::mark_origins(next_, letters, can_fail);
  for (std::size_t state = 0; state < states.size(); ++state)
    verdicts_.push_back(!can_fail[state]   ? RuleVerdict::satisfied
                        : !can_hold[state] ? RuleVerdict::violated
                                           : RuleVerdict::open);
}

}  // namespace cambium::inline v0_1
