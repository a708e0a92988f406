#pragma once

#include <bit>
#include <charconv>
#include <cstdint>
#include <limits>
#include <string>
#include <tuple>
#include <type_traits>

#include "cambium/core/error.hpp"

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

/// One field of a parameter struct: its key, where it lives, its unit ("m/s", "-" for none), its valid range, and one
/// sentence that says what it means. `Field`: `double`, `float`, an integer, `bool`, an enum (its number is checked),
/// or another described struct (its own ranges count, and its keys appear as "outer.inner").
template <class Owner, class Field>
struct Parameter {
  char const* name;
  Field Owner::*field;
  char const* unit;
  Range range;
  char const* sentence;
};

/// Describes one field; the elements of the tuple that `parameters()` returns.
template <class Owner, class Field>
[[nodiscard]] constexpr Parameter<Owner, Field> parameter(char const* name, Field Owner::*field, char const* unit,
                                                          Range range, char const* sentence) {
  return {name, field, unit, range, sentence};
}

/// A parameter struct that says once, in one place, what its fields are. It has
///   `static constexpr char const* name = "idm_classic";`   (its own name in files and messages)
///   `static constexpr auto parameters() { return std::make_tuple(parameter(...), ...); }`
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
  std::apply([&f](auto const&... parameters) { (f(parameters), ...); }, T::parameters());
}

namespace detail {

/// A key's path from the outermost struct, made into text only when somebody reads it.
struct ParameterPath {
  ParameterPath const* outer;
  char const* name;

  [[nodiscard]] std::string text() const { return outer != nullptr ? outer->text() + "." + name : std::string(name); }
};

template <Described T>
[[nodiscard]] constexpr char const* struct_name() {
  if constexpr (requires { T::name; }) {
    return T::name;
  } else {
    return "parameters";
  }
}

/// Calls `f(path, parameter, value)` for each field that is a plain value, nested structs included.
template <Described T, class F>
constexpr void visit_values(T const& object, ParameterPath const* outer, F&& f) {
  for_each_parameter<T>([&](auto const& entry) {
    auto const& value = object.*entry.field;
    using Field = std::remove_cvref_t<decltype(value)>;
    ParameterPath const path{outer, entry.name};
    if constexpr (Described<Field>) {
      visit_values(value, &path, f);
    } else {
      static_assert(std::is_arithmetic_v<Field> || std::is_enum_v<Field>,
                    "cambium::parameter: a field must be a number, a bool, an enum or another described struct.");
      f(path, entry, value);
    }
  });
}

/// Shortest text that reads back as the same number; enums as their number.
template <class Value>
[[nodiscard]] std::string number_text(Value value) {
  if constexpr (std::is_same_v<Value, bool>) {
    return value ? "true" : "false";
  } else if constexpr (std::is_enum_v<Value>) {
    return std::to_string(static_cast<std::underlying_type_t<Value>>(value));
  } else {
    char buffer[32];
    return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr};
  }
}

/// "15 m/s"; no unit for "-" and "".
[[nodiscard]] inline std::string with_unit(std::string number, char const* unit) {
  std::string const text(unit);
  return text.empty() || text == "-" ? number : number + " " + text;
}

/// "[0, 70]", "(0, inf)"; the bounds of the open ranges above are shown as what they mean.
[[nodiscard]] inline std::string range_text(Range range) {
  std::string text = range.low == any_finite.low ? "(-inf"
                     : range.low == positive.low ? "(0"
                                                 : "[" + number_text(range.low);
  return text + ", " + (range.high == any_finite.high ? "inf)" : number_text(range.high) + "]");
}

template <class Value>
[[nodiscard]] constexpr bool in_range(Value value, Range range) {
  if constexpr (std::is_same_v<Value, bool>) {
    return true;
  } else {
    auto const number = static_cast<double>(value);
    return number >= range.low && number <= range.high;  // false for NaN
  }
}

[[noreturn]] inline void throw_out_of_range(std::string const& where, std::string const& key, std::string const& value,
                                            Range range, char const* unit) {
  throw ParameterError((where.empty() ? "" : where + ": ") + key, "is " + with_unit(value, unit),
                       "give a value in " + with_unit(range_text(range), unit));
}

