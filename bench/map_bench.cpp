// What reading maps and asking them costs, beside what pugixml alone takes for the same files.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>
#include <pugixml.hpp>

#include "cambium/core/random.hpp"
#include "cambium/map/building/build_map.hpp"
#include "cambium/map/building/make_roads.hpp"
#include "cambium/map/building/map_builder.hpp"
#include "cambium/map/lanelet/lanelet2.hpp"
#include "cambium/map/lanelet/lanelet_map.hpp"
#include "cambium/map/lanes/road_lanes.hpp"
#include "cambium/map/opendrive.hpp"
#include "cambium/map/opendrive/writer.hpp"
#include "cambium/scenario/dataset/common_road.hpp"

#include "yardstick/main.hpp"

namespace {

namespace cb = cambium;
namespace fs = std::filesystem;
using cb::geometry::Pose;
using cb::map::LaneHit;

std::string read(fs::path const& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// The project's maps, and those of the test corpus where that is.
std::vector<fs::path> files() {
  char const* const named = std::getenv("CAMBIUM_CORPUS");
  fs::path const corpus = named != nullptr ? fs::path(named) : fs::path(CAMBIUM_SOURCE_DIR) / ".." / "shared";
  std::vector<fs::path> files;
  for (auto const& folder : {fs::path(CAMBIUM_SOURCE_DIR) / "maps", corpus / "opendrive", corpus / "lanelet2",
                             corpus / "scenarios" / "commonroad"}) {
    std::error_code absent;
    for (auto const& entry : fs::directory_iterator(folder, absent)) {
      auto const kind = entry.path().extension();
      if (kind == ".xodr" || kind == ".osm" || kind == ".xml") files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end(), [](auto const& a, auto const& b) { return a.stem() < b.stem(); });
  return files;
}

/// What is built of a map: each stage with those before it.
enum class Stage { read, sampled, linked };

/// Runs the stages that `parse_opendrive` consists of, up to `last`, with lanes sampled to 5 cm.
std::size_t run_stages(std::string const& text, std::string const& name, Stage last) {
  std::vector<cb::Diagnostic> diagnostics;
  auto document = cb::map::read_opendrive_document(text, name, diagnostics);
  if (last == Stage::read) return cb::map::make_roads(document).size();
  cb::map::detail::RequireBuildable::check(document);
  cb::map::detail::split_roads(document);
  cb::map::detail::MapBuild build(document, {.position_tolerance = 0.05}, name, diagnostics);
  build.add_lanes();
  if (last == Stage::linked) build.link_lanes();
  return diagnostics.size();
}

void register_xml(std::string const& stem, std::shared_ptr<std::string const> const& text) {
  yardstick::add("map/xml/" + stem, [text](benchmark::State& state) {
    yardstick::measure_duration(state, [&] {
      pugi::xml_document xml;
      benchmark::DoNotOptimize(xml.load_buffer(text->data(), text->size()).status);
    });
  });
}

/// Files of lanelets, with their tracks where they have any.
void register_lanelets(fs::path const& file, std::shared_ptr<std::string const> const& text) {
  register_xml(file.stem().string(), text);
  yardstick::add("map/world_ready/" + file.stem().string(), [file, text](benchmark::State& state) {
    yardstick::measure_duration(state, [&] {
      if (file.extension() == ".xml") return benchmark::DoNotOptimize(cb::parse_common_road(*text).map.get());
      std::vector<cb::Diagnostic> diagnostics;
      auto lanelets = cb::map::read_lanelet2(*text, {}, file.string(), diagnostics);
      benchmark::DoNotOptimize(cb::map::build_lanelet_map(std::move(lanelets)).map.get());
    });
  });
}

void register_loading(std::string const& stem, std::shared_ptr<std::string const> const& text) {
  register_xml(stem, text);
  for (auto const& [kind, stage] :
       {std::pair("map/read/", Stage::read), {"map/sampled/", Stage::sampled}, {"map/linked/", Stage::linked}})
    yardstick::add(kind + stem, [text, stem, last = stage](benchmark::State& state) {
      yardstick::measure_duration(state, [&] { benchmark::DoNotOptimize(run_stages(*text, stem, last)); });
    });
  yardstick::add("map/world_ready/" + stem, [text, stem](benchmark::State& state) {
    yardstick::measure_duration(state,
                                [&] { benchmark::DoNotOptimize(cb::parse_opendrive(*text, {}, stem).map.get()); });
  });
}

/// Places all over the drivable lanes of a map, in no order, and walks along some of them in steps of 0.1 m.
struct Queries {
  struct Place {
    cb::RoadId road;
    double s;
    int lane;
    Pose pose;
  };
  std::shared_ptr<cb::Map const> map;
  std::vector<Place> places;
  std::vector<Pose> walk;

  explicit Queries(std::string const& text) : map(cb::parse_opendrive(text).map) {
    cb::RandomStream random(1, 0, 0);
    auto const below = [&random](std::size_t n) { return static_cast<std::size_t>(random() % n); };
    auto const lanes = map->lanes();
    while (places.size() < 20000) {
      auto const& lane = lanes[below(lanes.size())];
      if (!lane.drivable()) continue;
      double const s = lane.length() * static_cast<double>(below(1001)) / 1000.0;
      places.push_back({lane.road, lane.station_at(s), lane.number, lane.path.pose(s)});
    }
    while (walk.size() < 20000) {
      auto const& lane = lanes[below(lanes.size())];
      if (!lane.drivable()) continue;
      for (double s = 0.0; s < lane.length() && s < 100.0; s += 0.1) walk.push_back(lane.path.pose(s));
    }
  }
};

template <class Ask>
void register_query(std::string const& name, std::shared_ptr<std::optional<Queries>> const& queries,
                    std::shared_ptr<std::string const> const& text, Ask ask) {
  yardstick::add(name, [=](benchmark::State& state) {
    if (!*queries) queries->emplace(*text);
    auto const& q = **queries;
    yardstick::measure_queries(state, q.places.size(), [&] { ask(q); });
  });
}

void register_queries(std::shared_ptr<std::string const> const& text) {
  auto const queries = std::make_shared<std::optional<Queries>>();  // made when first measured
  register_query("map/pose", queries, text, [](Queries const& q) {
    for (auto const& p : q.places) benchmark::DoNotOptimize(lane_point(q.map->road(p.road), p.s, p.lane)->center.x);
  });
  register_query("map/nearest_cold", queries, text, [](Queries const& q) {
    for (auto const& p : q.places) {
      auto const hit = q.map->nearest_lane(p.pose);
      benchmark::DoNotOptimize(exact_place(*q.map, p.pose.position(), *hit).s);
    }
  });
  register_query("map/nearest_warm", queries, text, [](Queries const& q) {
    auto hit = q.map->nearest_lane(q.walk.front());
    for (std::size_t i = 0; i < q.places.size(); ++i) {
      hit = q.map->nearest_lane(q.walk[i], *hit);
      benchmark::DoNotOptimize(exact_place(*q.map, q.walk[i].position(), *hit).s);
    }
  });
}

/// One road of many arcs: that reading it takes time in proportion.
std::string many_geometries(int count) {
  cb::MapBuilder builder;
  std::vector<cb::map::CurvePiece> pieces;
  for (int i = 0; i < count; ++i) pieces.push_back({10.0, i % 2 == 0 ? 0.002 : -0.002, i % 2 == 0 ? 0.002 : -0.002});
  cb::map::RoadPlan road;
  road.line = cb::map::lay_from({}, pieces);
  road.sections = {{.right = cb::map::equal_lanes(2)}};
  builder.add_road(road);
  return cb::map::write_opendrive(builder.document());
}

/// The parts of what it takes to load a map, as differences of the best times.
void print_parts(yardstick::Results const& results) {
  auto const best = [&](char const* kind) {
    auto const found = results.find(std::string("map/") + kind + "/Town04");
    return found == results.end() ? std::nan("") : found->second.best;
  };
  double const sampling = best("sampled") - best("read"), linking = best("linked") - best("sampled");
  if (!std::isfinite(sampling + linking + best("world_ready"))) return;
  std::printf(
      "\nTown04 [ms]: document, exact roads and links between lanes %.1f (at most 12), sampled lanes and borders "
      "at 5 cm %.1f more (20), world-ready %.1f (60)\n",
      best("read") + linking, sampling, best("world_ready"));
}

void print_ratios(yardstick::Results const& results) {
  print_parts(results);
  std::printf("\nratios of the best\n");
  auto const row = [&](char const* a, char const* b) {
    if (auto const r = yardstick::ratio(results, a, b)) std::printf("  %-32s / %-32s %6.2f\n", a, b, *r);
  };
  row("map/read/Town04", "map/xml/Town04");
  row("map/world_ready/Town04", "map/xml/Town04");
  for (std::string const lanelets : {"mapping_example", "autoware_intersection", "ZAM_Tjunction-1_42_T-1"})
    row(("map/world_ready/" + lanelets).c_str(), ("map/xml/" + lanelets).c_str());
  row("map/world_ready/3000_geometries", "map/world_ready/1000_geometries");
}

}  // namespace

int main(int argc, char** argv) {
  std::shared_ptr<std::string const> asked;
  for (auto const& file : files()) {
    auto const text = std::make_shared<std::string const>(read(file));
    if (file.extension() != ".xodr") {
      register_lanelets(file, text);
      continue;
    }
    register_loading(file.stem().string(), text);
    if (!asked || file.stem() == "Town04") asked = text;  // any map where the corpus is not there
  }
  for (int const count : {1000, 3000})
    register_loading(std::to_string(count) + "_geometries",
                     std::make_shared<std::string const>(many_geometries(count)));
  register_queries(asked);
  return yardstick::run_benchmarks(argc, argv, "What reading maps and asking them costs, beside pugixml alone.",
                                   print_ratios);
}
