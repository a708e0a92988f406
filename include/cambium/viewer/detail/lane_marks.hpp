#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "cambium/geometry/box.hpp"
#include "cambium/geometry/box_tree.hpp"
#include "cambium/viewer/detail/lane_area.hpp"
#include "cambium/viewer/recording.hpp"

namespace cambium::inline v0_1::detail {

/// How a piece of a lane border is painted.
enum class MarkStyle : std::uint32_t {
  edge = 0,     ///< solid: the edge of the road or of its driving lanes
  divider = 1,  ///< dashed: between lanes of one direction
  centre = 2,   ///< between opposite directions
  hidden = 3,   ///< not painted: the neighbour paints it, or the lane has no width here
  covered = 4,  ///< not painted: inside another lane
};

/// One painted line.
struct LaneMark {
  MarkStyle style = MarkStyle::edge;
  PointList points{};
};

/// Joins marks of the same style end to end, so that dashes keep their rhythm from lane to lane.
/// O(n (log n + marks that begin at the same x)).
inline std::vector<LaneMark> joined(std::vector<LaneMark> const& marks) {
  constexpr double joint = 0.1;  // [m]
  std::size_t const none = marks.size();
  std::multimap<double, std::size_t> begins;  // by x
  for (std::size_t i = 0; i < marks.size(); ++i) begins.emplace(marks[i].points.front().x(), i);
  std::vector<std::size_t> next(marks.size(), none);
  std::vector<bool> has_before(marks.size(), false), is_taken(marks.size(), false);
  for (std::size_t i = 0; i < marks.size(); ++i) {
    auto const& end = marks[i].points.back();
    auto const last = begins.upper_bound(end.x() + joint);
    for (auto at = begins.lower_bound(end.x() - joint); at != last && next[i] == none; ++at) {
      auto const j = at->second;
      bool const fits = j != i && !has_before[j] && marks[j].style == marks[i].style;
      if (fits && (marks[j].points.front() - end).norm() < joint) next[i] = j, has_before[j] = true;
    }
  }
  std::vector<LaneMark> result;
  for (bool const is_ring : {false, true})  // open lines from their begin, then closed rings from anywhere
    for (std::size_t first = 0; first < marks.size(); ++first) {
      if (is_taken[first] || (has_before[first] && !is_ring)) continue;
      LaneMark& line = result.emplace_back(LaneMark{marks[first].style});
      for (std::size_t i = first; i != none && !is_taken[i]; i = next[i]) {
        is_taken[i] = true;
        auto const& points = marks[i].points;
        line.points.insert(line.points.end(), points.begin() + (line.points.empty() ? 0 : 1), points.end());
      }
    }
  return result;
}

/// Decides how to paint every lane border. A recording does not say which lanes are neighbours, and the borders of
/// neighbours need not have the same points. So each border is cut into short pieces, and each piece is compared by
/// place and direction with the pieces near it: a border shared with another lane is a divider, a centre line or the
/// edge of a shoulder, and only one of the two lanes paints it. A border with nothing beyond it is the edge of the
/// road. A piece inside another lane, as in a junction, is not painted.
class LaneMarker {
 public:
  LaneMarker(std::vector<RecordedLane> const& lanes, std::vector<LaneArea> const& areas)
      : lanes_(lanes), areas_(areas) {
    for (std::size_t i = 0; i < areas.size(); ++i) {
      if (areas[i].empty() || lanes[i].kind == RecordedLaneKind::way) continue;
      add_border(i, areas[i].left, areas[i].right, 1.0);
      add_border(i, areas[i].right, areas[i].left, -1.0);
    }
    index_areas();
  }

  [[nodiscard]] std::vector<LaneMark> marks() const {
    std::vector<MarkStyle> styles;
    std::vector<bool> is_crossed(borders_, false);
    for (Piece const& piece : pieces_) {
      styles.push_back(style_of(piece));
      if (styles.back() == MarkStyle::covered && is_in_junction(piece)) is_crossed[piece.border] = true;
    }
    std::vector<LaneMark> result;
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      Piece const& piece = pieces_[i];
      // In a junction, a border with another lane is painted only if no lane crosses it anywhere.
      if (styles[i] != MarkStyle::edge && is_crossed[piece.border]) styles[i] = MarkStyle::hidden;
      if (styles[i] >= MarkStyle::hidden) continue;
      bool const goes_on = i > 0 && pieces_[i - 1].border == piece.border && styles[i - 1] == styles[i];
      if (!goes_on) result.push_back({styles[i], {piece.from}});
      result.back().points.push_back(piece.to);
    }
    result = joined(result);
    for (LaneMark& mark : result) mark.points = simplified(mark.points, 0.01);
    return result;
  }

