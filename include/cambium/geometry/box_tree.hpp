#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "cambium/geometry/box.hpp"

namespace cambium::inline v0_1::geometry {

namespace detail {

/// Index of the cell (x, y), each below 2^16, on the Hilbert curve. Cells close in the plane are mostly close on the
/// curve.
[[nodiscard]] inline std::uint32_t hilbert_index(std::uint32_t x, std::uint32_t y) {
  std::uint32_t index = 0;
  for (std::uint32_t side = 1u << 15; side > 0; side >>= 1) {
    bool const right = (x & side) != 0, upper = (y & side) != 0;
    index = 4 * index + (right ? (upper ? 2u : 3u) : (upper ? 1u : 0u));
    if (upper) continue;
    if (right) {
      x = ~x;
      y = ~y;
    }
    std::swap(x, y);
  }
  return index;
}

}  // namespace detail

/// A static R-tree in flat arrays (packed Hilbert R-tree; Kamel, Faloutsos 1993). Boxes are sorted along the Hilbert
/// curve of their centres, so that neighbours share a node. Eight consecutive boxes form a leaf, eight consecutive
/// nodes a node of the next level:
///
///     level 1                [    root    ]
///     level 0       [ node 0 ][ node 1 ] ... [ node 7 ]      128 B each
///     boxes         b0 ... b7  b8 ... b15                    in Hilbert order
///
/// Child j of node i is number 8 i + j of the level below, so nodes need no pointers. Corners are stored as float and
/// rounded outwards: a query may also visit boxes that it misses by that rounding.
class BoxTree {
 public:
  BoxTree() = default;

  /// Builds the tree in O(n log n). No box may be empty.
  explicit BoxTree(std::span<Box const> boxes) {
    if (boxes.empty()) return;
    Box all;
    for (auto const& b : boxes) {
      all.add(b.min_x, b.min_y);
      all.add(b.max_x, b.max_y);
    }
    origin_x_ = 0.5 * (all.min_x + all.max_x);
    origin_y_ = 0.5 * (all.min_y + all.max_y);
    sort(boxes, all);
    std::size_t children = boxes.size();
    do {
      auto const begin = nodes_.size();
      add_level(boxes, children);
      level_begin_.push_back(begin);
      children = nodes_.size() - begin;
    } while (children > 1);
  }

  /// Calls `visit(index of the box)` for every box that meets `query`, borders included, until `visit` returns true;
  /// returns whether it did. O(log n + number of boxes found); no allocation.
  template <class Visit>
  bool visit(Box const& query, Visit const& visit) const {
    if (nodes_.empty()) return false;
    float const min_x = below(query.min_x - origin_x_), max_x = above(query.max_x - origin_x_);
    float const min_y = below(query.min_y - origin_y_), max_y = above(query.max_y - origin_y_);
    std::array<Place, 7 * max_levels + 1> stack;
    std::size_t depth = 0;
    stack[depth++] = {static_cast<std::uint32_t>(level_begin_.size() - 1), 0};
    while (depth > 0) {
      Place const at = stack[--depth];
      auto const& node = nodes_[level_begin_[at.level] + at.index];
      std::array<bool, width> meets;
      for (std::size_t j = 0; j < width; ++j)
        meets[j] = (int{node.min_x[j] <= max_x} & int{node.max_x[j] >= min_x} & int{node.min_y[j] <= max_y} &
                    int{node.max_y[j] >= min_y}) != 0;
      for (std::size_t j = 0; j < width; ++j) {
        if (!meets[j]) continue;
        auto const child = static_cast<std::uint32_t>(at.index * width + j);
        if (at.level > 0)
          stack[depth++] = {at.level - 1, child};
        else if (visit(order_[child]))
          return true;
      }
    }
    return false;
  }

 private:
  static constexpr std::size_t width = 8;
  static constexpr std::size_t max_levels = 11;  // 8^11 exceeds the range of a box index

  struct alignas(64) Node {
    std::array<float, width> min_x, min_y, max_x, max_y;
  };
  struct Place {
    std::uint32_t level, index;
  };

  static constexpr float largest = std::numeric_limits<float>::max();

  // Clamped to finite floats: unused places of a node are at infinity, and an infinite query must not meet them.
  [[nodiscard]] static float below(double v) {
    auto const f = static_cast<float>(std::clamp<double>(v, -largest, largest));
    return static_cast<double>(f) <= v || f == -largest ? f : std::nextafter(f, -largest);
  }
  [[nodiscard]] static float above(double v) {
    auto const f = static_cast<float>(std::clamp<double>(v, -largest, largest));
    return static_cast<double>(f) >= v || f == largest ? f : std::nextafter(f, largest);
  }

  void sort(std::span<Box const> boxes, Box const& all) {
    double const extent = std::max({all.max_x - all.min_x, all.max_y - all.min_y, 1e-9});
    auto const cell = [extent](double low, double high, double origin) {
      return static_cast<std::uint32_t>(std::clamp((0.5 * (low + high) - origin) / extent, 0.0, 1.0) * 65535.0);
    };
    std::vector<std::uint64_t> keys(boxes.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      auto const& b = boxes[i];
      auto const place = detail::hilbert_index(cell(b.min_x, b.max_x, all.min_x), cell(b.min_y, b.max_y, all.min_y));
      keys[i] = std::uint64_t{place} << 32 | i;
    }
    std::sort(keys.begin(), keys.end());
    order_.resize(boxes.size());
    for (std::size_t i = 0; i < keys.size(); ++i) order_[i] = static_cast<std::uint32_t>(keys[i]);
  }

  /// Adds the level of nodes above `children` boxes (for the first level) or nodes of the level below.
  void add_level(std::span<Box const> boxes, std::size_t children) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    auto const first_child = level_begin_.empty() ? 0 : level_begin_.back();
    for (std::size_t begin = 0; begin < children; begin += width) {
      Node node;
      for (std::size_t j = 0; j < width; ++j) {
        node.min_x[j] = node.min_y[j] = infinity;
        node.max_x[j] = node.max_y[j] = -infinity;
        if (begin + j >= children) continue;
        if (level_begin_.empty()) {
          auto const& b = boxes[order_[begin + j]];
          node.min_x[j] = below(b.min_x - origin_x_);
          node.min_y[j] = below(b.min_y - origin_y_);
          node.max_x[j] = above(b.max_x - origin_x_);
          node.max_y[j] = above(b.max_y - origin_y_);
        } else {
          auto const& child = nodes_[first_child + begin + j];
          node.min_x[j] = *std::min_element(child.min_x.begin(), child.min_x.end());
          node.min_y[j] = *std::min_element(child.min_y.begin(), child.min_y.end());
          node.max_x[j] = *std::max_element(child.max_x.begin(), child.max_x.end());
          node.max_y[j] = *std::max_element(child.max_y.begin(), child.max_y.end());
        }
      }
      nodes_.push_back(node);
    }
  }

  std::vector<Node> nodes_;
  std::vector<std::size_t> level_begin_;  ///< first node of each level, leaves first
  std::vector<std::uint32_t> order_;      ///< original index of each box, in Hilbert order
  double origin_x_ = 0.0, origin_y_ = 0.0;
};

}  // namespace cambium::inline v0_1::geometry
