#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cambium/core/macros.hpp"
#include "cambium/core/nearest_names.hpp"
#include "cambium/evaluation/rules/formula.hpp"

namespace cambium::inline v0_1 {

namespace detail {

/// An operator's spellings, and how tightly it binds: 1 the least.
struct OperatorSign {
  Formula::Kind kind;
  int precedence;
  char const* sign;
  std::array<char const*, 2> others;
};

inline constexpr int tightest = 5;
inline constexpr std::array<OperatorSign, 10> operator_signs{{
    {Formula::Kind::implication, 1, "->", {"implies", ""}},
    {Formula::Kind::disjunction, 2, "|", {"||", "or"}},
    {Formula::Kind::conjunction, 3, "&", {"&&", "and"}},
    {Formula::Kind::until, 4, "U", {"until", ""}},
    {Formula::Kind::weak_until, 4, "W", {"weak_until", ""}},
    {Formula::Kind::negation, tightest, "!", {"not", ""}},
    {Formula::Kind::next, tightest, "X", {"next", ""}},
    {Formula::Kind::weak_next, tightest, "N", {"weak_next", ""}},
    {Formula::Kind::eventually, tightest, "F", {"eventually", ""}},
    {Formula::Kind::always, tightest, "G", {"always", ""}},
}};

/// Whether `f U g U h` means `f U (g U h)`.
[[nodiscard]] constexpr bool groups_right(Formula::Kind kind) {
  return kind == Formula::Kind::until || kind == Formula::Kind::weak_until || kind == Formula::Kind::implication;
}

[[nodiscard]] constexpr bool is_label_character(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

/// Whether it continues a character of several bytes (UTF-8), which is never a sign of its own.
[[nodiscard]] constexpr bool is_within_character(char c) { return (static_cast<unsigned char>(c) & 0xC0u) == 0x80u; }

CAMBIUM_COLD void refuse_label(std::string const& where, std::string_view label, std::span<std::string const> known) {
  throw FormulaError(where, "there is no label '" + std::string(label) + "'",
                     suggestion(label, {known.begin(), known.end()}));
}

/// Recursive descent over the text; writes operators behind their operands.
class FormulaReader {
 public:
  FormulaReader(std::string_view text, std::span<std::string const> labels) : text_(text), labels_(labels) {
    advance();
  }

  [[nodiscard]] std::vector<Formula::Node> read() {
    binary(1);
    if (!token_.empty())
      fail(token_ == ")" ? "expected the end, since no '(' is open" : "expected an operator or the end");
    return std::move(postfix_);
  }

 private:
  using Kind = Formula::Kind;
  static constexpr int deepest = 200;

  /// Operators of `precedence` and tighter ones.
  void binary(int precedence) {
    if (precedence == tightest) return unary();
    binary(precedence + 1);
    for (auto sign = binary_sign(precedence); sign; sign = binary_sign(precedence)) {
      advance();
      nest(1);
      binary(groups_right(*sign) ? precedence : precedence + 1);
      nest(-1);
      push(*sign);
    }
  }

  void unary() {
    nest(1);
    auto const at = std::find_if(operator_signs.begin(), operator_signs.end(),
                                 [&](auto const& sign) { return sign.precedence == tightest && is(sign); });
    if (at != operator_signs.end()) {
      advance();
      unary();
      push(at->kind);
    } else if (token_ == "(") {
      auto const opened = column();
      advance();
      binary(1);
      if (token_ != ")") fail("expected an operator or the ')' that closes the '(' in column " + opened);
      advance();
    } else {
      atom();
    }
    nest(-1);
  }

  void atom() {
    if (token_.empty() || !is_label_character(token_.front()) || is_binary_word())
      fail("expected a label or a formula");
    if (token_.front() >= '0' && token_.front() <= '9') fail("a label does not begin with a digit");
    if (token_ == "true" || token_ == "false") {
      push(token_ == "true" ? Kind::verum : Kind::falsum);
    } else {
      if (!labels_.empty() && std::find(labels_.begin(), labels_.end(), token_) == labels_.end())
        refuse_label(where(), token_, labels_);
      postfix_.push_back({Kind::label, std::string(token_)});
    }
    advance();
  }

  [[nodiscard]] bool is(OperatorSign const& sign) const {
    return !token_.empty() && (token_ == sign.sign || token_ == sign.others[0] || token_ == sign.others[1]);
  }
  [[nodiscard]] bool is_binary_word() const {
    for (int precedence = 1; precedence < tightest; ++precedence)
      if (binary_sign(precedence)) return true;
    return false;
  }
  [[nodiscard]] std::optional<Kind> binary_sign(int precedence) const {
    for (auto const& sign : operator_signs)
      if (sign.precedence == precedence && is(sign)) return sign.kind;
    return std::nullopt;
  }

  void push(Kind kind) { postfix_.push_back({kind, {}}); }

  /// Moves to the next word or sign; an empty one at the end.
  void advance() {
    place_ += token_.size();
    while (place_ < text_.size() &&
           (text_[place_] == ' ' || text_[place_] == '\t' || text_[place_] == '\r' || text_[place_] == '\n'))
      ++place_;
    std::size_t length = place_ < text_.size() ? 1 : 0;
    if (length == 1 && is_label_character(text_[place_]))
      while (place_ + length < text_.size() && is_label_character(text_[place_ + length])) ++length;
    else if (auto const two = text_.substr(std::min(place_, text_.size()), 2);
             two == "->" || two == "&&" || two == "||")
      length = 2;
    while (length > 0 && place_ + length < text_.size() && is_within_character(text_[place_ + length])) ++length;
    token_ = text_.substr(std::min(place_, text_.size()), length);
  }

  void nest(int levels) {
    depth_ += levels;
    if (depth_ > deepest) fail("there are more than " + std::to_string(deepest) + " operators in one another");
  }

  [[nodiscard]] std::string column() const { return std::to_string(place_ + 1); }
  [[nodiscard]] std::string where() const { return "formula '" + std::string(text_) + "', column " + column(); }
  [[noreturn]] void fail(std::string const& what) const {
    throw FormulaError(where(), what + (token_.empty() ? ", but the text ends" : ", not '" + std::string(token_) + "'"),
                       "write labels, true, false, ! & | -> X N F G U W and parentheses, as in G(a -> b U !c)");
  }

  std::string_view text_, token_;
  std::span<std::string const> labels_;
  std::vector<Formula::Node> postfix_;
  std::size_t place_ = 0;
  int depth_ = 0;
};

}  // namespace detail

CAMBIUM_COLD Formula::Formula(std::string_view text, std::span<std::string const> labels)
    : postfix_(detail::FormulaReader(text, labels).read()) {}

CAMBIUM_COLD Formula::Formula(char const* text, std::span<std::string const> labels)
    : Formula(std::string_view(text), labels) {}

CAMBIUM_COLD std::vector<std::string> Formula::labels() const {
  std::vector<std::string> all;
  for (auto const& node : postfix_)
    if (node.kind == Kind::label) all.push_back(node.label);
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

CAMBIUM_COLD Formula Formula::of(Kind kind, Formula const& f) {
  Formula result = f;
  result.postfix_.push_back({kind, {}});
  return result;
}

CAMBIUM_COLD Formula Formula::of(Kind kind, Formula const& f, Formula const& g) {
  Formula result = f;
  result.postfix_.insert(result.postfix_.end(), g.postfix_.begin(), g.postfix_.end());
  result.postfix_.push_back({kind, {}});
  return result;
}

CAMBIUM_COLD std::string to_string(Formula const& formula) {
  using Kind = Formula::Kind;
  struct Part {
    std::string text;
    int precedence;

    [[nodiscard]] std::string within(int least) const { return precedence < least ? "(" + text + ")" : text; }
  };
  std::vector<Part> parts;
  for (auto const& node : formula.postfix()) {
    if (node.arity() == 0) {
      parts.push_back({node.kind == Kind::label   ? node.label
                       : node.kind == Kind::verum ? "true"
                                                  : "false",
                       detail::tightest + 1});
      continue;
    }
    auto const& sign = *std::find_if(detail::operator_signs.begin(), detail::operator_signs.end(),
                                     [&](auto const& one) { return one.kind == node.kind; });
    auto const last = std::move(parts.back());
    parts.pop_back();
    if (node.arity() == 1) {
      bool const is_word = node.kind != Kind::negation && last.precedence >= detail::tightest;
      parts.push_back({sign.sign + std::string(is_word ? " " : "") + last.within(sign.precedence), sign.precedence});
      continue;
    }
    auto& first = parts.back();
    first.text = first.within(sign.precedence + (detail::groups_right(node.kind) ? 1 : 0)) + " " + sign.sign + " " +
                 last.within(sign.precedence + (detail::groups_right(node.kind) ? 0 : 1));
    first.precedence = sign.precedence;
  }
  return parts.back().text;
}

}  // namespace cambium::inline v0_1
