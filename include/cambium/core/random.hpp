#pragma once

#include <array>
#include <cstdint>

#include "cambium/core/described.hpp"

namespace cambium::inline v0_1 {

/// Counter of `philox4x32`.
using PhiloxCounter = std::array<std::uint32_t, 4>;
/// Key of `philox4x32`.
using PhiloxKey = std::array<std::uint32_t, 2>;

/// Philox4x32 with 10 rounds (Salmon, Moraes, Dror, Shaw 2011, "Parallel random numbers: as easy as 1, 2, 3"): 128
/// random bits as a pure function of a counter and a key. Passes BigCrush; needs no seeding, warm-up or stored state.
[[nodiscard]] constexpr PhiloxCounter philox4x32(PhiloxCounter counter, PhiloxKey key) {
  constexpr int rounds = 10;
  for (int round = 0; round < rounds; ++round) {
    std::uint64_t const product_0 = std::uint64_t{0xD2511F53u} * counter[0];
    std::uint64_t const product_1 = std::uint64_t{0xCD9E8D57u} * counter[2];
    counter = {static_cast<std::uint32_t>(product_1 >> 32) ^ counter[1] ^ key[0], static_cast<std::uint32_t>(product_1),
               static_cast<std::uint32_t>(product_0 >> 32) ^ counter[3] ^ key[1],
               static_cast<std::uint32_t>(product_0)};
    key[0] += 0x9E3779B9u;  // golden ratio
    key[1] += 0xBB67AE85u;  // sqrt(3) - 1
  }
  return counter;
}

/// A stream of random bits keyed by (seed, agent, step, purpose). Its bits depend on nothing else: not on other draws,
/// threads or copies. Different keys give independent streams. `purpose` separates uses within one agent and step (a
/// behaviour, an observer, a generator), so that extra draws in one do not shift another. Making a stream costs nothing
/// until the first draw. Models `std::uniform_random_bit_generator` with 64 bits; repeats after 2^33 draws. Use it with
/// the library's own distributions: those of the standard library differ between platforms.
class RandomStream {
 public:
  using result_type = std::uint64_t;

  /// The stream of this key, at its first draw.
  constexpr RandomStream(std::uint64_t seed, std::uint32_t agent, std::uint32_t step, std::uint32_t purpose = 0)
      : counter_{0, purpose, step, agent},
        key_{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)} {}

  [[nodiscard]] static constexpr result_type min() { return 0; }
  [[nodiscard]] static constexpr result_type max() { return ~result_type{0}; }

  /// The step of the key.
  [[nodiscard]] constexpr std::uint32_t step() const { return counter_[2]; }

  /// The stream with the same seed, agent and purpose for another step, from its beginning.
  [[nodiscard]] constexpr RandomStream at_step(std::uint32_t step) const {
    RandomStream other = *this;
    other.counter_ = {0, counter_[1], step, counter_[3]};
    other.has_spare_ = false;
    return other;
  }

  /// Substream `number` (below 256) of this stream, good for 2^25 draws. Gives each part of a composite model its own
  /// numbers.
  [[nodiscard]] constexpr RandomStream part(std::uint32_t number) const {
    RandomStream other = *this;
    other.counter_[0] += number << 24;
    other.has_spare_ = false;
    return other;
  }

  /// The next 64 bits.
  constexpr result_type operator()() {
    if (has_spare_) {
      has_spare_ = false;
      return spare_;
    }
    PhiloxCounter const bits = philox4x32(counter_, key_);
    ++counter_[0];
    spare_ = std::uint64_t{bits[3]} << 32 | bits[2];
    has_spare_ = true;
    return std::uint64_t{bits[1]} << 32 | bits[0];
  }

  static constexpr char const* name = "random_stream";
  /// For snapshots: a restored stream goes on where it was.
  static constexpr auto parameters() {
    using P = RandomStream;
    constexpr Range whole{0, 4294967295.0};
    return parameter_list(parameter("counter", &P::counter_, "-", whole, "of the next bits"),
                          parameter("key", &P::key_, "-", whole, "halves of the seed"),
                          parameter("spare", &P::spare_, "-", Range{0, 1.9e19}, "drawn, but not given yet"),
                          parameter("has_spare", &P::has_spare_, "whether there is such"));
  }

 private:
  PhiloxCounter counter_;
  PhiloxKey key_;
  std::uint64_t spare_ = 0;
  bool has_spare_ = false;
};

}  // namespace cambium::inline v0_1
