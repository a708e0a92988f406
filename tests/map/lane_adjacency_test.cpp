#include "cambium/map/building/lane_adjacency.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include "cambium/map/building/build_map.hpp"
#include "cambium/map/building/make_roads.hpp"
#include "cambium/map/opendrive.hpp"
#include "cambium/map/opendrive/reader.hpp"

#include "corpus_maps.hpp"
#include "../support/maps.hpp"
#include "road_text.hpp"

namespace {

namespace cb = cambium;
namespace odr = cambium::map::opendrive;

using Row = std::vector<std::string>;

Row row_of(cb::map::LaneAdjacency const& link) {
  auto const word = [](odr::ContactPoint end) { return std::string(end == odr::ContactPoint::end ? "end" : "start"); };
  return {link.road,
          word(link.end),
          std::to_string(link.lane),
          link.next_road,
          word(link.next_end),
          std::to_string(link.next_lane),
          link.junction.empty() ? "road" : "junction:" + link.junction};
}

std::multiset<Row> rows_of(cb::map::OpenDriveDocument const& document) {
  std::multiset<Row> rows;
  for (auto const& link : lane_adjacency(document, cb::map::make_roads(document))) rows.insert(row_of(link));
  return rows;
}

bool has(std::vector<cb::LaneId> const& ids, cb::LaneId id) {
  return std::find(ids.begin(), ids.end(), id) != ids.end();
}

/// The lane of that number in a section; null where the map has none.
cb::map::Lane const* find(cb::Map const& map, cb::map::RoadSection const& section, int number) {
  for (auto const& lane : section.lanes)
    if (lane.number == number && is_valid(lane.id)) return &map.lane(lane.id);
  return nullptr;
}

/// The lane of that number at the end of a road; sections without length are passed by.
cb::map::Lane const* find(cb::Map const& map, std::string const& road, odr::ContactPoint end, int number) {
  auto sections = map.find_road(road).sections;
  if (end == odr::ContactPoint::end) std::reverse(sections.begin(), sections.end());
  for (auto const& section : sections)
    if (section.end - section.begin >= 1e-6) return find(map, section, number);
  return nullptr;
}

/// From a section to the next one, those without length between them passed by.
bool is_within_road(cb::map::Lane const& lane, cb::map::Lane const& to) {
  if (to.road != lane.road || to.along_road != lane.along_road) return false;
  auto const &first = lane.along_road ? lane : to, &last = lane.along_road ? to : lane;
  return first.section < last.section && last.road_begin - first.road_end < 1e-4;
}

/// Checks that lanes which meet are joined in the map, unless they are driven against each other; returns those.
std::set<std::pair<cb::LaneId, cb::LaneId>> check_joined(cb::Map const& map,
                                                         std::vector<cb::map::LaneAdjacency> const& links) {
  std::set<std::pair<cb::LaneId, cb::LaneId>> joined;
  for (auto const& link : links) {
    auto const *a = find(map, link.road, link.end, link.lane),
               *b = find(map, link.next_road, link.next_end, link.next_lane);
    if (!a || !b) continue;  // without length
    bool const leaves_a = a->along_road == (link.end == odr::ContactPoint::end);
    if (leaves_a == (b->along_road == (link.next_end == odr::ContactPoint::end))) continue;
    auto const &from = leaves_a ? *a : *b, &to = leaves_a ? *b : *a;
    CHECK_MESSAGE((has(from.successors, to.id) && has(to.predecessors, from.id)), map.describe(from.id)
                                                                                      << " -> " << map.describe(to.id));
    joined.insert({from.id, to.id});
  }
  return joined;
}

}  // namespace

TEST_CASE("the lanes that meet at the ends of roads are those of the links tables, in the document and in the map") {
  auto const folder = corpus::find("opendrive");
  if (!folder) return;
  std::size_t all = 0;
  for (auto const& file : corpus::maps(*folder)) {
    CAPTURE(file.stem().string());
    std::vector<cb::Diagnostic> diagnostics;
    auto const document = cb::map::load_opendrive_document(file.string(), diagnostics);
    std::multiset<Row> theirs;
    for (auto row : corpus::table(file.parent_path() / "oracle" / file.stem().concat(".links.csv"))) {
      if (row.size() < 7) continue;  // an empty line
      row.resize(7);                 // without the column that names the peers
      theirs.insert(row);
    }
    CHECK(rows_of(document) == theirs);
    all += theirs.size();
    auto const map = cb::map::build_map(document, {}, "", diagnostics);
    auto const joined = check_joined(*map, lane_adjacency(document, cb::map::make_roads(document)));
    for (auto const& lane : map->lanes())
      for (auto const next : lane.successors) {
        bool const merges = is_valid(lane.merges_into) && has(map->lane(lane.merges_into).successors, next);
        CHECK_MESSAGE((merges || is_within_road(lane, map->lane(next)) || joined.contains({lane.id, next})),
                      map->describe(lane.id) << " -> " << map->describe(next));
      }
  }
  CHECK(all == 2852);
}

