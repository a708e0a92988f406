#pragma once

#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cambium/core/diagnostic.hpp"
#include "cambium/map/lane.hpp"
#include "cambium/map/map.hpp"
#include "cambium/map/opendrive_document.hpp"

namespace cambium::map::detail {

/// Joins lanes by what the file says, in the direction of travel. Links are read from both sides; each is entered once.
class LaneLinker {
 public:
  LaneLinker(OpenDriveDocument const& document, std::vector<Road> const& roads, std::vector<Lane>& lanes,
             std::string const& file, std::vector<Diagnostic>& diagnostics)
      : document_(document), roads_(roads), lanes_(lanes), file_(file), diagnostics_(diagnostics) {
    for (std::size_t i = 0; i < document.roads.size(); ++i) index_.emplace(document.roads[i].id, i);
  }

  void link() {
    for (std::size_t r = 0; r < document_.roads.size(); ++r) link_road(r);
    for (auto const& junction : document_.junctions)
      for (auto const& connection : junction.connections) link_connection(junction, connection);
    for (auto& lane : lanes_) {
      sort_unique(lane.successors);
      sort_unique(lane.predecessors);
    }
  }

 private:
  using ContactPoint = opendrive::ContactPoint;

  /// One end of one lane section of a road.
  struct SectionEnd {
    std::size_t road, section;
    ContactPoint end;
  };

  static void sort_unique(std::vector<LaneId>& ids) {
    std::sort(ids.begin(), ids.end());
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  }

  [[nodiscard]] SectionEnd road_end(std::size_t road, ContactPoint end) const {
    return {road, end == ContactPoint::end ? roads_[road].sections.size() - 1 : 0, end};
  }

  [[nodiscard]] LaneId find(SectionEnd const& at, int number) const {
    for (auto const& lane : roads_[at.road].sections[at.section].lanes)
      if (lane.number == number) return lane.id;
    return none<LaneId>;
  }

  void warn(int line, std::string element, std::string ids, std::string sentence) const {
    diagnostics_.push_back({Severity::warning, file_, line, std::move(element), std::move(ids), std::move(sentence)});
  }

  /// Enters that lane `a` at its road's end `ea` meets lane `b` at `eb`, in the direction of travel.
  void join(LaneId a, ContactPoint ea, LaneId b, ContactPoint eb, int line) {
    if (!is_valid(a) || !is_valid(b) || a == b) return;
    auto& la = lanes_[index_of(a)];
    auto& lb = lanes_[index_of(b)];
    bool const leaves_a = la.along_road == (ea == ContactPoint::end);
    bool const leaves_b = lb.along_road == (eb == ContactPoint::end);
    if (leaves_a == leaves_b) {
      if (la.drivable() && lb.drivable())
        warn(line, "link", "road " + roads_[index_of(la.road)].name + ", lane " + std::to_string(la.number),
             "it is linked to road " + roads_[index_of(lb.road)].name + ", lane " + std::to_string(lb.number) +
                 ", which is driven the other way; the link was left out");
      return;
    }
    auto& from = leaves_a ? la : lb;
    auto& to = leaves_a ? lb : la;
    from.successors.push_back(to.id);
    to.predecessors.push_back(from.id);
  }

  void link_road(std::size_t r) {
    auto const& road = document_.roads[r];
    for (std::size_t k = 0; k < road.lane_sections.size(); ++k)
      for (auto const& lane : road.lane_sections[k].lanes) {
        if (lane.id == 0) continue;
        bool const first = k == 0, last = k + 1 == road.lane_sections.size();
        link_lane(r, k, lane, ContactPoint::end, lane.successors,
                  last ? follow(road.successor) : SectionEnd{r, k + 1, ContactPoint::start});
        link_lane(r, k, lane, ContactPoint::start, lane.predecessors,
                  first ? follow(road.predecessor) : SectionEnd{r, k - 1, ContactPoint::end});
      }
  }

