#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "cambium/geometry/polygon.hpp"
#include "cambium/viewer/recording.hpp"

namespace cambium::detail {

using PointList = std::vector<geometry::Point>;

using geometry::distance_to_segment;

/// Distance [m] of `p` from a polyline of at least one point. O(points).
inline double distance_to_line(geometry::Point const& p, PointList const& line) {
  double best = (line.front() - p).norm();
  for (std::size_t i = 1; i < line.size(); ++i) best = std::min(best, distance_to_segment(p, line[i - 1], line[i]));
  return best;
}

/// The polyline without the points that it can spare at `tolerance` [m] (Douglas, Peucker 1973), and without points
/// that are not on Earth (not finite, or beyond 1e8 m).
inline PointList simplified(PointList const& line, double tolerance) {
  PointList points;
  for (geometry::Point const& p : line)
    if (p.allFinite() && p.cwiseAbs().maxCoeff() < 1e8) points.push_back(p);
  if (points.size() < 3) return points;
  std::vector<bool> keep(points.size(), false);
  keep.front() = keep.back() = true;
  std::vector<std::pair<std::size_t, std::size_t>> open{{0, points.size() - 1}};
  while (!open.empty()) {
    auto const [first, last] = open.back();
    open.pop_back();
    std::size_t farthest = first;
    double most = tolerance;
    for (std::size_t i = first + 1; i < last; ++i) {
      double const distance = distance_to_segment(points[i], points[first], points[last]);
      if (distance > most) most = distance, farthest = i;
    }
    if (farthest == first) continue;
    keep[farthest] = true;
    open.emplace_back(first, farthest);
    open.emplace_back(farthest, last);
  }
  PointList result;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (keep[i]) result.push_back(points[i]);
  return result;
}

/// The point at a fraction [0, 1] of the length of a polyline of at least one point. O(points).
inline geometry::Point point_at(PointList const& line, double fraction) {
  double length = 0.0;
  for (std::size_t i = 1; i < line.size(); ++i) length += (line[i] - line[i - 1]).norm();
  double left = fraction * length;
  for (std::size_t i = 1; i < line.size(); ++i) {
    double const step = (line[i] - line[i - 1]).norm();
    if (left <= step && step > 0.0) return line[i - 1] + (line[i] - line[i - 1]) * (left / step);
    left -= step;
  }
  return line.back();
}

/// A lane ready to draw: borders simplified to 1 cm, and their bounding box.
struct LaneArea {
  PointList left;
  PointList right;
  PointList outline;  ///< the left border, then the right one backwards
  geometry::Point low{0.0, 0.0};
  geometry::Point high{0.0, 0.0};

  explicit LaneArea(RecordedLane const& lane) : left(simplified(lane.left, 0.01)), right(simplified(lane.right, 0.01)) {
    if (left.size() < 2 || right.size() < 2) left.clear(), right.clear();
    if (left.empty()) return;
    outline = left;
    outline.insert(outline.end(), right.rbegin(), right.rend());
    low = high = left.front();
    for (geometry::Point const& p : outline) low = low.cwiseMin(p), high = high.cwiseMax(p);
  }

  [[nodiscard]] bool empty() const { return left.empty(); }

  /// True when `p` lies inside the outline (even-odd rule). O(points) within the bounding box, else O(1).
  [[nodiscard]] bool contains(geometry::Point const& p) const {
    if (empty() || (p.array() < low.array()).any() || (p.array() > high.array()).any()) return false;
    bool inside = false;
    for (std::size_t i = 0, j = outline.size() - 1; i < outline.size(); j = i++) {
      geometry::Point const &a = outline[i], &b = outline[j];
      if ((a.y() > p.y()) != (b.y() > p.y()) && p.x() < (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y()) + a.x())
        inside = !inside;
    }
    return inside;
  }

  /// Middle of the lane at a fraction of its length.
  [[nodiscard]] geometry::Point middle(double fraction) const {
    return 0.5 * (point_at(left, fraction) + point_at(right, fraction));
  }
};

/// How a piece of a lane border is painted.
enum class MarkStyle : std::uint32_t {
  edge = 0,     ///< solid: the rim of the road or of the driven lanes
  divider = 1,  ///< dashed: between lanes of one direction
  centre = 2,   ///< between opposite directions
  hidden = 3,   ///< not painted: within another lane, or the neighbour paints it
};

/// One painted line.
struct LaneMark {
  MarkStyle style = MarkStyle::edge;
  PointList points{};
};

/// Finds the style of every piece of every border from where the other lanes are. The borders of neighbours need not
/// have the same points: pieces of at most 3 m are compared by place and direction.
class LaneMarker {
 public:
  LaneMarker(std::vector<RecordedLane> const& lanes, std::vector<LaneArea> const& areas)
      : lanes_(lanes), areas_(areas) {
    for (std::size_t i = 0; i < areas.size(); ++i) {
      if (areas[i].empty() || lanes[i].kind == RecordedLaneKind::way) continue;
      add_border(i, areas[i].left, areas[i].right, 1.0);
      add_border(i, areas[i].right, areas[i].left, -1.0);
    }
  }

