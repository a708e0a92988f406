#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "cambium/geometry/pose.hpp"
#include "cambium/map/detail/id_places.hpp"
#include "cambium/map/opendrive/document.hpp"
#include "cambium/map/road/road.hpp"

namespace cambium::inline v0_1::map::detail {

/// A lane section shorter than this [m] has no lanes in the map; links lead through it.
inline constexpr double shortest_section = 1e-6;

/// One end of one lane section of a road.
struct SectionEnd {
  std::size_t road{}, section{};
  opendrive::ContactPoint end = opendrive::ContactPoint::none;

  friend bool operator==(SectionEnd const&, SectionEnd const&) = default;
};

/// The section ends that a link leads to: none, one, or where it meets a road in the middle the two that touch there.
using SectionEnds = std::vector<SectionEnd>;

[[nodiscard]] constexpr opendrive::ContactPoint opposite(opendrive::ContactPoint end) {
  return end == opendrive::ContactPoint::start ? opendrive::ContactPoint::end : opendrive::ContactPoint::start;
}

/// Where the links of a document's roads and the connections of its junctions lead. Keeps references to both.
class RoadLinks {
 public:
  using ContactPoint = opendrive::ContactPoint;

  RoadLinks(OpenDriveDocument const& document, std::vector<Road> const& roads)
      : document_(document), roads_(roads), index_(places_of(document.roads)) {}

  [[nodiscard]] OpenDriveDocument const& document() const { return document_; }
  [[nodiscard]] std::vector<Road> const& roads() const { return roads_; }

  /// The place of the road of that id. O(1) on average.
  [[nodiscard]] std::optional<std::size_t> find(std::string_view id) const {
    auto const at = index_.find(id);
    return at == index_.end() ? std::nullopt : std::optional(at->second);
  }

  [[nodiscard]] SectionEnd road_end(std::size_t road, ContactPoint end) const {
    return {road, end == ContactPoint::end ? roads_[road].sections.size() - 1 : 0, end};
  }

  [[nodiscard]] bool is_road_end(SectionEnd const& at) const {
    return at.end == ContactPoint::end ? at.section + 1 == roads_[at.road].sections.size() : at.section == 0;
  }

  /// What the file says of a lane of the section; null where it is not there. O(lanes).
  [[nodiscard]] opendrive::LaneElement const* written(SectionEnd const& at, int number) const {
    return document_.roads[at.road].lane_sections[at.section].find(number);
  }

  /// The road's link at one of its ends.
  [[nodiscard]] std::optional<opendrive::RoadLink> const& link_at(std::size_t road, ContactPoint end) const {
    auto const& source = document_.roads[road];
    return end == ContactPoint::end ? source.successor : source.predecessor;
  }

  /// Where a road link leads; nowhere where it names a junction (its connections say), no road, or no end of it.
  [[nodiscard]] SectionEnds follow(std::optional<opendrive::RoadLink> const& link) const {
    if (!link || link->element_type != opendrive::ElementType::road) return {};
    auto const road = find(link->id);
    if (!road) return {};
    if (link->element_s) return around(*road, *link->element_s);
    if (link->contact_point == ContactPoint::none) return {};
    return {road_end(*road, link->contact_point)};
  }

  /// What follows the end of a section: the adjacent section, or at the road's end what its link leads to.
  [[nodiscard]] SectionEnds beyond(SectionEnd const& at) const {
    if (is_road_end(at)) return follow(link_at(at.road, at.end));
    bool const ahead = at.end == ContactPoint::end;
    return {{at.road, ahead ? at.section + 1 : at.section - 1, opposite(at.end)}};
  }

  /// The end at which a connection enters its road; none where that road is not there.
  [[nodiscard]] std::optional<SectionEnd> entry_of(opendrive::Connection const& connection) const {
    auto const road = find(connection.entered_road());
    if (!road) return std::nullopt;
    return road_end(*road,
                    connection.contact_point == ContactPoint::none ? ContactPoint::start : connection.contact_point);
  }

  /// The end of a connection's incoming road that touches the junction; where both do, the one that the entered road
  /// names at its `entry`, else the one nearer to that. In a virtual junction the place in the middle of the road that
  /// the entered road names. None where the incoming road is not there, or meets the junction nowhere.
  [[nodiscard]] SectionEnds exits_of(opendrive::JunctionElement const& junction,
                                     opendrive::Connection const& connection, SectionEnd const& entry) const {
    auto const incoming = find(connection.incoming_road);
    if (!incoming) return {};
    auto const touches = [&](ContactPoint end) {
      auto const& link = link_at(*incoming, end);
      return link && link->element_type == opendrive::ElementType::junction && link->id == junction.id;
    };
    bool const at_end = touches(ContactPoint::end), at_start = touches(ContactPoint::start);
    if (at_end != at_start) return {road_end(*incoming, at_end ? ContactPoint::end : ContactPoint::start)};
    auto const& link = link_at(entry.road, entry.end);
    SectionEnds named = link && link->id == connection.incoming_road ? follow(link) : SectionEnds{};
    if (!at_end) return junction.type == opendrive::JunctionType::virtual_ ? named : SectionEnds{};
    if (named.size() == 1 && is_road_end(named[0])) return named;
    bool const by_end = distance(road_end(*incoming, ContactPoint::end), entry) <=
                        distance(road_end(*incoming, ContactPoint::start), entry);
    return {road_end(*incoming, by_end ? ContactPoint::end : ContactPoint::start)};
  }

 private:
  /// Between the reference lines' ends [m].
  [[nodiscard]] double distance(SectionEnd const& a, SectionEnd const& b) const {
    auto const point = [this](SectionEnd const& at) {
      auto const p = roads_[at.road].reference_line.at(at.end == ContactPoint::end ? roads_[at.road].length : 0.0);
      return geometry::Point(p.x, p.y);
    };
    return (point(a) - point(b)).norm();
  }

  /// The section ends that meet at `s` of a road, where sections were split for that (`split_roads`).
  [[nodiscard]] SectionEnds around(std::size_t road, double s) const {
    SectionEnds ends;
    auto const& sections = roads_[road].sections;
    for (std::size_t k = 0; k < sections.size(); ++k) {
      if (std::abs(sections[k].end - s) <= shortest_section && ends.size() < 2)
        ends.push_back({road, k, ContactPoint::end});
      if (std::abs(sections[k].begin - s) <= shortest_section && ends.size() < 2)
        ends.push_back({road, k, ContactPoint::start});
    }
    return ends;
  }

  OpenDriveDocument const& document_;
  std::vector<Road> const& roads_;
  IdPlaces index_;
};

}  // namespace cambium::inline v0_1::map::detail
