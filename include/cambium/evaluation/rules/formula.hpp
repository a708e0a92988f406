#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cambium/core/error.hpp"

namespace cambium::inline v0_1 {

/// A formula is not what it should be: its text cannot be parsed, a label is unknown, or it is too complex to monitor.
struct FormulaError : Error {
  using Error::Error;
};

namespace detail {

/// Throws the `FormulaError` about a label that is not among those known: it names those of these that are near, or
/// all.
[[noreturn]] void refuse_label(std::string const& where, std::string_view label, std::span<std::string const> known);

}  // namespace detail

/// A formula of linear temporal logic on finite traces (LTLf; De Giacomo, Vardi 2013, "Linear temporal logic and linear
/// dynamic logic on finite traces"), as a value: what has to hold over the steps of a run. Its atoms are labels, which
/// are true or false at each step. Made from text, or in C++ by the functions below, where text stands for a formula:
///
///     Formula const rule("G(lane_change -> safe_behind)");
///     Formula const same = always(implies("lane_change", "safe_behind"));
///
/// | text | or | in C++ | holds at a step where |
/// |---|---|---|---|
/// | `near` | | `"near"` | the label `near` does: letters, digits and `_`, no digit first, no word of this table |
/// | `true`, `false` | | `"true"` | always, never |
/// | `! f` | `not` | `!f` | f does not hold |
/// | `f & g` | `&&`, `and` | `f && g` | both hold |
/// | `f \| g` | `\|\|`, `or` | `f \|\| g` | at least one holds |
/// | `f -> g` | `implies` | `implies(f, g)` | g holds if f does |
/// | `X f` | `next` | `next(f)` | there is a next step, and f holds there |
/// | `N f` | `weak_next` | `weak_next(f)` | f holds at the next step, if there is one |
/// | `F f` | `eventually` | `eventually(f)` | f holds now or at a later step |
/// | `G f` | `always` | `always(f)` | f holds from now on to the end |
/// | `f U g` | `until` | `until(f, g)` | g holds now or later, and f until then |
/// | `f W g` | `weak_until` | `weak_until(f, g)` | the same, or f holds to the end |
///
/// Operators bind in the order `! X N F G`, `U W`, `&`, `|`, `->`; `U`, `W` and `->` group to the right.
class Formula {
 public:
  enum class Kind : std::uint8_t {
    falsum,
    verum,
    label,
    negation,
    next,
    weak_next,
    eventually,
    always,
    until,
    weak_until,
    conjunction,
    disjunction,
    implication,
  };

  /// An operator or an atom.
  struct Node {
    Kind kind = Kind::verum;
    std::string label{};  ///< of a `Kind::label`

    /// The number of formulas that it takes: 0, 1 or 2.
    [[nodiscard]] int arity() const { return kind <= Kind::label ? 0 : kind <= Kind::always ? 1 : 2; }
    friend bool operator==(Node const&, Node const&) = default;
  };

  /// The formula `true`.
  Formula() : postfix_{Node{}} {}
  /// Reads text. Throws `FormulaError` with the column where it goes wrong, what was expected, and a remedy. Where
  /// `labels` is not empty, so is a label that is not among them. At most 200 operators deep. O(text).
  Formula(char const* text, std::span<std::string const> labels = {});
  Formula(std::string_view text, std::span<std::string const> labels = {});
  Formula(std::string const& text, std::span<std::string const> labels = {})
      : Formula(std::string_view(text), labels) {}

  /// Its operators and atoms, each behind what it takes: `a U !b` is a, b, not, until.
  [[nodiscard]] std::vector<Node> const& postfix() const { return postfix_; }

  /// Its labels in alphabetical order, each once.
  [[nodiscard]] std::vector<std::string> labels() const;

  /// Whether they are written alike: `!!p` differs from `p`.
  friend bool operator==(Formula const&, Formula const&) = default;

  /// Applies an operator of as many formulas as it takes.
  [[nodiscard]] static Formula of(Kind kind, Formula const& f);
  [[nodiscard]] static Formula of(Kind kind, Formula const& f, Formula const& g);

 private:
  std::vector<Node> postfix_;
};

/// As text in ASCII, with no more parentheses than needed; reads back as the same formula. O(length).
[[nodiscard]] std::string to_string(Formula const& formula);

/// Not f.
[[nodiscard]] inline Formula operator!(Formula const& f) { return Formula::of(Formula::Kind::negation, f); }
/// f and g.
[[nodiscard]] inline Formula operator&&(Formula const& f, Formula const& g) {
  return Formula::of(Formula::Kind::conjunction, f, g);
}
/// f or g.
[[nodiscard]] inline Formula operator||(Formula const& f, Formula const& g) {
  return Formula::of(Formula::Kind::disjunction, f, g);
}
/// f implies g.
[[nodiscard]] inline Formula implies(Formula const& f, Formula const& g) {
  return Formula::of(Formula::Kind::implication, f, g);
}
/// There is a next step, and f holds from it on.
[[nodiscard]] inline Formula next(Formula const& f) { return Formula::of(Formula::Kind::next, f); }
/// f holds from the next step on, if there is one.
[[nodiscard]] inline Formula weak_next(Formula const& f) { return Formula::of(Formula::Kind::weak_next, f); }
/// f holds at some step from now on.
[[nodiscard]] inline Formula eventually(Formula const& f) { return Formula::of(Formula::Kind::eventually, f); }
/// f holds at each step from now on.
[[nodiscard]] inline Formula always(Formula const& f) { return Formula::of(Formula::Kind::always, f); }
/// g holds at some step, and f at each step before it.
[[nodiscard]] inline Formula until(Formula const& f, Formula const& g) {
  return Formula::of(Formula::Kind::until, f, g);
}
/// f until g, or f always.
[[nodiscard]] inline Formula weak_until(Formula const& f, Formula const& g) {
  return Formula::of(Formula::Kind::weak_until, f, g);
}

}  // namespace cambium::inline v0_1

#ifndef CAMBIUM_COMPILED
#include "cambium/evaluation/rules/formula_impl.hpp"
#endif
