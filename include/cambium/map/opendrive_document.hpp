#pragma once

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cambium/map/cubic.hpp"
#include "cambium/map/lane_type.hpp"
#include "cambium/map/reference_line.hpp"

/// An OpenDRIVE file as plain data: ids are the file's words, nothing is linked or sampled. The reader fills it;
/// whoever builds a map, writes a file or checks one works on it. Every element has its `line` in the file (first line
/// 1, 0 unknown).
namespace cambium::map::opendrive {

/// Which end of a road a link touches; `none`: not written.
enum class ContactPoint { none, start, end };

enum class ElementType { road, junction };

/// Side of the road that traffic keeps to: right- or left-hand traffic.
enum class TrafficRule { right_hand, left_hand };

/// Across which side of a road mark lanes may be changed; `unspecified`: not written (the standard then means `both`).
enum class LaneChange { unspecified, both, increase, decrease, none };

/// Driving direction of a lane relative to what traffic rule and side say (revision 1.8).
enum class LaneDirection { standard, reversed, both };

/// Shift of the whole data set: translated by x, y, z, then rotated by `heading` about the origin of the map frame.
struct HeaderOffset {
  double x{};        ///< [m]
  double y{};        ///< [m]
  double z{};        ///< [m]
  double heading{};  ///< [rad]
};

struct Header {
  int rev_major = 0;  ///< 0: not written
  int rev_minor = 0;
  std::string name;
  std::string vendor;
  double north{};  ///< bounds as written [m]
  double south{};
  double east{};
  double west{};
  HeaderOffset offset;
  std::string geo_reference;  ///< projection string, empty when absent
  int line = 0;               ///< 0: the file has no header
};

struct RoadLink {
  ElementType element_type = ElementType::road;
  std::string id;
  ContactPoint contact_point = ContactPoint::none;  ///< always `none` for junctions
  std::optional<double>
      element_s;  ///< where the other road is met, in place of one of its ends (virtual junctions) [m]
  int line = 0;
};

/// Speed limit from `s` (roads) or `s` behind the section's start (lanes) on, to the next one.
struct SpeedRecord {
  double s{};                   ///< [m]
  std::optional<double> limit;  ///< [m/s], infinite for "no limit", empty for "undefined"
};

struct RoadType {
  double s{};                   ///< [m]
  std::string type;             ///< e.g. "motorway"
  std::optional<double> limit;  ///< [m/s], infinite for "no limit", empty when undefined or not written
};

struct RoadMark {
  double s_offset{};  ///< from the section's start [m]
  std::string type;   ///< e.g. "broken", "solid solid"
  std::string color;
  double width{};  ///< [m], 0: not written
  LaneChange lane_change = LaneChange::unspecified;
};

struct Lane {
  int id = 0;  ///< left > 0, right < 0, counted from the centre lane 0
  LaneType type = LaneType::none;
  bool level = false;
  LaneDirection direction = LaneDirection::standard;
  std::vector<int> predecessors;     ///< lane ids at the section's start, as written
  std::vector<int> successors;       ///< lane ids at the section's end
  std::vector<CubicRecord> widths;   ///< sorted; s counts from the section's start
  std::vector<CubicRecord> borders;  ///< sorted; outer border's t, in force only where there are no widths
  std::vector<RoadMark> road_marks;  ///< of the outer border (lane 0: of the centre line), sorted
  std::vector<SpeedRecord> speeds;   ///< sorted; s counts from the section's start
  int line = 0;
};

struct LaneSection {
  double s{};                ///< start station [m]
  bool single_side = false;  ///< the section speaks only for the sides that it has lanes for
  std::vector<Lane> lanes;   ///< from left to right: descending ids, unique; lane 0 is always there
  int line = 0;

  /// The lane of that id, null when there is none.
  [[nodiscard]] Lane const* find(int id) const {
    for (Lane const& lane : lanes)
      if (lane.id == id) return &lane;
    return nullptr;
  }
};

struct Road {
  std::string id;
  std::string name;
  double length{};       ///< as written [m]; the geometry's length counts, see `geometry_length`
  std::string junction;  ///< the junction that this road is a connecting road of; empty: none (written as "-1")
  TrafficRule rule = TrafficRule::right_hand;
  std::optional<RoadLink> predecessor;
  std::optional<RoadLink> successor;
  std::vector<RoadType> types;              ///< sorted
  std::vector<Geometry> geometries;         ///< sorted, at least one, header offset not applied
  std::vector<int> geometry_lines;          ///< line in the file of each geometry
  std::vector<CubicRecord> elevation;       ///< sorted; z(s) without the header offset
  std::vector<CubicRecord> superelevation;  ///< sorted [rad]
  std::vector<CubicRecord> lane_offset;     ///< sorted; t of lane 0's line
  std::vector<LaneSection> lane_sections;   ///< sorted, at least one
  int line = 0;

  /// Where the last geometry ends [m].
  [[nodiscard]] double geometry_length() const {
    return geometries.empty() ? 0.0 : geometries.back().s + geometries.back().length;
  }
};

struct LaneLink {
  int from = 0;
  int to = 0;
};

/// A way through a junction: from the incoming road into the connecting road, entered at `contact_point`.
struct Connection {
  std::string id;
  std::string incoming_road;
  std::string connecting_road;  ///< "linkedRoad" of a direct junction goes here too
  ContactPoint contact_point = ContactPoint::none;
  std::vector<LaneLink> lane_links;
  int line = 0;
};

struct Junction {
  std::string id;
  std::string name;
  std::string type = "default";
  std::vector<Connection> connections;
  int line = 0;
};

struct Document {
  Header header;
  std::vector<Road> roads;
  std::vector<Junction> junctions;
};

/// A pose of the file moved into the map frame by the header's offset.
[[nodiscard]] inline Geometry with_offset(Geometry g, HeaderOffset const& offset) {
  double const x = g.x + offset.x;
  double const y = g.y + offset.y;
  double const c = std::cos(offset.heading);
  double const s = std::sin(offset.heading);
  g.x = offset.heading == 0.0 ? x : c * x - s * y;
  g.y = offset.heading == 0.0 ? y : s * x + c * y;
  g.heading += offset.heading;
  return g;
}

/// The road's reference line in the map frame, header offset applied.
[[nodiscard]] inline ReferenceLine make_reference_line(Road const& road, HeaderOffset const& offset) {
  std::vector<Geometry> geometries;
  geometries.reserve(road.geometries.size());
  for (Geometry const& g : road.geometries) geometries.push_back(with_offset(g, offset));
  return ReferenceLine(std::move(geometries));
}

}  // namespace cambium::map::opendrive

namespace cambium::map {
using OpenDriveDocument = opendrive::Document;
}  // namespace cambium::map
