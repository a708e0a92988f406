#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "cambium/map/building/detail/road_links.hpp"
#include "cambium/map/detail/findings.hpp"
#include "cambium/map/lanes/lane.hpp"
#include "cambium/map/map.hpp"
#include "cambium/map/opendrive/document.hpp"

namespace cambium::inline v0_1::map::detail {

/// Enters that `to` follows `from`.
inline void join_lanes(Lane& from, Lane& to) {
  from.successors.push_back(to.id);
  to.predecessors.push_back(from.id);
}

/// Joins lanes by what the file says, in the direction of travel. Links are read from both sides; each is entered once.
/// They lead through sections that are too short for lanes in the map. A link into the middle of a road (virtual
/// junctions) joins what is driven into that place with what is driven out of it; "elementDir" is not needed for that.
class LaneLinker {
 public:
  LaneLinker(RoadLinks const& links, std::vector<Lane>& lanes, Findings& findings)
      : links_(links), roads_(links.roads()), lanes_(lanes), findings_(findings) {}

  void link() {
    auto const& document = links_.document();
    for (std::size_t r = 0; r < document.roads.size(); ++r) link_road(r);
    for (auto const& junction : document.junctions)
      for (auto const& connection : junction.connections) link_connection(junction, connection);
    for (auto& lane : lanes_) {
      sort_unique(lane.successors);
      sort_unique(lane.predecessors);
    }
  }

 private:
  using ContactPoint = opendrive::ContactPoint;

  static void sort_unique(std::vector<LaneId>& ids) {
    std::sort(ids.begin(), ids.end());
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  }

  void warn(int line, std::string element, std::string ids, std::string sentence) const {
    findings_.add(Severity::warning, line, std::move(element), std::move(ids), std::move(sentence));
  }

  [[nodiscard]] bool is_written(SectionEnds const& ends, int number) const {
    return std::any_of(ends.begin(), ends.end(),
                       [&](SectionEnd const& at) { return links_.written(at, number) != nullptr; });
  }

  /// Calls `visit(RoadLane, end)` for lane `number` at a section's end; where the section is too short for lanes, for
  /// those behind it that the lane is linked to.
  template <class Visit>
  void visit_lanes(SectionEnd const& at, int number, Visit const& visit) const {
    int steps = 64;  // through short sections
    visit_lanes(at, number, visit, steps);
  }

  template <class Visit>
  void visit_lanes(SectionEnd const& at, int number, Visit const& visit, int& steps) const {
    auto const& section = roads_[at.road].sections[at.section];
    if (section.end - section.begin >= shortest_section) {
      for (auto const& lane : section.lanes)
        if (lane.number == number && is_valid(lane.id)) visit(lane, at.end);
      return;
    }
    auto const* lane = links_.written(at, number);
    if (lane == nullptr) return;
    SectionEnd const other{at.road, at.section, opposite(at.end)};
    for (auto const& next : links_.beyond(other))
      for (int const to : other.end == ContactPoint::end ? lane->successors : lane->predecessors)
        if (--steps >= 0) visit_lanes(next, to, visit, steps);
  }

  /// Enters that lane `number` at a section's end meets lane `to` at the others, whichever way each is driven.
  void join(SectionEnd const& from, int number, SectionEnds const& others, int to, int line) {
    bool met = false, joined = false;
    LaneId of = none<LaneId>, with = none<LaneId>;
    visit_lanes(from, number, [&](RoadLane const& a, ContactPoint end_a) {
      for (auto const& other : others)
        visit_lanes(other, to, [&](RoadLane const& b, ContactPoint end_b) {
          met = true;
          of = a.id;
          with = b.id;
          for (auto const first : {a.id, a.opposite})
            for (auto const second : {b.id, b.opposite}) joined = join(first, end_a, second, end_b) || joined;
        });
    });
    if (!met || joined || of == with) return;
    auto const &a = lanes_[index_of(of)], &b = lanes_[index_of(with)];
    if (a.drivable() && b.drivable())
      warn(line, "link", "road " + roads_[index_of(a.road)].name + ", lane " + std::to_string(a.number),
           "it is linked to road " + roads_[index_of(b.road)].name + ", lane " + std::to_string(b.number) +
               ", which is driven the other way; the link was left out");
  }

