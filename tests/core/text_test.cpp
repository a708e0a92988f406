#include "cambium/core/text.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <clocale>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <doctest/doctest.h>

#include "cambium/core/random.hpp"

using namespace cambium::detail;

TEST_CASE("white space goes from both ends of a text, and nothing else") {
  CHECK(trimmed(" \t a b\r\n") == "a b");
  CHECK(trimmed(" \n ").empty());
  CHECK(trimmed("\"a\" ", " \"") == "a");
}

TEST_CASE("a text is split at every separator, also where nothing is between") {
  CHECK(split("a,b;;c,", ",;") == std::vector<std::string_view>{"a", "b", "", "c", ""});
  CHECK(split("", ",") == std::vector<std::string_view>{""});
}

TEST_CASE("a number is a number as a whole, in decimal digits, in every locale") {
  char const* const before = std::setlocale(LC_NUMERIC, nullptr);
  std::string const kept = before;
  std::setlocale(LC_NUMERIC, "de_DE.UTF-8");  // where there is one
  for (auto const* text : {"12.5", " 12.5\n", "+12.5", "1.25e1", "012.50"}) {
    CAPTURE(text);
    CHECK(parse_number<double>(text) == 12.5);
  }
  for (auto const* text :
       {"",          " ",     "+",   "-",   "12.5 m", "12,5", "12.5x", "0x10",  "0x1p4", "nan",    "inf",
        "-infinity", "1e999", "+-1", "++1", "- 1",    "1 2",  "1e",    "1.5.2", "1'000", "\u00a01"}) {
    CAPTURE(text);
    CHECK(parse_number<double>(text) == std::nullopt);
  }
  std::setlocale(LC_NUMERIC, kept.c_str());
}

#ifdef __cpp_lib_to_chars
TEST_CASE_TEMPLATE("strtod reads a number as std::from_chars does, in every locale", Number, double, float) {
  std::string const kept = std::setlocale(LC_NUMERIC, nullptr);
  std::setlocale(LC_NUMERIC, "de_DE.UTF-8");  // where there is one
  std::vector<std::string> texts{"",      "-",       ".",       "+1",     " 1",    "0x10",  "-0",   "1e",
                                 "1e+5x", ".5.",     "1,5",     "1e999",  "inf",   "-inf",  "nan",  "-nan",
                                 "in",    "1e-9999", "-1e-999", "5e-324", "1e-45", "1e-40", "2,5.1"};
  cambium::RandomStream bits(7, 0, 0);
  for (int i = 0; i < 2000; ++i) {
    auto const number = std::bit_cast<double>(bits());
    std::array<char, 40> text{};
    std::snprintf(text.data(), text.size(), i % 2 == 0 ? "%.17g" : "%.3f",
                  i % 2 == 0 ? number : std::remainder(number, 1e6));
    texts.emplace_back(text.data());
    std::replace(texts.back().begin(), texts.back().end(), ',', '.');
  }
  for (auto const& text : texts) {
    CAPTURE(text);
    Number a{}, b{};
    auto const wanted = std::from_chars(text.data(), text.data() + text.size(), a);
    auto const found = cambium::detail::from_chars_by_strtod(text.data(), text.data() + text.size(), b);
    CHECK(found.ptr == wanted.ptr);
    CHECK(found.ec == wanted.ec);
    CHECK(std::memcmp(&a, &b, sizeof a) == 0);
  }
  std::setlocale(LC_NUMERIC, kept.c_str());
}
#endif

TEST_CASE("a number ends where its text ends") {
  std::string_view const digits = "12345 ";
  CHECK(parse_number<int>(digits.substr(0, 2)) == 12);
  CHECK(parse_number<double>(digits.substr(1, 3)) == 234.0);
}

TEST_CASE("a number too small for a double is 0, one too large for its type is an error") {
  CHECK(parse_number<double>("-1e-999") == 0.0);
  CHECK(parse_number<double>("0." + std::string(400, '0') + "1") == 0.0);
  CHECK(parse_number<double>(std::string(400, '9')) == std::nullopt);
  CHECK(parse_number<int>("-7") == -7);
  CHECK(parse_number<int>("2147483648") == std::nullopt);
  CHECK(parse_number<int>("7.0") == std::nullopt);
  CHECK(parse_number<unsigned>("-7") == std::nullopt);
  CHECK(parse_number<long long>("9223372036854775807") == std::numeric_limits<long long>::max());
}
