#include "skipped.hpp"

#include <cstdio>
#include <map>
#include <set>

#include <doctest/doctest.h>

namespace support {
namespace {

/// What is running, and what was skipped: by reason, as often as test cases gave it.
struct Skipped {
  doctest::TestCaseData const* running = nullptr;
  std::map<std::string, std::set<doctest::TestCaseData const*>> cases;
};

Skipped& skipped() {
  static Skipped all;
  return all;
}

/// Prints a line for each reason, which tests/run reads.
struct SkippedReporter : doctest::IReporter {
  explicit SkippedReporter(doctest::ContextOptions const&) {}

  void test_case_start(doctest::TestCaseData const& test_case) override { skipped().running = &test_case; }
  void test_case_end(doctest::CurrentTestCaseStats const&) override { skipped().running = nullptr; }
  void test_run_end(doctest::TestRunStats const&) override {
    for (auto const& [reason, cases] : skipped().cases)
      std::printf("[skipped] %zu test cases, in whole or in part: %s\n", cases.size(), reason.c_str());
    std::fflush(stdout);
  }

  void report_query(doctest::QueryData const&) override {}
  void test_run_start() override {}
  void test_case_reenter(doctest::TestCaseData const&) override {}
  void test_case_exception(doctest::TestCaseException const&) override {}
  void subcase_start(doctest::SubcaseSignature const&) override {}
  void subcase_end() override {}
  void log_assert(doctest::AssertData const&) override {}
  void log_message(doctest::MessageData const&) override {}
  void test_case_skipped(doctest::TestCaseData const&) override {}
};
REGISTER_LISTENER("skipped", 1, SkippedReporter);

}  // namespace

void skip(std::string const& reason) {
  MESSAGE("skipped: " << reason);
  if (skipped().running != nullptr) skipped().cases[reason].insert(skipped().running);
}

}  // namespace support
