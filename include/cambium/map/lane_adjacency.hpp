#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "cambium/map/opendrive_document.hpp"

namespace cambium::map::opendrive {

/// That one meets lane `next_lane` of `next_road` at its end `next_end` when leaving `road` at its end `end` in lane
/// `lane`: as the file says, whatever way lanes are driven.
struct LaneAdjacency {
  std::string road;
  ContactPoint end = ContactPoint::none;
  int lane = 0;
  std::string next_road;
  ContactPoint next_end = ContactPoint::none;
  int next_lane = 0;
  std::string junction;  ///< whose connection says so; empty: the road's own link

  friend bool operator==(LaneAdjacency const&, LaneAdjacency const&) = default;
};

namespace detail {

/// See `lane_adjacency`.
class AdjacencyList {
 public:
  explicit AdjacencyList(Document const& document) : document_(document) {
    for (Road const& road : document.roads) roads_.emplace(road.id, &road);
  }

  [[nodiscard]] std::vector<LaneAdjacency> list() {
    for (Road const& road : document_.roads) {
      add_links(road, ContactPoint::start, road.predecessor);
      add_links(road, ContactPoint::end, road.successor);
    }
    for (Junction const& junction : document_.junctions)
      for (Connection const& connection : junction.connections) add_connection(junction, connection);
    return std::move(result_);
  }

 private:
  [[nodiscard]] Road const* find(std::string const& id) const {
    auto const at = roads_.find(id);
    return at == roads_.end() ? nullptr : at->second;
  }
  [[nodiscard]] static LaneSection const& section_at(Road const& road, ContactPoint end) {
    return end == ContactPoint::end ? road.lane_sections.back() : road.lane_sections.front();
  }

  void add(Road const& road, ContactPoint end, int lane, Road const& next, ContactPoint next_end, int next_lane,
           std::string const& junction) {
    if (lane == 0 || next_lane == 0) return;
    if (!section_at(road, end).find(lane) || !section_at(next, next_end).find(next_lane)) return;
    result_.push_back({road.id, end, lane, next.id, next_end, next_lane, junction});
  }

  void add_links(Road const& road, ContactPoint end, std::optional<RoadLink> const& link) {
    if (!link || link->element_type != ElementType::road || link->contact_point == ContactPoint::none) return;
    Road const* const next = find(link->id);
    if (next == nullptr) return;
    for (Lane const& lane : section_at(road, end).lanes)
      for (int const to : end == ContactPoint::end ? lane.successors : lane.predecessors)
        add(road, end, lane.id, *next, link->contact_point, to, {});
  }

  void add_connection(Junction const& junction, Connection const& connection) {
    Road const* const road = find(connection.incoming_road);
    Road const* const next = find(connection.entered_road());
    if (road == nullptr || next == nullptr) return;
    ContactPoint const next_end =
        connection.contact_point == ContactPoint::none ? ContactPoint::start : connection.contact_point;
    auto const touches = [&](std::optional<RoadLink> const& link) {
      return link && link->element_type == ElementType::junction && link->id == junction.id;
    };
    for (ContactPoint const end : {ContactPoint::start, ContactPoint::end})
      if (touches(end == ContactPoint::end ? road->successor : road->predecessor))
        for (LaneLink const& link : connection.lane_links)
          add(*road, end, link.from, *next, next_end, link.to, junction.id);
  }

  Document const& document_;
  std::unordered_map<std::string, Road const*> roads_;
  std::vector<LaneAdjacency> result_;
};

}  // namespace detail

/// Which lanes meet at the ends of roads, as written: by the roads' own links, in the order of the roads, then by the
/// junctions' connections, from the incoming road into the road that is entered. Links to roads or lanes that are not
/// there are left out. O(document).
[[nodiscard]] inline std::vector<LaneAdjacency> lane_adjacency(Document const& document) {
  return detail::AdjacencyList(document).list();
}

}  // namespace cambium::map::opendrive
