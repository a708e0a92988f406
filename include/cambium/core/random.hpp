#pragma once

#include <array>
#include <cstdint>

namespace cambium {

using PhiloxCounter = std::array<std::uint32_t, 4>;
using PhiloxKey = std::array<std::uint32_t, 2>;

/// Philox4x32 with 10 rounds (Salmon, Moraes, Dror, Shaw 2011, "Parallel random numbers: as easy as 1, 2, 3"): 128
/// random bits as a pure function of a counter and a key. Passes BigCrush; nothing to seed, warm up or carry along.
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

/// Random bits that belong to (seed, agent, step): made where they are needed, at no cost until the first draw, and the
/// same whatever was drawn elsewhere, on any thread, after any copy. Different keys give independent streams. `purpose`
/// separates uses within one agent and step (a behaviour, an observer, a generator), so that one that draws more does
/// not shift another. A `std::uniform_random_bit_generator` of 64 bits; a stream repeats after 2^33 draws. For use with
/// the library's own distributions: those of the standard library differ between platforms.
class RandomStream {
 public:
  using result_type = std::uint64_t;

  constexpr RandomStream(std::uint64_t seed, std::uint32_t agent, std::uint32_t step, std::uint32_t purpose = 0)
      : counter_{0, purpose, step, agent},
        key_{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)} {}

  [[nodiscard]] static constexpr result_type min() { return 0; }
  [[nodiscard]] static constexpr result_type max() { return ~result_type{0}; }

  /// The step that the numbers belong to.
  [[nodiscard]] constexpr std::uint32_t step() const { return counter_[2]; }

  /// The stream of the same owner and purpose that belongs to `step`.
  [[nodiscard]] constexpr RandomStream at_step(std::uint32_t step) const {
    RandomStream other = *this;
    other.counter_ = {0, counter_[1], step, counter_[3]};
    other.has_spare_ = false;
    return other;
  }

  /// Part `number` of this stream, below 256: for models made of several, each with numbers of its own. 2^25 draws.
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

 private:
  PhiloxCounter counter_;
  PhiloxKey key_;
  std::uint64_t spare_ = 0;
  bool has_spare_ = false;
};

}  // namespace cambium