  /// True where one of the lanes is driven into the place where their ends meet, the other out of it.
  bool join(LaneId a, ContactPoint end_a, LaneId b, ContactPoint end_b) {
    if (!is_valid(a) || !is_valid(b) || a == b) return false;
    auto &la = lanes_[index_of(a)], &lb = lanes_[index_of(b)];
    bool const leaves_a = la.along_road == (end_a == ContactPoint::end);
    bool const leaves_b = lb.along_road == (end_b == ContactPoint::end);
    if (leaves_a == leaves_b || la.opposite == b) return false;
    leaves_a ? join_lanes(la, lb) : join_lanes(lb, la);
    return true;
  }

  void link_road(std::size_t r) {
    auto const& road = links_.document().roads[r];
    for (auto const* link : {&road.predecessor, &road.successor})
      if (*link && (*link)->element_s && links_.find((*link)->id) && links_.follow(*link).empty())
        warn((*link)->line, link == &road.predecessor ? "predecessor" : "successor", "road " + road.id,
             "its elementS does not lie inside road " + (*link)->id + "; the link was left out");
    for (std::size_t k = 0; k < road.lane_sections.size(); ++k) {
      SectionEnd const start{r, k, ContactPoint::start}, end{r, k, ContactPoint::end};
      SectionEnds const before = links_.beyond(start), behind = links_.beyond(end);
      for (auto const& lane : road.lane_sections[k].lanes) {
        if (lane.id == 0) continue;
        link_lane(end, lane, lane.successors, behind);
        link_lane(start, lane, lane.predecessors, before);
      }
    }
  }

  void link_lane(SectionEnd const& at, opendrive::LaneElement const& lane, std::vector<int> const& numbers,
                 SectionEnds const& others) {
    if (others.empty()) return;
    for (int const number : numbers) {
      std::size_t const other = others[0].road;
      // The reader says so of sections of one road.
      if (number != 0 && links_.is_road_end(at) && !is_written(others, number))
        warn(lane.line, "link",
             "road " + roads_[at.road].name + ", section " + std::to_string(at.section) + ", lane " +
                 std::to_string(lane.id),
             "it names lane " + std::to_string(number) + " of road " + roads_[other].name +
                 ", which does not exist; the link was left out");
      join(at, lane.id, others, number, lane.line);
    }
  }

  void link_connection(opendrive::JunctionElement const& junction, opendrive::Connection const& connection) {
    auto const entry = links_.entry_of(connection);
    if (!entry || !links_.find(connection.incoming_road)) return;  // the reader has said so
    std::string const ids = "junction " + junction.id + ", connection " + connection.id;
    auto const exits = links_.exits_of(junction, connection, *entry);
    if (exits.empty()) {
      warn(connection.line, "connection", ids,
           "road " + connection.incoming_road +
               ((junction.type == opendrive::JunctionType::virtual_)
                    ? " does not meet the connecting road: that gives no elementS; the connection was left out"
                    : " is not linked to this junction; lanes are joined by their own links, or where they meet"));
      return;
    }
    for (auto const& link : connection.lane_links) {
      if (!is_written(exits, link.from) || links_.written(*entry, link.to) == nullptr)
        warn(connection.line, "laneLink", ids,
             "lane " + std::to_string(link.from) + " of road " + connection.incoming_road + " or lane " +
                 std::to_string(link.to) + " of road " + connection.entered_road() +
                 " does not exist; the link was left out");
      join(*entry, link.to, exits, link.from, connection.line);
    }
  }

  RoadLinks const& links_;
  std::vector<Road> const& roads_;
  std::vector<Lane>& lanes_;
  Findings& findings_;
};

}  // namespace cambium::inline v0_1::map::detail
