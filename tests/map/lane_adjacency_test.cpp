#include "cambium/map/building/lane_adjacency.hpp"

#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include "cambium/map/building/make_roads.hpp"
#include "cambium/map/opendrive.hpp"
#include "cambium/map/opendrive/reader.hpp"

#include "../support/corpus.hpp"
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

}  // namespace

TEST_CASE("the lanes that meet at the ends of roads are those of the links table on every map of the corpus") {
  auto const folder = corpus::find("opendrive");
  if (!folder) return;
  std::size_t all = 0;
  for (auto const& file : corpus::maps(*folder)) {
    std::vector<cb::Diagnostic> diagnostics;
    std::multiset<Row> ours, theirs;
    for (auto const& row : rows_of(cambium::map::load_opendrive_document(file.string(), diagnostics))) ours.insert(row);
    for (auto row : corpus::table(file.parent_path() / "oracle" / file.stem().concat(".links.csv"))) {
      if (row.size() < 7) continue;  // an empty line
      row.resize(7);                 // without the column that names the peers
      theirs.insert(row);
    }
    MESSAGE(file.stem().string() << ": " << theirs.size() << " rows");
    CAPTURE(file.stem().string());
    CHECK(ours == theirs);
    all += theirs.size();
  }
  CHECK(all == 2852);
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
