#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "../support/text.hpp"
#include "cambium/core/version.hpp"

namespace {

/// Headers by path below include/ ("cambium/core/ids.hpp"), each with what it includes.
using Includes = std::map<std::string, std::vector<std::string>>;

/// The rooms from top to bottom: a header includes its own room and those above. The last ones are no rooms, but
/// headers in front of all.
constexpr std::array rooms = {"core",      "geometry", "map",      "dynamics",   "execution", "behavior",   "observer",
                              "goal",      "world",    "tracking", "evaluation", "planner",   "scenario",   "viewer",
                              "benchmark", "snapshot", "learning", "testing",    "predictor", "c_interface"};
constexpr std::size_t no_room = rooms.size();
/// Families are folders of a room, from top to bottom: a header of a family includes its own family, those above, and
/// the headers that lie in the room itself.
std::map<std::string, std::vector<std::string>> const families{
    {"map", {"road", "opendrive", "lanes", "routing", "corridor", "building", "lanelet"}},
    {"behavior", {"law", "driver", "heed", "lateral", "open_loop", "actions", "wrap", "pedestrian"}},
    {"evaluation", {"metrics", "rules"}},
    {"planner", {"search", "mcts", "frenet", "policy"}},
    {"scenario", {"dataset"}}};
/// Rooms that do without the Boost libraries that are slow to compile, over whatever they include.
constexpr std::array light_rooms = {"dynamics", "execution", "behavior",   "observer",
                                    "goal",     "world",     "evaluation", "planner"};
/// Headers (beginnings of paths) that may include Boost.Geometry and Boost.Graph.
constexpr std::array heavy_headers = {"cambium/geometry/polygon_union", "cambium/geometry/detail/boost_polygon"};
/// Headers (beginnings of paths) of the optional parts, by the library that they need; all others do without it.
std::map<std::string, std::vector<std::string>> const optional_headers{
    {"pugixml.hpp",
     {"cambium/map/opendrive.hpp", "cambium/map/opendrive_impl.hpp", "cambium/map/opendrive/",
      "cambium/scenario/scenario_file.hpp", "cambium/scenario/detail/scenario_maps", "cambium/benchmark",
      "cambium/predictor", "cambium/c_interface_impl.hpp", "cambium/map/lanelet/lanelet2",
      "cambium/map/lanelet/detail/osm_", "cambium/map/lanelet/detail/lanelet_tags",
      "cambium/scenario/dataset/common_road", "cambium/scenario/dataset/detail/common_road"}},
    {"nlohmann/json.hpp",
     {"cambium/core/json", "cambium/scenario/scenario_file.hpp", "cambium/scenario/detail/scenario_maps",
      "cambium/benchmark"}},
    {"sqlite3.h", {"cambium/benchmark"}},
    {"CLI/CLI.hpp", {"cambium/benchmark/benchmark_main", "cambium/benchmark/benchmark_on_ranks"}}};

/// Who makes maps brings what a map itself calls.
bool makes_maps(std::string const& header) { return header == "cambium/map/building/build_map.hpp"; }

/// The word after cambium/: "map" of both cambium/map.hpp and cambium/map/lanes/lane.hpp, "predictor" of its
/// definitions.
std::string room_name(std::string const& header) {
  auto const begin = header.find('/') + 1;
  auto const name = header.substr(begin, header.find_first_of("/.", begin) - begin);
  return name.substr(0, name.find("_impl"));
}

/// Position in `rooms`, or `no_room`.
std::size_t room_of(std::string const& header) {
  return static_cast<std::size_t>(std::find(rooms.begin(), rooms.end(), room_name(header)) - rooms.begin());
}

/// The folder of `header` below its room, "detail" included; empty where it lies in the room itself.
std::string folder_of(std::string const& header) {
  auto const room_end = header.find('/', header.find('/') + 1);
  auto const folder_end = room_end == std::string::npos ? room_end : header.find('/', room_end + 1);
  return folder_end == std::string::npos ? "" : header.substr(room_end + 1, folder_end - room_end - 1);
}

bool is_heavy_library(std::string_view include) {
  return include.starts_with("boost/geometry") || include.starts_with("boost/graph");
}

template <class Range>
bool begins_with_any(std::string const& text, Range const& beginnings) {
  return std::any_of(beginnings.begin(), beginnings.end(), [&](auto const& b) { return text.starts_with(b); });
}

/// The header that defines what `header` declares, where there is one.
std::string definitions_of(std::string const& header) {
  return header.substr(0, header.size() - std::string(".hpp").size()) + "_impl.hpp";
}

/// All that `header` includes, directly or not; `cold`: with the definitions that end headers.
std::set<std::string> reach(Includes const& includes, std::string const& header, bool cold = true) {
  std::set<std::string> seen;
  std::vector<std::string> open{header};
  while (!open.empty()) {
    auto const found = includes.find(open.back());
    open.pop_back();
    if (found == includes.end()) continue;
    for (auto const& next : found->second) {
      if (!cold && next == definitions_of(found->first)) continue;
      if (seen.insert(next).second) open.push_back(next);
    }
  }
  return seen;
}

void check_rooms(Includes const& includes, std::string const& header, std::vector<std::string>& breaches) {
  if (header == "cambium/cambium.hpp") return;
  if (room_of(header) == no_room) breaches.push_back(header + " is in no room of the list");
  for (auto const& include : includes.at(header)) {
    if (!include.starts_with("cambium/") || include == "cambium/cambium.h") continue;
    if (!includes.contains(include)) breaches.push_back(header + " includes " + include + ", which does not exist");
    if (room_of(include) > room_of(header)) breaches.push_back(header + " looks down: " + include);
  }
}

void check_families(Includes const& includes, std::string const& header, std::vector<std::string>& breaches) {
  auto const known = families.find(room_name(header));
  auto const place = [&](std::string const& folder) {
    if (known == families.end()) return std::ptrdiff_t{-1};
    auto const at = std::find(known->second.begin(), known->second.end(), folder);
    return at == known->second.end() ? -1 : at - known->second.begin();
  };
  auto const family = folder_of(header);
  if (!family.empty() && family != "detail" && place(family) < 0)
    breaches.push_back(header + " is in no family of its room");
  for (auto const& include : includes.at(header)) {
    if (!include.starts_with("cambium/")) continue;
    if (place(family) >= 0 && room_name(include) == room_name(header) && place(folder_of(include)) > place(family))
      breaches.push_back(header + " looks down in its room: " + include);
    auto const hidden = include.find("/detail/");
    if (hidden == std::string::npos || header.starts_with(include.substr(0, hidden + 1))) continue;
    bool const of_the_room = folder_of(header).empty() && room_name(header) == room_name(include);
    if (!of_the_room) breaches.push_back(header + " looks into the detail of others: " + include);
  }
}

void check_weight(Includes const& includes, std::string const& header, std::vector<std::string>& breaches) {
  auto const& direct = includes.at(header);
  if (std::any_of(direct.begin(), direct.end(), is_heavy_library) && !begins_with_any(header, heavy_headers)) {
    breaches.push_back(header + " includes Boost.Geometry or Boost.Graph itself");
  }
  auto const all = reach(includes, header);
  if (reach(includes, header, false).contains(header)) breaches.push_back(header + " includes itself in the end");
  for (auto const& include : direct)
    if (include.ends_with("_impl.hpp") && include != definitions_of(header) && !makes_maps(header))
      breaches.push_back(header + " includes the definitions " + include + " of another header");
  auto const name = room_name(header);
  bool const light = std::find(light_rooms.begin(), light_rooms.end(), name) != light_rooms.end();
  auto const heavy = std::find_if(all.begin(), all.end(), is_heavy_library);
  if (light && heavy != all.end()) breaches.push_back(header + " drags in " + *heavy);
  for (auto const& [library, users] : optional_headers)
    if (all.contains(library) && !begins_with_any(header, users)) breaches.push_back(header + " drags in " + library);
}

std::vector<std::string> find_breaches(Includes const& includes) {
  std::vector<std::string> breaches;
  for (auto const& entry : includes) {
    check_rooms(includes, entry.first, breaches);
    check_families(includes, entry.first, breaches);
    check_weight(includes, entry.first, breaches);
  }
  return breaches;
}

/// The path in `#include <path>` or `#include "path"`, else empty.
std::string include_of(std::string_view line) {
  auto const skip_blanks = [&] { line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size())); };
  for (std::string_view const token : {"#", "include"}) {
    skip_blanks();
    if (!line.starts_with(token)) return {};
    line.remove_prefix(token.size());
  }
  skip_blanks();
  if (!line.starts_with('<') && !line.starts_with('"')) return {};
  line.remove_prefix(1);
  return std::string(line.substr(0, line.find_first_of(">\"")));
}

