#pragma once

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include "cambium/core/ids.hpp"
#include "cambium/map/building/detail/lane_geometry.hpp"
#include "cambium/map/building/detail/section_sampler.hpp"
#include "cambium/map/lanes/lane.hpp"
#include "cambium/map/map.hpp"

namespace cambium::map::detail {

/// Lets lanes that end while their neighbour goes on merge into that one; not those in `dead_ends`. A lane that is
/// linked to a neighbour's successor beside its own end ends, too.
class LaneMerger {
 public:
  LaneMerger(std::vector<Road> const& roads, std::vector<Lane>& lanes, MapOptions const& options,
             std::set<LaneId> dead_ends)
      : roads_(roads), lanes_(lanes), options_(options), dead_ends_(std::move(dead_ends)) {}

  void merge() {
    for (auto& lane : lanes_)
      if (lane.drivable() && lane.successors.size() == 1) unlink_aside(lane);
    // From the lanes that go on outwards: one may merge into another that merges itself.
    for (bool found = true; found;) {
      found = false;
      for (auto& lane : lanes_)
        if (lane.drivable() && lane.successors.empty() && find_merge(lane)) found = swing(lane) || found;
    }
  }

 private:
  /// Takes a link back that leads to a neighbour's successor, which begins aside of where the lane ends.
  void unlink_aside(Lane& lane) {
    constexpr double aside = 0.5;  // [m]
    auto& next = lanes_[index_of(lane.successors.front())];
    if ((next.path.pose(0.0).position() - lane.path.pose(lane.length()).position()).norm() < aside) return;
    for (auto const side : {lane.left_neighbor, lane.right_neighbor}) {
      if (!is_valid(side)) continue;
      auto const& beside = lanes_[index_of(side)];
      auto const end = beside.path.pose(beside.length()).position();
      if (beside.successors != lane.successors || (next.path.pose(0.0).position() - end).norm() > aside) continue;
      lane.successors.clear();
      std::erase(next.predecessors, lane.id);
      return;
    }
  }

  [[nodiscard]] bool find_merge(Lane& lane) const {
    bool const keeps_left = roads_[index_of(lane.road)].left_hand_traffic;
    for (auto const side : {keeps_left ? lane.right_neighbor : lane.left_neighbor,
                            keeps_left ? lane.left_neighbor : lane.right_neighbor}) {
      if (!is_valid(side) || lanes_[index_of(side)].successors.empty() || dead_ends_.contains(lane.id)) continue;
      lane.merges_into = side;
      return true;
    }
    return false;
  }

  /// Lets the lane's path swing onto the neighbour's and go on as that one does.
  bool swing(Lane& lane) {
    // [m] between the stations of a swing: its curvature is some 0.03 1/m at most (3.5 m over 30 m).
    double const spacing = std::clamp(std::sqrt(8.0 * 0.7 * options_.position_tolerance / 0.03), 0.05, 1.5);
    auto const& road = roads_[index_of(lane.road)];
    auto const& section = road.sections[lane.section];
    auto const column = column_of(section, lane.number),
               target = column_of(section, lanes_[index_of(lane.merges_into)].number);
    SectionSampler const sampler(road, section, options_);
    double const from = taper_begin(sampler, column, lane.along_road, options_.merge_length);
    double const to = lane.along_road ? section.end : section.begin;
    auto const cross_sections = sampler.sample(spacing, std::min(from, to), std::max(from, to));
    auto const path = [&](CrossSection const& c) { return merging_path(c, column, target, from, to); };
    if (!set_geometry(lane, cross_sections, column, path)) {
      lane.merges_into = none<LaneId>;
      dead_ends_.insert(lane.id);
      return false;
    }
    lane.merge_begin = lane.position_at(from);
    auto const& neighbor = lanes_[index_of(lane.merges_into)];
    lane.successors = neighbor.successors;
    for (auto const next : lane.successors) lanes_[index_of(next)].predecessors.push_back(lane.id);
    return !lane.successors.empty();
  }

  std::vector<Road> const& roads_;
  std::vector<Lane>& lanes_;
  MapOptions const& options_;
  std::set<LaneId> dead_ends_;  ///< lanes that must not merge, or could not
};

}  // namespace cambium::map::detail
