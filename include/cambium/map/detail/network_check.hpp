#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "cambium/geometry/angle.hpp"
#include "cambium/geometry/box.hpp"
#include "cambium/geometry/box_tree.hpp"
#include "cambium/map/lanes/lane.hpp"
#include "cambium/map/lanes/lane_network.hpp"
#include "cambium/map/map.hpp"

namespace cambium::inline v0_1::map::detail {

/// See `check_lane_network`.
class NetworkCheck {
 public:
  NetworkCheck(std::span<Lane const> lanes, NetworkTolerances const& tolerances)
      : lanes_(lanes), tolerances_(tolerances) {}

  [[nodiscard]] std::vector<NetworkFinding> run() {
    find_possible_links([this](Lane const&, Lane const&) { return tolerances_.link_direction; });
    for (auto const& lane : lanes_) {
      check_links(lane, lane.successors, &Lane::predecessors);
      check_links(lane, lane.predecessors, &Lane::successors);
      if (!lane.drivable() || lane.path.empty()) continue;
      for (auto const next : lane.successors) check_joint(lane, next);
      add_end(lane);
    }
    return std::move(findings_);
  }

  /// The possible links alone, by lane; `turn(from, to)` is the largest turn of a link [rad], negative for none.
  template <class Turn>
  std::vector<NetworkFinding> const& find_possible_links(Turn const& turn) {
    collect_begins();
    for (auto const& lane : lanes_)
      if (lane.drivable() && !lane.path.empty() && lane.successors.empty()) find_possible_link(lane, turn);
    for (auto const& finding : possible_) entered_.push_back(finding.other);
    std::sort(entered_.begin(), entered_.end());
    return possible_;
  }

 private:
  [[nodiscard]] static double distance(geometry::Line const& before, geometry::Line const& behind) {
    if (before.empty() || behind.empty()) return 0.0;  // a border without length
    return (before.end_pose().position() - behind.begin_pose().position()).norm();
  }

  void check_links(Lane const& lane, std::vector<LaneId> const& links, std::vector<LaneId> Lane::*back) {
    for (auto const id : links) {
      if (index_of(id) >= lanes_.size()) {
        findings_.push_back({NetworkFault::dangling, lane.id, id, 0.0});
        continue;
      }
      auto const& others = lanes_[index_of(id)].*back;
      if (std::find(others.begin(), others.end(), lane.id) == others.end())
        findings_.push_back({NetworkFault::one_sided, lane.id, id, 0.0});
    }
  }

  void check_joint(Lane const& lane, LaneId id) {
    if (index_of(id) >= lanes_.size()) return;
    auto const& next = lanes_[index_of(id)];
    if (!next.drivable() || next.path.empty()) return;
    double const gap = distance(lane.path, next.path);
    if (gap > tolerances_.gap) findings_.push_back({NetworkFault::gap, lane.id, id, gap});
    double const turn = geometry::angle_difference(next.path.begin_pose().heading, lane.path.end_pose().heading);
    bool const is_kink = std::abs(turn) > tolerances_.kink;
    if (is_kink) findings_.push_back({NetworkFault::kink, lane.id, id, turn});
    double const step = std::max(distance(lane.left, next.left), distance(lane.right, next.right));
    // A lane that has merged is beside its successor with one border at least.
    if (!is_kink && gap <= tolerances_.gap && step > tolerances_.gap && !is_valid(lane.merges_into))
      findings_.push_back({NetworkFault::border_step, lane.id, id, step});
  }

  void add_end(Lane const& lane) {
    if (lane.successors.empty()) {
      auto const at = std::lower_bound(possible_.begin(), possible_.end(), lane.id,
                                       [](NetworkFinding const& f, LaneId id) { return f.lane < id; });
      bool const is_possible = at != possible_.end() && at->lane == lane.id;
      findings_.push_back(is_possible ? *at : NetworkFinding{NetworkFault::dead_end, lane.id});
    }
    if (lane.predecessors.empty() && !std::binary_search(entered_.begin(), entered_.end(), lane.id))
      findings_.push_back({NetworkFault::no_way_in, lane.id});
  }

  void collect_begins() {
    std::vector<geometry::Box> places;
    for (auto const& lane : lanes_) {
      if (!lane.drivable() || lane.path.empty() || !lane.predecessors.empty()) continue;
      begins_.push_back(lane.id);
      auto const begin = lane.path.begin_pose().position();
      places.push_back(geometry::box_around({&begin, 1}));
    }
    begin_tree_ = geometry::BoxTree(places);
  }

  /// The nearest begin within `link_distance`, and whose direction differs by `turn(lane, other)` at most; of equal
  /// ones the first lane's.
  template <class Turn>
  void find_possible_link(Lane const& lane, Turn const& turn) {
    auto const end = lane.path.end_pose();
    double const reach = tolerances_.link_distance;
    double best = reach;
    LaneId with = none<LaneId>;
    begin_tree_.visit({end.x - reach, end.y - reach, end.x + reach, end.y + reach}, [&](std::uint32_t i) {
      auto const& other = lanes_[index_of(begins_[i])];
      if (other.id == lane.id || other.id == lane.opposite) return false;
      auto const begin = other.path.begin_pose();
      double const apart = (begin.position() - end.position()).norm();
      if (!(apart < best || (apart == best && !(with < other.id)))) return false;
      if (!(std::abs(geometry::angle_difference(begin.heading, end.heading)) <= turn(lane, other))) return false;
      best = apart;
      with = other.id;
      return false;
    });
    if (is_valid(with)) possible_.push_back({NetworkFault::possible_link, lane.id, with, best});
  }

  std::span<Lane const> lanes_;
  NetworkTolerances const& tolerances_;
  std::vector<LaneId> begins_;            ///< lanes without predecessor
  geometry::BoxTree begin_tree_;          ///< of the points where these begin
  std::vector<NetworkFinding> possible_;  ///< by lane
  std::vector<LaneId> entered_;           ///< the others of those, sorted
  std::vector<NetworkFinding> findings_;
};

}  // namespace cambium::inline v0_1::map::detail
