#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string_view>
#include <system_error>
#include <type_traits>
#include <vector>

/// Words and numbers in texts of users.
namespace cambium::detail {

/// `text` without the `blank` characters at its ends.
[[nodiscard]] constexpr std::string_view trimmed(std::string_view text, std::string_view blank = " \t\r\n") {
  auto const is_blank = [blank](char c) {
    bool found = false;
    for (char const b : blank) found |= b == c;  // for a few characters faster than a search
    return found;
  };
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

/// The parts of `text` between any of the `separators`: one more than there are of those.
[[nodiscard]] inline std::vector<std::string_view> split(std::string_view text, std::string_view separators) {
  std::vector<std::string_view> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    std::size_t const end = std::min(text.find_first_of(separators, begin), text.size());
    parts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

/// Whether a number that is out of the range of doubles is too small for it, not too large. One whose exponent is
/// outweighed by hundreds of digits before it counts by its exponent.
[[nodiscard]] constexpr bool is_underflow(std::string_view number) {
  if (auto const exponent = number.find_first_of("eE"); exponent != number.npos)
    return number.substr(exponent + 1).starts_with('-');
  return number.find_first_not_of("-0") == number.find('.');
}

/// The finite number that the whole of `text`, but for white space at its ends, spells in decimal digits, whatever the
/// locale; a leading '+' is allowed, and what is closer to 0 than any double is 0.
template <class Number>
[[nodiscard]] std::optional<Number> parse_number(std::string_view text) {
  text = trimmed(text);
  if (text.size() > 1 && text.front() == '+' && text[1] != '-') text.remove_prefix(1);
  Number value{};
  auto const [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (end != text.data() + text.size()) return std::nullopt;
  if constexpr (std::is_floating_point_v<Number>) {
    if (error == std::errc::result_out_of_range && is_underflow(text)) return Number{};
    if (!std::isfinite(value)) return std::nullopt;
  }
  if (error != std::errc{}) return std::nullopt;
  return value;
}

}  // namespace cambium::detail
