// Formulas on finite traces: as text, and watched by automata, beside the semantics of De Giacomo and Vardi 2013 spelt
// out over whole traces.
#include "cambium/evaluation/rules/formula_automaton.hpp"

#include <doctest/doctest.h>

#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "../support/error_of.hpp"
#include "cambium/core/distributions.hpp"
#include "cambium/core/random.hpp"
#include "cambium/evaluation/rules/formula.hpp"

namespace {

using namespace cambium;
using Kind = Formula::Kind;
using Letters = std::vector<std::uint32_t>;

/// A formula with at most `size` operators over the first `labels` of a, b, c.
Formula random_formula(RandomStream& random, std::uint32_t size, std::uint32_t labels) {
  constexpr char const* names[] = {"a", "b", "c"};
  if (size == 0) {
    auto const i = uniform_index(random, labels + 1);
    return i < labels ? Formula(names[i]) : Formula(uniform_index(random, 2) == 0 ? "true" : "false");
  }
  auto const kind = static_cast<Kind>(static_cast<std::uint32_t>(Kind::negation) + uniform_index(random, 10));
  if (kind <= Kind::always) return Formula::of(kind, random_formula(random, size - 1, labels));
  auto const left = uniform_index(random, size);
  auto const f = random_formula(random, left, labels);
  return Formula::of(kind, f, random_formula(random, size - 1 - left, labels));
}

/// The semantics: whether a formula holds at a step of a trace, all of which is known.
struct Semantics {
  std::vector<Formula::Node> nodes;
  std::vector<std::string> names;

  explicit Semantics(Formula const& formula) : nodes(formula.postfix()), names(formula.labels()) {}

  [[nodiscard]] std::size_t begin_of(std::size_t node) const {  // of what is written as one formula that ends there
    for (int missing = nodes[node].arity(); missing > 0; --missing) node = begin_of(node - 1);
    return node;
  }

  [[nodiscard]] bool holds(Letters const& trace) const { return at(nodes.size() - 1, trace, 0); }

