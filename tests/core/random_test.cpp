#include "cambium/core/random.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <random>
#include <vector>

#include <doctest/doctest.h>

using cambium::philox4x32;
using cambium::PhiloxCounter;
using cambium::RandomStream;

static_assert(std::uniform_random_bit_generator<RandomStream>);
static_assert(philox4x32({0, 0, 0, 0}, {0, 0})[0] == 0x6627e8d5u);

TEST_CASE("Philox4x32-10 gives the published known answers") {
  // Random123 1.14, kat_vectors.
  CHECK(philox4x32({0, 0, 0, 0}, {0, 0}) == PhiloxCounter{0x6627e8d5u, 0xe169c58du, 0xbc57ac4cu, 0x9b00dbd8u});
  std::uint32_t const ones = 0xffffffffu;
  CHECK(philox4x32({ones, ones, ones, ones}, {ones, ones}) ==
        PhiloxCounter{0x408f276du, 0x41c83b0eu, 0xa20bc7c6u, 0x6d5451fdu});
  CHECK(philox4x32({0x243f6a88u, 0x85a308d3u, 0x13198a2eu, 0x03707344u}, {0xa4093822u, 0x299f31d0u}) ==
        PhiloxCounter{0xd16cfe09u, 0x94fdccebu, 0x5001e420u, 0x24126ea1u});
}

TEST_CASE("a stream's values are the Philox blocks of its key") {
  RandomStream stream(0x123456789abcdef0u, 5, 6, 7);
  for (std::uint32_t block = 0; block < 3; ++block) {
    auto const bits = philox4x32({block, 7, 6, 5}, {0x9abcdef0u, 0x12345678u});
    CHECK(stream() == (std::uint64_t{bits[1]} << 32 | bits[0]));
    CHECK(stream() == (std::uint64_t{bits[3]} << 32 | bits[2]));
  }
}

TEST_CASE("a stream begins with the same values on every platform and in every version") {
  RandomStream stream(42, 3, 17, 1);
  std::array<std::uint64_t, 4> const expected{0x997435568792b4e1u, 0xa7738f6a0568699eu, 0xd7d80f73f06b50d8u,
                                              0x1e9a50f3b7aa60b9u};
  for (auto const value : expected) CHECK(stream() == value);
}

TEST_CASE("a copy of a stream continues as the original does") {
  RandomStream stream(1, 2, 3);
  static_cast<void>(stream());
  RandomStream copy = stream;
  for (int i = 0; i < 10; ++i) CHECK(stream() == copy());
}

TEST_CASE("streams that differ in one part of their key have nothing in common") {
  // Agreement of bits between neighbouring streams: binomial with n = 64 * draws, p = 1/2.
  constexpr int draws = 20000;
  auto const agreement = [](RandomStream a, RandomStream b) {
    int equal = 0;
    for (int i = 0; i < draws; ++i) equal += std::popcount(~(a() ^ b()));
    double const n = 64.0 * draws;
    return std::abs(equal - 0.5 * n) / std::sqrt(0.25 * n);  // in standard deviations
  };
  RandomStream const base(7, 11, 13, 2);
  CHECK(agreement(base, base) > 100.0);
  CHECK(agreement(base, RandomStream(8, 11, 13, 2)) < 4.0);
  CHECK(agreement(base, RandomStream(7 + (1ull << 32), 11, 13, 2)) < 4.0);
  CHECK(agreement(base, RandomStream(7, 12, 13, 2)) < 4.0);
  CHECK(agreement(base, RandomStream(7, 11, 14, 2)) < 4.0);
  CHECK(agreement(base, RandomStream(7, 11, 13, 3)) < 4.0);
  CHECK(agreement(base, RandomStream(7, 13, 11, 2)) < 4.0);
}

TEST_CASE("first draws are uniform across agents and steps") {
  // What a world does: one fresh stream for each agent and step. Chi-squared over 256 cells of the first byte.
  std::vector<int> cells(256, 0);
  constexpr int agents = 200, steps = 500;
  for (std::uint32_t agent = 0; agent < agents; ++agent) {
    for (std::uint32_t step = 0; step < steps; ++step) ++cells[RandomStream(99, agent, step)() >> 56];
  }
  double const mean = agents * steps / 256.0;
  double chi_squared = 0.0;
  for (int const count : cells) chi_squared += (count - mean) * (count - mean) / mean;
  CHECK(std::abs(chi_squared - 255.0) < 4.0 * std::sqrt(2.0 * 255.0));
}
