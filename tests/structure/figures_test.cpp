#include <doctest/doctest.h>

#include <string>
#include <utility>

#include "../support/text.hpp"

TEST_CASE("the figures on the front page are those of the benches") {
  auto const front = support::content_of(CAMBIUM_SOURCE_DIR "/README.md"),
             bench = support::content_of(CAMBIUM_SOURCE_DIR "/bench/README.md");
  for (auto const& [said, measured] :
       {std::pair("**11 ns** into a world used before, 32 ns into a new one", "| 5 / 11 / 75 ns, 0 allocations |"),
        std::pair("**11 ns** into a world used before, 32 ns into a new one", "| 32 (47) ns, 1 allocation |"),
        std::pair("**57 ns** per agent", "| 57 (58) ns per agent-step, 0 allocations |"),
        std::pair("**247 000 iterations/s** of 10 steps with 5 agents", "| 247 000, 0 allocations |")}) {
    CAPTURE(std::string(said));
    CHECK(support::has(front, said));
    CHECK(support::has(bench, measured));
  }
}
