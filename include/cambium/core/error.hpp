#pragma once

#include <cstddef>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

namespace cambium {

namespace detail {

/// A number for messages: six digits, no trailing zeros.
[[nodiscard]] inline std::string rounded_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

/// `text` with its control characters (ASCII's, and U+0080 to U+009F) spelled as \x1b: words of a file may hold what
/// a terminal would obey.
[[nodiscard]] inline std::string printable(std::string_view text) {
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

}  // namespace detail

/// Root of everything the library throws, and only outside the step path. `what()` reads "where: what; remedy", with
/// control characters spelled out (\x1b).
class Error : public std::runtime_error {
 public:
  /// `where`: file, line, element, key or id; `what`: one clause; `remedy`: what the user can do (may be empty).
  Error(std::string where, std::string const& what, std::string const& remedy = {})
      : std::runtime_error(
            detail::printable((where.empty() ? "" : where + ": ") + what + (remedy.empty() ? "" : "; " + remedy))),
        where_(std::move(where)) {}

  [[nodiscard]] std::string const& where() const { return where_; }

 private:
  std::string where_;
};

/// A parameter is missing, not a number, or outside its range.
struct ParameterError : Error {
  using Error::Error;
};

/// A map cannot be read or built, or a query names something that it does not have.
struct MapError : Error {
  using Error::Error;
};

/// A world was asked for something that it cannot do: an unknown agent, a position off the map, a route that does not
/// exist.
struct WorldError : Error {
  using Error::Error;
};

}  // namespace cambium
