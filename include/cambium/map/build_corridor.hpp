#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "cambium/core/error.hpp"
#include "cambium/core/ids.hpp"
#include "cambium/map/corridor.hpp"
#include "cambium/map/detail/feeders.hpp"
#include "cambium/map/detail/lane_chains.hpp"
#include "cambium/map/map.hpp"

namespace cambium::map {

namespace detail {

/// Joins lanes to a lane corridor's lines, widths and pieces.
class LaneJoiner {
 public:
  explicit LaneJoiner(Map const& map) : map_(map) {}

  [[nodiscard]] LaneCorridor join(std::span<LaneId const> lanes) {
    for (auto const id : lanes) add(map_.lane(id));
    LaneCorridor corridor;
    corridor.center = geometry::Line::from_samples(center_);
    corridor.widths = std::move(widths_);
    if (left_.size() > 1) corridor.left = geometry::Line::from_samples(left_);
    if (right_.size() > 1) corridor.right = geometry::Line::from_samples(right_);
    corridor.pieces = std::move(pieces_);
    set_positions(corridor);
    auto const& last = map_.lane(lanes.back());
    corridor.continues = std::any_of(last.successors.begin(), last.successors.end(),
                                     [&](LaneId next) { return may_enter(last, map_.lane(next)); });
    return corridor;
  }

 private:
  void add(Lane const& lane) {
    auto const samples = lane.path.samples();
    std::size_t first = 0;
    double first_s = 0.0;
    joints_.push_back({center_.empty() ? 0 : center_.size() - 1, 0, 0.0});
    if (!center_.empty()) {
      // The lane before has the joint's vertex. Where the two do not quite meet there, the rest of the way is bridged.
      first_s = bridge(lane, samples.front());
      if (first_s > 0.0) append(lane.path.pose(first_s), lane.widths_at(first_s));
      auto const segments = lane.path.segments();
      first = 1;
      while (first < segments.size() && segments[first].s < first_s + 1e-3) ++first;
      if (first_s == 0.0) first_s = first < segments.size() ? segments[first].s : lane.length();
    }
    joints_.back().vertex = center_.empty() ? 0 : (first_s > 0.0 && bridged_ ? center_.size() - 1 : center_.size());
    joints_.back().s = first_s;
    for (std::size_t i = first; i < samples.size(); ++i) append(samples[i], lane.widths[i]);
    append_border(left_, lane.left);
    append_border(right_, lane.right);
    pieces_.push_back({lane.id, 0.0, 0.0, 0.0, no_corridor, no_corridor});
  }
  Map const& map_;
};

}  // namespace detail
}  // namespace cambium::map
