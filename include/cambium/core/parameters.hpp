#pragma once

#include <cstdint>
#include <string>

#include "cambium/core/described.hpp"
#include "cambium/core/detail/parameter_values.hpp"
#include "cambium/core/error.hpp"

namespace cambium {

namespace detail {

/// Shortest text that reads back as the same number.
[[nodiscard]] std::string number_text(double value);

/// The value as text: a number as above, a choice by its name, an id by its number or "none".
[[nodiscard]] std::string value_text(ParameterInfo const& info, ParameterValue const& value);

/// "15 m/s"; no unit for "-" and "".
[[nodiscard]] std::string with_unit(std::string number, char const* unit);

/// The valid values as text: "[0, 70]", "(0, inf)"; the names of a choice.
[[nodiscard]] std::string range_text(ParameterInfo const& info);

// The functions below serve all structs. They do not know the type of `object`; `read` does, and passes its fields to
// a reader, side by side with those of `other` if that is not null.
using ReadStruct = void (*)(void const* object, void const* other, ParameterPath const* own, ListElements lists,
                            ParameterReader& reader);
void check_values(char const* name, void const* object, ReadStruct read, std::string const& where);
[[nodiscard]] std::string parameters_table(void const* object, ReadStruct read);
[[nodiscard]] std::string parameters_line(char const* name, void const* object, ReadStruct read);
[[nodiscard]] std::uint64_t parameters_hash(char const* name, void const* object, ReadStruct read);
[[nodiscard]] bool parameters_equal(void const* a, void const* b, ReadStruct read);

template <Described T>
void read_struct(void const* object, void const* other, ParameterPath const* own, ListElements lists,
                 ParameterReader& reader) {
  read_parameters(*static_cast<T const*>(object), static_cast<T const*>(other), own, lists, reader);
}

}  // namespace detail

/// Throws `ParameterError` unless every field is within its range (NaN never is). The message names `where` (a file, an
/// agent), the struct and key, the value and the range. If the struct or a nested one has a member `check`, calls it
/// after the checks of its fields.
template <Described T>
void check_parameters(T const& object, std::string const& where = {}) {
  detail::check_values(detail::struct_name<T>(), &object, &detail::read_struct<T>, where);
}

/// True when all fields are equal by `==` (so 0 equals -0, and NaN equals nothing), lists element by element.
template <Described T>
[[nodiscard]] bool equal_parameters(T const& a, T const& b) {
  return detail::parameters_equal(&a, &b, &detail::read_struct<T>);
}

/// The parameters of T as a Markdown table with header: name, default, unit, range, meaning. A list is shown by the
/// rows of one element.
template <Described T>
[[nodiscard]] std::string describe_parameters() {
  T const defaults{};
  return detail::parameters_table(&defaults, &detail::read_struct<T>);
}

/// One line for logs: "idm_classic: desired_speed=15 m/s, time_headway=1.5 s". Numbers read back as the same bits.
template <Described T>
[[nodiscard]] std::string to_string(T const& object) {
  return detail::parameters_line(detail::struct_name<T>(), &object, &detail::read_struct<T>);
}

/// Hash of the struct's name, its keys and the bits of its values (FNV-1a, 64 bit). It is the same on every platform
/// and in every run, and changes when a field is renamed. Equal parameters have equal hashes.
template <Described T>
[[nodiscard]] std::uint64_t hash_parameters(T const& object) {
  return detail::parameters_hash(detail::struct_name<T>(), &object, &detail::read_struct<T>);
}

}  // namespace cambium

#ifndef CAMBIUM_COMPILED
#include "cambium/core/parameters_impl.hpp"
#endif
