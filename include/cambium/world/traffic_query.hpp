#pragma once

#include <cstdint>

#include "cambium/behavior/view.hpp"

namespace cambium::inline v0_1 {

/// A road user on a lane: the `position` of its reference point in the map-wide lane coordinate (see
/// `Lane::index_begin`), its extent in front of and behind that point [m] and its speed along the lane [m/s]. `slot`
/// numbers it among the agents or the objects; `id` is the value of its AgentId or ObjectId. Entries sort by position,
/// then slot.
struct TrafficEntry {
  double position{};
  double front{}, rear{};
  double speed{};
  Slot slot{};
  std::uint32_t id{};

  friend bool operator<(TrafficEntry const& a, TrafficEntry const& b) {
    return a.position < b.position || (a.position == b.position && a.slot < b.slot);
  }
};

/// A search for neighbours: the searching agent's position `s` on a lane corridor, its extent, and which road users
/// count. `slot` is the searching agent's own: it breaks ties, and its entries are never found.
struct TrafficQuery {
  Slot slot{};
  double s{};
  double front{}, rear{};
  PieceId piece{};
  Merging merging = Merging::counts;
  double distance = Look::horizon;  ///< largest distance between reference points [m]

  /// Whether the search skips an entry `way` [m] away: here, the searching agent's own entries.
  [[nodiscard]] bool skips(TrafficEntry const& entry, bool is_object, double /*way*/) const {
    return !is_object && entry.slot == slot;
  }
};

/// A query that finds only visible road users: `sees(entry, way)` tests agents, `sees_object(slot)` static objects.
template <class Sees, class SeesObject>
struct SightedQuery : TrafficQuery {
  Sees sees;
  SeesObject sees_object;
  double far = Look::horizon;  ///< an entry farther away ends the search, visible or not [m]

  /// Whether the search goes on behind this entry, `way` [m] ahead: ego cannot see it.
  [[nodiscard]] bool skips(TrafficEntry const& entry, bool is_object, double way) const {
    if (is_object) return way <= far && !sees_object(entry.slot);
    return entry.slot == slot || (way <= far && !sees(entry, way));
  }
};

}  // namespace cambium::inline v0_1
