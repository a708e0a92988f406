// Every adjacency at road ends that two other readers found (the oracle's links tables) is in the map, and no other.
#include <algorithm>
#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include <doctest/doctest.h>

#include "cambium/map/building/build_map.hpp"
#include "cambium/map/opendrive.hpp"
#include "cambium/map/opendrive/reader.hpp"

#include "../support/corpus.hpp"
#include "../support/maps.hpp"

namespace {

using namespace cambium;
using namespace cambium::map;

/// A lane at one end of a road.
struct LaneAtEnd {
  std::string road;
  bool at_end = false;
  int lane = 0;
  friend auto operator<=>(LaneAtEnd const&, LaneAtEnd const&) = default;
};

struct Row {
  LaneAtEnd from, to;
};

struct Counts {
  int rows = 0, joined = 0, oncoming = 0, not_there = 0;         // of the table
  int relations = 0, in_table = 0, merged = 0, unexplained = 0;  // of the map, over the borders of roads
};

std::vector<Row> links_of(std::filesystem::path const& map) {
  auto const name = map.stem().string() + ".links.csv";
  std::vector<Row> rows;
  for (auto const& cells : corpus::table(map.parent_path() / "oracle" / name))
    if (cells.size() == 8)  // else the blank line of a table without rows
      rows.push_back(
          {{cells[0], cells[1] == "end", std::stoi(cells[2])}, {cells[3], cells[4] == "end", std::stoi(cells[5])}});
  return rows;
}

/// The lanes of the map at the ends of roads; sections without length are passed by.
class Ends {
 public:
  explicit Ends(Map const& map) : map_(&map) {
    for (auto const& road : map.roads()) {
      add(road, false);
      add(road, true);
    }
  }

  /// Null where it is no lane of the map.
  [[nodiscard]] Lane const* find(LaneAtEnd const& at) const {
    auto const found = lanes_.find(at);
    return found == lanes_.end() ? nullptr : &map_->lane(found->second);
  }
  /// Where a lane is left (or entered), when that is at the end of its road.
  [[nodiscard]] bool is_at(Lane const& lane, bool leaving, LaneAtEnd& at) const {
    at = {map_->road(lane.road).name, lane.along_road == leaving, lane.number};
    auto const* found = find(at);
    return found != nullptr && found->section == lane.section;
  }

 private:
  void add(Road const& road, bool at_end) {
    for (std::size_t i = 0; i < road.sections.size(); ++i) {
      auto const& section = road.sections[at_end ? road.sections.size() - 1 - i : i];
      if (section.end - section.begin < 1e-6) continue;
      for (auto const& lane : section.lanes)
        if (is_valid(lane.id)) lanes_[{road.name, at_end, lane.number}] = lane.id;
      return;
    }
  }

  Map const* map_;
  std::map<LaneAtEnd, LaneId> lanes_;
};

bool has(std::vector<LaneId> const& ids, LaneId id) { return std::find(ids.begin(), ids.end(), id) != ids.end(); }

/// Counts what becomes of the table's rows, and names those that the map has lost.
void count_rows(std::vector<Row> const& rows, Ends const& ends, Counts& counts) {
  for (auto const& row : rows) {
    ++counts.rows;
    auto const *a = ends.find(row.from), *b = ends.find(row.to);
    if (a == nullptr || b == nullptr) {
      ++counts.not_there;
      continue;
    }
    bool const leaves_a = a->along_road == row.from.at_end, leaves_b = b->along_road == row.to.at_end;
    if (leaves_a == leaves_b) {
      ++counts.oncoming;
      continue;
    }
    auto const &from = leaves_a ? *a : *b, &to = leaves_a ? *b : *a;
    bool const joined = has(from.successors, to.id) && has(to.predecessors, from.id);
    counts.joined += joined;
    CHECK_MESSAGE(joined,
                  row.from.road << " lane " << row.from.lane << " -> " << row.to.road << " lane " << row.to.lane);
  }
}

/// From a section to the next one, those without length between them passed by.
bool is_within_road(Lane const& lane, Lane const& to) {
  if (to.road != lane.road || to.along_road != lane.along_road) return false;
  auto const &first = lane.along_road ? lane : to, &last = lane.along_road ? to : lane;
  return first.section < last.section && last.road_begin - first.road_end < 1e-4;
}

void count_relations(Map const& map, std::vector<Row> const& rows, Ends const& ends, Counts& counts) {
  std::set<std::tuple<LaneAtEnd, LaneAtEnd>> table;
  for (auto const& row : rows) {
    table.insert({row.from, row.to});
    table.insert({row.to, row.from});  // the reverse of a junction's links is not written
  }
  for (auto const& lane : map.lanes())
    for (auto const next : lane.successors) {
      auto const& to = map.lane(next);
      if (is_within_road(lane, to)) continue;
      LaneAtEnd exit, entry;
      bool const at_ends = ends.is_at(lane, true, exit) && ends.is_at(to, false, entry);
      ++counts.relations;
      if (at_ends && table.contains({exit, entry})) {
        ++counts.in_table;
      } else if (is_valid(lane.merges_into) && has(map.lane(lane.merges_into).successors, next)) {
        ++counts.merged;
      } else {
        ++counts.unexplained;
        CHECK_MESSAGE(false, map.describe(lane.id) << " -> " << map.describe(next) << " is not in the table");
      }
    }
}

}  // namespace

