#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "../support/text.hpp"

namespace {

namespace fs = std::filesystem;

fs::path const headers = fs::path(CAMBIUM_SOURCE_DIR) / "include" / "cambium";

/// The lines of a header.
std::set<std::string> lines_of(fs::path const& file) {
  auto const lines = support::split(support::content_of(file), '\n');
  return {lines.begin(), lines.end()};
}

std::vector<std::string> rooms() {
  std::vector<std::string> names;
  for (auto const& entry : fs::directory_iterator(headers))
    if (entry.is_directory()) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

/// Headers that stay out of the umbrellas: they need CLI11, pugixml, Eigen or POSIX, are for those who read, check or
/// write maps and files or watch traffic rules, or only declare what other headers define.
bool needs_more(std::string const& header) {
  std::set<std::string> const apart{"benchmark/benchmark_main.hpp",
                                    "benchmark/benchmark_traffic.hpp",
                                    "benchmark/benchmark_on_ranks.hpp",
                                    "benchmark/run_on_processes.hpp",
                                    "benchmark/run_on_ranks.hpp",
                                    "core/binary.hpp",
                                    "core/hash.hpp",
                                    "core/json.hpp",
                                    "core/json_document.hpp",
                                    "core/nearest_names.hpp",
                                    "core/markup.hpp",
                                    "core/read_file.hpp",
                                    "core/stable_sort.hpp",
                                    "core/state_vector.hpp",
                                    "core/text.hpp",
                                    "core/write_file.hpp",
                                    "geometry/polygon_union.hpp",
                                    "map/content_hash.hpp",
                                    "map/corridor/road_area.hpp",
                                    "map/fwd.hpp",
                                    "map/lanes/lane_network.hpp",
                                    "map/lanes/signal_codes.hpp",
                                    "map/lanes/overlaps.hpp",
                                    "map/opendrive.hpp",
                                    "map/road/curve_layout.hpp",
                                    "map/road/road_surface.hpp",
                                    "scenario/highway_site.hpp",
                                    "scenario/junction_site.hpp",
                                    "scenario/lane_flow.hpp",
                                    "scenario/traffic_population.hpp",
                                    "scenario/merging_site.hpp",
                                    "scenario/recipe.hpp",
                                    "scenario/ring_road.hpp",
                                    "scenario/scenario_file.hpp",
                                    "scenario/scenario_set.hpp",
                                    "scenario/traffic_inflow.hpp"};
  return apart.contains(header) || header.starts_with("map/building/") || header.starts_with("map/opendrive/") ||
         header.starts_with("map/lanelet/") || header.starts_with("scenario/dataset/") ||
         header.starts_with("evaluation/rules") || header.ends_with("_impl.hpp");
}

}  // namespace

TEST_CASE("every room has an umbrella header that gathers all of its headers but those of building maps") {
  CHECK(rooms().size() >= 12);
  for (auto const& room : rooms()) {
    CAPTURE(room);
    REQUIRE(fs::exists(headers / (room + ".hpp")));
    auto const lines = lines_of(headers / (room + ".hpp"));
    for (auto const& entry : fs::recursive_directory_iterator(headers / room)) {
      auto const header = fs::relative(entry.path(), headers).generic_string();
      if (entry.path().extension() != ".hpp" || header.find("/detail/") != std::string::npos) continue;
      CAPTURE(header);
      CHECK(lines.contains("#include \"cambium/" + header + "\"") == !needs_more(header));
    }
  }
}

TEST_CASE("evaluation/rules.hpp gathers what watches traffic rules") {
  auto const lines = lines_of(headers / "evaluation" / "rules.hpp");
  for (auto const& entry : fs::directory_iterator(headers / "evaluation" / "rules")) {
    auto const header = fs::relative(entry.path(), headers).generic_string();
    CAPTURE(header);
    CHECK(lines.contains("#include \"cambium/" + header + "\"") == !header.ends_with("_impl.hpp"));
  }
}

TEST_CASE("cambium.hpp gathers all rooms but the viewer, the benchmark and snapshots") {
  auto const lines = lines_of(headers / "cambium.hpp");
  for (auto const& room : rooms()) {
    CAPTURE(room);
    CHECK(lines.contains("#include \"cambium/" + room + ".hpp\"") ==
          (room != "viewer" && room != "benchmark" && room != "snapshot"));
  }
}
