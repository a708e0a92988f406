#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "cambium/core/ids.hpp"
#include "cambium/core/one_of.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/evaluation/collision.hpp"
#include "cambium/evaluation/rules/formula.hpp"
#include "cambium/evaluation/rules/formula_automaton.hpp"
#include "cambium/evaluation/rules/label.hpp"

namespace cambium::inline v0_1 {

/// A label under the name by which formulas call it; that of its struct where none is given. `Labels` is a `OneOf`.
template <class Labels>
struct NamedLabel {
  std::string name{};
  Labels label;

  /// A label under its own name, or under another.
  template <class L>
  requires(Labels::template contains<L>) NamedLabel(L const& one) : name(L::name), label(one) {}
  NamedLabel(std::string own_name, Labels const& one) : name(std::move(own_name)), label(one) {}
};

/// A traffic rule: a formula over labels. A formula with a label of two agents (`PairLabel`) holds for each other agent
/// separately. `Labels` is the `OneOf` of all label types that the rule may use, the user's own among them.
template <class Labels>
struct TrafficRule {
  std::string name{};
  std::string summary{};
  std::string source{};
  Formula formula{};
  std::vector<NamedLabel<Labels>> labels{};  ///< may be more than the formula has
};

/// A stretch of steps at which a rule was violated.
struct Violation {
  double begin{}, end{};          ///< time of the first and of the last such step [s]
  AgentId agent = none<AgentId>;  ///< the one that is judged
  AgentId other = none<AgentId>;  ///< none where the rule has no label of two agents

  friend bool operator==(Violation const&, Violation const&) = default;
};

/// Watches whether one agent keeps a rule, step by step:
///
///     RuleMonitor monitor(rule);
///     while (...) {
///       world.step(dt);
///       monitor(world, world.slot_of(ego));
///     }
///     monitor.finish();   // what the formula still demands is not fulfilled
///     monitor.count(), monitor.violations()
///
/// After a violation the formula is watched anew from the next step on; violations at successive steps count as one. If
/// the rule has labels of two agents, each other agent in traffic has a trace of its own, from the step at which it is
/// first seen to the one at which it has left: what the formula still demands then is a violation. A trace that ends
/// may come out as satisfied or violated, but not open.
///
/// A step costs O(labels), for a rule with labels of two agents O(agents * labels), and one look into a table each; it
/// does not allocate while there are no more others and violations than the constructor reserved room for. A copy
/// continues by itself, shares the automaton, and gets its room as it needs it.
template <class Labels>
class RuleMonitor {
 public:
  /// Checks the labels' parameters and compiles the formula, at a cost of microseconds to milliseconds (see
  /// `FormulaAutomaton`). Throws `ParameterError`; throws `FormulaError` for a label that the rule does not have, and
  /// for a formula that is too complex. `violations` is how many are located; all are counted.
  explicit RuleMonitor(TrafficRule<Labels> rule, std::size_t others = 64, std::size_t violations = 256)
      : compiled_(compile(std::move(rule))), most_located_(violations) {
    traces_.reserve(others);
    next_.reserve(others);
    located_.reserve(violations);
  }

  /// Judges the step that led to the present frame: violated if the rule was violated in this step; satisfied if it no
  /// longer can be, with any of the agents that are in traffic; else open. Nothing happens while the agent is not in
  /// traffic; when it has left, or another agent is at `slot`, its trace is finished, see `finish`.
  template <class World>
  RuleVerdict operator()(World& world, Slot slot) {
    auto const id = world.roster().agents[slot].id;
    if (id != agent_) {
      finish();
      agent_ = id;
    }
    if (!in_traffic(world, slot)) return finish();
    time_ = world.frame().time;
    is_violated_ = false;
    auto const letter = letter_of(world, slot);
    if ((is_pair_rule<World>()))
      read_pairs(world, slot, letter);
    else
      read_alone(letter);
    if (is_violated_) return RuleVerdict::violated;
    auto const is_satisfied = [&](Trace const& trace) {
      return automaton().verdict(trace.state) == RuleVerdict::satisfied;
    };
    bool const all = !traces_.empty() && std::all_of(traces_.begin(), traces_.end(), is_satisfied);
    return all ? RuleVerdict::satisfied : RuleVerdict::open;
  }

  /// Ends the traces: what the formula still demands is a violation at the last step. Satisfied or violated; open where
  /// there was no trace.
  RuleVerdict finish() {
    if (traces_.empty()) return RuleVerdict::open;
    is_violated_ = false;
    for (auto const& trace : traces_) end(trace);
    traces_.clear();
    return is_violated_ ? RuleVerdict::violated : RuleVerdict::satisfied;
  }

  /// The number of violations.
  [[nodiscard]] std::size_t count() const { return count_; }
  /// Where they were, in the order in which they began.
  [[nodiscard]] std::span<Violation const> violations() const { return located_; }
  [[nodiscard]] TrafficRule<Labels> const& rule() const { return compiled_->rule; }
  [[nodiscard]] FormulaAutomaton const& automaton() const { return compiled_->automaton; }

 private:
  using State = FormulaAutomaton::State;

  struct Compiled {
    TrafficRule<Labels> rule;
    FormulaAutomaton automaton;
    std::vector<Labels> labels;  ///< in the order of the automaton's
  };