Includes read_includes(std::filesystem::path const& folder) {
  Includes includes;
  for (auto const& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.path().extension() != ".hpp") continue;
    auto& found = includes[std::filesystem::relative(entry.path(), folder).generic_string()];
    for (auto const& line : support::split(support::content_of(entry.path()), '\n'))
      if (auto include = include_of(line); !include.empty()) found.push_back(std::move(include));
  }
  return includes;
}

}  // namespace

TEST_CASE("rooms include only upward, and the rooms of a step stay free of heavy libraries") {
  auto const includes = read_includes(std::filesystem::path(CAMBIUM_SOURCE_DIR) / "include");
  CHECK(includes.contains("cambium/core/ids.hpp"));
  for (auto const& breach : find_breaches(includes)) FAIL_CHECK(breach);
}

TEST_CASE("all that headers declare is in the inline namespace of their version") {
  std::string const version =
      "inline v" + std::to_string(CAMBIUM_VERSION_MAJOR) + "_" + std::to_string(CAMBIUM_VERSION_MINOR);
  int read = 0;
  for (auto const& entry :
       std::filesystem::recursive_directory_iterator(std::filesystem::path(CAMBIUM_SOURCE_DIR) / "include")) {
    if (entry.path().extension() != ".hpp") continue;
    CAPTURE(entry.path().string());
    std::istringstream lines(support::content_of(entry.path()));
    for (std::string line; std::getline(lines, line);) {
      if (!line.starts_with("namespace cambium")) continue;
      CHECK(line.starts_with("namespace cambium::" + version));
      ++read;
    }
  }
  CHECK(read > 400);
}

