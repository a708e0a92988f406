#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cambium/map/opendrive/element.hpp"
#include "cambium/map/road/cubic.hpp"
#include "cambium/map/road/lane_type.hpp"

/// Lane sections of an OpenDRIVE file.
namespace cambium::inline v0_1::map::opendrive {

/// Across which side of a road mark lanes may be changed; `unspecified`: not written (the standard then means `both`).
enum class LaneChangePermission { unspecified, both, increase, decrease, none };

/// Driving direction of a lane relative to what traffic rule and side say (revision 1.8).
enum class LaneDirection { standard, reversed, both };

/// The unit in which a speed limit is written.
enum class SpeedUnit { metres_per_second, kilometres_per_hour, miles_per_hour };

/// Speed limit from `s` on, to the next one; of lanes, `s` counts from the section's start.
struct SpeedRecord {
  double s{};                   ///< [m]
  std::optional<double> limit;  ///< [m/s], infinite for "no limit", empty for "undefined"
  SpeedUnit unit{};

  friend bool operator==(SpeedRecord const&, SpeedRecord const&) = default;
};

/// `<roadMark>`.
struct RoadMark {
  double s_offset{};  ///< from the section's start [m]
  std::string type;   ///< e.g. "broken", "solid solid"
  std::string color;
  double width{};  ///< [m], 0: not written
  LaneChangePermission lane_change = LaneChangePermission::unspecified;
  std::string weight{};  ///< "standard", "bold" or empty
  Rest rest{};           ///< the single lines, sway, material, height

  friend bool operator==(RoadMark const&, RoadMark const&) = default;
};

/// Height of a lane above the plane of the road, as on a kerb.
struct HeightRecord {
  double s_offset{};  ///< from the section's start [m]
  double inner{};     ///< at the border towards lane 0 [m]
  double outer{};     ///< [m]
  Rest rest{};

  friend bool operator==(HeightRecord const&, HeightRecord const&) = default;
};

/// `<lane>`.
struct LaneElement {
  int id = 0;  ///< left > 0, right < 0, counted from the centre lane 0
  LaneType type = LaneType::none;
  LaneDirection direction = LaneDirection::standard;
  std::vector<int> predecessors;      ///< lane ids at the section's start, as written
  std::vector<int> successors;        ///< lane ids at the section's end
  std::vector<CubicRecord> widths;    ///< sorted; s counts from the section's start
  std::vector<CubicRecord> borders;   ///< sorted; outer border's t, in force only where there are no widths
  std::vector<RoadMark> road_marks;   ///< of the outer border (lane 0: of the centre line), sorted
  std::vector<SpeedRecord> speeds;    ///< sorted; s counts from the section's start
  std::vector<HeightRecord> heights;  ///< sorted
  Rest rest;                          ///< who may use it, rules, materials, user data, ...
  FileLine line;

  friend bool operator==(LaneElement const&, LaneElement const&) = default;
};

/// `<laneSection>`.
struct LaneSection {
  double s{};                      ///< start station [m]
  bool single_side = false;        ///< it speaks only for the sides that it has lanes for; the reader adds the other's
  std::vector<LaneElement> lanes;  ///< from left to right: descending ids, unique; lane 0 is always there
  Rest rest;
  FileLine line;

  /// The lane of that id, null when there is none.
  [[nodiscard]] LaneElement const* find(int id) const {
    for (LaneElement const& lane : lanes)
      if (lane.id == id) return &lane;
    return nullptr;
  }

  friend bool operator==(LaneSection const&, LaneSection const&) = default;
};

}  // namespace cambium::inline v0_1::map::opendrive