  /// The steps with one other agent, or with none.
  struct Trace {
    AgentId other = none<AgentId>;
    State state = FormulaAutomaton::start;
    std::uint32_t violation = no_violation;  ///< the one that lasts, by its number
  };
  static constexpr std::uint32_t no_violation = std::numeric_limits<std::uint32_t>::max();
  static constexpr std::uint32_t not_located = no_violation - 1;  ///< one that is only counted

  [[nodiscard]] static std::shared_ptr<Compiled const> compile(TrafficRule<Labels> rule) {
    FormulaAutomaton automaton(rule.formula);
    std::vector<Labels> labels;
    for (auto const& name : automaton.labels()) {
      auto const found =
          std::find_if(rule.labels.begin(), rule.labels.end(), [&](auto const& label) { return label.name == name; });
      if (found == rule.labels.end()) {
        std::vector<std::string> known;
        for (auto const& label : rule.labels) known.push_back(label.name);
        detail::refuse_label("rule '" + rule.name + "', formula '" + to_string(rule.formula) + "'", name, known);
      }
      found->label.visit([&](auto const& label) {
        if constexpr (Described<std::decay_t<decltype(label)>>)
          check_parameters(label, "rule '" + rule.name + "', label '" + name + "'");
      });
      labels.push_back(found->label);
    }
    return std::make_shared<Compiled const>(Compiled{std::move(rule), std::move(automaton), std::move(labels)});
  }

  /// Whether a label, by its index, is one of two agents.
  template <class World, class... Ls>
  [[nodiscard]] static constexpr std::array<bool, Labels::size> pair_labels(OneOf<Ls...> const*) {
    static_assert(
        ((AgentLabel<Ls, World> != PairLabel<Ls, World>)&&...),
        "cambium::RuleMonitor<OneOf<Labels...>>: each label must have either `template <class World> bool "
        "operator()(World&, Slot) const` or `template <class World> bool operator()(World&, Slot, Slot other) "
        "const`; make one of an evaluator that returns a number by cambium::Exceeds");
    return {PairLabel<Ls, World>...};
  }
  template <class World>
  static constexpr auto is_pair_label = pair_labels<World>(static_cast<Labels const*>(nullptr));

  template <class World>
  [[nodiscard]] bool is_pair_rule() const {
    return std::any_of(compiled_->labels.begin(), compiled_->labels.end(),
                       [](Labels const& label) { return is_pair_label<World>[label.index()]; });
  }

  template <class L, class World, class... Others>
  [[nodiscard]] static bool ask(L const& label, World& world, Slot slot, Others... others) {
    if constexpr (PairLabel<L, World> == (sizeof...(others) > 0))
      return label(world, slot, others...);
    else
      return false;
  }

  /// The bits of the labels of one agent (`others` none) or of two.
  template <class World, class... Others>
  [[nodiscard]] std::uint32_t letter_of(World& world, Slot slot, Others... others) const {
    std::uint32_t letter = 0;
    for (std::size_t i = 0; i < compiled_->labels.size(); ++i) {
      auto const& one = compiled_->labels[i];
      if (is_pair_label<World>[one.index()] != (sizeof...(others) > 0)) continue;
      bool const holds = one.visit([&](auto const& label) { return ask(label, world, slot, others...); });
      letter |= static_cast<std::uint32_t>(holds) << i;
    }
    return letter;
  }

  void read_alone(std::uint32_t letter) {
    if (traces_.empty()) traces_.emplace_back();
    read(traces_.front(), letter);
  }

  /// Traces and agents are both sorted by id.
  template <class World>
  void read_pairs(World& world, Slot slot, std::uint32_t letter) {
    auto const& agents = world.roster().agents;
    next_.clear();
    auto known = traces_.begin();
    for (Slot other{}; index_of(other) < world.size(); ++other) {
      if (other == slot || !in_traffic(world, other)) continue;
      auto const id = agents[other].id;
      for (; known != traces_.end() && known->other < id; ++known) end(*known);
      Trace& trace = next_.emplace_back();
      trace.other = id;
      if (known != traces_.end() && known->other == id) trace = *known++;
      if (automaton().verdict(trace.state) == RuleVerdict::satisfied) continue;
      read(trace, letter | letter_of(world, slot, other));
    }
    for (; known != traces_.end(); ++known) end(*known);
    traces_.swap(next_);
  }

  void read(Trace& trace, std::uint32_t letter) {
    trace.state = automaton().next(trace.state, letter);
    if (automaton().verdict(trace.state) != RuleVerdict::violated) {
      trace.violation = no_violation;
      return;
    }
    trace.state = FormulaAutomaton::start;
    is_violated_ = true;
    if (trace.violation == no_violation)
      trace.violation = violated(trace.other);
    else if (trace.violation != not_located)
      located_[trace.violation].end = time_;
  }

  void end(Trace const& trace) {
    if (automaton().verdict_at_end(trace.state) != RuleVerdict::violated) return;
    is_violated_ = true;
    violated(trace.other);
  }

  /// Counts a violation; returns its number.
  std::uint32_t violated(AgentId other) {
    ++count_;
    if (located_.size() >= most_located_) return not_located;
    located_.push_back({time_, time_, agent_, other});
    return static_cast<std::uint32_t>(located_.size() - 1);
  }

  std::shared_ptr<Compiled const> compiled_;
  AgentId agent_ = none<AgentId>;
  double time_ = 0.0;  ///< of the last step [s]
  bool is_violated_ = false;
  std::size_t count_ = 0, most_located_;
  std::vector<Trace> traces_, next_;  ///< by the other's id
  std::vector<Violation> located_;
};

}  // namespace cambium::inline v0_1