TEST_CASE("lanes of one road are linked from section to section") {
  int links = 0;
  bool const is_there = for_each_corpus_map([&links](auto const& file, cb::Map const& map) {
    std::vector<cb::Diagnostic> diagnostics;
    auto const document = cb::map::load_opendrive_document(file.string(), diagnostics);
    for (std::size_t r = 0; r < document.roads.size(); ++r) {
      auto const& road = map.roads()[r];
      if (road.sections.size() != document.roads[r].lane_sections.size()) continue;  // split: it closes upon itself
      for (std::size_t k = 0; k + 1 < road.sections.size(); ++k)
        for (auto const& lane : document.roads[r].lane_sections[k].lanes)
          for (int const id : lane.successors) {
            auto const *a = find(map, road.sections[k], lane.id), *b = find(map, road.sections[k + 1], id);
            if (!a || !b) continue;
            auto const &from = a->along_road ? *a : *b, &to = a->along_road ? *b : *a;
            CHECK_MESSAGE((has(from.successors, to.id) || is_valid(from.merges_into)), map.describe(from.id));
            ++links;
          }
    }
  });
  if (is_there) CHECK(links > 1000);
}

TEST_CASE("a road with both ends in one junction is left at the end that the road it leads into names, as in the map") {
  using namespace road_text;
  double const circle = 2.0 * std::acos(-1.0) / 0.02;
  for (double const part : {0.75, 1.0})  // its ends apart, and upon each other
    for (bool const is_turned : {false, true}) {
      CAPTURE(part);
      CAPTURE(is_turned);
      Road ring{.length = part * circle, .before = to_junction("9"), .behind = to_junction("9"), .curvature = 0.02};
      ring.sections[0].lanes = {{1}, {-1}};
      // From the ring's end to its start, or the other way.
      Road link{.id = "2", .length = 5.0, .before = to_end("1"), .behind = to_start("1"), .junction = "9"};
      if (is_turned) std::swap(link.before, link.behind);
      link.x = part < 1.0 ? (is_turned ? 0.0 : -50.0) : 0.0;
      link.y = part < 1.0 ? (is_turned ? 0.0 : 50.0) : 0.0;
      int const lane = is_turned ? 1 : -1;  // of the link, that goes on as lane -1 of the ring
      link.sections[0].lanes = {{1}, {-1}};
      for (Lane& each : link.sections[0].lanes) each.before = each.behind = {is_turned ? -each.id : each.id};
      auto const text =
          file({ring, link}, junction("9", connection("1", "2", is_turned ? "end" : "start", -1, lane) +
                                               connection("1", "2", is_turned ? "start" : "end", 1, -lane)));
      std::vector<cb::Diagnostic> diagnostics;
      std::string const from = is_turned ? "end" : "start", to = is_turned ? "start" : "end", l = std::to_string(lane),
                        other = std::to_string(-lane);
      CHECK(rows_of(cambium::map::read_opendrive_document(text, "", diagnostics)) ==
            std::multiset<Row>{{"1", "end", "-1", "2", from, l, "junction:9"},
                               {"1", "start", "1", "2", to, other, "junction:9"},
                               {"2", from, l, "1", "end", "-1", "road"},
                               {"2", to, l, "1", "start", "-1", "road"},
                               {"2", from, other, "1", "end", "1", "road"},
                               {"2", to, other, "1", "start", "1", "road"}});
      auto const loaded = load(text);
      CHECK(leads(loaded, {"1", 10.0, -1}, {"2", 1.0, lane}));
      CHECK(leads(loaded, {"2", 1.0, lane}, {"1", 10.0, -1}));
      CHECK(leads(loaded, {"1", 10.0, 1}, {"2", 1.0, -lane}));
      CHECK(leads(loaded, {"2", 1.0, -lane}, {"1", 10.0, 1}));
      CHECK(count(loaded, cb::Severity::warning, "driven the other way") == 0);
    }
}

TEST_CASE("without a link of the road that is entered, its own place says which end of the incoming road is left") {
  using namespace road_text;
  for (bool const is_start : {false, true}) {
    CAPTURE(is_start);
    Road const both{.before = to_junction("9"), .behind = to_junction("9"), .sections = {{0.0, {{1}, {-1}}}}};
    Road const away{
        .id = "2", .x = is_start ? -1.0 : 101.0, .before = to_junction("9"), .sections = {{0.0, {{1}, {-1}}}}};
    auto const text = file({both, away}, junction("9", connection("1", "2", "start", -1, -1, "linkedRoad"), "direct"));
    std::vector<cb::Diagnostic> diagnostics;
    CHECK(rows_of(cambium::map::read_opendrive_document(text, "", diagnostics)) ==
          std::multiset<Row>{{"1", is_start ? "start" : "end", "-1", "2", "start", "-1", "junction:9"}});
  }
}
