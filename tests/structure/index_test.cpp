// The index of include/cambium/README.md: which header to include for a type or a concept.
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <string>
#include <vector>

#include "../support/text.hpp"

namespace {

namespace fs = std::filesystem;

fs::path const headers = fs::path(CAMBIUM_SOURCE_DIR) / "include" / "cambium";

/// The types, concepts and aliases that a header declares for users, with their namespace below `cambium`.
std::vector<std::string> names_in(std::string const& text) {
  static std::regex const opens("namespace (?:cambium::inline v0_1)?(?:::)?([a-z_:]*) \\{");
  static std::regex const declares(
      "(?:struct|class|enum class|concept)\\s+(?:\\[\\[\\w+\\]\\] )?([A-Z]\\w*)\\b(?! *;)(?!<).*|using ([A-Z]\\w*) "
      "=.*|using "
      "[a-z]+::([A-Z]\\w*);");
  std::vector<std::string> names, inside;
  for (auto const& line : support::split(text, '\n')) {
    std::smatch found;
    if (std::regex_match(line, found, opens)) inside.push_back(found[1]);
    if (line.starts_with("}  // namespace") && !inside.empty()) inside.pop_back();
    std::string where;
    for (auto const& name : inside) where += name.empty() ? "" : name + "::";
    if (inside.empty() || where.find("detail::") != where.npos || !std::regex_match(line, found, declares)) continue;
    for (std::size_t i = 1; i < found.size(); ++i)
      if (found[i].matched) names.push_back(where + found[i].str());
  }
  return names;
}

}  // namespace

TEST_CASE("the index of include/cambium/README.md names the header of each type and concept") {
  std::map<std::string, std::string> index;  // the first header that declares it, in the order of their names
  for (auto const& entry : fs::recursive_directory_iterator(headers)) {
    auto const header = fs::relative(entry.path(), headers).generic_string();
    if (!header.ends_with(".hpp") || header.ends_with("_impl.hpp") || header.find("detail/") != header.npos) continue;
    for (auto const& name : names_in(support::content_of(entry.path()))) {
      auto const [at, is_new] = index.try_emplace(name, header);
      if (!is_new) at->second = std::min(at->second, header);
    }
  }
  CHECK(index.size() > 300);
  for (auto const* name : {"World", "UrbanDriver", "DynamicModel", "map::LaneCorridor", "geometry::Shape", "Predictor"})
    CHECK_MESSAGE(index.contains(name), std::string(name));
  std::string text =
      "# Index: name to header\n\nFor each type, concept and alias in namespace `cambium` the header to include, as "
      "`<cambium/HEADER>`. `<cambium/ROOM.hpp>` has a\nwhole room, `<cambium/cambium.hpp>` all that needs only Eigen "
      "and "
      "Boost. A test keeps this page up to date.\n\n| name | header |\n|---|---|\n";
  for (auto const& [name, header] : index) text += "| `" + name + "` | [" + header + "](" + header + ") |\n";
  auto const page = headers / "README.md";
  if (text == support::content_of(page)) return;
  auto const now = fs::path(CAMBIUM_BUILD_DIR) / "index.md";
  std::ofstream(now, std::ios::binary) << text;
  FAIL_CHECK("types or headers have changed: cp " << now.string() << " " << page.string());
}