  /// The section end behind a road link; nothing where the link names a junction (its connections say), no road, or
  /// none at all.
  [[nodiscard]] std::optional<SectionEnd> follow(std::optional<opendrive::RoadLink> const& link) const {
    if (!link || link->element_type != opendrive::ElementType::road || link->contact_point == ContactPoint::none)
      return std::nullopt;
    auto const at = index_.find(link->id);
    if (at == index_.end()) return std::nullopt;
    return road_end(at->second, link->contact_point);
  }

  void link_lane(std::size_t r, std::size_t k, opendrive::Lane const& lane, ContactPoint end,
                 std::vector<int> const& numbers, std::optional<SectionEnd> const& other) {
    if (!other) return;
    for (int const number : numbers) {
      LaneId const target = find(*other, number);
      if (!is_valid(target) && number != 0)
        warn(lane.line, "link",
             "road " + roads_[r].name + ", section " + std::to_string(k) + ", lane " + std::to_string(lane.id),
             "it names lane " + std::to_string(number) + " of road " + roads_[other->road].name +
                 ", which is not there; the link was left out");
      join(find({r, k, end}, lane.id), end, target, other->end, lane.line);
    }
  }

  void link_connection(opendrive::Junction const& junction, opendrive::Connection const& connection) {
    auto const incoming = index_.find(connection.incoming_road), connecting = index_.find(connection.entered_road());
    if (incoming == index_.end() || connecting == index_.end()) return;  // the reader has said so
    ContactPoint const contact =
        connection.contact_point == ContactPoint::none ? ContactPoint::start : connection.contact_point;
    auto const entry = road_end(connecting->second, contact);
    auto const exit = incoming_end(incoming->second, junction.id, entry);
    if (!exit) {
      warn(connection.line, "connection", "junction " + junction.id + ", connection " + connection.id,
           "road " + connection.incoming_road + " is not linked to this junction; the connection was left out");
      return;
    }
    for (auto const& link : connection.lane_links) {
      LaneId const from = find(*exit, link.from), to = find(entry, link.to);
      if (!is_valid(from) || !is_valid(to))
        warn(connection.line, "laneLink", "junction " + junction.id + ", connection " + connection.id,
             "lane " + std::to_string(link.from) + " of road " + connection.incoming_road + " or lane " +
                 std::to_string(link.to) + " of road " + connection.entered_road() +
                 " is not there; the link was left out");
      join(from, exit->end, to, entry.end, connection.line);
    }
  }

  /// The end of the incoming road that touches the junction; where both do, the one nearer to the connecting road.
  [[nodiscard]] std::optional<SectionEnd> incoming_end(std::size_t incoming, std::string const& junction,
                                                       SectionEnd const& entry) const {
    auto const& road = document_.roads[incoming];
    auto const touches = [&](std::optional<opendrive::RoadLink> const& link) {
      return link && link->element_type == opendrive::ElementType::junction && link->id == junction;
    };
    bool const at_end = touches(road.successor), at_start = touches(road.predecessor);
    if (!at_end && !at_start) return std::nullopt;
    if (at_end != at_start) return road_end(incoming, at_end ? ContactPoint::end : ContactPoint::start);
    auto const end_point = [&](std::size_t r, ContactPoint end) {
      auto const p = roads_[r].reference_line.at(end == ContactPoint::end ? roads_[r].length : 0.0);
      return geometry::Point(p.x, p.y);
    };
    auto const target = end_point(entry.road, entry.end);
    double const from_end = (end_point(incoming, ContactPoint::end) - target).norm();
    double const from_start = (end_point(incoming, ContactPoint::start) - target).norm();
    return road_end(incoming, from_end <= from_start ? ContactPoint::end : ContactPoint::start);
  }

  OpenDriveDocument const& document_;
  std::vector<Road> const& roads_;
  std::vector<Lane>& lanes_;
  std::string const& file_;
  std::vector<Diagnostic>& diagnostics_;
  std::map<std::string, std::size_t> index_;
};

}  // namespace cambium::map::detail
