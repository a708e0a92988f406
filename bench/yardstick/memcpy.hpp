#pragma once

#include <cstddef>
#include <cstring>
#include <vector>

// Yardstick of copies: a world that were one flat buffer, copied hot to hot.

namespace yardstick {

inline constexpr std::size_t bytes_per_agent = 256;

/// A source and a target of `agents` times `bytes_per_agent` bytes.
class FlatCopy {
 public:
  explicit FlatCopy(std::size_t agents)
      : source_(agents * bytes_per_agent, std::byte{1}), target_(agents * bytes_per_agent, std::byte{0}) {}

  /// One memcpy of the whole buffer. O(agents).
  void copy() { std::memcpy(target_.data(), source_.data(), source_.size()); }

  [[nodiscard]] std::byte* source() { return source_.data(); }
  [[nodiscard]] std::byte* target() { return target_.data(); }

 private:
  std::vector<std::byte> source_;
  std::vector<std::byte> target_;
};

}  // namespace yardstick
