#pragma once

#include <doctest/doctest.h>

#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "../support/skipped.hpp"
#include "../viewer/browser.hpp"

/// Runs built example programs as a user does.
namespace program {

namespace fs = std::filesystem;

inline std::string content_of(fs::path const& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

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

  [[nodiscard]] Run run(std::vector<std::string> const& words) const {
    browser::TemporaryFolder const folder;
    auto const out = folder.path() / "out", err = folder.path() / "err";
    std::string command = browser::quoted(path_.string());
    for (auto const& word : words) command += ' ' + browser::quoted(word);
    int const status =
        std::system((command + " >" + browser::quoted(out.string()) + " 2>" + browser::quoted(err.string())).c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, content_of(out), content_of(err)};
  }

 private:
  fs::path path_;
};

}  // namespace program