  [[nodiscard]] std::vector<LaneMark> marks() const {
    std::vector<LaneMark> result;
    Piece const* before = nullptr;
    MarkStyle last = MarkStyle::hidden;
    for (Piece const& piece : pieces_) {
      MarkStyle const style = style_of(piece);
      bool const goes_on = before != nullptr && before->border == piece.border && last == style;
      if (style != MarkStyle::hidden) {
        if (!goes_on) result.push_back({style, {piece.from}});
        result.back().points.push_back(piece.to);
      }
      before = &piece;
      last = style;
    }
    result = joined(std::move(result));
    for (LaneMark& mark : result) mark.points = simplified(mark.points, 0.01);
    return result;
  }

 private:
  /// Marks that begin where one of their style ends go on in that one: dashes keep their rhythm from lane to lane.
  [[nodiscard]] static std::vector<LaneMark> joined(std::vector<LaneMark> marks) {
    std::unordered_multimap<std::uint64_t, std::size_t> begins;
    auto const key = [](geometry::Point const& p, int dx, int dy) {
      return key_of(std::llround(p.x() / joint_) + dx, std::llround(p.y() / joint_) + dy);
    };
    for (std::size_t i = 0; i < marks.size(); ++i) begins.emplace(key(marks[i].points.front(), 0, 0), i);
    std::vector<bool> is_taken(marks.size(), false), has_before(marks.size(), false);
    std::vector<std::size_t> next(marks.size(), marks.size());
    for (std::size_t i = 0; i < marks.size(); ++i) {
      auto const& end = marks[i].points.back();
      for (int dx = -1; dx <= 1; ++dx)
        for (int dy = -1; dy <= 1; ++dy) {
          auto const [first, last] = begins.equal_range(key(end, dx, dy));
          for (auto at = first; at != last; ++at) {
            auto const j = at->second;
            bool const fits = j != i && !has_before[j] && next[i] == marks.size() && marks[j].style == marks[i].style &&
                              (marks[j].points.front() - end).norm() < joint_;
            if (fits) next[i] = j, has_before[j] = true;
          }
        }
    }
    std::vector<LaneMark> result;
    auto const follow = [&](std::size_t i) {
      if (is_taken[i]) return;
      result.push_back({marks[i].style, {}});
      for (; i < marks.size() && !is_taken[i]; i = next[i]) {
        is_taken[i] = true;
        auto& points = result.back().points;
        points.insert(points.end(), marks[i].points.begin() + (points.empty() ? 0 : 1), marks[i].points.end());
      }
    };
    for (std::size_t i = 0; i < marks.size(); ++i)
      if (!has_before[i]) follow(i);
    for (std::size_t i = 0; i < marks.size(); ++i) follow(i);  // rings have no begin
    return result;
  }

  static constexpr double cell_ = 4.0;   // [m] of the look-up grid
  static constexpr double near_ = 0.3;   // [m] within which two borders are one
  static constexpr double piece_ = 3.0;  // [m] longest piece
  static constexpr double joint_ = 0.1;  // [m] within which a mark goes on in the next

  struct Piece {
    geometry::Point from, to;
    geometry::Point travel;  // unit direction of the traffic of its lane
    geometry::Point inward;  // unit direction to the lane's other border
    std::size_t lane;
    std::size_t border;
    bool thin;  // the lane has no width here
  };

  void add_border(std::size_t lane, PointList const& line, PointList const& opposite, double side) {
    std::size_t const border = borders_++;
    for (std::size_t i = 1; i < line.size(); ++i) {
      geometry::Point const step = line[i] - line[i - 1];
      double const length = step.norm();
      if (!(length > 0.0)) continue;
      geometry::Point const along = step / length;
      auto const count = static_cast<std::size_t>(std::ceil(length / piece_));
      for (std::size_t k = 0; k < count; ++k) {
        Piece piece{.from = line[i - 1] + step * (static_cast<double>(k) / static_cast<double>(count)),
                    .to = line[i - 1] + step * (static_cast<double>(k + 1) / static_cast<double>(count)),
                    .travel = lanes_[lane].forward ? along : geometry::Point(-along),
                    .inward = geometry::Point(side * along.y(), -side * along.x()),
                    .lane = lane,
                    .border = border,
                    .thin = false};
        piece.thin = distance_to_line(0.5 * (piece.from + piece.to), opposite) < 1.5 * near_;
        insert(piece);
        pieces_.push_back(piece);
      }
    }
  }

