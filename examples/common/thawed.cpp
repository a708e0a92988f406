#include "thawed_world.hpp"

#include "cambium/core/json.hpp"

void examples::read_edit(cb::TypeInfo const& type, void* object, std::string const& json) {
  cb::detail::read_json_value(cb::detail::parse_json(json, "the ego"), type, object, type.name, "the ego", nullptr);
}

std::string examples::difference(cb::TypeInfo const& type, void const* object) {
  return cb::detail::print_json(cb::detail::json_value(type, object, cb::JsonDetail::differences, nullptr));
}

void examples::require_json(std::string const& text, std::string const& where) {
  try {
    static_cast<void>(cb::detail::parse_json(text, where));
  } catch (cb::Error const&) {
    throw cb::ParameterError(where, "has no value of JSON",
                             "write a number (to 1e308), a word, true, false, or a list: [1, 2]");
  }
}
