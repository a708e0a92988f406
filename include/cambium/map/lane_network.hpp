#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "cambium/geometry/angle.hpp"
#include "cambium/geometry/box.hpp"
#include "cambium/geometry/box_tree.hpp"
#include "cambium/map/lane.hpp"
#include "cambium/map/map.hpp"

namespace cambium::map {

/// What can be odd about how lanes hang together.
enum class NetworkFault : std::uint8_t {
  dangling,       ///< a successor or predecessor that is not in the map
  one_sided,      ///< a successor that does not have the lane as predecessor, or the other way round
  gap,            ///< the path of a successor does not begin where this lane's path ends
  border_step,    ///< the paths meet without a kink, but the borders do not: the width jumps
  kink,           ///< a successor begins in another direction
  possible_link,  ///< the lane has no successor, but ends where a lane without predecessor begins
  dead_end,       ///< the lane has no successor, and nothing begins at its end
  no_way_in,      ///< the lane has no predecessor, and nothing ends at its begin
};

[[nodiscard]] constexpr std::string_view to_string(NetworkFault fault) {
  constexpr std::string_view words[] = {"dangling", "one_sided",     "gap",      "border_step",
                                        "kink",     "possible_link", "dead_end", "no_way_in"};
  return words[static_cast<std::size_t>(fault)];
}

/// One finding about a lane's end (or for `no_way_in` its begin).
struct NetworkFinding {
  NetworkFault fault = NetworkFault::gap;
  LaneId lane = none<LaneId>;
  LaneId other = none<LaneId>;  ///< the lane that it is joined with, or could be; none for dead ends and no way in
  double size{};                ///< distance [m]; of a kink the angle [rad], positive to the left

  friend bool operator==(NetworkFinding const&, NetworkFinding const&) = default;
};

/// From where on a finding is one.
struct NetworkTolerances {
  double gap = 0.01;            ///< between path ends, and between border ends [m]
  double kink = 0.1;            ///< [rad]
  double link_distance = 0.5;   ///< of a possible link [m]
  double link_direction = 0.2;  ///< of a possible link [rad]
};

namespace detail {

/// See `check_lane_network`.
class NetworkCheck {
 public:
  NetworkCheck(std::span<Lane const> lanes, NetworkTolerances const& tolerances)
      : lanes_(lanes), tolerances_(tolerances) {}

  [[nodiscard]] std::vector<NetworkFinding> run() {
    find_possible_links([](Lane const&, Lane const&) { return true; });
    for (auto const& lane : lanes_) {
      check_links(lane, lane.successors, &Lane::predecessors);
      check_links(lane, lane.predecessors, &Lane::successors);
      if (!lane.drivable() || lane.path.empty()) continue;
      for (auto const next : lane.successors) check_joint(lane, next);
      add_end(lane);
    }
    return std::move(findings_);
  }

  /// The possible links alone, by lane: of those that `permits(from, to)`.
  template <class Permits>
  std::vector<NetworkFinding> const& find_possible_links(Permits const& permits) {
    collect_begins();
    for (auto const& lane : lanes_)
      if (lane.drivable() && !lane.path.empty() && lane.successors.empty()) find_possible_link(lane, permits);
    for (auto const& finding : possible_) entered_.push_back(finding.other);
    std::sort(entered_.begin(), entered_.end());
    return possible_;
  }

 private:
  [[nodiscard]] static geometry::Pose begin_of(geometry::Line const& line) {
    std::uint32_t first = 0;
    return line.pose(0.0, first);
  }
  [[nodiscard]] static geometry::Pose end_of(geometry::Line const& line) {
    auto last = static_cast<std::uint32_t>(line.segments().size() - 1);
    return line.pose(line.length(), last);
  }
  [[nodiscard]] static double distance(geometry::Line const& before, geometry::Line const& behind) {
    if (before.empty() || behind.empty()) return 0.0;  // a border without length
    return (end_of(before).position() - begin_of(behind).position()).norm();
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
    double const turn = geometry::angle_difference(begin_of(next.path).heading, end_of(lane.path).heading);
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
      places.emplace_back().add(begin_of(lane.path).x, begin_of(lane.path).y);
    }
    begin_tree_ = geometry::BoxTree(places);
  }

  /// The nearest begin within the tolerances; of equal ones the first lane's.
  template <class Permits>
  void find_possible_link(Lane const& lane, Permits const& permits) {
    auto const end = end_of(lane.path);
    double const reach = tolerances_.link_distance;
    double best = reach;
    LaneId with = none<LaneId>;
    begin_tree_.visit({end.x - reach, end.y - reach, end.x + reach, end.y + reach}, [&](std::uint32_t i) {
      auto const& other = lanes_[index_of(begins_[i])];
      if (other.id == lane.id || other.id == lane.opposite) return false;
      auto const begin = begin_of(other.path);
      double const apart = (begin.position() - end.position()).norm();
      if (!(apart < best || (apart == best && !(with < other.id)))) return false;
      if (std::abs(geometry::angle_difference(begin.heading, end.heading)) > tolerances_.link_direction) return false;
      if (!permits(lane, other)) return false;
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

}  // namespace detail

/// What is odd about how the lanes hang together, lane by lane in the order of their ids. Links of all lanes are
/// looked at; joints and ends only of drivable ones. Dead ends and lanes without a way in are no fault at the border
/// of a map. The number of a lane must be its place in `lanes`. O(n log n).
[[nodiscard]] inline std::vector<NetworkFinding> check_lane_network(std::span<Lane const> lanes,
                                                                    NetworkTolerances const& tolerances = {}) {
  return detail::NetworkCheck(lanes, tolerances).run();
}

/// As above, for a map, whoever built it.
[[nodiscard]] inline std::vector<NetworkFinding> check_lane_network(Map const& map,
                                                                    NetworkTolerances const& tolerances = {}) {
  return check_lane_network(map.lanes(), tolerances);
}

}  // namespace cambium::map

namespace cambium {
using map::check_lane_network;
using map::NetworkFault;
using map::NetworkFinding;
}  // namespace cambium
