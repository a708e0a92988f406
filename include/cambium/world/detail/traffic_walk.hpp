#pragma once

#include <cstddef>
#include <span>

#include "cambium/core/ids.hpp"
#include "cambium/map/corridor/corridor.hpp"
#include "cambium/world/traffic_query.hpp"

namespace cambium::inline v0_1::detail {

/// Entries in their order.
using TrafficList = std::span<TrafficEntry const>;

/// First entry at or beyond `position`: a binary search without unpredictable branches.
[[nodiscard]] inline std::size_t first_at(TrafficList list, double position) {
  TrafficEntry const* base = list.data();
  std::size_t left = list.size();
  if (left == 0) return 0;
  while (left > 1) {
    std::size_t const half = left / 2;
    TrafficEntry const* const middle = base + half;
    base = middle[-1].position < position ? middle : base;
    left -= half;
  }
  return static_cast<std::size_t>(base - list.data()) + (base->position < position ? 1 : 0);
}
/// First entry that sorts after (position, slot).
[[nodiscard]] inline std::size_t upper(TrafficList list, double position, Slot slot) {
  auto i = first_at(list, position);
  while (i < list.size() && list[i].position == position && list[i].slot <= slot) ++i;
  return i;
}
/// First entry that does not sort before (position, slot).
[[nodiscard]] inline std::size_t lower(TrafficList list, double position, Slot slot) {
  auto i = first_at(list, position);
  while (i < list.size() && list[i].position == position && list[i].slot < slot) ++i;
  return i;
}

/// A search walking through a list: ahead (`sign` 1), where the next entry is number `at`, or back (-1), where it is
/// the one before.
template <int sign>
struct TrafficWalk {
  TrafficList list;
  std::size_t at;

  /// Where the search of the agent with this slot begins.
  [[nodiscard]] static std::size_t start(TrafficList list, double position, Slot slot) {
    return sign > 0 ? upper(list, position, slot) : lower(list, position, slot);
  }
  /// From `position` on, entries there included.
  [[nodiscard]] static TrafficWalk from(TrafficList list, double position) {
    return {list, sign > 0 ? first_at(list, position) : upper(list, position, none<Slot>)};
  }
  /// Into a piece of a lane corridor. Each overlaps its neighbours by 1 m, so that no entry is lost between them.
  [[nodiscard]] static TrafficWalk into(TrafficList list, map::CorridorPiece const& piece) {
    return from(list, (sign > 0 ? piece.begin - 1.0 : piece.end + 1.0) + piece.index_offset);
  }

  explicit operator bool() const { return sign > 0 ? at < list.size() : at > 0; }
  [[nodiscard]] TrafficEntry const& operator*() const { return list[sign > 0 ? at : at - 1]; }
  [[nodiscard]] TrafficEntry const* operator->() const { return &**this; }
  void operator++() { at = sign > 0 ? at + 1 : at - 1; }

  /// Whether the next entry lies in the piece, or before it.
  [[nodiscard]] bool is_within(map::CorridorPiece const& piece) const {
    return sign > 0 ? (**this).position <= piece.end + 1.0 + piece.index_offset
                    : (**this).position >= piece.begin - 1.0 + piece.index_offset;
  }
  /// How far the next entry reaches towards the searching agent [m].
  [[nodiscard]] double reach_back() const { return sign > 0 ? (**this).rear : (**this).front; }
};

}  // namespace cambium::inline v0_1::detail
