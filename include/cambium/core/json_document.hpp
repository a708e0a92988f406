#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#ifdef CAMBIUM_COMPILED_WITHOUT_JSON
#error "cambium::compiled was made without JSON: make nlohmann_json available before cambium (nlohmann-json3-dev)"
#endif

/// JSON texts as trees; `core/json.hpp` reads and writes described structs. Needs nlohmann_json.
namespace cambium::inline v0_1::detail {

/// A value of a JSON document. Integers keep their bits.
struct JsonValue {
  struct Member;
  std::variant<std::monostate, bool, std::int64_t, std::uint64_t, double, std::string, std::vector<JsonValue>,
               std::vector<Member>>
      value;

  template <class T>
  [[nodiscard]] T const* get() const {
    return std::get_if<T>(&value);
  }
  [[nodiscard]] auto const* members() const { return get<std::vector<Member>>(); }
  [[nodiscard]] auto const* items() const { return get<std::vector<JsonValue>>(); }

  /// Whether it is an object or a list with something in it.
  [[nodiscard]] bool has_parts() const;

  /// What it is, for messages: "a number", "null".
  [[nodiscard]] char const* kind() const {
    constexpr char const* names[] = {"null",     "a truth value", "a number", "a number",
                                     "a number", "a text",        "a list",   "an object"};
    return names[value.index()];
  }
};

/// A member of an object. (Not a pair, which asks for a complete `JsonValue` too early.)
struct JsonValue::Member {
  std::string first;
  JsonValue second{};
};

inline bool JsonValue::has_parts() const {
  return (members() != nullptr && !members()->empty()) || (items() != nullptr && !items()->empty());
}

/// Parses a text. Throws `ParameterError` at `where` with line and column if it is no JSON, if objects and lists are
/// nested deeper than 100, or if a key is there twice in one object.
[[nodiscard]] JsonValue parse_json(std::string_view text, std::string const& where);

/// Whether a text is UTF-8, as those of JSON are.
[[nodiscard]] bool is_utf8(std::string const& text);

/// Writes a value on one line, unless `text` would get longer than `most`; returns whether it did.
bool print_flat(JsonValue const& value, std::size_t most, std::string& text);

/// The text of a document, which ends with a line break. What is longer than `width` is broken into lines.
[[nodiscard]] std::string print_json(JsonValue const& document, std::size_t width = 120);

}  // namespace cambium::inline v0_1::detail

#ifndef CAMBIUM_COMPILED
#include "cambium/core/json_document_impl.hpp"
#endif
