#pragma once

#include <limits>

namespace cambium {

/// Valid values of a parameter: `low` to `high`, both included. An infinite bound admits infinity as a value; use the
/// ranges below where it must not.
struct Range {
  double low, high;
};

/// Every number, but neither infinity nor NaN.
inline constexpr Range any_finite{std::numeric_limits<double>::lowest(), std::numeric_limits<double>::max()};
/// Zero and every finite number above.
inline constexpr Range non_negative{0.0, std::numeric_limits<double>::max()};
/// Every finite number above zero.
inline constexpr Range positive{std::numeric_limits<double>::denorm_min(), std::numeric_limits<double>::max()};

/// What is said of one field of a parameter struct.
struct ParameterInfo {
  char const* name;
  char const* unit;
  Range range;
  char const* sentence;
  char const* choices = nullptr;  ///< of an enum the names of its values, from 0 on: "rk4|euler"
};

/// One field of a parameter struct: its key, where it lives, its unit ("m/s", "-" for none), its valid range, and one
/// sentence that says what it means. `Field`: `double`, `float`, an integer, `bool`, an id (no range: the world or map
/// knows which there are), another described struct (its own ranges count, and its keys appear as "outer.inner"), or a
/// list of these: an array, a vector, or a pointer to one (unit and range are those of each element, keys appear as
/// "list[0]" and "list[0].inner"); an enum by `choice`.
template <class Owner, class Field>
struct Parameter : ParameterInfo {
  Field Owner::*field;
};

/// Describes one field.
template <class Owner, class Field>
[[nodiscard]] constexpr Parameter<Owner, Field> parameter(char const* name, Field Owner::*field, char const* unit,
                                                          Range range, char const* sentence) {
  return {{name, unit, range, sentence}, field};
}

/// Describes a field that is an enum. `names`: those of its values, from 0 on, as "rk4|euler".
template <class Owner, class Field>
[[nodiscard]] constexpr Parameter<Owner, Field> choice(char const* name, Field Owner::*field, char const* names,
                                                       char const* sentence) {
  double last = 0.0;
  for (char const* c = names; *c != '\0'; ++c) last += *c == '|';
  return {{name, "-", {0.0, last}, sentence, names}, field};
}

/// What `parameters()` returns: calls what it is given with each field.
template <class... Parameters>
[[nodiscard]] constexpr auto parameter_list(Parameters... parameters) {
  return [=](auto&& visit) { (visit(parameters), ...); };
}

/// Two lists in one.
template <class First, class Second>
[[nodiscard]] constexpr auto join_parameters(First first, Second second) {
  return [=](auto&& visit) { (first(visit), second(visit)); };
}

/// A parameter struct that says once, in one place, what its fields are. It has
///   `static constexpr char const* name = "idm_classic";`   (its own name in files and messages)
///   `static constexpr auto parameters() { return cambium::parameter_list(cambium::parameter(...), ...); }`
/// and, where fields depend on each other, `void check(std::string const& where) const`, which throws `ParameterError`;
/// `where` is the full key of the struct ("traffic.json: source.spacing").
/// Models say more of themselves: `summary`, their law in short, and `source`, where it was published.
/// Checking, printing, comparing, hashing, every file format and the documentation follow from that.
template <class T>
concept Described = requires {
  T::parameters();
};

/// Calls `f(parameter)` for each field of T, in the order of the description. Nested structs are one parameter.
template <Described T, class F>
constexpr void for_each_parameter(F&& f) {
  constexpr bool is_list = requires { T::parameters()(f); };
  static_assert(is_list,
                "cambium: a struct's parameters() must return cambium::parameter_list(cambium::parameter(...), ...)");
  if constexpr (is_list) T::parameters()(f);
}

}  // namespace cambium
