#pragma once

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <clocale>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <type_traits>
#include <vector>

namespace cambium::inline v0_1 {

/// A hash as in files, databases and messages: 16 hexadecimal digits.
[[nodiscard]] inline std::string hash_text(std::uint64_t hash) {
  std::string text(16, '0');
  for (std::size_t i = 16; i-- > 0; hash >>= 4) text[i] = "0123456789abcdef"[hash & 15u];
  return text;
}

/// `word` for a shell: quoted where it has blanks or signs that a shell would read.
[[nodiscard]] inline std::string shell_word(std::string const& word) {
  constexpr char const* plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./,:=+";
  if (!word.empty() && word.find_first_not_of(plain) == word.npos) return word;
  std::string quoted = "'";
  for (char const c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

}  // namespace cambium::inline v0_1

/// Parsing of words and numbers in user text.
namespace cambium::inline v0_1::detail {

/// `text` without the `blank` characters at its ends.
[[nodiscard]] constexpr std::string_view trimmed(std::string_view text, std::string_view blank = " \t\r\n") {
  auto const is_blank = [blank](char c) {
    bool found = false;
    for (char const b : blank) found |= b == c;  // faster than a search for a few characters
    return found;
  };
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

/// Splits `text` at each character that is one of `separators`. n separators give n + 1 parts, some maybe empty.
[[nodiscard]] inline std::vector<std::string_view> split(std::string_view text, std::string_view separators) {
  std::vector<std::string_view> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    std::size_t const end = std::min(text.find_first_of(separators, begin), text.size());
    parts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

/// The parts, with `between` between each two.
template <class Text>
[[nodiscard]] std::string joined(std::vector<Text> const& parts, std::string_view between) {
  std::string text;
  for (auto const& part : parts) text.append(&part == parts.data() ? "" : between).append(part);
  return text;
}

/// Whether a number outside the range of doubles is too small rather than too large. The sign of the exponent decides,
/// even if hundreds of digits before it outweigh it.
[[nodiscard]] constexpr bool is_underflow(std::string_view number) {
  if (auto const exponent = number.find_first_of("eE"); exponent != number.npos)
    return number.substr(exponent + 1).starts_with('-');
  return number.find_first_not_of("-0") == number.find('.');
}

/// `std::from_chars` for floating point by way of `strtod`. No other thread may call `setlocale`
/// meanwhile, because it decides on the decimal point.
template <class Number>
[[nodiscard]] std::from_chars_result from_chars_by_strtod(char const* begin, char const* end, Number& value) {
  std::string text(begin, end);
  std::size_t const sign = text.starts_with('-') ? 1 : 0;
  constexpr std::string_view firsts = ".0123456789iInN";  // strtod allows blanks and signs, too
  if (text.size() == sign || firsts.find(text[sign]) == firsts.npos) return {begin, std::errc::invalid_argument};
  text.resize(std::min(text.find_first_of("xX"), text.size()));  // no hexadecimal digits
  std::string_view const point = std::localeconv()->decimal_point;
  std::size_t dot = text.npos;
  if (point != ".") {
    text.resize(std::min(text.find(point), text.size()));
    if (dot = text.find('.'); dot != text.npos) text.replace(dot, 1, point);
  }
  char* stop = nullptr;
  errno = 0;
  Number read{};
  if constexpr (std::is_same_v<Number, float>)
    read = std::strtof(text.c_str(), &stop);
  else
    read = std::strtod(text.c_str(), &stop);
  auto length = static_cast<std::size_t>(stop - text.c_str());
  if (length == 0) return {begin, std::errc::invalid_argument};
  if (dot < length) length -= point.size() - 1;
  if (errno == ERANGE && (std::isinf(read) || read == Number{}))
    return {begin + length, std::errc::result_out_of_range};
  value = read;
  return {begin + length, std::errc{}};
}

/// `std::from_chars`, also where the library has only that of integers, as libc++ before 20.
template <class Number>
[[nodiscard]] std::from_chars_result from_chars(char const* begin, char const* end, Number& value) {
  if constexpr (requires { std::from_chars(begin, end, value); })
    return std::from_chars(begin, end, value);
  else
    return from_chars_by_strtod(begin, end, value);
}

/// Parses all of `text` as a finite decimal number, independent of the locale; nothing if it is not one. White space
/// at the ends and a leading '+' are allowed. A number too small for a double becomes 0.
template <class Number>
[[nodiscard]] std::optional<Number> parse_number(std::string_view text) {
  text = trimmed(text);
  if (text.size() > 1 && text.front() == '+' && text[1] != '-') text.remove_prefix(1);
  Number value{};
  auto const [end, error] = detail::from_chars(text.data(), text.data() + text.size(), value);
  if (end != text.data() + text.size()) return std::nullopt;
  if constexpr (std::is_floating_point_v<Number>) {
    if (error == std::errc::result_out_of_range && is_underflow(text)) return Number{};
    if (!std::isfinite(value)) return std::nullopt;
  }
  if (error != std::errc{}) return std::nullopt;
  return value;
}

}  // namespace cambium::inline v0_1::detail
