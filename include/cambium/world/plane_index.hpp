#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "cambium/core/ids.hpp"
#include "cambium/geometry/box.hpp"

namespace cambium::inline v0_1 {

/// Finds agents by their position in the plane, regardless of lanes, for behaviours that look around, such as those of
/// pedestrians. A grid holds each agent in every cell that its bounding box meets. The cells are hashed into buckets,
/// so the memory depends on the number of agents, not on the size of the map.
class PlaneIndex {
 public:
  /// Side of a cell [m].
  static constexpr double cell = 4.0;

  /// Rebuilds the index for `count` agents. `box_of(slot)` returns an agent's bounding box; an empty box leaves the
  /// agent out. No allocation once warm. O(count).
  template <class BoxOf>
  void refresh(std::size_t count, BoxOf const& box_of) {
    ranges_.resize(count);
    begins_.assign(std::bit_ceil(count + 1) + 1, 0);
    std::size_t most = 0;
    for (Slot slot{}; index_of(slot) < count; ++slot) {
      geometry::Box const box = box_of(slot);
      auto& range = ranges_[slot];
      range = box.min_x <= box.max_x ? range_of(box) : Range{0, 0, -1, -1};
      for_each_cell(range, [&](std::int32_t x, std::int32_t y) { ++begins_[bucket(x, y) + 1]; });
      most += at_most(box.max_x - box.min_x) * at_most(box.max_y - box.min_y);
    }
    for (std::size_t i = 1; i < begins_.size(); ++i) begins_[i] += begins_[i - 1];
    if (entries_.capacity() < most) entries_.reserve(2 * most);
    entries_.resize(begins_.back());
    next_ = begins_;
    for (Slot slot{}; index_of(slot) < count; ++slot)
      for_each_cell(ranges_[slot], [&](std::int32_t x, std::int32_t y) {
        entries_[next_[bucket(x, y)]++] = {x, y, slot};
      });
  }

  /// Calls `f(slot)` once for each agent that shares a cell with `box`: every agent whose bounding box meets `box`, and
  /// some nearby. The order depends only on positions and slots. O(cells of the box + agents there), at most
  /// O(agents + 4096).
  template <class F>
  void for_each_near(geometry::Box const& box, F&& f) const {
    if (ranges_.empty() || !(box.min_x <= box.max_x)) return;
    auto const asked = range_of(box);
    auto const side = [](std::int32_t from, std::int32_t to) { return static_cast<double>(to) - from + 1.0; };
    if (side(asked.min_x, asked.max_x) * side(asked.min_y, asked.max_y) > 4096.0) {  // testing all agents is cheaper
      for (Slot slot{}; index_of(slot) < ranges_.size(); ++slot)
        if (meet(ranges_[slot], asked)) f(slot);
      return;
    }
    for_each_cell(asked, [&](std::int32_t x, std::int32_t y) {
      auto const in = bucket(x, y);
      for (auto i = begins_[in]; i < begins_[in + 1]; ++i) {
        auto const& entry = entries_[i];
        if (entry.x != x || entry.y != y) continue;
        auto const& range = ranges_[entry.slot];
        // Report an agent in several cells only once: in the first cell that it shares with the box.
        if (x == std::max(range.min_x, asked.min_x) && y == std::max(range.min_y, asked.min_y)) f(entry.slot);
      }
    });
  }

 private:
  struct Range {
    std::int32_t min_x, min_y, max_x, max_y;
  };
  struct Entry {
    std::int32_t x, y;
    Slot slot;
  };

  [[nodiscard]] static std::int32_t cell_of(double coordinate) {
    return static_cast<std::int32_t>(std::floor(std::clamp(coordinate / cell, -1e9, 1e9)));
  }
  [[nodiscard]] static Range range_of(geometry::Box const& box) {
    return {cell_of(box.min_x), cell_of(box.min_y), cell_of(box.max_x), cell_of(box.max_y)};
  }
  /// Largest number of cells that this side [m] of a box can meet.
  [[nodiscard]] static std::size_t at_most(double side) {
    return side >= 0.0 ? static_cast<std::size_t>(side / cell) + 2 : 0;
  }
  [[nodiscard]] static bool meet(Range const& a, Range const& b) {
    return std::max(a.min_x, b.min_x) <= std::min(a.max_x, b.max_x) &&
           std::max(a.min_y, b.min_y) <= std::min(a.max_y, b.max_y);
  }
  template <class F>
  static void for_each_cell(Range const& range, F&& f) {
    for (std::int32_t x = range.min_x; x <= range.max_x; ++x)
      for (std::int32_t y = range.min_y; y <= range.max_y; ++y) f(x, y);
  }

  [[nodiscard]] std::size_t bucket(std::int32_t x, std::int32_t y) const {
    auto const mixed = static_cast<std::uint32_t>(x) * 0x9E3779B1u ^ static_cast<std::uint32_t>(y) * 0x85EBCA77u;
    return (mixed ^ (mixed >> 15)) & (begins_.size() - 2);
  }

  IdVector<Range, Slot> ranges_;       ///< by slot
  std::vector<std::uint32_t> begins_;  ///< index of each bucket's first entry, and the end
  std::vector<std::uint32_t> next_;
  std::vector<Entry> entries_;  ///< by bucket, then slot
};

}  // namespace cambium::inline v0_1
