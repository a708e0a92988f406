#pragma once

#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "cambium/map/map.hpp"
#include "cambium/map/opendrive_document.hpp"

namespace cambium::map::detail {

/// A lane section shorter than this [m] has no lanes in the map; links lead through it.
inline constexpr double shortest_section = 1e-6;

/// One end of one lane section of a road.
struct SectionEnd {
  std::size_t road{}, section{};
  opendrive::ContactPoint end = opendrive::ContactPoint::none;

  friend bool operator==(SectionEnd const&, SectionEnd const&) = default;
};

/// The section ends that a link leads to: none, one, or where it meets a road in the middle the two that touch there.
struct SectionEnds {
  SectionEnd at[2];
  std::size_t count = 0;

  [[nodiscard]] SectionEnd const* begin() const { return at; }
  [[nodiscard]] SectionEnd const* end() const { return at + count; }
};

[[nodiscard]] constexpr opendrive::ContactPoint opposite(opendrive::ContactPoint end) {
  return end == opendrive::ContactPoint::start ? opendrive::ContactPoint::end : opendrive::ContactPoint::start;
}

/// Where the links of a document's roads lead. Keeps references to both.
class RoadLinks {
 public:
  using ContactPoint = opendrive::ContactPoint;

  RoadLinks(OpenDriveDocument const& document, std::vector<Road> const& roads) : document_(document), roads_(roads) {
    for (std::size_t i = 0; i < document.roads.size(); ++i) index_.emplace(document.roads[i].id, i);
  }

  [[nodiscard]] OpenDriveDocument const& document() const { return document_; }
  [[nodiscard]] std::vector<Road> const& roads() const { return roads_; }

  /// The place of the road of that id. O(log roads).
  [[nodiscard]] std::optional<std::size_t> find(std::string const& id) const {
    auto const at = index_.find(id);
    return at == index_.end() ? std::nullopt : std::optional(at->second);
  }

  [[nodiscard]] SectionEnd road_end(std::size_t road, ContactPoint end) const {
    return {road, end == ContactPoint::end ? roads_[road].sections.size() - 1 : 0, end};
  }

  [[nodiscard]] bool is_road_end(SectionEnd const& at) const {
    return at.end == ContactPoint::end ? at.section + 1 == roads_[at.road].sections.size() : at.section == 0;
  }

  /// The road's link at one of its ends.
  [[nodiscard]] std::optional<opendrive::RoadLink> const& link_at(std::size_t road, ContactPoint end) const {
    auto const& source = document_.roads[road];
    return end == ContactPoint::end ? source.successor : source.predecessor;
  }

  /// Where a road link leads; nowhere where it names a junction (its connections say), no road, or no end of it.
  [[nodiscard]] SectionEnds follow(std::optional<opendrive::RoadLink> const& link) const {
    SectionEnds ends;
    if (!link || link->element_type != opendrive::ElementType::road) return ends;
    auto const road = find(link->id);
    if (!road) return ends;
    if (link->element_s) return around(*road, *link->element_s);
    if (link->contact_point != ContactPoint::none) ends.at[ends.count++] = road_end(*road, link->contact_point);
    return ends;
  }

  /// What lies behind the end of a section: the section beside, or at the road's end what its link leads to.
  [[nodiscard]] SectionEnds beyond(SectionEnd const& at) const {
    if (is_road_end(at)) return follow(link_at(at.road, at.end));
    bool const ahead = at.end == ContactPoint::end;
    return {{{at.road, ahead ? at.section + 1 : at.section - 1, opposite(at.end)}, {}}, 1};
  }

 private:
  /// The section ends that meet at `s` of a road, where sections were split for that (`split_roads`).
  [[nodiscard]] SectionEnds around(std::size_t road, double s) const {
    SectionEnds ends;
    auto const& sections = roads_[road].sections;
    for (std::size_t k = 0; k < sections.size(); ++k) {
      if (std::abs(sections[k].end - s) <= shortest_section && ends.count < 2)
        ends.at[ends.count++] = {road, k, ContactPoint::end};
      if (std::abs(sections[k].begin - s) <= shortest_section && ends.count < 2)
        ends.at[ends.count++] = {road, k, ContactPoint::start};
    }
    return ends;
  }

  OpenDriveDocument const& document_;
  std::vector<Road> const& roads_;
  std::map<std::string, std::size_t> index_;
};

}  // namespace cambium::map::detail
