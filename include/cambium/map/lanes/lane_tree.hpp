#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

#include "cambium/core/ids.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/geometry/box.hpp"
#include "cambium/geometry/pose.hpp"
#include "cambium/map/lanes/detail/lane_index.hpp"
#include "cambium/map/lanes/lane.hpp"

namespace cambium::inline v0_1::map {

/// Which lanes `Map::lanes_near` looks for.
struct LaneQuery {
  static constexpr std::size_t all = std::numeric_limits<std::size_t>::max();

  double radius = 0.0;              ///< how far beyond a lane's border or end the point may be [m]; infinite: any
  std::size_t count = all;          ///< at most this many, the nearest
  std::optional<double> heading{};  ///< only lanes driven in about this direction [rad]
  double heading_tolerance = 0.5 * geometry::pi;  ///< how far from it [rad]
  bool only_drivable = false;
};

/// Finds the lanes at a point: a packed R-tree over short stretches of the lanes. Immutable; copies what it needs of
/// the lanes.
///
/// A point belongs to a lane at each of its foot points: where its distance to the path has a local minimum (a path
/// that curls up may have several). Of these the one with the smallest `LaneHit::distance` counts, then that nearest to
/// the path.
class LaneTree {
 public:
  /// A drivable lane counts as holding a point up to this far outside [m]: neighbouring lanes sampled to a tolerance
  /// leave slits.
  static constexpr double slack = 0.05;

  LaneTree() = default;
  /// O(n log n) for n path segments.
  explicit LaneTree(std::span<Lane const> lanes) {
    for (auto const& lane : lanes) (lane.drivable() ? drivable_ : others_).add(lane);
    drivable_.finish();
    others_.finish();
  }

  /// The lanes that `query` asks for at `p`: one hit a lane, sorted by distance, then by id. O(log n) and those found.
  [[nodiscard]] std::vector<LaneHit> near(geometry::Point const& p, LaneQuery const& query) const {
    double reach = query.count == LaneQuery::all ? query.radius : std::min(query.radius, 10.0);
    for (;; reach = std::min(4.0 * reach, query.radius)) {
      auto hits = within(p, reach, query);
      bool const is_complete = hits.size() >= query.count || !(reach < query.radius) || reach > 1e8;
      if (!is_complete) continue;
      if (hits.size() > query.count) hits.resize(query.count);
      return hits;
    }
  }

  /// Lanes of any type of which a part lies in `box`, borders included, in the order of their ids. O(log n) and those
  /// found.
  [[nodiscard]] std::vector<LaneId> in(geometry::Box const& box) const {
    std::vector<LaneId> lanes;
    for (auto const* index : {&drivable_, &others_}) index->add_lanes_in(box, lanes);
    std::sort(lanes.begin(), lanes.end());
    lanes.erase(std::unique(lanes.begin(), lanes.end()), lanes.end());
    return lanes;
  }

  /// The drivable lane of a vehicle at `pose`: of the lanes that hold the position the one whose direction fits best
  /// (to steps of 0.05 rad; then the one whose path is nearest, then the smallest id); where none holds it, the nearest
  /// within `radius` [m] whose direction is less than a quarter turn off. Nothing if there is none. O(log n), no
  /// allocation.
  [[nodiscard]] std::optional<LaneHit> nearest_drivable(geometry::Pose const& pose, double radius) const {
    auto const own = portable::sin_cos(pose.heading);
    double const s = own.sin, c = own.cos;
    if (!std::isfinite(c)) return std::nullopt;  // a heading that is none fits no lane
    Best holding, nearest;
    drivable_.visit(pose.position(), 0.0, [&](LaneHit const& hit, geometry::Point const& d) {
      if (hit.distance > 0.0) return false;
      double const error = std::abs(portable::atan2(d.x() * s - d.y() * c, d.x() * c + d.y() * s));
      holding.offer(std::floor(error / 0.05), hit);
      return false;
    });
    if (is_valid(holding.hit.lane)) return holding.hit;
    for (double const reach : {0.2 * radius, radius}) {  // mostly it is near, and then there is less to look at
      drivable_.visit(pose.position(), reach, [&](LaneHit const& hit, geometry::Point const& d) {
        if (hit.distance <= reach && d.x() * c + d.y() * s > 0.0) nearest.offer(hit.distance, hit);
        return false;
      });
      if (is_valid(nearest.hit.lane)) return nearest.hit;
    }
    return std::nullopt;
  }

  /// Calls `f(LaneHit)` for the drivable lanes that hold `p` or come within `radius` [m] of it: once for each foot
  /// point there, in no particular order. O(log n) and those found, no allocation.
  template <class F>
  void for_each_drivable(geometry::Point const& p, double radius, F&& f) const {
    drivable_.visit(p, radius, [&](LaneHit const& hit, geometry::Point const&) {
      if (hit.distance <= radius) f(hit);
      return false;
    });
  }

  /// True when `p` is in a drivable lane, or not farther than `slack` from one. O(log n), no allocation.
  [[nodiscard]] bool any_drivable_at(geometry::Point const& p) const {
    return drivable_.visit(p, slack, [](LaneHit const& hit, geometry::Point const&) { return hit.distance <= slack; });
  }

 private:
  /// What `near` finds for a radius of `reach`, of any number.
  [[nodiscard]] std::vector<LaneHit> within(geometry::Point const& p, double reach, LaneQuery const& query) const {
    std::vector<LaneHit> hits;
    auto const [sin, cos] = portable::sin_cos(query.heading.value_or(0.0));
    geometry::Point const ahead{cos, sin};
    double const least = query.heading ? portable::cos(std::min(query.heading_tolerance, geometry::pi)) : -2.0;
    auto const collect = [&](LaneHit const& hit, geometry::Point const& d) {
      if (hit.distance <= reach && d.dot(ahead) >= least) hits.push_back(hit);
      return false;
    };
    drivable_.visit(p, reach, collect);
    if (!query.only_drivable) others_.visit(p, reach, collect);
    std::sort(hits.begin(), hits.end(), [](LaneHit const& a, LaneHit const& b) {
      return a.lane != b.lane ? a.lane < b.lane : in_lane_order(a) < in_lane_order(b);
    });
    hits.erase(
        std::unique(hits.begin(), hits.end(), [](LaneHit const& a, LaneHit const& b) { return a.lane == b.lane; }),
        hits.end());
    std::sort(hits.begin(), hits.end(), [](LaneHit const& a, LaneHit const& b) {
      return std::tie(a.distance, a.lane) < std::tie(b.distance, b.lane);
    });
    return hits;
  }

  [[nodiscard]] static std::tuple<double, double, std::uint32_t> in_lane_order(LaneHit const& hit) {
    return {hit.distance, std::abs(hit.lateral), hit.segment};
  }

  /// The hit with the smallest measure; ties go to the nearer path, the smaller id, the earlier segment.
  struct Best {
    double measure = std::numeric_limits<double>::infinity();
    LaneHit hit;

    void offer(double candidate_measure, LaneHit const& candidate) {
      auto const key = [](double m, LaneHit const& h) {
        return std::make_tuple(m, std::abs(h.lateral), h.lane, h.segment);
      };
      if (is_valid(hit.lane) && !(key(candidate_measure, candidate) < key(measure, hit))) return;
      measure = candidate_measure;
      hit = candidate;
    }
  };

  detail::LaneIndex drivable_, others_;
};

}  // namespace cambium::inline v0_1::map
