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

#include "cambium/core/macros.hpp"
#include "cambium/core/ids.hpp"
#include "cambium/geometry/pose.hpp"
#include "cambium/map/detail/box_tree.hpp"
#include "cambium/map/lane.hpp"

namespace cambium::map {

/// Where a point lies in or beside a lane.
struct LaneHit {
  LaneId lane = none<LaneId>;
  double s{};               ///< path position of the foot point [m]; below 0 or beyond the length past the lane's ends
  double lateral{};         ///< signed offset from the path, left positive [m]
  double distance{};        ///< 0 inside the lane, else how far beyond its border, its end, or (by Pythagoras) both [m]
  std::uint32_t segment{};  ///< of the path: the hint for the next projection
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

  /// Lanes of any type that hold `p` or come within `radius` [m] of it: one hit a lane, sorted by distance, then by id.
  /// O(log n).
  [[nodiscard]] std::vector<LaneHit> near(geometry::Point const& p, double radius) const {
    std::vector<LaneHit> hits;
    auto const collect = [&](LaneHit const& hit, Direction const&) {
      if (hit.distance <= radius) hits.push_back(hit);
      return false;
    };
    drivable_.visit(p, radius, collect);
    others_.visit(p, radius, collect);
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

  /// The drivable lane of a vehicle at `pose`: of the lanes that hold the position the one whose direction fits best
  /// (to steps of 0.05 rad; then the one whose path is nearest, then the smallest id); where none holds it, the nearest
  /// within `radius` [m] whose direction is less than a quarter turn off. Nothing if there is none. O(log n), no
  /// allocation.
  [[nodiscard]] std::optional<LaneHit> nearest_drivable(geometry::Pose const& pose, double radius) const {
    double const c = std::cos(pose.heading), s = std::sin(pose.heading);
    Best holding, nearest;
    drivable_.visit(pose.position(), 0.0, [&](LaneHit const& hit, Direction const& d) {
      if (hit.distance > 0.0) return false;
      double const error = std::abs(std::atan2(d.x * s - d.y * c, d.x * c + d.y * s));
      holding.offer(std::floor(error / 0.05), hit);
      return false;
    });
    if (is_valid(holding.hit.lane)) return holding.hit;
    for (double const reach : {0.2 * radius, radius}) {  // mostly it is near, and then there is less to look at
      drivable_.visit(pose.position(), reach, [&](LaneHit const& hit, Direction const& d) {
        if (hit.distance <= reach && d.x * c + d.y * s > 0.0) nearest.offer(hit.distance, hit);
        return false;
      });
      if (is_valid(nearest.hit.lane)) return nearest.hit;
    }
    return std::nullopt;
  }

  /// True when `p` is in a drivable lane, or not farther than `slack` from one. O(log n), no allocation.
  [[nodiscard]] bool any_drivable_at(geometry::Point const& p) const {
    return drivable_.visit(p, slack, [](LaneHit const& hit, Direction const&) { return hit.distance <= slack; });
  }

 private:
  struct Direction {
    double x, y;
  };

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

  /// A path segment with the lane's borders beside it.
  struct Stretch {
    double x, y, ux, uy, length, s;
    SideWidths begin, end;
    LaneId lane;
    std::uint32_t segment;
  };

  class Index {
   public:
    void add(Lane const& lane) {
      auto const segments = lane.path.segments();
      CAMBIUM_ASSERT(lane.widths.size() == segments.size() + 1, "a lane has widths at each vertex of its path");
      for (std::size_t i = 0; i < segments.size(); ++i) {
        auto const& g = segments[i];
        stretches_.push_back({g.x, g.y, g.ux, g.uy, g.length, g.s, lane.widths[i], lane.widths[i + 1], lane.id,
                              static_cast<std::uint32_t>(i)});
      }
      add_boxes(stretches_.size() - segments.size());
    }

    void finish() {
      stretches_.push_back({0, 0, 0, 0, 0, 0, {}, {}, none<LaneId>, 0});  // so that the last one has a next one
      tree_ = detail::BoxTree(boxes_);
      boxes_ = {};
    }

    /// Calls `visit(hit, direction of the lane)` for each foot point of `p` in a lane that is within `radius`, perhaps
    /// for others and for some twice, until that returns true.
    template <class Visit>
    bool visit(geometry::Point const& p, double radius, Visit const& visit) const {
      detail::Box const query{p.x() - radius, p.y() - radius, p.x() + radius, p.y() + radius};
      return tree_.visit(query, [&](std::uint32_t box) {
        LaneHit hit;
        auto const [first, end] = runs_[box];
        for (auto i = first; i < end; ++i)
          if (foot(i, p, hit) && visit(hit, Direction{stretches_[i].ux, stretches_[i].uy})) return true;
        return false;
      });
    }

   private:
    /// Fills `hit` if the stretch holds a foot point of `p`.
    [[nodiscard]] bool foot(std::size_t i, geometry::Point const& p, LaneHit& hit) const {
      auto const &g = stretches_[i], &next = stretches_[i + 1];
      bool const is_first = g.segment == 0, is_last = next.lane != g.lane;
      double const dx = p.x() - g.x, dy = p.y() - g.y;
      double along = dx * g.ux + dy * g.uy;
      double lateral = g.ux * dy - g.uy * dx;
      if (along < 0.0 && !is_first) return false;
      if (along > g.length && !is_last) {
        // Either the next stretch has the foot point, or it is the vertex between them.
        if ((p.x() - next.x) * next.ux + (p.y() - next.y) * next.uy >= 0.0) return false;
        lateral = std::copysign(std::hypot(lateral, along - g.length), lateral);
        along = g.length;
      }
      double const u = std::clamp(along / g.length, 0.0, 1.0);
      double const left = g.begin.left + u * (g.end.left - g.begin.left);
      double const right = g.begin.right + u * (g.end.right - g.begin.right);
      double const aside = std::max({lateral - left, -right - lateral, 0.0});
      double const past = std::max({-along, along - g.length, 0.0});
      hit = {g.lane, g.s + along, lateral, past == 0.0 ? aside : std::hypot(aside, past), g.segment};
      return true;
    }

    /// Boxes of a lane's stretches from the one at `first` on: of several while these are short, of parts where one is
    /// long and runs askew.
    void add_boxes(std::size_t first) {
      constexpr double longest_run = 6.0, longest_part = 25.0;  // [m]
      constexpr std::size_t most = 8;
      for (std::size_t i = first; i < stretches_.size();) {
        detail::Box box;
        double length = 0.0;
        std::size_t end = i;
        do {
          length += stretches_[end].length;
          add_quad(stretches_[end], 0.0, 1.0, box);
          if (end + 1 < stretches_.size()) add_wedge(stretches_[end], stretches_[end + 1], box);
          ++end;
        } while (end < stretches_.size() && end - i < most && length + stretches_[end].length < longest_run);
        bool const is_askew = std::min(std::abs(stretches_[i].ux), std::abs(stretches_[i].uy)) > 0.02;
        if (end - i == 1 && length > longest_part && is_askew)
          add_parts(i, static_cast<int>(std::ceil(length / longest_part)));
        else
          add_run(box, i, end);
        i = end;
      }
    }

    void add_parts(std::size_t i, int parts) {
      for (int k = 0; k < parts; ++k) {
        detail::Box box;
        add_quad(stretches_[i], static_cast<double>(k) / parts, static_cast<double>(k + 1) / parts, box);
        if (k + 1 == parts && i + 1 < stretches_.size()) add_wedge(stretches_[i], stretches_[i + 1], box);
        add_run(box, i, i + 1);
      }
    }

    void add_run(detail::Box const& box, std::size_t first, std::size_t end) {
      boxes_.push_back(box.grown(1e-6));
      runs_.push_back({static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(end)});
    }

    /// Adds the corners of the part of `g` between the fractions `from` and `to` of its length.
    static void add_quad(Stretch const& g, double from, double to, detail::Box& box) {
      for (double const u : {from, to}) {
        double const left = g.begin.left + u * (g.end.left - g.begin.left);
        double const right = g.begin.right + u * (g.end.right - g.begin.right);
        double const x = g.x + g.ux * g.length * u, y = g.y + g.uy * g.length * u;
        box.add(x - g.uy * left, y + g.ux * left);
        box.add(x + g.uy * right, y - g.ux * right);
      }
    }

    /// Adds the points whose foot point is the vertex between `a` and `b`: an arc of the width's radius.
    static void add_wedge(Stretch const& a, Stretch const& b, detail::Box& box) {
      double const cos_of_turn = a.ux * b.ux + a.uy * b.uy;
      if (cos_of_turn < 0.5) {
        double const reach = std::max(std::abs(a.end.left), std::abs(a.end.right));
        box.add(b.x - reach, b.y - reach);
        box.add(b.x + reach, b.y + reach);
        return;
      }
      double const bulge =
          std::sqrt(2.0 / (1.0 + cos_of_turn));  // the chord between the points so far out touches the arc
      for (double const across : {a.end.left * bulge, -a.end.right * bulge})
        for (auto const* g : {&a, &b}) box.add(b.x - g->uy * across, b.y + g->ux * across);
    }

    struct Run {
      std::uint32_t first, end;
    };

    std::vector<Stretch> stretches_;  ///< in the lanes' order, and one more that is in none
    std::vector<Run> runs_;           ///< of stretches, by box
    std::vector<detail::Box> boxes_;  ///< until the tree is made
    detail::BoxTree tree_;
  };

  Index drivable_, others_;
};

}  // namespace cambium::map
