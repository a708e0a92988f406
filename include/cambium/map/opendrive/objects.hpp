#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cambium/map/opendrive/element.hpp"

/// Signals, controllers and objects of an OpenDRIVE file: data that is kept, not interpreted. Places are on the road's
/// reference line (s) and left of it (t).
namespace cambium::map::opendrive {

/// For which direction of travel something counts: "+" along the road's s, "-" against it, "none" both.
enum class Orientation { both, along, against };

/// The lanes that a signal or an object counts for.
struct Validity {
  int from_lane = 0;
  int to_lane = 0;
  Rest rest{};

  friend bool operator==(Validity const&, Validity const&) = default;
};

struct Signal {
  std::string id;
  double s{};  ///< [m]
  double t{};  ///< [m]
  std::string name;
  bool dynamic = false;  ///< it changes, as a traffic light does
  Orientation orientation = Orientation::both;
  double z_offset{};    ///< of its lower edge above the road [m]
  std::string country;  ///< by whose catalogue `type` and `subtype` are meant
  std::string country_revision;
  std::string type;
  std::string subtype;
  std::optional<double> value;  ///< e.g. of a speed limit, in `unit`
  std::string unit;
  std::optional<double> height;  ///< [m]
  std::optional<double> width;   ///< [m]
  std::string text;
  double h_offset{};  ///< heading relative to the road and the orientation [rad]
  double pitch{};     ///< [rad]
  double roll{};      ///< [rad]
  std::vector<Validity> validities;
  Rest rest;  ///< dependencies, references, positions, ...
  Line line;

  friend bool operator==(Signal const&, Signal const&) = default;
};

/// A signal of another road that counts here too.
struct SignalReference {
  std::string id;  ///< the signal's
  double s{};      ///< [m]
  double t{};      ///< [m]
  Orientation orientation = Orientation::both;
  std::vector<Validity> validities;
  Rest rest;
  Line line;

  friend bool operator==(SignalReference const&, SignalReference const&) = default;
};

/// A signal that a controller switches.
struct Control {
  std::string signal_id;
  std::string type;
  Rest rest{};

  friend bool operator==(Control const&, Control const&) = default;
};

/// Dynamic signals that are switched together.
struct Controller {
  std::string id;
  std::string name;
  std::optional<int> sequence;
  std::vector<Control> controls;
  Rest rest;
  Line line;

  friend bool operator==(Controller const&, Controller const&) = default;
};

/// A corner of an outline on the road.
struct RoadCorner {
  double s{};       ///< [m]
  double t{};       ///< [m]
  double dz{};      ///< above the road [m]
  double height{};  ///< of the object there [m]
  std::optional<int> id;
  Rest rest{};

  friend bool operator==(RoadCorner const&, RoadCorner const&) = default;
};

/// A corner of an outline in the object's frame.
struct LocalCorner {
  double u{};       ///< forward [m]
  double v{};       ///< to the left [m]
  double z{};       ///< [m]
  double height{};  ///< of the object there [m]
  std::optional<int> id;
  Rest rest{};

  friend bool operator==(LocalCorner const&, LocalCorner const&) = default;
};

/// A polygon, or a chain where it is not closed. It has corners of one kind only in a file that follows the standard.
struct Outline {
  std::optional<int> id;
  bool closed = false;
  std::string fill_type;
  std::string lane_type;
  std::vector<RoadCorner> road_corners;
  std::vector<LocalCorner> local_corners;
  Rest rest;

  friend bool operator==(Outline const&, Outline const&) = default;
};

/// Copies of an object along a stretch of road. What is empty is the object's own.
struct Repeat {
  double s{};         ///< [m]
  double length{};    ///< of the stretch [m]
  double distance{};  ///< between two copies, 0: one object all along [m]
  std::optional<double> t_start, t_end;
  std::optional<double> width_start, width_end;
  std::optional<double> height_start, height_end;
  std::optional<double> z_offset_start, z_offset_end;
  std::optional<double> length_start, length_end;
  std::optional<double> radius_start, radius_end;
  Rest rest;

  friend bool operator==(Repeat const&, Repeat const&) = default;
};

struct Object {
  std::string id;
  std::string name;
  std::string type;
  std::string subtype;
  double s{};                    ///< of its origin [m]
  double t{};                    ///< [m]
  double z_offset{};             ///< of its origin above the road [m]
  double heading{};              ///< relative to the road [rad]
  double pitch{};                ///< [rad]
  double roll{};                 ///< [rad]
  std::optional<double> height;  ///< [m]
  std::optional<double> length;  ///< [m], with `width`; or a cylinder with `radius`
  std::optional<double> width;   ///< [m]
  std::optional<double> radius;  ///< [m]
  Orientation orientation = Orientation::both;
  double valid_length{};  ///< [m]
  bool dynamic = false;
  std::vector<Outline> outlines;
  std::vector<Repeat> repeats;
  std::vector<Validity> validities;
  Rest rest;  ///< parking space, markings, borders, materials, ...
  Line line;

  friend bool operator==(Object const&, Object const&) = default;
};

/// An object of another road that counts here too.
struct ObjectReference {
  std::string id;         ///< the object's
  double s{};             ///< [m]
  double t{};             ///< [m]
  double z_offset{};      ///< [m]
  double valid_length{};  ///< [m]
  Orientation orientation = Orientation::both;
  std::vector<Validity> validities;
  Rest rest;
  Line line;

  friend bool operator==(ObjectReference const&, ObjectReference const&) = default;
};

}  // namespace cambium::map::opendrive
