#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "cambium/core/error.hpp"
#include "cambium/core/ids.hpp"
#include "cambium/map/building/detail/road_links.hpp"
#include "cambium/map/detail/findings.hpp"
#include "cambium/map/lanes/lane_network.hpp"

namespace cambium::inline v0_1::map::detail {

/// Reports links that only one side knows, and joined lanes that do not meet: a line for each pair of roads.
class LinkCheck {
 public:
  LinkCheck(RoadLinks const& links, Findings& findings) : links_(links), findings_(findings) {}

  /// What the document says from one side only.
  void report_one_sided() {
    auto const& roads = links_.document().roads;
    for (std::size_t r = 0; r < roads.size(); ++r) {
      for (auto const end : {ContactPoint::start, ContactPoint::end}) check_road_link(r, end);
      check_lane_links(r);
      check_short_sections(r);
    }
    check_connections();
  }

  /// Gaps and kinks between lanes that were joined: one finding for each pair of roads, with the largest of each.
  void report_joints(std::span<Lane const> lanes) {
    std::map<std::pair<RoadId, RoadId>, Joint> joints;
    for (auto const& finding : check_lane_network(lanes)) {
      auto const kind = std::find(std::begin(joint_faults), std::end(joint_faults), finding.fault);
      if (kind == std::end(joint_faults)) continue;
      RoadId const a = lanes[index_of(finding.lane)].road, b = lanes[index_of(finding.other)].road;
      auto& joint = joints[std::minmax(a, b)];
      joint.lanes.emplace(finding.lane, finding.other);
      auto& worst = joint.worst[kind - std::begin(joint_faults)];
      if (!worst || std::abs(finding.size) > std::abs(worst->size)) worst = finding;
    }
    for (auto const& [roads, joint] : joints) report_joint(lanes, joint);
  }

 private:
  using ContactPoint = opendrive::ContactPoint;
  static constexpr NetworkFault joint_faults[] = {NetworkFault::gap, NetworkFault::border_step, NetworkFault::kink};

  /// What is wrong where lanes of two roads are joined.
  struct Joint {
    std::optional<NetworkFinding> worst[std::size(joint_faults)]{};
    std::set<std::pair<LaneId, LaneId>> lanes{};
  };

  /// A road's link must be known to the road that it leads to, or to the junction that lies there.
  void check_road_link(std::size_t r, ContactPoint end) {
    auto const& link = links_.link_at(r, end);
    if (!link || link->element_s) return;
    auto const others = links_.follow(link);
    if (others.empty()) return;
    SectionEnd const at = links_.road_end(r, end);
    auto const& road = links_.document().roads[r];
    auto const& back = links_.link_at(others[0].road, others[0].end);
    // The road before a junction names that, not the connecting roads; a direct junction may be named by one side only.
    if (back && back->element_type == opendrive::ElementType::junction) return;
    auto const returns = links_.follow(back);
    if (std::find(returns.begin(), returns.end(), at) != returns.end()) return;
    findings_.add(Severity::warning, link->line, end == ContactPoint::end ? "successor" : "predecessor",
                  "road " + road.id,
                  "it names the " + std::string(others[0].end == ContactPoint::end ? "end" : "start") + " of road " +
                      link->id + ", which " + (back ? "names another place" : "names nothing there") +
                      "; lanes are joined by what either side says");
  }

