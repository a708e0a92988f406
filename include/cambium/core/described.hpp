#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "cambium/core/ids.hpp"

namespace cambium::inline v0_1 {

/// Valid values of a parameter: `low` to `high`, both included. An infinite bound admits infinity as a value; the
/// ranges below do not.
struct Range {
  double low, high;
};

/// Every finite number; neither infinity nor NaN.
inline constexpr Range any_finite{std::numeric_limits<double>::lowest(), std::numeric_limits<double>::max()};
/// Zero and every finite number above.
inline constexpr Range non_negative{0.0, std::numeric_limits<double>::max()};
/// Every finite number above zero.
inline constexpr Range positive{std::numeric_limits<double>::denorm_min(), std::numeric_limits<double>::max()};

/// Name, unit, range and meaning of one field of a parameter struct.
struct ParameterInfo {
  char const* name;
  char const* unit;
  Range range;
  char const* sentence;
  char const* choices = nullptr;  ///< an enum's value names, from 0 on: "rk4|euler"; null for other fields
};

/// One field of a parameter struct: its key, member pointer, unit ("m/s", "-" for none), valid range, and one sentence
/// that says what it means. `Field` is one of:
///   - `double`, `float`, an integer or `bool`;
///   - an enum, described by `choice`;
///   - an id, which has no range, because only the world or map knows which ids exist;
///   - a `std::string`, which has no range either;
///   - another described struct: its own ranges apply, and its keys appear as "outer.inner";
///   - a `OneOf` of described structs: keys appear as "outer.alternative.inner";
///   - a `std::optional` of these: nothing appears of an empty one;
///   - a list of these (an array, a vector, or a pointer to one): unit and range hold for each element, and keys appear
///     as "list[0]" and "list[0].inner".
template <class Owner, class Field>
struct Parameter : ParameterInfo {
  Field Owner::*field;
};

namespace detail {
/// What an element of a list consists of: its type, which may still be incomplete, or of a list in it that one's.
template <class Element>
struct ElementPart {
  using type = Element;
};
template <class Inner>
struct ElementPart<std::vector<Inner>> : ElementPart<Inner> {};
template <class Inner>
struct ElementPart<std::optional<Inner>> : ElementPart<Inner> {};
template <class Inner, std::size_t size>
struct ElementPart<std::array<Inner, size>> : ElementPart<Inner> {};

/// What a field consists of: of a list or an optional what its elements consist of.
template <class Field>
struct PartOf {
  using type = Field;
};
template <class Field>
requires requires { typename Field::value_type; }
struct PartOf<Field> : ElementPart<typename Field::value_type> {};
template <class Field>
requires requires { typename Field::element_type::value_type; }  // a pointer to a list
struct PartOf<Field> : ElementPart<typename Field::element_type::value_type> {};
template <>
struct PartOf<std::string> {
  using type = std::string;
};

template <class Field>
constexpr void check_no_choice() {
  using Part = typename PartOf<Field>::type;
  static_assert(!std::is_enum_v<Part> || StrongId<Part>,
                "cambium::parameter: describe an enum by choice(name, field, \"a|b\", sentence)");
}
}  // namespace detail

/// Describes one field.
template <class Owner, class Field>
[[nodiscard]] constexpr Parameter<Owner, Field> parameter(char const* name, Field Owner::*field, char const* unit,
                                                          Range range, char const* sentence) {
  detail::check_no_choice<Field>();
  return {{name, unit, range, sentence}, field};
}

/// Describes a field without unit and range: a bool, an id, a text, or a struct, a `OneOf` or a list of these.
template <class Owner, class Field>
[[nodiscard]] constexpr Parameter<Owner, Field> parameter(char const* name, Field Owner::*field, char const* sentence) {
  detail::check_no_choice<Field>();
  using Part = typename detail::PartOf<Field>::type;
  static_assert(!std::is_arithmetic_v<Part> || std::is_same_v<Part, bool>,
                "cambium::parameter: a number needs a unit and a range: parameter(name, field, \"m/s\", Range{0, 70}, "
                "sentence)");
  return {{name, "-", {}, sentence}, field};
}

/// Describes a field that is an enum. `names`: the names of its values, from 0 on, as "rk4|euler".
template <class Owner, class Field>
[[nodiscard]] constexpr Parameter<Owner, Field> choice(char const* name, Field Owner::*field, char const* names,
                                                       char const* sentence) {
  double last = 0.0;
  for (char const* c = names; *c != '\0'; ++c) last += *c == '|';
  return {{name, "-", {0.0, last}, sentence, names}, field};
}

/// The result of `parameters()`: a function that calls its argument with each field in turn.
template <class... Parameters>
[[nodiscard]] constexpr auto parameter_list(Parameters... parameters) {
  return [=]([[maybe_unused]] auto&& visit) { (visit(parameters), ...); };
}

/// Concatenates two parameter lists.
template <class First, class Second>
[[nodiscard]] constexpr auto join_parameters(First first, Second second) {
  return [=](auto&& visit) { (first(visit), second(visit)); };
}

/// A parameter struct that describes its fields once, in one place. Checking, printing, comparing, hashing, every file
/// format and the documentation follow from that description. The struct has
///   `static constexpr char const* name = "idm_classic";`   (its name in files and messages)
///   `static constexpr auto parameters() { return cambium::parameter_list(cambium::parameter(...), ...); }`
/// and, if fields depend on each other, `void check(std::string const& where) const`, which throws `ParameterError`;
/// `where` is the full key of the struct ("traffic.json: source.spacing").
/// Models also have `summary`, their law in short, and `source`, where it was published.
template <class T>
concept Described = requires {
  T::parameters();
};

/// Calls `f(parameter)` for each field of T, in the order of the description. A nested struct counts as one parameter.
template <Described T, class F>
constexpr void for_each_parameter(F&& f) {
  constexpr bool is_list = requires { T::parameters()(f); };
  static_assert(is_list,
                "cambium: a struct's parameters() must return cambium::parameter_list(cambium::parameter(...), ...)");
  if constexpr (is_list) T::parameters()(f);
}

}  // namespace cambium::inline v0_1
