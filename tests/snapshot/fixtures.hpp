#pragma once

#include <array>
#include <cstddef>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <string>

#include <doctest/doctest.h>

#include "../support/error_of.hpp"
#include "cambium/core/random.hpp"
#include "cambium/snapshot.hpp"
#include "support/sealed.hpp"

namespace fixtures {

using support::says;

inline constexpr std::array formats{cambium::SnapshotFormat::binary, cambium::SnapshotFormat::text,
                                    cambium::SnapshotFormat::xml};

inline std::filesystem::path const golden_folder = std::filesystem::path(CAMBIUM_SOURCE_DIR) / "tests/snapshot/golden";

/// Writes golden files of `parts()` in the first formats, if the environment asks for them.
void write_golden(std::string const& name, std::size_t number_of_formats, auto const& parts) {
  if (std::getenv("CAMBIUM_WRITE_GOLDEN") == nullptr) return;
  for (std::size_t i = 0; i < number_of_formats; ++i)
    save_snapshot(golden_folder / (name + std::array{".binary", ".text", ".xml"}[i] + ".snapshot"),
                  {.format = formats[i]}, parts());
}

/// Calls `check(path)` with each golden file whose name begins with `prefix`; returns how many there are.
int for_each_golden(std::string const& prefix, auto const& check) {
  int files = 0;
  for (auto const& entry : std::filesystem::directory_iterator(golden_folder)) {
    if (!entry.path().filename().string().starts_with(prefix)) continue;
    CAPTURE(entry.path());
    check(entry.path().string());
    ++files;
  }
  return files;
}

/// A snapshot with up to three changes behind byte `begin`, and a checksum that fits.
inline std::string changed_archive(std::string bytes, std::size_t begin, cambium::RandomStream& random) {
  for (auto k = 1 + random() % 3; k > 0 && bytes.size() > begin; --k) {
    auto const at = begin + random() % (bytes.size() - begin);
    if (random() % 32 == 0)
      bytes.resize(at);
    else if (random() % 3 == 0)
      bytes.erase(at, 1 + (random() % 8 == 0 ? random() % 64 : 0));
    else
      bytes[at] = static_cast<char>(random() % 2 == 0 ? random() : static_cast<unsigned>('0') + random() % 10);
  }
  return support::sealed_again(bytes);
}

}  // namespace fixtures