/// Calls the own checks of a struct and of the structs in it, where they have one, with the full key as `where`.
template <Described T>
void check_relations(T const& object, ParameterPath const& path, std::string const& where) {
  for_each_parameter<T>([&](auto const& entry) {
    if constexpr (Described<std::remove_cvref_t<decltype(object.*entry.field)>>) {
      check_relations(object.*entry.field, ParameterPath{&path, entry.name}, where);
    }
  });
  if constexpr (requires { object.check(where); }) {
    object.check((where.empty() ? "" : where + ": ") + path.text());
  }
}

}  // namespace detail

/// Throws `ParameterError` unless every field is within its range (NaN never is). The message names `where` (a file, an
/// agent), the struct and key, the value and the range. Then calls the own `check` of the struct and of those in it,
/// where they have one.
template <Described T>
void check_parameters(T const& object, std::string const& where = {}) {
  detail::ParameterPath const root{nullptr, detail::struct_name<T>()};
  detail::visit_values(object, &root, [&where](auto const& path, auto const& entry, auto value) {
    if (!detail::in_range(value, entry.range)) {
      detail::throw_out_of_range(where, path.text(), detail::number_text(value), entry.range, entry.unit);
    }
  });
  detail::check_relations(object, root, where);
}

/// True when all fields are equal by `==` (so 0 equals -0, and NaN equals nothing).
template <Described T>
[[nodiscard]] constexpr bool equal_parameters(T const& a, T const& b) {
  bool equal = true;
  for_each_parameter<T>([&](auto const& entry) {
    if constexpr (Described<std::remove_cvref_t<decltype(a.*entry.field)>>) {
      equal = equal && equal_parameters(a.*entry.field, b.*entry.field);
    } else {
      equal = equal && a.*entry.field == b.*entry.field;
    }
  });
  return equal;
}

/// The parameters of T as a Markdown table with header: name, default, unit, range, meaning.
template <Described T>
[[nodiscard]] std::string describe_parameters() {
  std::string table = "| name | default | unit | range | meaning |\n|---|---|---|---|---|\n";
  for_each_parameter<T>([&](auto const& outer) {
    T const defaults{};
    auto const row = [&table](auto const& path, auto const& entry, auto value) {
      bool const has_range = !std::is_same_v<decltype(value), bool>;
      table += "| " + path.text() + " | " + detail::number_text(value) + " | " + entry.unit + " | " +
               (has_range ? detail::range_text(entry.range) : "-") + " | " + entry.sentence + " |\n";
    };
    detail::ParameterPath const path{nullptr, outer.name};
    if constexpr (Described<std::remove_cvref_t<decltype(defaults.*outer.field)>>) {
      detail::visit_values(defaults.*outer.field, &path, row);
    } else {
      row(path, outer, defaults.*outer.field);
    }
  });
  return table;
}

/// One line for logs: "idm_classic: desired_speed=15 m/s, time_headway=1.5 s". Numbers read back as the same bits.
template <Described T>
[[nodiscard]] std::string to_string(T const& object) {
  std::string line;
  detail::visit_values(object, nullptr, [&line](auto const& path, auto const& entry, auto value) {
    line += (line.empty() ? "" : ", ") + path.text() + "=" + detail::with_unit(detail::number_text(value), entry.unit);
  });
  return std::string(detail::struct_name<T>()) + ": " + line;
}

/// Hash over the struct's name, its keys and the bits of its values (FNV-1a, 64 bit): the same on every platform and in
/// every run; changes when a field is renamed. Equal parameters have equal hashes.
template <Described T>
[[nodiscard]] constexpr std::uint64_t hash_parameters(T const& object) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  auto const add_byte = [&hash](std::uint64_t byte) { hash = (hash ^ byte) * 0x100000001b3u; };
  auto const add_name = [&](char const* name) {
    for (; *name != '\0'; ++name) add_byte(static_cast<unsigned char>(*name));
    add_byte(0);
  };
  auto const add_value = [&](auto value) {
    std::uint64_t bits;
    if constexpr (std::is_floating_point_v<decltype(value)>) {
      bits = std::bit_cast<std::uint64_t>(static_cast<double>(value) + 0.0);  // -0 becomes 0
    } else {
      bits = static_cast<std::uint64_t>(value);
    }
    for (int shift = 0; shift < 64; shift += 8) add_byte((bits >> shift) & 0xffu);
  };
  add_name(detail::struct_name<T>());
  detail::visit_values(object, nullptr, [&](auto const& path, auto const& entry, auto value) {
    for (auto const* outer = path.outer; outer != nullptr; outer = outer->outer) add_name(outer->name);
    add_name(entry.name);
    add_value(value);
  });
  return hash;
}

}  // namespace cambium