TEST_CASE("a step dispatches its calls for each agent without std::visit, its table of functions and its exception") {
  int read = 0;
  for (std::string const room : {"dynamics", "execution", "observer"})
    for (auto const& entry : std::filesystem::recursive_directory_iterator(std::filesystem::path(CAMBIUM_SOURCE_DIR) /
                                                                           "include" / "cambium" / room)) {
      if (!entry.is_regular_file()) continue;
      CAPTURE(entry.path().string());
      CHECK_FALSE(support::has(support::content_of(entry.path()), "std::visit("));
      ++read;
    }
  CHECK(read > 20);
}

TEST_CASE("an include is read in every way to write it") {
  CHECK(include_of("#include <cambium/map/lanes/lane.hpp>") == "cambium/map/lanes/lane.hpp");
  CHECK(include_of("  #  include \"a.hpp\"  // why") == "a.hpp");
  CHECK(include_of("// #include <vector>").empty());
  CHECK(include_of("#define x").empty());
  CHECK(include_of("").empty());
}

TEST_CASE("the walk finds each kind of breach") {
  auto const only_breach = [](Includes const& includes) {
    auto const breaches = find_breaches(includes);
    REQUIRE(breaches.size() == 1);
    return breaches.front();
  };
  Includes const good{{"cambium/core/ids.hpp", {"vector"}}, {"cambium/map.hpp", {"cambium/core/ids.hpp"}}};
  CHECK(find_breaches(good).empty());
  CHECK(only_breach({{"cambium/core/a.hpp", {"cambium/map.hpp"}}, {"cambium/map.hpp", {}}}) ==
        "cambium/core/a.hpp looks down: cambium/map.hpp");
  CHECK(only_breach({{"cambium/core/a.hpp", {"cambium/core/b.hpp"}}}) ==
        "cambium/core/a.hpp includes cambium/core/b.hpp, which does not exist");
  CHECK(only_breach({{"cambium/cellar/a.hpp", {}}}) == "cambium/cellar/a.hpp is in no room of the list");
  CHECK(only_breach({{"cambium/map/attic/a.hpp", {}}}) == "cambium/map/attic/a.hpp is in no family of its room");
  CHECK(
      only_breach({{"cambium/map/lanes/a.hpp", {"cambium/map/building/b.hpp"}}, {"cambium/map/building/b.hpp", {}}}) ==
      "cambium/map/lanes/a.hpp looks down in its room: cambium/map/building/b.hpp");
  CHECK(only_breach({{"cambium/map/building/a.hpp", {"cambium/map/lanes/detail/b.hpp"}},
                     {"cambium/map/lanes/detail/b.hpp", {}}}) ==
        "cambium/map/building/a.hpp looks into the detail of others: cambium/map/lanes/detail/b.hpp");
  CHECK(only_breach({{"cambium/world/a.hpp", {"cambium/map/detail/b.hpp"}}, {"cambium/map/detail/b.hpp", {}}}) ==
        "cambium/world/a.hpp looks into the detail of others: cambium/map/detail/b.hpp");
  CHECK(find_breaches({{"cambium/map/map.hpp", {"cambium/map/lanes/detail/b.hpp"}},
                       {"cambium/map/building/a.hpp", {"cambium/map/map.hpp", "cambium/map/detail/c.hpp"}},
                       {"cambium/map/detail/c.hpp", {}},
                       {"cambium/map/lanes/detail/b.hpp", {}}})
            .empty());
  CHECK(only_breach({{"cambium/map/map.hpp", {"boost/graph/astar_search.hpp"}}}) ==
        "cambium/map/map.hpp includes Boost.Geometry or Boost.Graph itself");
  CHECK(only_breach({{"cambium/geometry/polygon_union.hpp", {"boost/geometry/algorithms/union.hpp"}},
                     {"cambium/map/map.hpp", {"cambium/geometry/polygon_union.hpp"}},
                     {"cambium/world/world.hpp", {"cambium/map/map.hpp"}}}) ==
        "cambium/world/world.hpp drags in boost/geometry/algorithms/union.hpp");
  CHECK(only_breach({{"cambium/core/a.hpp", {"cambium/core/a.hpp"}}}) ==
        "cambium/core/a.hpp includes itself in the end");
  CHECK(find_breaches(
            {{"cambium/core/a.hpp", {"cambium/core/a_impl.hpp"}}, {"cambium/core/a_impl.hpp", {"cambium/core/a.hpp"}}})
            .empty());
  CHECK(only_breach({{"cambium/core/a_impl.hpp", {}}, {"cambium/core/b.hpp", {"cambium/core/a_impl.hpp"}}}) ==
        "cambium/core/b.hpp includes the definitions cambium/core/a_impl.hpp of another header");
  CHECK(only_breach({{"cambium/cambium.hpp", {"cambium/map/opendrive.hpp"}},
                     {"cambium/map/opendrive.hpp", {"pugixml.hpp"}}}) == "cambium/cambium.hpp drags in pugixml.hpp");
}
