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

/// As above; of a choice its name, of nothing's id "none".
[[nodiscard]] std::string value_text(ParameterInfo const& info, ParameterValue const& value);

/// "15 m/s"; no unit for "-" and "".
[[nodiscard]] std::string with_unit(std::string number, char const* unit);

/// "[0, 70]", "(0, inf)"; the bounds of the open ranges are shown as what they mean; of a choice its names.
[[nodiscard]] std::string range_text(ParameterInfo const& info);

// What is said once of all structs. Each shows its reader the struct that it is given, and a second one if that is not
// null.
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
/// agent), the struct and key, the value and the range. Calls the own `check` of the struct, and of those in it, where
/// they have one, after their fields.
template <Described T>
void check_parameters(T const& object, std::string const& where = {}) {
  detail::check_values(detail::struct_name<T>(), &object, &detail::read_struct<T>, where);
}

/// True when all fields are equal by `==` (so 0 equals -0, and NaN equals nothing), lists element by element.
template <Described T>
[[nodiscard]] bool equal_parameters(T const& a, T const& b) {
  return detail::parameters_equal(&a, &b, &detail::read_struct<T>);
}

/// The parameters of T as a Markdown table with header: name, default, unit, range, meaning. For a list what each of
/// its elements has.
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

/// Hash over the struct's name, its keys and the bits of its values (FNV-1a, 64 bit): the same on every platform and in
/// every run; changes when a field is renamed. Equal parameters have equal hashes.
template <Described T>
[[nodiscard]] std::uint64_t hash_parameters(T const& object) {
  return detail::parameters_hash(detail::struct_name<T>(), &object, &detail::read_struct<T>);
}

}  // namespace cambium

#ifndef CAMBIUM_COMPILED
#include "cambium/core/parameters_impl.hpp"
#endif
