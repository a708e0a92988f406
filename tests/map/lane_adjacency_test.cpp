#include "cambium/map/lane_adjacency.hpp"

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "../support/corpus.hpp"
#include "../support/maps.hpp"

namespace {

namespace cb = cambium;
namespace odr = cambium::map::opendrive;

using Row = std::vector<std::string>;

Row row_of(odr::LaneAdjacency const& link) {
  auto const word = [](odr::ContactPoint end) { return std::string(end == odr::ContactPoint::end ? "end" : "start"); };
  return {link.road,
          word(link.end),
          std::to_string(link.lane),
          link.next_road,
          word(link.next_end),
          std::to_string(link.next_lane),
          link.junction.empty() ? "road" : "junction:" + link.junction};
}

}  // namespace

TEST_CASE("the lanes that meet at the ends of roads are those of the links table on every map of the corpus") {
  auto const folder = corpus::find("opendrive");
  if (!folder) return;
  std::size_t all = 0;
  for (auto const& file : corpus::maps(*folder)) {
    std::vector<cb::Diagnostic> diagnostics;
    std::multiset<Row> ours, theirs;
    for (auto const& link : lane_adjacency(support::load_opendrive_document(file.string(), diagnostics)))
      ours.insert(row_of(link));
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
