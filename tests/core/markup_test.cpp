#include "cambium/core/markup.hpp"

#include <limits>
#include <string>

#include <doctest/doctest.h>

using namespace cambium;

namespace {

std::string number(double value, int decimals) {
  std::string text;
  detail::append_number(text, value, decimals);
  return text;
}

}  // namespace

TEST_CASE("numbers are rounded, without trailing zeros or a negative zero") {
  CHECK(number(1.25, 3) == "1.25");
  CHECK(number(-0.004, 2) == "0");
  CHECK(number(100.0, 2) == "100");
  CHECK(number(100.0, 0) == "100");
  CHECK(number(-12.345678, 2) == "-12.35");
  CHECK(number(std::numeric_limits<double>::infinity(), 2) == "null");
  CHECK(number(std::numeric_limits<double>::lowest(), 3).size() == 310);
}

TEST_CASE("escaped text keeps UTF-8 and replaces what is none") {
  CHECK(detail::escape_markup("<\xC3\xA4\xE2\x82\xAC\xF0\x9F\x9A\x97>") ==
        "&lt;\xC3\xA4\xE2\x82\xAC\xF0\x9F\x9A\x97&gt;");
  CHECK(detail::escape_markup("a\xC3") == "a\xEF\xBF\xBD");
  CHECK(detail::escape_markup("\x80z\x07") == "\xEF\xBF\xBDz ");
  CHECK(detail::escape_markup("'&\"") == "&#39;&amp;&quot;");
  CHECK(detail::json_string("a\"\\\n\t&</b>") == "\"a\\\"\\\\\\n\\t\\u0026\\u003c/b\\u003e\"");
}
