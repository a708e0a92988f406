#include "cambium/core/text.hpp"

#include <clocale>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <doctest/doctest.h>

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
