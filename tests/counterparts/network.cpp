// Prints who follows whom and lies beside whom on a map of lanelets, a row a lane: what counterparts are asked for,
// too.
//   network FILE [WRITTEN.xml]     also writes a CommonRoad scenario again
#include <cstdio>
#include <fstream>
#include <map>
#include <memory>
#include <set>
#include <string>

#include "cambium/map/lanelet/lanelet2.hpp"
#include "cambium/scenario/dataset/common_road.hpp"
#include "cambium/scenario/dataset/common_road_writer.hpp"

#include "../support/named_by.hpp"

namespace {

using namespace cambium;

struct Network {
  std::shared_ptr<Map const> map;
  std::map<std::int64_t, LaneId> lanes;
  std::vector<Diagnostic> diagnostics;
};

/// Rows "id successors left right may_change_left may_change_right limit", lists joined by commas, "-" for none; a
/// minus before an id: that lanelet, driven backwards. Then rows "named" with two lanelets that a finding is about.
void print(Network const& network) {
  std::map<LaneId, std::string> names;
  for (auto const& [id, lane] : network.lanes) {
    names[lane] = std::to_string(id);
    if (auto const back = network.map->lane(lane).opposite; is_valid(back)) names[back] = "-" + names[lane];
  }
  for (auto const& [id, name] : names) {
    auto const& lane = network.map->lane(id);
    if (!lane.drivable()) continue;
    std::set<std::string> next;
    if (!is_valid(lane.merges_into))
      for (auto const other : lane.successors) next.insert(names.at(other));
    std::string successors;
    for (auto const& other : next) successors += (successors.empty() ? "" : ",") + other;
    auto const beside = [&](LaneId other) { return is_valid(other) ? names.at(other) : "-"; };
    std::printf("%s %s %s %s %d %d %.2f\n", name.c_str(), successors.empty() ? "-" : successors.c_str(),
                beside(lane.left_neighbor).c_str(), beside(lane.right_neighbor).c_str(), !lane.left_changes.empty(),
                !lane.right_changes.empty(), lane.speed_limit_at(0.5 * lane.length()) * 3.6);
  }
  for (auto const& [a, b] : support::named_by(network.diagnostics)) std::printf("named %s %s\n", a.c_str(), b.c_str());
}

}  // namespace

int main(int count, char** words) {
  try {
    std::string const file = count > 1 ? words[1] : "";
    if (file.ends_with(".osm")) {
      auto made = load_lanelet2(file);
      print({made.map, std::move(made.lanes), std::move(made.diagnostics)});
    } else {
      auto const traffic = load_common_road(file);
      if (traffic.map) print({traffic.map, traffic.lanes, traffic.diagnostics});
      if (count > 2) std::ofstream(words[2]) << common_road_text(traffic);
    }
  } catch (Error const& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
