#include "cambium/core/error.hpp"

#include <string>

#include <doctest/doctest.h>

using namespace cambium;

TEST_CASE("an error says where, what and what to do, without stray punctuation") {
  MapError const error("merging.xodr:12", "lane -1 has no width", "add a <width> element");
  CHECK(std::string(error.what()) == "merging.xodr:12: lane -1 has no width; add a <width> element");
  CHECK(error.where() == "merging.xodr:12");
  CHECK(std::string(Error("", "it failed").what()) == "it failed");
  CHECK(std::string(Error("here", "it failed").what()) == "here: it failed");
}

TEST_CASE("every kind of error is caught as an Error") {
  CHECK_THROWS_AS(throw ParameterError("key", "is wrong"), Error);
  CHECK_THROWS_AS(throw MapError("file", "is wrong"), Error);
  CHECK_THROWS_AS(throw WorldError("agent 3", "is wrong"), Error);
}

TEST_CASE("control characters of a file reach nobody's terminal in a message") {
  Error const error("road \x1b[2J", "line\nbreak\x7f, \xC2\x9B", "ask for \xC3\x9F");
  CHECK(std::string(error.what()) == R"(road \x1b[2J: line\x0abreak\x7f, \x9b; ask for )"
                                     "\xC3\x9F");
  CHECK(error.where() == "road \x1b[2J");
}
