#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "cambium/core/ids.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/geometry/box.hpp"
#include "cambium/geometry/box_tree.hpp"
#include "cambium/geometry/pose.hpp"
#include "cambium/map/lanes/lane.hpp"

namespace cambium::inline v0_1::map {

/// Where a point lies in or beside a lane.
struct LaneHit {
  LaneId lane = none<LaneId>;
  double s{};               ///< path position of the foot point [m]; below 0 or beyond the length past the lane's ends
  double lateral{};         ///< signed offset from the path, left positive [m]
  double distance{};        ///< 0 inside the lane, else how far beyond its border, its end, or (by Pythagoras) both [m]
  std::uint32_t segment{};  ///< of the path: the hint for the next projection
};

namespace detail {

using geometry::Box;

/// A packed R-tree over stretches of lanes' paths with the borders beside them; see `LaneTree`.
class LaneIndex {
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
    tree_ = geometry::BoxTree(boxes_);
    boxes_ = {};
  }

  /// Calls `visit(hit, direction of the lane)` for each foot point of `p` in a lane that is within `radius`, perhaps
  /// for others and for some twice, until that returns true.
  template <class Visit>
  bool visit(geometry::Point const& p, double radius, Visit const& visit) const {
    Box const query{p.x() - radius, p.y() - radius, p.x() + radius, p.y() + radius};
    return tree_.visit(query, [&](std::uint32_t box) {
      LaneHit hit;
      auto const [first, end] = runs_[box];
      for (auto i = first; i < end; ++i)
        if (foot(i, p, hit) && visit(hit, geometry::Point(stretches_[i].ux, stretches_[i].uy))) return true;
      return false;
    });
  }

  /// Appends the lanes of which a stretch meets `box`.
  void add_lanes_in(geometry::Box const& box, std::vector<LaneId>& lanes) const {
    tree_.visit(box, [&](std::uint32_t number) {
      auto const [first, end] = runs_[number];
      for (auto i = first; i < end; ++i)
        if (meets(stretches_[i], box)) lanes.push_back(stretches_[i].lane);
      return false;
    });
  }

 private:
  /// A path segment with the lane's borders beside it.
  struct Stretch {
    double x, y, ux, uy, length, s;
    SideWidths begin, end;
    LaneId lane;
    std::uint32_t segment;
  };

  /// Whether the quad of a stretch meets `box`: no side of either parts them.
  [[nodiscard]] static bool meets(Stretch const& g, geometry::Box const& box) {
    std::array<geometry::Point, 4> const quad{
        geometry::Point(g.x - g.uy * g.begin.left, g.y + g.ux * g.begin.left),
        geometry::Point(g.x + g.uy * g.begin.right, g.y - g.ux * g.begin.right),
        geometry::Point(g.x + g.ux * g.length + g.uy * g.end.right, g.y + g.uy * g.length - g.ux * g.end.right),
        geometry::Point(g.x + g.ux * g.length - g.uy * g.end.left, g.y + g.uy * g.length + g.ux * g.end.left)};
    if (!geometry::box_around(quad).intersects(box)) return false;
    for (std::size_t i = 0; i < 4; ++i) {
      auto const &a = quad[i], &b = quad[(i + 1) % 4];
      // Counter-clockwise: the inside is to the left. The corner of the box that is farthest to the left:
      double const nx = a.y() - b.y(), ny = b.x() - a.x();
      double const x = nx > 0.0 ? box.max_x : box.min_x, y = ny > 0.0 ? box.max_y : box.min_y;
      if (nx * (x - a.x()) + ny * (y - a.y()) < 0.0) return false;
    }
    return true;
  }

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
      lateral = std::copysign(portable::hypot(lateral, along - g.length), lateral);
      along = g.length;
    }
    double const u = std::clamp(along / g.length, 0.0, 1.0);
    double const left = g.begin.left + u * (g.end.left - g.begin.left);
    double const right = g.begin.right + u * (g.end.right - g.begin.right);
    double const aside = std::max({lateral - left, -right - lateral, 0.0});
    double const past = std::max({-along, along - g.length, 0.0});
    hit = {g.lane, g.s + along, lateral, past == 0.0 ? aside : portable::hypot(aside, past), g.segment};
    return true;
  }

  /// Boxes of a lane's stretches from the one at `first` on: of several while these are short, of parts where one is
  /// long and runs askew.
  void add_boxes(std::size_t first) {
    constexpr double longest_run = 6.0, longest_part = 25.0;  // [m]
    constexpr std::size_t most = 8;
    for (std::size_t i = first; i < stretches_.size();) {
      Box box;
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
      Box box;
      add_quad(stretches_[i], static_cast<double>(k) / parts, static_cast<double>(k + 1) / parts, box);
      if (k + 1 == parts && i + 1 < stretches_.size()) add_wedge(stretches_[i], stretches_[i + 1], box);
      add_run(box, i, i + 1);
    }
  }

  void add_run(Box const& box, std::size_t first, std::size_t end) {
    boxes_.push_back(box.grown(1e-6));
    runs_.push_back({static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(end)});
  }

  /// Adds the corners of the part of `g` between the fractions `from` and `to` of its length.
  static void add_quad(Stretch const& g, double from, double to, Box& box) {
    for (double const u : {from, to}) {
      double const left = g.begin.left + u * (g.end.left - g.begin.left);
      double const right = g.begin.right + u * (g.end.right - g.begin.right);
      double const x = g.x + g.ux * g.length * u, y = g.y + g.uy * g.length * u;
      box.add(x - g.uy * left, y + g.ux * left);
      box.add(x + g.uy * right, y - g.ux * right);
    }
  }

  /// Adds the points whose foot point is the vertex between `a` and `b`: an arc of the width's radius.
  static void add_wedge(Stretch const& a, Stretch const& b, Box& box) {
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
  std::vector<Box> boxes_;          ///< until the tree is made
  geometry::BoxTree tree_;
};

}  // namespace detail

}  // namespace cambium::inline v0_1::map
