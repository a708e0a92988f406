#pragma once

#include <string>
#include <vector>

#include "cambium/map/opendrive/element.hpp"

/// Signs and traffic lights of an OpenDRIVE file, as far as lanes and maps need them.
namespace cambium::inline v0_1::map::opendrive {

/// The direction of travel that a signal applies to: "+" along the road's s, "-" against it, "none" both.
enum class Orientation { both, along, against };

/// The range of lanes that a signal applies to, both ends included, in either order.
struct Validity {
  int from_lane = 0;
  int to_lane = 0;
  Rest rest{};

  friend bool operator==(Validity const&, Validity const&) = default;
};

/// A sign or a traffic light at a road, or a reference to one at another road that applies here too.
struct Signal {
  std::string id;  ///< of a reference: the signal's
  double s{};      ///< station on this road [m]
  Orientation orientation = Orientation::both;
  std::string type;                  ///< number in a catalogue, such as "206"; empty for a reference
  std::vector<Validity> validities;  ///< none: all lanes
  Rest rest;                         ///< position, size, text, country, dependencies, ...
  FileLine line{};

  friend bool operator==(Signal const&, Signal const&) = default;
};

/// A signal that a controller switches.
struct Control {
  std::string signal_id;
  Rest rest{};

  friend bool operator==(Control const&, Control const&) = default;
};

/// Traffic lights that are switched together.
struct Controller {
  std::string id;
  std::vector<Control> controls;
  Rest rest;

  friend bool operator==(Controller const&, Controller const&) = default;
};

}  // namespace cambium::inline v0_1::map::opendrive
