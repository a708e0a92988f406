#include "thawed_world.hpp"

#include "cambium/core/json.hpp"

void examples::read_edit(char const* name, void* object, void const* usual, cb::detail::TransferStruct transfer,
                         std::string const& json) {
  cb::detail::read_json_value(cb::detail::parse_json(json, "the ego"), name, object, usual, transfer, "the ego",
                              nullptr);
}

std::string examples::difference(void* object, void const* usual, cb::detail::TransferStruct transfer) {
  return cb::detail::print_json(cb::detail::json_value(object, usual, transfer, cb::JsonDetail::differences, nullptr));
}

void examples::require_json(std::string const& text, std::string const& where) {
  try {
    static_cast<void>(cb::detail::parse_json(text, where));
  } catch (cb::Error const&) {
    throw cb::ParameterError(where, "has no value of JSON",
                             "write a number (to 1e308), a word, true, false, or a list: [1, 2]");
  }
}
