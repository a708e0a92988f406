#pragma once

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>

#include "cambium/core/described.hpp"
#include "cambium/core/detail/parameter_values.hpp"
#include "cambium/core/error.hpp"
#include "cambium/core/ids.hpp"

namespace cambium {

namespace detail {

/// Shortest text that reads back as the same number; enums as their number, the id of nothing as "none".
template <class Value>
[[nodiscard]] std::string number_text(Value value) {
  if constexpr (std::is_same_v<Value, bool>) {
    return value ? "true" : "false";
  } else if constexpr (StrongId<Value>) {
    return to_string(value);
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

/// Whether values of the type have a range.
template <class Value>
inline constexpr bool has_range = !std::is_same_v<Value, bool> && !StrongId<Value>;

template <class Value>
[[nodiscard]] constexpr bool in_range(Value value, Range range) {
  if constexpr (!has_range<Value>) {
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
template <class Value>
void check_relations(Value const& value, ParameterPath const& path, std::string const& where) {
  if constexpr (Described<Value>) {
    for_each_parameter<Value>([&](auto const& entry) {
      check_relations(value.*entry.field, ParameterPath{&path, entry.name}, where);
    });
    if constexpr (requires { value.check(where); }) value.check((where.empty() ? "" : where + ": ") + path.text());
  } else if constexpr (ParameterList<Value>) {
    std::size_t i = 0;
    for (auto const& element : elements_of(value))
      check_relations(element, ParameterPath{path.outer, path.name, i++}, where);
  }
}

}  // namespace detail

/// Throws `ParameterError` unless every field is within its range (NaN never is). The message names `where` (a file, an
/// agent), the struct and key, the value and the range. Then calls the own `check` of the struct and of those in it,
/// where they have one.
template <Described T>
void check_parameters(T const& object, std::string const& where = {}) {
  detail::ParameterPath const root{nullptr, detail::struct_name<T>()};
  detail::visit_values<true>(object, &root, [&where](auto const& path, auto const& entry, auto value) {
    if (!detail::in_range(value, entry.range)) {
      detail::throw_out_of_range(where, path.text(), detail::number_text(value), entry.range, entry.unit);
    }
  });
  detail::check_relations(object, root, where);
}

namespace detail {

template <class Value>
[[nodiscard]] constexpr bool equal_values(Value const& a, Value const& b) {
  if constexpr (Described<Value>) {
    bool equal = true;
    for_each_parameter<Value>(
        [&](auto const& entry) { equal = equal && equal_values(a.*entry.field, b.*entry.field); });
    return equal;
  } else if constexpr (ParameterList<Value>) {
    auto const of_a = elements_of(a), of_b = elements_of(b);
    return std::equal(of_a.begin(), of_a.end(), of_b.begin(), of_b.end(),
                      [](auto const& one, auto const& other) { return equal_values(one, other); });
  } else {
    return a == b;
  }
}

}  // namespace detail

/// True when all fields are equal by `==` (so 0 equals -0, and NaN equals nothing), lists element by element.
template <Described T>
[[nodiscard]] constexpr bool equal_parameters(T const& a, T const& b) {
  return detail::equal_values(a, b);
}

/// The parameters of T as a Markdown table with header: name, default, unit, range, meaning. For a list what each of
/// its elements has.
template <Described T>
[[nodiscard]] std::string describe_parameters() {
  std::string table = "| name | default | unit | range | meaning |\n|---|---|---|---|---|\n";
  detail::visit_values<false>(T{}, nullptr, [&table](auto const& path, auto const& entry, auto value) {
    table += "| " + path.text() + " | " + (path.is_any_element() ? "-" : detail::number_text(value)) + " | " +
             entry.unit + " | " + (detail::has_range<decltype(value)> ? detail::range_text(entry.range) : "-") + " | " +
             entry.sentence + " |\n";
  });
  return table;
}

/// One line for logs: "idm_classic: desired_speed=15 m/s, time_headway=1.5 s". Numbers read back as the same bits.
template <Described T>
[[nodiscard]] std::string to_string(T const& object) {
  std::string line;
  detail::visit_values<true>(object, nullptr, [&line](auto const& path, auto const& entry, auto value) {
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
  detail::visit_values<true>(object, nullptr, [&](auto const& path, auto const& entry, auto value) {
    for (auto const* key = &path; key != nullptr; key = key->outer) {
      if (key != &path) add_name(key->name);
      if (key->element != key->no_list) add_value(key->element);
    }
    add_name(entry.name);
    add_value(value);
  });
  return hash;
}

}  // namespace cambium
