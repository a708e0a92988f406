#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "cambium/evaluation/rules/formula.hpp"

namespace cambium::inline v0_1 {

/// What the steps so far say about a formula.
enum class RuleVerdict : std::uint8_t {
  open,       ///< it depends on what follows
  satisfied,  ///< it holds, whatever follows
  violated,   ///< it does not hold, whatever follows
};

/// "open", "satisfied", "violated".
[[nodiscard]] constexpr char const* to_string(RuleVerdict verdict) {
  return verdict == RuleVerdict::open ? "open" : verdict == RuleVerdict::satisfied ? "satisfied" : "violated";
}

/// The deterministic automaton that reads a trace step by step and knows at each whether the formula holds if the trace
/// ends there, and whether it still can hold and can fail (the three verdicts of Bauer, Leucker, Schallhart 2011, on
/// finite traces: De Giacomo, De Masellis, Maggi, Montali 2022, "Monitoring constraints and metaconstraints with
/// temporal logics on finite traces").
///
/// Its states are what remains to be shown: Boolean functions of the obligations that the operators leave for the next
/// step, found by formula progression (Bacchus, Kabanza 1998). Functions that are equal count as one, because they are
/// kept as reduced binary decision diagrams (Bryant 1986), so that there are finitely many.
///
/// Immutable. 2 bytes a transition: states * 2^labels.
class FormulaAutomaton {
 public:
  using State = std::uint16_t;

  static constexpr std::size_t most_labels = 12;
  static constexpr std::size_t most_states = 1024;
  /// Nothing is read yet. No transition leads here.
  static constexpr State start = 0;

  /// Throws `FormulaError` if the formula has more than `most_labels` labels or needs more than `most_states` states.
  /// O(states * 2^labels) and more, the states at worst doubly exponential in the formula: compile once.
  explicit FormulaAutomaton(Formula const& formula);

  /// The formula's labels in alphabetical order.
  [[nodiscard]] std::vector<std::string> const& labels() const { return labels_; }
  [[nodiscard]] std::size_t size() const { return verdicts_.size(); }

  /// The state after a step in `state` with the labels in `letter`: bit i is that of `labels()[i]`. O(1).
  [[nodiscard]] State next(State state, std::uint32_t letter) const {
    return next_[(std::size_t{state} << labels_.size()) | letter];
  }

  /// The verdict in a state. O(1).
  [[nodiscard]] RuleVerdict verdict(State state) const { return verdicts_[state]; }

  /// The verdict if the trace ends in that state: not open, except at the start. O(1).
  [[nodiscard]] RuleVerdict verdict_at_end(State state) const { return at_end_[state]; }

 private:
  std::vector<std::string> labels_;
  std::vector<State> next_;
  std::vector<RuleVerdict> verdicts_, at_end_;
};

}  // namespace cambium::inline v0_1

#ifndef CAMBIUM_COMPILED
#include "cambium/evaluation/rules/formula_automaton_impl.hpp"
#endif