  /// Lanes that name a lane which names others at that place, or none.
  void check_lane_links(std::size_t r) {
    auto const& road = links_.document().roads[r];
    int count = 0, one_sided = 0;
    std::string first, first_one_sided;
    int line = 0, line_one_sided = 0;
    auto const check = [&](SectionEnd const& at, opendrive::LaneElement const& lane, std::vector<int> const& numbers) {
      auto const others = links_.beyond(at);
      if (others.size() != 1 || numbers.empty()) return;
      auto const& other = others[0];
      auto const& section = links_.document().roads[other.road].lane_sections[other.section];
      auto const returns = links_.beyond(other);
      if (std::find(returns.begin(), returns.end(), at) == returns.end()) return;  // the road's link is not known there
      for (int const number : numbers) {
        auto const* named = section.find(number);
        if (named == nullptr || lane.id == 0) continue;
        auto const& back = other.end == ContactPoint::end ? named->successors : named->predecessors;
        if (std::find(back.begin(), back.end(), lane.id) != back.end()) continue;
        if ((back.empty() ? one_sided : count)++ > 0) continue;
        (back.empty() ? line_one_sided : line) = lane.line;
        (back.empty() ? first_one_sided : first) =
            "lane " + std::to_string(lane.id) + " of section " + std::to_string(at.section) + " names lane " +
            std::to_string(number) + " of road " + links_.document().roads[other.road].id + ", which names " +
            (back.empty() ? "none back" : "lane " + std::to_string(back.front()));
      }
    };
    for (std::size_t k = 0; k < road.lane_sections.size(); ++k)
      for (auto const& lane : road.lane_sections[k].lanes) {
        check({r, k, ContactPoint::start}, lane, lane.predecessors);
        check({r, k, ContactPoint::end}, lane, lane.successors);
      }
    if (count > 0)
      findings_.add(Severity::info, line, "link", "road " + road.id,
                    first + others_text(count) + "; the lanes were joined");
    if (one_sided > 0)
      findings_.add(Severity::info, line_one_sided, "link", "road " + road.id,
                    first_one_sided + others_text(one_sided) + "; the lanes were joined");
  }

  /// Connections that name no lanes: their lanes' own links count, or where their ends meet.
  void check_connections() {
    for (auto const& junction : links_.document().junctions)
      for (auto const& connection : junction.connections)
        if (connection.lane_links.empty() && links_.find(connection.incoming_road) &&
            links_.find(connection.entered_road()))
          findings_.add(Severity::info, connection.line, "connection",
                        "junction " + junction.id + ", connection " + connection.id,
                        "it names no lanes; they are joined by their own links, or where they meet");
  }

  void check_short_sections(std::size_t r) {
    int count = 0, line = 0;
    auto const& sections = links_.roads()[r].sections;
    for (std::size_t k = 0; k < sections.size(); ++k)
      if (sections[k].end - sections[k].begin < shortest_section && count++ == 0)
        line = links_.document().roads[r].lane_sections[k].line;
    if (count > 0)
      findings_.add(Severity::info, line, "laneSection", "road " + links_.roads()[r].name,
                    "it has no length" + others_text(count) + "; its lanes are not in the map, links lead through it");
  }

  [[nodiscard]] static std::string others_text(int count) {
    return count > 1 ? " (and " + std::to_string(count - 1) + " more such)" : "";
  }

  void report_joint(std::span<Lane const> lanes, Joint const& joint) {
    constexpr double sharp = 0.5;  // [rad], own choice: no road that was surveyed turns so at a point
    auto const& [gap, step, kink] = joint.worst;
    auto const& finding = gap ? *gap : step ? *step : *kink;
    auto const &lane = lanes[index_of(finding.lane)], &next = lanes[index_of(finding.other)];
    auto const name = [&](Lane const& l) { return links_.roads()[index_of(l.road)].name; };
    auto const* written = links_.document().roads[index_of(lane.road)].lane_sections[lane.section].find(lane.number);
    std::string what;
    auto const add = [&](std::optional<NetworkFinding> const& fault, std::string const& before, char const* behind) {
      if (fault)
        what += (what.empty() ? "" : ", ") + before + cambium::detail::rounded_text(std::abs(fault->size)) + behind;
    };
    add(gap, "", " m away from where it ends");
    add(step, "with a border ", " m away from its own");
    add(kink, "", " rad off its direction");
    findings_.add(
        gap || (kink && std::abs(kink->size) > sharp) ? Severity::warning : Severity::info,
        written != nullptr ? static_cast<int>(written->line) : 0, "link",
        "road " + name(lane) + ", section " + std::to_string(lane.section) + ", lane " + std::to_string(lane.number),
        "lane " + std::to_string(next.number) + " of road " + name(next) + ", section " + std::to_string(next.section) +
            ", continues " + what + others_text(static_cast<int>(joint.lanes.size())) + "; the link was kept");
  }

  RoadLinks const& links_;
  Findings& findings_;
};

}  // namespace cambium::inline v0_1::map::detail
