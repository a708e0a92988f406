// What the sampled examples print and write, and what all examples say of a wrong command line.
#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

#include "../../examples/common/wilson.hpp"
#include "../support/corpus.hpp"
#include "program.hpp"

using program::content_of;
using program::Program;

TEST_CASE("Wilson's intervals are those of the literature") {
  // Newcombe 1998 (table I, method 3): 81 of 263, 15 of 148, 0 of 20, 1 of 29.
  struct Row {
    unsigned count, n;
    double low, high;
  };
  for (auto const& [count, n, low, high] :
       {Row{81, 263, 0.2553, 0.3662}, Row{15, 148, 0.0624, 0.1605}, Row{0, 20, 0.0, 0.1611}, Row{1, 29, 0.0061, 0.1718}}) {
    auto const interval = examples::wilson(count, n);
    CHECK(std::abs(interval.low - low) < 1e-4);
    CHECK(std::abs(interval.high - high) < 1e-4);
  }
  CHECK(examples::wilson(20, 20).high == 1.0);
}

TEST_CASE("the table counts scenarios and gives intervals, and says how to give them more time") {
  Program const program("merging");
  if (!program.is_there()) return;
  browser::TemporaryFolder const folder;
  auto const run = program.run({"--scenarios", "8", "--steps", "5", "--out", folder.path().string()});
  REQUIRE(run.code == 0);
  CHECK(run.out.find("success        0 of 8    0.0 % (0.0-32.4)") != std::string::npos);
  CHECK(run.out.find("time-out       8 of 8  100.0 % (67.6-100.0)") != std::string::npos);
  CHECK(run.out.find("8 scenarios ended by the limit of 5 steps (1 s); --steps raises it") != std::string::npos);
  CHECK(program.run({"--help"}).out.find("[200]") != std::string::npos);
}
