#pragma once

#include <doctest/doctest.h>

#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "../support/skipped.hpp"
#include "../support/text.hpp"
#include "../viewer/browser.hpp"

/// Runs built example programs as a user does.
namespace program {

namespace fs = std::filesystem;
using support::content_of;
using support::count;
using support::has;
using support::value_of;

struct Run {
  int code = -1;
  std::string out, err;
};

/// The program with these words as its command line.
class Program {
 public:
  explicit Program(std::string const& name) : path_(fs::path(CAMBIUM_EXAMPLES_DIR) / name) {}

  /// False where the examples are not built: then the test counts as skipped.
  [[nodiscard]] bool is_there() const {
    if (fs::exists(path_)) return true;
    support::skip("no example programs: build the examples");
    return false;
  }

  /// Its path, quoted for a shell.
  [[nodiscard]] std::string command() const { return browser::quoted(path_.string()); }

  [[nodiscard]] Run run(std::vector<std::string> const& words) const {
    browser::TemporaryFolder const folder;
    auto const out = folder.file("out"), err = folder.file("err");
    std::string call = command();
    for (auto const& word : words) call += ' ' + browser::quoted(word);
    int const status = std::system((call + " >" + browser::quoted(out) + " 2>" + browser::quoted(err)).c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, content_of(out), content_of(err)};
  }

  /// What it writes to the standard output; it must succeed and complain of nothing.
  std::string output(std::vector<std::string> const& words) const {
    auto const done = run(words);
    CAPTURE(done.err);
    CHECK(done.code == 0);
    CHECK(done.err.empty());
    return done.out;
  }

  /// Wrong words get exit code 2 and one line, which has `sentence`.
  void refuses(std::vector<std::string> const& words, std::string const& sentence) const {
    auto const done = run(words);
    CAPTURE(sentence);
    CAPTURE(done.err);
    CHECK(done.code == 2);
    CHECK(has(done.err, sentence));
    CHECK(done.err.find('\n') + 1 == done.err.size());
  }

 private:
  fs::path path_;
};

}  // namespace program