TEST_CASE("every row of the links tables is a link of the map, and every link between roads is a row") {
  auto const folder = corpus::find("opendrive");
  if (!folder) return;
  int rows = 0;
  auto const maps = corpus::maps(*folder);
  CHECK(maps.size() >= 28);
  for (auto const& path : maps) {
    CAPTURE(path.filename().string());
    auto const map = cambium::load_opendrive(path.string()).map;
    auto const table = links_of(path);
    Ends const ends(*map);
    Counts c;
    count_rows(table, ends, c);
    count_relations(*map, table, ends, c);
    rows += c.rows;
    CHECK(c.rows == c.joined + c.oncoming + c.not_there);
    MESSAGE(path.stem().string() << ": " << c.rows << " rows: " << c.joined << " joined, " << c.oncoming
                                 << " driven against each other, " << c.not_there << " of lanes without length; "
                                 << c.relations << " links between roads: " << c.in_table << " in the table, "
                                 << c.merged << " of merging lanes");
  }
  CHECK(rows > 2800);
}

TEST_CASE("lanes of one road are linked from section to section, over those without length, too") {
  auto const folder = corpus::find("opendrive");
  if (!folder) return;
  int links = 0, over = 0;
  for (auto const& path : corpus::maps(*folder)) {
    CAPTURE(path.filename().string());
    std::vector<Diagnostic> diagnostics;
    auto const document = cambium::map::read_opendrive_document(corpus::read(path), "", diagnostics);
    auto const map = cambium::map::build_map(document, {}, "", diagnostics);
    for (std::size_t r = 0; r < document.roads.size(); ++r) {
      auto const& sections = document.roads[r].lane_sections;
      auto const& road = map->roads()[r];
      if (road.sections.size() != sections.size()) continue;  // split: it closes upon itself
      auto const has_length = [&](std::size_t k) { return road.sections[k].end - road.sections[k].begin >= 1e-6; };
      auto const find = [&](std::size_t k, int number) {
        for (auto const& lane : road.sections[k].lanes)
          if (lane.number == number) return lane.id;
        return none<LaneId>;
      };
      for (std::size_t k = 0; k < sections.size(); ++k)
        for (auto const& lane : sections[k].lanes) {
          if (lane.id == 0 || !has_length(k)) continue;
          std::vector<int> ids = lane.successors;
          std::size_t next = k + 1;
          for (; next < sections.size() && !has_length(next); ++next) {
            std::vector<int> behind;
            for (int const id : ids)
              if (auto const* passed = sections[next].find(id))
                behind.insert(behind.end(), passed->successors.begin(), passed->successors.end());
            ids = behind;
          }
          if (next >= sections.size()) continue;
          for (int const id : ids) {
            auto const a = find(k, lane.id), b = find(next, id);
            if (!is_valid(a) || !is_valid(b)) continue;
            auto const &from = map->lane(map->lane(a).along_road ? a : b),
                       &to = map->lane(map->lane(a).along_road ? b : a);
            CHECK_MESSAGE((has(from.successors, to.id) || is_valid(from.merges_into)), map->describe(from.id));
            ++links;
            over += next > k + 1;
          }
        }
    }
  }
  MESSAGE(links << " links within roads, " << over << " of them over sections without length");
  CHECK(links > 1000);
  CHECK(over > 20);
}
