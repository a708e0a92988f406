#pragma once

#include <cstdio>
#include <string>
#include <string_view>

#include "cambium/core/error.hpp"
#include "cambium/core/macros.hpp"

namespace cambium::inline v0_1 {

namespace detail {

CAMBIUM_COLD std::string rounded_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

CAMBIUM_COLD std::string printable(std::string_view text) {
  constexpr char digits[] = "0123456789abcdef";
  std::string result;
  result.reserve(text.size());
  for (char const c : text) {
    auto const code = static_cast<unsigned char>(c);
    bool const ends_pair = code >= 0x80 && code < 0xA0 && result.ends_with('\xC2');  // U+0080 to U+009F in UTF-8
    bool const is_control = code < 0x20 || code == 0x7F || ends_pair;
    if (ends_pair) result.pop_back();
    if (is_control)
      result += {'\\', 'x', digits[code / 16], digits[code % 16]};
    else
      result += c;
  }
  return result;
}

/// "where: what; remedy", with control characters escaped.
[[nodiscard]] inline std::string error_text(std::string_view where, std::string_view what, std::string_view remedy) {
  std::string text(where);
  if (!where.empty()) text += ": ";
  text += what;
  if (!remedy.empty()) (text += "; ") += remedy;
  return printable(text);
}

}  // namespace detail

CAMBIUM_COLD Error::Error(std::string_view where, std::string_view what, std::string_view remedy)
    : std::runtime_error(detail::error_text(where, what, remedy)), where_(where) {}

}  // namespace cambium::inline v0_1
