#pragma once

#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include "cambium/core/ids.hpp"
#include "cambium/core/json_document.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/core/type_info.hpp"

/// Described structs as JSON: parameters, scenarios, scenario sets. Needs nlohmann_json (`cambium::json`).
///
///   `{"idm": {"desired_speed": 14.5}, "patience": 2}`
///
/// An absent field keeps its default, so a file holds only what differs. A choice is written by name; an alternative as
/// `{"its_name": {...}}`, or just `"its_name"` if all its fields have their defaults; infinity as "inf". Numbers are
/// written such that they read back as the same bits.
namespace cambium::inline v0_1 {

/// How much `to_json` writes.
enum class JsonDetail : unsigned char {
  differences,  ///< what differs from the defaults
  everything
};

/// Names lanes in files; without it, files hold their numbers.
class LaneNames {
 public:
  [[nodiscard]] virtual std::string name(LaneId lane) const = 0;
  [[nodiscard]] virtual LaneId lane(std::string_view name) const = 0;

 protected:
  ~LaneNames() = default;
};

namespace detail {

/// A struct as a document.
[[nodiscard]] JsonValue json_value(TypeInfo const& type, void const* object, JsonDetail detail, LaneNames const* lanes);
/// Reads `object`, whose name is `name` in messages.
void read_json_value(JsonValue const& document, TypeInfo const& type, void* object, char const* name,
                     std::string const& where, LaneNames const* lanes);

}  // namespace detail

/// The struct as JSON text. Lines are broken where an object or a list gets longer than 120 characters. Throws
/// `ParameterError` if a `OneOf` holds a struct without a description, or a number is NaN.
template <Described T>
[[nodiscard]] std::string to_json(T const& object, JsonDetail detail = JsonDetail::differences,
                                  LaneNames const* lanes = nullptr) {
  static_assert(std::is_default_constructible_v<T>,
                "cambium::to_json: JSON holds what differs from T{}, which T lacks");
  return detail::print_json(detail::json_value(type_info<T>(), &object, detail, lanes));
}

/// Reads JSON text into `object`; what the text does not say, stays. Throws `ParameterError`, and leaves the object as
/// it is, if the text is no JSON (with line and column), if a key is unknown (with the nearest known one), is there
/// twice, or its value has a wrong type or is out of range (with the full key). `where`: the file, for messages.
/// O(text).
template <Described T>
void read_json(T& object, std::string_view text, std::string const& where = "JSON", LaneNames const* lanes = nullptr) {
  static_assert(std::is_default_constructible_v<T>,
                "cambium::read_json: JSON holds what differs from T{}, which T lacks");
  T read = object;
  detail::read_json_value(detail::parse_json(text, where), type_info<T>(), &read, detail::struct_name<T>(), where,
                          lanes);
  check_parameters(read, where);
  object = std::move(read);
}

/// A struct from JSON text, its defaults where the text says nothing. Throws as `read_json`.
template <Described T>
[[nodiscard]] T from_json(std::string_view text, std::string const& where = "JSON", LaneNames const* lanes = nullptr) {
  T object{};
  read_json(object, text, where, lanes);
  return object;
}

}  // namespace cambium::inline v0_1

#ifndef CAMBIUM_COMPILED
#include "cambium/core/json_impl.hpp"
#endif
