#pragma once

#include <utility>

#include "cambium/core/macros.hpp"
#include "cambium/map/building/detail/road_links.hpp"
#include "cambium/map/building/lane_adjacency.hpp"

namespace cambium::inline v0_1::map {

namespace detail {

/// See `lane_adjacency`.
class AdjacencyList {
 public:
  explicit AdjacencyList(RoadLinks const& links) : links_(links) {}

  [[nodiscard]] std::vector<LaneAdjacency> list() {
    using enum opendrive::ContactPoint;
    for (std::size_t r = 0; r < links_.roads().size(); ++r)
      for (auto const at : {links_.road_end(r, start), links_.road_end(r, end)}) add_links(at);
    for (auto const& junction : links_.document().junctions)
      for (auto const& connection : junction.connections) add_connection(junction, connection);
    return std::move(result_);
  }

 private:
  void add(SectionEnd const& at, int lane, SectionEnd const& next, int next_lane, std::string const& junction) {
    if (lane == 0 || next_lane == 0 || !links_.is_road_end(next)) return;
    if (links_.written(at, lane) == nullptr || links_.written(next, next_lane) == nullptr) return;
    auto const name = [this](SectionEnd const& place) { return links_.document().roads[place.road].id; };
    result_.push_back({name(at), at.end, lane, name(next), next.end, next_lane, junction});
  }

  void add_links(SectionEnd const& at) {
    auto const others = links_.beyond(at);
    for (auto const& lane : links_.document().roads[at.road].lane_sections[at.section].lanes)
      for (int const to : at.end == opendrive::ContactPoint::end ? lane.successors : lane.predecessors)
        for (auto const& next : others) add(at, lane.id, next, to, {});
  }

  void add_connection(opendrive::JunctionElement const& junction, opendrive::Connection const& connection) {
    auto const entry = links_.entry_of(connection);
    if (!entry) return;
    for (auto const& exit : links_.exits_of(junction, connection, *entry))
      for (auto const& link : connection.lane_links)
        if (links_.is_road_end(exit)) add(exit, link.from, *entry, link.to, junction.id);
  }

  RoadLinks const& links_;
  std::vector<LaneAdjacency> result_;
};

}  // namespace detail

CAMBIUM_COLD std::vector<LaneAdjacency> lane_adjacency(OpenDriveDocument const& document,
                                                       std::vector<Road> const& roads) {
  return detail::AdjacencyList(detail::RoadLinks(document, roads)).list();
}

}  // namespace cambium::inline v0_1::map
