#pragma once

#include <cstdint>

#include "cambium/behavior/view.hpp"

namespace cambium {

/// A road user on the lanes: `position` in the map-wide lane coordinate (see `Lane::index_begin`), how far it reaches
/// from there forward and back [m], its speed along the lane [m/s]. `slot` is its place among the agents or the
/// objects, `id` the value of its AgentId or ObjectId. Sorted by position, then slot.
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

/// Who asks for neighbours: a position `s` on a lane corridor, the asker's extent, and what counts. `slot` breaks ties
/// and is never found.
struct TrafficQuery {
  Slot slot{};
  double s{};
  double front{}, rear{};
  PieceId piece{};
  Merging merging = Merging::counts;
  double distance = Look::horizon;  ///< reference points farther away are not found [m]

  /// Whether an entry, `way` [m] away, is passed over: it is the asker's own.
  [[nodiscard]] bool skips(TrafficEntry const& entry, double /*way*/) const { return entry.slot == slot; }
  /// The same of a static object.
  [[nodiscard]] bool skips_object(TrafficEntry const&, double) const { return false; }
};

/// One who does not see everybody: `sees(entry, way)` says whom, `sees_object(slot)` which objects.
template <class Sees, class SeesObject>
struct SightedQuery : TrafficQuery {
  Sees sees;
  SeesObject sees_object;
  double far = Look::horizon;  ///< who is farther ends the search, seen or not [m]

  [[nodiscard]] bool skips(TrafficEntry const& entry, double way) const {
    return entry.slot == slot || (way <= far && !sees(entry, way));
  }
  [[nodiscard]] bool skips_object(TrafficEntry const& entry, double way) const {
    return way <= far && !sees_object(entry.slot);
  }
};

}  // namespace cambium
