#include "skipped.hpp"

#include <cstdio>
#include <map>
#include <set>

#include <doctest/doctest.h>

namespace support {
namespace {

/// The test cases that were skipped, by reason. At the program's end it prints a line for each reason, which tests/run
/// reads.
struct Skipped {
  std::map<std::string, std::set<void const*>> cases;

  ~Skipped() {
    for (auto const& [reason, skipped] : cases)
      std::printf("[skipped] %zu test cases, in whole or in part: %s\n", skipped.size(), reason.c_str());
  }
};

}  // namespace

void skip(std::string const& reason) {
  static Skipped all;
  MESSAGE("skipped: " << reason);
  if (auto const* running = doctest::getContextOptions()->currentTest) all.cases[reason].insert(running);
}

}  // namespace support
