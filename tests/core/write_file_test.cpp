#include "cambium/core/write_file.hpp"

#include <filesystem>
#include <string>

#include <doctest/doctest.h>

#include "../support/skipped.hpp"

using namespace cambium;

TEST_CASE("a file that cannot be written is an error that says why, and what would help") {
  std::filesystem::path const folder(CAMBIUM_BUILD_DIR);
  CHECK_THROWS_WITH_AS(write_file(folder, "text"), doctest::Contains("; name a file, not a folder"), Error);
  CHECK_THROWS_WITH_AS(write_file(folder / "missing" / "file.txt", "text"),
                       doctest::Contains("missing/file.txt: cannot be written (No such file or directory); name a file "
                                         "in a folder that exists"),
                       Error);
  if (!std::filesystem::exists("/dev/full")) return support::skip("no /dev/full here, a disk without room");
  std::string const text(1 << 20, 'x');
  CHECK_THROWS_WITH_AS(write_file("/dev/full", text), doctest::Contains("; make room there, or write elsewhere"),
                       Error);
}
