#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cambium/core/portable_math.hpp"
#include "cambium/map/opendrive/element.hpp"
#include "cambium/map/opendrive/lanes.hpp"
#include "cambium/map/opendrive/signals.hpp"
#include "cambium/map/road/cubic.hpp"
#include "cambium/map/road/reference_line.hpp"

/// An OpenDRIVE file as plain data: ids are text as in the file, and nothing is linked or sampled. The reader fills a
/// document; checks, the writer and the map building work on it. What has no field is kept in the `rest` of its
/// element. Two documents are equal when they say the same, no matter in which lines (`line`).
namespace cambium::inline v0_1::map::opendrive {

/// Which end of a road a link touches; `none`: not written.
enum class ContactPoint { none, start, end };

/// What a road links to.
enum class ElementType { road, junction };

/// Side of the road that traffic keeps to: right- or left-hand traffic.
enum class DrivingSide { right_hand, left_hand };

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

/// `<header>`.
struct Header {
  int rev_major = 0;  ///< 0: not written
  int rev_minor = 0;
  std::string name;
  std::string vendor;
  HeaderOffset offset;
  std::string geo_reference;  ///< projection string, empty when absent
  Rest rest;                  ///< version, date, bounds, user data, ...
  FileLine line;              ///< 0: the file has no header

  friend bool operator==(Header const&, Header const&) = default;
};

/// What lies before or behind a road, or a connection of a virtual junction. The link meets a road at one of its ends,
/// or, in a virtual junction, at the station `element_s`.
struct RoadLink {
  ElementType element_type = ElementType::road;
  std::string id;
  ContactPoint contact_point = ContactPoint::none;  ///< always `none` for junctions
  std::optional<double> element_s{};                ///< [m]
  Rest rest{};
  FileLine line{};

  friend bool operator==(RoadLink const&, RoadLink const&) = default;
};

/// `<type>`: what kind of road it is from `s` on, and its speed limit.
struct RoadType {
  double s{};                   ///< [m]
  std::string type;             ///< e.g. "motorway"
  std::optional<double> limit;  ///< [m/s], infinite for "no limit", empty when undefined or not written
  SpeedUnit unit{};
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

/// `<road>`.
struct RoadElement {
  std::string id;
  std::string name;
  double length{};       ///< as written [m]; the geometry's length counts, see `geometry_length`
  std::string junction;  ///< the junction that this road is a connecting road of; empty: none (written as "-1")
  DrivingSide rule = DrivingSide::right_hand;
  std::optional<RoadLink> predecessor;
  std::optional<RoadLink> successor;
  std::vector<RoadType> types;               ///< sorted
  std::vector<Geometry> geometries;          ///< sorted, at least one, header offset not applied
  std::vector<FileLine> geometry_lines;      ///< of each geometry
  std::vector<GeometryRest> geometry_rests;  ///< of the few geometries that have one, by rising index
  std::vector<CubicRecord> elevation;        ///< sorted; z(s) without the header offset
  std::vector<CubicRecord> superelevation;   ///< sorted [rad]
  std::vector<Crossfall> crossfall;          ///< sorted
  std::vector<LateralShape> shape;           ///< sorted by s, as written within one s
  std::vector<CubicRecord> lane_offset;      ///< sorted; t of lane 0's line
  std::vector<LaneSection> lane_sections;    ///< sorted, at least one
  std::vector<Signal> signals;
  std::vector<Signal> signal_references;
  Rest rest;  ///< objects, surface, railroad, user data, ...
  FileLine line;

  /// Where the last geometry ends [m].
  [[nodiscard]] double geometry_length() const {
    return geometries.empty() ? 0.0 : geometries.back().s + geometries.back().length;
  }

  friend bool operator==(RoadElement const&, RoadElement const&) = default;
};

/// `<laneLink>`: ids of the lane on the incoming and on the connecting road.
struct LaneLink {
  int from = 0;
  int to = 0;
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
  std::vector<LaneLink> lane_links;
  std::optional<RoadLink> predecessor;  ///< of virtual connections
  std::optional<RoadLink> successor;    ///< of virtual connections
  Rest rest;
  FileLine line;

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

/// `<junction>`.
struct JunctionElement {
  std::string id;
  std::string name;
  JunctionType type = JunctionType::standard;
  std::vector<Connection> connections;
  std::vector<Priority> priorities;
  Rest rest;  ///< controllers, crossing paths, the main road of a virtual junction, ...
  FileLine line;

  friend bool operator==(JunctionElement const&, JunctionElement const&) = default;
};

/// `<OpenDRIVE>`: all that a file says.
struct Document {
  Header header;
  std::vector<RoadElement> roads;
  std::vector<JunctionElement> junctions;
  std::vector<Controller> controllers;
  Rest rest;  ///< the root's attributes; junction groups, stations, user data, ...

  friend bool operator==(Document const&, Document const&) = default;
};

/// A pose of the file moved into the map frame by the header's offset.
[[nodiscard]] inline Geometry with_offset(Geometry g, HeaderOffset const& offset) {
  double const x = g.x + offset.x;
  double const y = g.y + offset.y;
  auto const [s, c] = portable::sin_cos(offset.heading);
  g.x = offset.heading == 0.0 ? x : c * x - s * y;
  g.y = offset.heading == 0.0 ? y : s * x + c * y;
  g.heading += offset.heading;
  return g;
}

/// The road's reference line in the map frame, header offset applied.
[[nodiscard]] inline ReferenceLine make_reference_line(RoadElement const& road, HeaderOffset const& offset) {
  std::vector<Geometry> geometries;
  geometries.reserve(road.geometries.size());
  for (Geometry const& g : road.geometries) geometries.push_back(with_offset(g, offset));
  return ReferenceLine(std::move(geometries));
}

}  // namespace cambium::inline v0_1::map::opendrive

namespace cambium::inline v0_1::map {
/// An OpenDRIVE file as a struct.
using OpenDriveDocument = opendrive::Document;
}  // namespace cambium::inline v0_1::map
