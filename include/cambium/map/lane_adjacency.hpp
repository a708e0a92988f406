#pragma once

#include <string>
#include <utility>
#include <vector>

#include "cambium/map/detail/road_links.hpp"
#include "cambium/map/opendrive_document.hpp"
#include "cambium/map/road.hpp"

namespace cambium::map {

/// That one meets lane `next_lane` of `next_road` at its end `next_end` when leaving `road` at its end `end` in lane
/// `lane`: as the file says, whatever way lanes are driven.
struct LaneAdjacency {
  std::string road;
  opendrive::ContactPoint end = opendrive::ContactPoint::none;
  int lane = 0;
  std::string next_road;
  opendrive::ContactPoint next_end = opendrive::ContactPoint::none;
  int next_lane = 0;
  std::string junction;  ///< whose connection says so; empty: the road's own link

  friend bool operator==(LaneAdjacency const&, LaneAdjacency const&) = default;
};

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

  void add_connection(opendrive::Junction const& junction, opendrive::Connection const& connection) {
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

/// Which lanes meet at the ends of roads, as written: by the roads' own links, in the order of the roads, then by the
/// junctions' connections, from the incoming road into the road that is entered. Where they lead is found as for a
/// `Map`. Links to roads or lanes that are not there are left out, and so are those to the middle of a road. `roads` is
/// what `make_roads` makes of the document. O(document) but for the lanes of a section.
[[nodiscard]] inline std::vector<LaneAdjacency> lane_adjacency(OpenDriveDocument const& document,
                                                               std::vector<Road> const& roads) {
  return detail::AdjacencyList(detail::RoadLinks(document, roads)).list();
}

}  // namespace cambium::map
