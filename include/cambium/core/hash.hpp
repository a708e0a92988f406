#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <type_traits>

namespace cambium::inline v0_1::detail {

/// FNV-1a (Fowler, Noll, Vo 1991) of 32 or 64 bits. The same on every platform.
template <class Word>
class Fnv1a {
 public:
  constexpr Fnv1a() = default;
  /// Continues from `start`.
  constexpr explicit Fnv1a(Word start) : hash_(start) {}

  /// Adds a whole word at once: quicker than its bytes, and a change within one word always changes the hash.
  constexpr void add_word(Word word) { hash_ = (hash_ ^ word) * prime; }
  constexpr void add_byte(unsigned char byte) { add_word(byte); }
  /// Adds the bytes of `bits`, the lowest first.
  constexpr void add_bytes(std::uint64_t bits) {
    for (int shift = 0; shift < 64; shift += 8) add_byte(static_cast<unsigned char>(bits >> shift & 0xffu));
  }

  [[nodiscard]] constexpr Word value() const { return hash_; }

 private:
  static_assert(std::is_same_v<Word, std::uint32_t> || std::is_same_v<Word, std::uint64_t>);
  static constexpr Word prime = static_cast<Word>(sizeof(Word) == 4 ? 0x01000193u : 0x100000001b3u);
  Word hash_ = static_cast<Word>(sizeof(Word) == 4 ? 0x811c9dc5u : 0xcbf29ce484222325u);
};

/// `hash` with another word added: for tables and keys, quicker than `Fnv1a`, and each bit of the word reaches the low
/// half of the result. Multiplies by the golden ratio (Knuth 1973, multiplicative hashing).
[[nodiscard]] constexpr std::uint64_t mixed(std::uint64_t hash, std::uint64_t word) {
  hash = (hash ^ word) * 0x9e3779b97f4a7c15u;
  return hash ^ (hash >> 32);
}

/// FNV-1a over words of 8 bytes, the lowest byte first; the last word is filled up by zeros.
[[nodiscard]] inline std::uint64_t checksum_of(std::string_view bytes) {
  Fnv1a<std::uint64_t> hash(Fnv1a<std::uint64_t>().value() ^ bytes.size());
  for (std::size_t at = 0; at < bytes.size(); at += 8) {
    std::array<unsigned char, 8> word{};
    std::memcpy(word.data(), bytes.data() + at, std::min<std::size_t>(8, bytes.size() - at));
    if constexpr (std::endian::native == std::endian::big) std::reverse(word.begin(), word.end());
    hash.add_word(std::bit_cast<std::uint64_t>(word));
  }
  return hash.value();
}

}  // namespace cambium::inline v0_1::detail
