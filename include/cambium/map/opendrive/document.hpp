#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cambium/map/opendrive/element.hpp"
#include "cambium/map/opendrive/lanes.hpp"
#include "cambium/map/opendrive/objects.hpp"
#include "cambium/map/road/cubic.hpp"
#include "cambium/map/road/reference_line.hpp"

/// An OpenDRIVE file as plain data: ids are the file's words, nothing is linked or sampled. The reader fills it;
/// whoever builds a map, writes a file or checks one works on it. What has no field is kept in the `rest` of its
/// element. Two documents are equal when they say the same; in which lines (`line`) does not count.
namespace cambium::map::opendrive {

/// Which end of a road a link touches; `none`: not written.
enum class ContactPoint { none, start, end };

enum class ElementType { road, junction };

/// Side of the road that traffic keeps to: right- or left-hand traffic.
enum class TrafficRule { right_hand, left_hand };

/// What a junction is: the words "default", "direct", "virtual" and "crossing"; `other` has its word in the rest.
enum class JunctionType { standard, direct, virtual_, crossing, other };

/// For which side of the road a crossfall counts.
enum class Side { both, left, right };

/// Shift of the whole data set: translated by x, y, z, then rotated by `heading` about the origin of the map frame.
struct HeaderOffset {
  double x{};        ///< [m]
  double y{};        ///< [m]
  double z{};        ///< [m]
  double heading{};  ///< [rad]

  friend bool operator==(HeaderOffset const&, HeaderOffset const&) = default;
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
  Rest rest;                  ///< version, date, user data, ...
  Line line;                  ///< 0: the file has no header

  friend bool operator==(Header const&, Header const&) = default;
};

/// What lies before or behind a road, or a connection of a virtual junction. A road is touched at one of its ends, or,
/// by a virtual junction, at the station `element_s` in the direction `element_direction`.
struct RoadLink {
  ElementType element_type = ElementType::road;
  std::string id;
  ContactPoint contact_point = ContactPoint::none;  ///< always `none` for junctions
  std::optional<double> element_s{};                ///< [m]
  Orientation element_direction = Orientation::both;
  Rest rest{};
  Line line{};

  friend bool operator==(RoadLink const&, RoadLink const&) = default;
};

struct RoadType {
  double s{};                   ///< [m]
  std::string type;             ///< e.g. "motorway"
  std::optional<double> limit;  ///< [m/s], infinite for "no limit", empty when undefined or not written
  SpeedUnit unit{};
  std::string country{};  ///< code of the country whose rules count, may be empty
  Rest rest{};

  friend bool operator==(RoadType const&, RoadType const&) = default;
};

/// Cross slope of one side of the road, a cubic of the station [rad].
struct Crossfall {
  CubicRecord record;
  Side side = Side::both;

  friend bool operator==(Crossfall const&, Crossfall const&) = default;
};

/// Piece of the height profile across the road at station `s`: a cubic of t, from t = `record.s` on [m].
struct LateralShape {
  double s{};  ///< [m]
  CubicRecord record;

  friend bool operator==(LateralShape const&, LateralShape const&) = default;
};

/// The rest of one geometry of a road.
struct GeometryRest {
  std::size_t geometry = 0;  ///< its index
  Rest rest;

  friend bool operator==(GeometryRest const&, GeometryRest const&) = default;
};

struct Road {
  std::string id;
  std::string name;
  double length{};       ///< as written [m]; the geometry's length counts, see `geometry_length`
  std::string junction;  ///< the junction that this road is a connecting road of; empty: none (written as "-1")
  TrafficRule rule = TrafficRule::right_hand;
  std::optional<RoadLink> predecessor;
  std::optional<RoadLink> successor;
  std::vector<RoadType> types;               ///< sorted
  std::vector<Geometry> geometries;          ///< sorted, at least one, header offset not applied
  std::vector<Line> geometry_lines;          ///< of each geometry
  std::vector<GeometryRest> geometry_rests;  ///< of the few geometries that have one, by rising index
  std::vector<CubicRecord> elevation;        ///< sorted; z(s) without the header offset
  std::vector<CubicRecord> superelevation;   ///< sorted [rad]
  std::vector<Crossfall> crossfall;          ///< sorted
  std::vector<LateralShape> shape;           ///< sorted by s, as written within one s
  std::vector<CubicRecord> lane_offset;      ///< sorted; t of lane 0's line
  std::vector<LaneSection> lane_sections;    ///< sorted, at least one
  std::vector<Signal> signals;
  std::vector<SignalReference> signal_references;
  std::vector<Object> objects;
  std::vector<ObjectReference> object_references;
  Rest rest;  ///< surface, railroad, user data, ...; in "objects" bridges and tunnels
  Line line;

  /// Where the last geometry ends [m].
  [[nodiscard]] double geometry_length() const {
    return geometries.empty() ? 0.0 : geometries.back().s + geometries.back().length;
  }

  friend bool operator==(Road const&, Road const&) = default;
};

struct LaneLink {
  int from = 0;
  int to = 0;
  std::optional<double> overlap_zone{};  ///< length over which both lanes lie on each other (direct junctions) [m]
  Rest rest{};

  friend bool operator==(LaneLink const&, LaneLink const&) = default;
};

/// A way through a junction: from the incoming road into the entered road, at its end `contact_point`.
struct Connection {
  std::string id;
  std::string incoming_road;
  std::string connecting_road;  ///< empty in direct junctions
  std::string linked_road;      ///< of direct junctions: the road that is entered without a connecting road
  ContactPoint contact_point = ContactPoint::none;
  std::string type;  ///< "default", "virtual" or empty
  std::vector<LaneLink> lane_links;
  std::optional<RoadLink> predecessor;  ///< of virtual connections
  std::optional<RoadLink> successor;    ///< of virtual connections
  Rest rest;
  Line line;

  /// The road that the connection leads into: the connecting one, or the linked one of a direct junction.
  [[nodiscard]] std::string const& entered_road() const {
    return connecting_road.empty() ? linked_road : connecting_road;
  }

  friend bool operator==(Connection const&, Connection const&) = default;
};

/// Traffic on the connecting road `high` goes before that on `low`.
struct Priority {
  std::string high;
  std::string low;
  Rest rest{};

  friend bool operator==(Priority const&, Priority const&) = default;
};

/// A controller whose signals stand in the junction.
struct JunctionController {
  std::string id;
  std::string type;
  std::optional<int> sequence{};
  Rest rest{};

  friend bool operator==(JunctionController const&, JunctionController const&) = default;
};

struct Junction {
  std::string id;
  std::string name;
  JunctionType type = JunctionType::standard;
  std::string main_road;          ///< of virtual junctions: the road that goes through
  std::optional<double> s_start;  ///< where on the main road [m]
  std::optional<double> s_end;    ///< [m]
  Orientation orientation = Orientation::both;
  std::vector<Connection> connections;
  std::vector<Priority> priorities;
  std::vector<JunctionController> controllers;
  Rest rest;
  Line line;

  friend bool operator==(Junction const&, Junction const&) = default;
};

struct Document {
  Header header;
  std::vector<Road> roads;
  std::vector<Junction> junctions;
  std::vector<Controller> controllers;
  Rest rest;  ///< the root's attributes; junction groups, stations, user data, ...

  friend bool operator==(Document const&, Document const&) = default;
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