  void insert(Piece const& piece) {
    geometry::Point const low = piece.from.cwiseMin(piece.to), high = piece.from.cwiseMax(piece.to);
    for (std::int64_t x = cell_of(low.x() - near_); x <= cell_of(high.x() + near_); ++x)
      for (std::int64_t y = cell_of(low.y() - near_); y <= cell_of(high.y() + near_); ++y)
        grid_[key_of(x, y)].push_back(pieces_.size());
  }

  [[nodiscard]] MarkStyle style_of(Piece const& piece) const {
    if (piece.thin) return MarkStyle::hidden;
    geometry::Point const middle = 0.5 * (piece.from + piece.to);
    std::vector<std::size_t> touching;
    MarkStyle style = MarkStyle::edge;
    for (std::size_t index : cell_at(middle)) {
      Piece const& other = pieces_[index];
      if (other.lane == piece.lane || distance_to_segment(middle, other.from, other.to) > near_) continue;
      touching.push_back(other.lane);
      if (other.thin) continue;  // a lane without width borders on nothing
      double const same_way = other.travel.dot(piece.travel);
      if (std::abs(same_way) < 0.95) continue;
      if (other.lane < piece.lane) return MarkStyle::hidden;
      if (other.inward.dot(piece.inward) < 0.0) style = style_between(piece.lane, other.lane, same_way);
    }
    for (std::size_t lane = 0; lane < areas_.size(); ++lane) {
      bool const candidate = lane != piece.lane && std::count(touching.begin(), touching.end(), lane) == 0;
      if (candidate && lanes_[lane].kind != RecordedLaneKind::way && areas_[lane].contains(middle))
        return MarkStyle::hidden;
    }
    return style;
  }

  [[nodiscard]] MarkStyle style_between(std::size_t a, std::size_t b, double same_way) const {
    bool const rim = lanes_[a].kind == RecordedLaneKind::other || lanes_[b].kind == RecordedLaneKind::other;
    if (rim) return MarkStyle::edge;
    return same_way < 0.0 ? MarkStyle::centre : MarkStyle::divider;
  }

  [[nodiscard]] std::span<std::size_t const> cell_at(geometry::Point const& p) const {
    auto const found = grid_.find(key_of(cell_of(p.x()), cell_of(p.y())));
    return found == grid_.end() ? std::span<std::size_t const>() : std::span<std::size_t const>(found->second);
  }

  static std::int64_t cell_of(double coordinate) { return static_cast<std::int64_t>(std::floor(coordinate / cell_)); }
  static std::uint64_t key_of(std::int64_t x, std::int64_t y) {
    return (static_cast<std::uint64_t>(x) << 32U) ^ (static_cast<std::uint64_t>(y) & 0xFFFFFFFFU);
  }

  std::vector<RecordedLane> const& lanes_;
  std::vector<LaneArea> const& areas_;
  std::vector<Piece> pieces_;
  std::unordered_map<std::uint64_t, std::vector<std::size_t>> grid_;
  std::size_t borders_ = 0;
};

/// A direction arrow on a lane.
struct LaneArrow {
  geometry::Point at{0.0, 0.0};
  double heading = 0.0;  ///< [rad]
};

/// Arrows in the direction of traffic, one about every `spacing` [m] of each driving lane that is wide enough to show
/// one.
inline std::vector<LaneArrow> lane_arrows(std::vector<RecordedLane> const& lanes, std::vector<LaneArea> const& areas,
                                          double spacing) {
  std::vector<LaneArrow> arrows;
  for (std::size_t i = 0; i < lanes.size(); ++i) {
    LaneArea const& area = areas[i];
    if (area.empty() || lanes[i].kind != RecordedLaneKind::driving) continue;
    double length = 0.0;
    for (std::size_t k = 1; k < area.left.size(); ++k) length += (area.left[k] - area.left[k - 1]).norm();
    if (length < 12.0) continue;
    auto const count = std::max(1L, std::lround(length / spacing));
    for (long k = 0; k < count; ++k) {
      double const fraction = (static_cast<double>(k) + 0.5) / static_cast<double>(count);
      if ((point_at(area.left, fraction) - point_at(area.right, fraction)).norm() < 2.0) continue;
      geometry::Point along = area.middle(fraction + 1.0 / length) - area.middle(fraction - 1.0 / length);
      if (!lanes[i].forward) along = -along;
      arrows.push_back({area.middle(fraction), std::atan2(along.y(), along.x())});
    }
  }
  return arrows;
}

}  // namespace cambium::detail
