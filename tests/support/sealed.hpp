#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>

namespace support {

[[nodiscard]] inline std::string hex(std::uint64_t number) {
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(number));
  return text;
}

/// The bytes of a snapshot with a right length and checksum again, after their body was changed.
[[nodiscard]] inline std::string sealed_again(std::string const& bytes) {
  auto const second = bytes.find('\n') + 1, third = bytes.find('\n', second) + 1;
  std::string const body = bytes.substr(third);
  std::uint64_t checksum = 0xcbf29ce484222325u ^ body.size();
  for (std::size_t at = 0; at < body.size(); at += 8) {
    std::uint64_t word = 0;
    for (std::size_t k = 0; k < 8 && at + k < body.size(); ++k)
      word |= std::uint64_t{static_cast<unsigned char>(body[at + k])} << (8 * k);
    checksum = (checksum ^ word) * 0x100000001b3u;
  }
  return bytes.substr(0, second) + std::to_string(body.size()) + " " + hex(checksum) + "\n" + body;
}

}  // namespace support
