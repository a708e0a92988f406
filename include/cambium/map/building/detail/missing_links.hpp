#pragma once

#include <algorithm>
#include <numbers>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "cambium/map/building/detail/lane_links.hpp"
#include "cambium/map/building/detail/road_links.hpp"
#include "cambium/map/detail/findings.hpp"
#include "cambium/map/detail/network_check.hpp"
#include "cambium/map/lanes/lane.hpp"
#include "cambium/map/lanes/lane_network.hpp"
#include "cambium/map/map.hpp"

namespace cambium::inline v0_1::map::detail {

/// Finds links that a file seems to have forgotten: where a lane ends and another begins, neither is linked, and the
/// links of their roads (or that there are none) permit it.
class MissingLinks {
 public:
  MissingLinks(RoadLinks const& links, std::vector<Lane>& lanes, Findings& findings)
      : links_(links), lanes_(lanes), findings_(findings) {}

  /// Reports the possible links, and enters them when asked to, or where the file links their roads. The lanes that
  /// were left as dead ends.
  [[nodiscard]] std::set<LaneId> find(bool infer) {
    std::set<LaneId> dead_ends;
    NetworkTolerances const tolerances;
    NetworkCheck check(lanes_, tolerances);
    auto const turn = [&](Lane const& from, Lane const& to) {
      if (is_linked(from, to)) return std::numbers::pi;
      return permits(exit_of(from), entry_of(to)) && permits(entry_of(to), exit_of(from)) ? tolerances.link_direction
                                                                                          : -1.0;
    };
    for (auto const& finding : check.find_possible_links(turn)) {
      auto& from = lanes_[index_of(finding.lane)];
      auto& to = lanes_[index_of(finding.other)];
      bool const joins = infer || is_linked(from, to);
      report(joins ? Severity::info : Severity::warning, from,
             "it has no successor, but " + describe(to) + " begins where it ends; " +
                 (joins ? "the two were joined" : "is the link missing? It was left as a dead end"));
      if (joins)
        join_lanes(from, to);
      else
        dead_ends.insert(from.id);
    }
    for (auto& lane : lanes_) std::sort(lane.predecessors.begin(), lane.predecessors.end());
    return dead_ends;
  }

  /// Reports dead ends where, by the road's link, the lane of the same id continues. Call it after merging.
  void report_dead_ends(std::set<LaneId> const& reported) {
    for (auto const& lane : lanes_) {
      if (!lane.drivable() || !lane.successors.empty() || reported.contains(lane.id)) continue;
      auto const exit = exit_of(lane);
      if (!links_.is_road_end(exit)) continue;
      for (auto const& next : links_.beyond(exit)) report_dead_end(lane, exit, next);
    }
  }

 private:
  using ContactPoint = opendrive::ContactPoint;

  [[nodiscard]] static SectionEnd exit_of(Lane const& lane) {
    return {index_of(lane.road), lane.section, lane.along_road ? ContactPoint::end : ContactPoint::start};
  }
  [[nodiscard]] static SectionEnd entry_of(Lane const& lane) {
    return {index_of(lane.road), lane.section, lane.along_road ? ContactPoint::start : ContactPoint::end};
  }

  /// Whether the road's link at one section's end leads to the other.
  [[nodiscard]] bool leads(SectionEnd const& at, SectionEnd const& other) const {
    auto const beyond = links_.beyond(at);
    return std::find(beyond.begin(), beyond.end(), other) != beyond.end();
  }

  /// Whether the file links the sections of two lanes, or connects their roads without naming lanes.
  [[nodiscard]] bool is_linked(Lane const& from, Lane const& to) const {
    auto const exit = exit_of(from), entry = entry_of(to);
    return leads(exit, entry) || leads(entry, exit) || is_connected(exit, entry) || is_connected(entry, exit);
  }

  /// Whether a junction connects the incoming road of `at` with the road of `other` and names no lanes; or has the road
  /// of `other` as a connecting road that nothing is linked to there, and lies at `at`.
  [[nodiscard]] bool is_connected(SectionEnd const& at, SectionEnd const& other) const {
    auto const& roads = links_.document().roads;
    if (!links_.is_road_end(at) || !links_.is_road_end(other)) return false;
    auto const& link = links_.link_at(at.road, at.end);
    auto const& back = links_.link_at(other.road, other.end);
    if (link && link->element_type != opendrive::ElementType::junction) return false;
    for (auto const& junction : links_.document().junctions)
      for (auto const& connection : junction.connections) {
        if ((link && junction.id != link->id) || connection.entered_road() != roads[other.road].id) continue;
        if (connection.incoming_road == roads[at.road].id && (connection.lane_links.empty() || (!link && !back)))
          return true;
        if (link && !back && roads[other.road].junction == junction.id) return true;
      }
    return false;
  }

  /// Whether what is linked to the section's end `at`, if anything is, can be `other`.
  [[nodiscard]] bool permits(SectionEnd const& at, SectionEnd const& other) const {
    if (links_.is_road_end(at)) {
      auto const& link = links_.link_at(at.road, at.end);
      if (link && link->element_type == opendrive::ElementType::junction) return touches(other, link->id);
    }
    auto const beyond = links_.beyond(at);
    return beyond.empty() || std::find(beyond.begin(), beyond.end(), other) != beyond.end();
  }

  /// Whether a road's end is of a connecting road of the junction, or linked to it.
  [[nodiscard]] bool touches(SectionEnd const& at, std::string const& junction) const {
    if (!links_.is_road_end(at)) return false;
    if (links_.document().roads[at.road].junction == junction) return true;
    auto const& link = links_.link_at(at.road, at.end);
    return link && link->element_type == opendrive::ElementType::junction && link->id == junction;
  }

  void report_dead_end(Lane const& lane, SectionEnd const& exit, SectionEnd const& next) {
    int const number = exit.end == next.end ? -lane.number : lane.number;
    for (auto const& beyond : links_.roads()[next.road].sections[next.section].lanes) {
      if (beyond.number != number || !is_valid(beyond.id)) continue;
      auto const& other = lanes_[index_of(beyond.id)];
      if (other.drivable() && entry_of(other) == next)
        report(Severity::warning, lane,
               "it ends here, but " + describe(other) + " continues from there; is the link missing?");
    }
  }

  [[nodiscard]] std::string describe(Lane const& lane) const {
    return "lane " + std::to_string(lane.number) + " of road " + links_.roads()[index_of(lane.road)].name;
  }

  void report(Severity severity, Lane const& lane, std::string sentence) {
    auto const& road = links_.document().roads[index_of(lane.road)];
    auto const* written = road.lane_sections[lane.section].find(lane.number);
    findings_.add(severity, written != nullptr ? static_cast<int>(written->line) : 0, "link",
                  "road " + road.id + ", lane " + std::to_string(lane.number), std::move(sentence));
  }

  RoadLinks const& links_;
  std::vector<Lane>& lanes_;
  Findings& findings_;
};

}  // namespace cambium::inline v0_1::map::detail