 private:
  static constexpr double cell_ = 4.0;            // [m] of the look-up grid
  static constexpr double near_ = 0.3;            // [m] borders closer than this are one
  static constexpr double beyond_ = 0.05;         // [m] from a border to the point that tests what lies beyond
  static constexpr double slit_ = 0.5;            // [m] widest gap between lanes of a junction without edge marks
  static constexpr double piece_ = 3.0;           // [m] longest piece
  static constexpr double junction_piece_ = 0.5;  // [m] longest piece in junctions, where lanes cross

  struct Piece {
    geometry::Point from, to;
    geometry::Point travel;  // unit direction of the traffic of its lane
    geometry::Point inward;  // unit direction to the lane's other border
    std::size_t lane;
    std::size_t border;
    bool thin;  // the lane has no width here
  };

  [[nodiscard]] bool is_in_junction(Piece const& piece) const {
    return lanes_[piece.lane].kind == RecordedLaneKind::junction;
  }

  void add_border(std::size_t lane, PointList const& line, PointList const& opposite, double side) {
    std::size_t const border = borders_++;
    double const longest = lanes_[lane].kind == RecordedLaneKind::junction ? junction_piece_ : piece_;
    for (std::size_t i = 1; i < line.size(); ++i) {
      geometry::Point const step = line[i] - line[i - 1];
      double const length = step.norm();
      if (!(length > 0.0)) continue;
      geometry::Point const along = step / length;
      auto const count = static_cast<std::size_t>(std::ceil(length / longest));
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
    std::vector<std::size_t> beside;  // lanes that share the border
    MarkStyle style = MarkStyle::edge;
    for (std::size_t index : cell_at(middle)) {
      Piece const& other = pieces_[index];
      double const same_way = other.travel.dot(piece.travel);
      if (other.lane == piece.lane || std::abs(same_way) < 0.95) continue;
      bool const is_copy = other.inward.dot(piece.inward) > 0.0;
      if (!runs_by(other, middle, is_copy && !other.thin ? beyond_ : near_)) continue;
      beside.push_back(other.lane);
      if (other.thin) continue;  // a lane without width here is no neighbour
      if (other.lane < piece.lane) style = MarkStyle::hidden;
      if (style != MarkStyle::hidden && !is_copy) style = style_between(piece.lane, other.lane, same_way);
    }
    bool const covered = is_covered(middle - beyond_ * piece.inward, piece.lane, beside) ||
                         (is_in_junction(piece) && is_covered(middle - slit_ * piece.inward, piece.lane, beside));
    return covered ? MarkStyle::covered : style;
  }

  void index_areas() {
    std::vector<geometry::Box> boxes;
    for (std::size_t i = 0; i < areas_.size(); ++i) {
      auto const& area = areas_[i];
      if (area.empty() || lanes_[i].kind == RecordedLaneKind::way) continue;
      coverers_.push_back(i);
      boxes.push_back({area.low.x(), area.low.y(), area.high.x(), area.high.y()});
    }
    coverer_tree_ = geometry::BoxTree(boxes);
  }

  /// Whether a point lies in a lane other than `own` and those `beside` it.
  [[nodiscard]] bool is_covered(geometry::Point const& p, std::size_t own,
                                std::vector<std::size_t> const& beside) const {
    return coverer_tree_.visit({p.x(), p.y(), p.x(), p.y()}, [&](std::uint32_t i) {
      auto const lane = coverers_[i];
      return lane != own && areas_[lane].contains(p) && std::count(beside.begin(), beside.end(), lane) == 0;
    });
  }

  /// Whether a point lies beside the piece, at most `distance` [m] away.
  [[nodiscard]] static bool runs_by(Piece const& piece, geometry::Point const& p, double distance) {
    constexpr double joint = 0.02;  // tolerance at both ends for gaps between pieces in bends [m]
    geometry::Point const step = piece.to - piece.from;
    double const length = step.norm(), along = (p - piece.from).dot(step) / length;
    return std::abs((p - piece.from).dot(piece.inward)) <= distance && along >= -joint && along <= length + joint;
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
  std::vector<std::size_t> coverers_;  ///< lanes that may cover borders of others
  geometry::BoxTree coverer_tree_;     ///< boxes of their areas
};

}  // namespace cambium::inline v0_1::detail
