#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>

/// Numbers and text inside HTML, SVG and JSON.
namespace cambium::inline v0_1::detail {

/// Appends `value` rounded to `decimals` places, without trailing zeros, regardless of the locale. A value that is not
/// finite becomes `null`, "-0" becomes "0".
inline void append_number(std::string& out, double value, int decimals) {
  if (!std::isfinite(value)) {
    out += "null";
    return;
  }
  char buffer[400];  // the largest double has 309 digits before the point
  auto const result = std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::fixed, decimals);
  std::string_view text(buffer, static_cast<std::size_t>(result.ptr - buffer));
  if (text.find('.') != std::string_view::npos) {
    text.remove_suffix(text.size() - 1 - text.find_last_not_of('0'));
    if (text.back() == '.') text.remove_suffix(1);
  }
  out += text == "-0" ? std::string_view("0") : text;
}

/// Number of bytes of the UTF-8 character that `text` begins with; 0 if it begins with none (RFC 3629, except its
/// checks for overlong forms of three and four bytes, which browsers replace themselves).
inline std::size_t utf8_length(std::string_view text) {
  auto const lead = static_cast<unsigned char>(text.front());
  std::size_t const length = lead < 0x80   ? 1
                             : lead < 0xC2 ? 0
                             : lead < 0xE0 ? 2
                             : lead < 0xF0 ? 3
                             : lead < 0xF5 ? 4
                                           : 0;
  if (length > text.size()) return 0;
  for (std::size_t i = 1; i < length; ++i)
    if ((static_cast<unsigned char>(text[i]) & 0xC0U) != 0x80U) return 0;
  return length;
}

/// ASCII characters, and what to write instead.
using Replacements = std::initializer_list<std::pair<char, std::string_view>>;

/// Escapes `text`: makes `replacements`; other control characters become blanks, and bytes that are not UTF-8 become
/// U+FFFD.
[[nodiscard]] inline std::string escape(std::string_view text, Replacements replacements) {
  std::string out;
  out.reserve(text.size());
  while (!text.empty()) {
    std::size_t const length = utf8_length(text);
    char const c = text.front();
    auto const* const found = std::find_if(replacements.begin(), replacements.end(),
                                           [&](auto const& one) { return length == 1 && one.first == c; });
    if (length == 0)
      out += "\xEF\xBF\xBD";
    else if (found != replacements.end())
      out += found->second;
    else if (length == 1 && (static_cast<unsigned char>(c) < 0x20 || c == 0x7F))
      out += ' ';
    else
      out += text.substr(0, length);
    text.remove_prefix(length == 0 ? 1 : length);
  }
  return out;
}

/// `text` escaped for HTML and XML, between tags and in quoted attributes.
[[nodiscard]] inline std::string escape_markup(std::string_view text) {
  return escape(text, {{'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}, {'\'', "&#39;"}});
}

/// `text` as a quoted JSON string that is safe inside a `<script>` element: it contains no `<`, `>` or `&`.
[[nodiscard]] inline std::string json_string(std::string_view text) {
  return '"' +
         escape(text, {{'"', "\\\""},
                       {'\\', "\\\\"},
                       {'\n', "\\n"},
                       {'\t', "\\t"},
                       {'<', "\\u003c"},
                       {'>', "\\u003e"},
                       {'&', "\\u0026"}}) +
         '"';
}

}  // namespace cambium::inline v0_1::detail