  [[nodiscard]] bool at(std::size_t node, Letters const& trace, std::size_t i) const {
    auto const last = [&](std::size_t step) { return at(node - 1, trace, step); };
    auto const first = [&](std::size_t step) { return at(begin_of(node - 1) - 1, trace, step); };
    switch (nodes[node].kind) {
      case Kind::falsum:
        return false;
      case Kind::verum:
        return true;
      case Kind::label:
        for (std::size_t bit = 0; bit < names.size(); ++bit)
          if (names[bit] == nodes[node].label) return (trace[i] >> bit & 1u) != 0;
        return false;
      case Kind::negation:
        return !last(i);
      case Kind::conjunction:
        return first(i) && last(i);
      case Kind::disjunction:
        return first(i) || last(i);
      case Kind::implication:
        return !first(i) || last(i);
      case Kind::next:
        return i + 1 < trace.size() && last(i + 1);
      case Kind::weak_next:
        return i + 1 == trace.size() || last(i + 1);
      case Kind::eventually:
        for (auto k = i; k < trace.size(); ++k)
          if (last(k)) return true;
        return false;
      case Kind::always:
        for (auto k = i; k < trace.size(); ++k)
          if (!last(k)) return false;
        return true;
      case Kind::until:
      case Kind::weak_until:
        for (auto k = i; k < trace.size(); ++k) {
          if (last(k)) return true;
          if (!first(k)) return false;
        }
        return nodes[node].kind == Kind::weak_until;
    }
    return false;
  }
};

/// Calls `f` with every extension of a trace by at most `longest` steps, itself included.
template <class F>
void each_extension(Letters& trace, std::size_t longest, std::uint32_t letters, F const& f) {
  f(trace);
  if (longest == 0) return;
  for (std::uint32_t letter = 0; letter < letters; ++letter) {
    trace.push_back(letter);
    each_extension(trace, longest - 1, letters, f);
    trace.pop_back();
  }
}

/// The shortest way on from `state` to a state in which a trace may end with `verdict`; it must exist.
Letters way_to(FormulaAutomaton const& automaton, FormulaAutomaton::State state, RuleVerdict verdict) {
  struct Reached {
    FormulaAutomaton::State state;
    Letters way;
  };
  std::deque<Reached> open{{state, {}}};
  std::vector<bool> seen(automaton.size());
  while (!open.empty()) {
    auto const at = open.front();
    open.pop_front();
    if (automaton.verdict_at_end(at.state) == verdict) return at.way;
    for (std::uint32_t letter = 0; letter < 1u << automaton.labels().size(); ++letter) {
      auto const next = automaton.next(at.state, letter);
      if (seen[next]) continue;
      seen[next] = true;
      auto way = at.way;
      way.push_back(letter);
      open.push_back({next, way});
    }
  }
  FAIL("an open verdict that nothing decides");
  return {};
}

Letters joined(Letters a, Letters const& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

std::string mistake(char const* text, std::vector<std::string> const& labels = {}) {
  return support::error_of<FormulaError>([&] { Formula(text, labels); });
}

}  // namespace

TEST_CASE("automata say of random traces what the semantics say of all their extensions") {
  std::size_t decided = 0, undecided = 0, most_states = 0;
  for (std::uint32_t number = 0; number < 4000; ++number) {
    RandomStream random(11, number, 0);
    auto const formula = random_formula(random, 1 + number % 9, 1 + number % 3);
    CAPTURE(to_string(formula));
    Semantics const semantics(formula);
    FormulaAutomaton const automaton(formula);
    most_states = std::max(most_states, automaton.size());
    REQUIRE(automaton.labels() == semantics.names);
    auto const letters = 1u << automaton.labels().size();
    Letters trace;
    auto state = FormulaAutomaton::start;
    auto before = RuleVerdict::open;
    for (int step = 0; step < 7; ++step) {
      trace.push_back(uniform_index(random, letters));
      state = automaton.next(state, trace.back());
      auto const verdict = automaton.verdict(state);
      bool const holds = semantics.holds(trace);
      REQUIRE(automaton.verdict_at_end(state) == (holds ? RuleVerdict::satisfied : RuleVerdict::violated));
      if (verdict == RuleVerdict::open) {
        REQUIRE(before == RuleVerdict::open);
        REQUIRE(semantics.holds(joined(trace, way_to(automaton, state, RuleVerdict::satisfied))));
        REQUIRE_FALSE(semantics.holds(joined(trace, way_to(automaton, state, RuleVerdict::violated))));
        ++undecided;
      } else if (before == RuleVerdict::open) {
        each_extension(trace, letters == 8 ? 3 : 4, letters, [&](Letters const& longer) {
          REQUIRE(semantics.holds(longer) == (verdict == RuleVerdict::satisfied));
        });
        ++decided;
      } else {
        REQUIRE(verdict == before);
      }
      before = verdict;
    }
  }
  CHECK(decided > 2000);
  CHECK(undecided > 2000);
  CHECK(most_states > 20);
}

TEST_CASE("text reads back as the same formula, and C++ writes the same as text") {
  for (std::uint32_t number = 0; number < 4000; ++number) {
    RandomStream random(12, number, 0);
    auto const formula = random_formula(random, number % 20, 3);
    CAPTURE(to_string(formula));
    REQUIRE(Formula(to_string(formula)) == formula);
  }
  CHECK(Formula("G(lane_change -> safe_behind)") == always(implies("lane_change", "safe_behind")));
  CHECK(Formula("a & b | c -> !a U b U c") ==
        implies(("a" && Formula("b")) || "c", until(!Formula("a"), until("b", "c"))));
  CHECK(Formula("always (a implies next b) and weak_next not c") ==
        (always(implies("a", next("b"))) && weak_next(!Formula("c"))));
  CHECK(Formula("a&&b||c") == Formula("a and b or c"));
  CHECK(Formula("a W b") == weak_until("a", "b"));
  CHECK(Formula("c & (a | b W G a)") == ("c" && (Formula("a") || weak_until("b", always("a")))));
  CHECK(Formula("a -> b -> c") == implies("a", implies("b", "c")));
  CHECK(Formula("a & b & c") != ("a" && (Formula("b") && "c")));
  CHECK(Formula("F a") == eventually("a"));
  CHECK(Formula() == Formula("true"));
  CHECK(to_string(Formula("((a)) U (b U (!(c)))")) == "a U b U !c");
  CHECK(to_string(Formula("(a U b) U (X(N(a)) & true)")) == "(a U b) U (X N a & true)");
  CHECK(Formula("b & a & b").labels() == std::vector<std::string>{"a", "b"});
}

TEST_CASE("a mistake in a formula is named with its column, and what was expected there") {
  std::string const remedy = "; write labels, true, false, ! & | -> X N F G U W and parentheses, as in G(a -> b U !c)";
  CHECK(mistake("G(a ->") == "formula 'G(a ->', column 7: expected a label or a formula, but the text ends" + remedy);
  CHECK(mistake("") == "formula '', column 1: expected a label or a formula, but the text ends" + remedy);
  CHECK(mistake("a b") == "formula 'a b', column 3: expected an operator or the end, not 'b'" + remedy);
  CHECK(mistake("(a") ==
        "formula '(a', column 3: expected an operator or the ')' that closes the '(' in column 1, but "
        "the text ends" +
            remedy);
  CHECK(mistake("a)") == "formula 'a)', column 2: expected the end, since no '(' is open, not ')'" + remedy);
  CHECK(mistake("a & 1b") == "formula 'a & 1b', column 5: a label does not begin with a digit, not '1b'" + remedy);
  CHECK(mistake("a & W") == "formula 'a & W', column 5: expected a label or a formula, not 'W'" + remedy);
  CHECK(mistake("a \xC3\xA4 b") ==
        "formula 'a \xC3\xA4 b', column 3: expected an operator or the end, not '\xC3\xA4'" + remedy);
  CHECK(mistake("G lane_chage", {"lane_change", "near"}) ==
        "formula 'G lane_chage', column 3: there is no label 'lane_chage'; is it lane_change?");
  CHECK(mistake("G foo", {"lane_change", "near"}) ==
        "formula 'G foo', column 3: there is no label 'foo'; give one of lane_change, near");
  CHECK(mistake("near & !lane_change", {"lane_change", "near"}) == "no error");
  std::string deep(250, '!');
  deep += 'a';
  CHECK(mistake(deep.c_str()).find("more than 200 operators in one another") != std::string::npos);
}

TEST_CASE("equal obligations are one state, and a formula that needs too many is refused") {
  CHECK(FormulaAutomaton("G a").size() == 3);          // nothing read, kept so far, violated
  CHECK(FormulaAutomaton("F a & X F a").size() == 5);  // nothing read; a due now and later, later, once; done
  CHECK(FormulaAutomaton("G(a -> F b)").size() == 3);  // nothing read, b is not due, b is due
  CHECK(FormulaAutomaton("true").verdict(FormulaAutomaton::start) == RuleVerdict::satisfied);
  CHECK(FormulaAutomaton("a | !a").verdict(FormulaAutomaton::start) == RuleVerdict::satisfied);
  CHECK(FormulaAutomaton("X a & N !a").verdict(FormulaAutomaton::start) == RuleVerdict::violated);
  auto const problem = [](Formula const& formula) {
    return support::error_of<FormulaError>([&] { FormulaAutomaton{formula}; });
  };
  Formula last = "!X true";  // whether the label held a number of steps before the last one: a bit for each
  for (int i = 0; i < 8; ++i) last = next(last);
  CHECK(FormulaAutomaton(eventually("a" && last)).size() > 500);
  for (int i = 0; i < 4; ++i) last = next(last);
  CHECK(problem(eventually("a" && last)) ==
        "formula '" + to_string(eventually("a" && last)) +
            "': its automaton has more than 1024 states; split it into several rules");
  Formula many = "true";
  for (char c = 'a'; c < 'a' + 13; ++c) many = many && Formula(std::string(1, c));
  CHECK(problem(always(many)).find("it has 13 labels; a monitor takes at most 12; split it into several rules") !=
        std::string::npos);
}
