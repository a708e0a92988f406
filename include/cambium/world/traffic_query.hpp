#pragma once

#include <cstdint>
#include <limits>

namespace cambium {

/// A road user on the lanes: `position` in the map-wide lane coordinate (see `Lane::index_begin`), how far it reaches
/// from there forward and back [m], its speed along the lane [m/s]. `slot` is its place among the agents or the
/// objects, `id` the value of its AgentId or ObjectId. Sorted by position, then slot.
struct TrafficEntry {
  double position{};
  double front{}, rear{};
  double speed{};
  std::uint32_t slot{};
  std::uint32_t id{};

  friend bool operator<(TrafficEntry const& a, TrafficEntry const& b) {
    return a.position < b.position || (a.position == b.position && a.slot < b.slot);
  }
};

/// Who asks for neighbours: a position `s` on a lane corridor and the asker's extent. `slot` breaks ties and is never
/// found.
struct TrafficQuery {
  std::uint32_t slot{};
  double s{};
  double front{}, rear{};
  std::uint16_t piece{};
  bool with_merging = true;  ///< who is in a lane that is still to merge counts
  bool by_rule = false;      ///< leave out who is still to merge in a junction (see `Feeder::by_rule`)

  /// Whether an entry, `distance` [m] away, is passed over: it is the asker's own.
  [[nodiscard]] bool skips(TrafficEntry const& entry, double /*distance*/) const { return entry.slot == slot; }
  /// The same of a static object.
  [[nodiscard]] bool skips_object(TrafficEntry const&, double) const { return false; }
};

/// One who does not see everybody: `sees(slot)` says whom, `sees_object(slot)` which objects.
template <class Sees, class SeesObject>
struct SightedQuery : TrafficQuery {
  Sees sees;
  SeesObject sees_object;
  double far = 400.0;  ///< who is farther ends the search, seen or not [m]

  [[nodiscard]] bool skips(TrafficEntry const& entry, double distance) const {
    return entry.slot == slot || (distance <= far && !sees(entry.slot));
  }
  [[nodiscard]] bool skips_object(TrafficEntry const& entry, double distance) const {
    return distance <= far && !sees_object(entry.slot);
  }
};

/// What was found: an agent, or an object.
struct TrafficHit {
  std::uint32_t slot{};
  std::uint32_t id{};
  bool is_object = false;
  double gap = std::numeric_limits<double>::infinity();  ///< [m]
  double speed{};                                        ///< along its lane [m/s]
  double length{};                                       ///< along its lane [m]
};

}  // namespace cambium
