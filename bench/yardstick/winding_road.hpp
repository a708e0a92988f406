#pragma once

#include <cmath>
#include <memory>
#include <sstream>

#include "cambium/map/opendrive.hpp"

namespace yardstick {

/// A winding carriageway of three lanes and at least `length` metres.
inline std::shared_ptr<cambium::Map const> winding_road(double length) {
  constexpr double piece = 400.0, curvature = 1.0 / 700.0;
  int const pieces = static_cast<int>(std::ceil(length / piece));
  std::ostringstream xml;
  xml.precision(17);
  xml << "<OpenDRIVE><header revMajor=\"1\" revMinor=\"6\"/><road id=\"1\" junction=\"-1\" length=\"" << pieces * piece
      << "\"><planView>";
  double x = 0, y = 0, heading = -piece * curvature / 2;
  for (int i = 0; i < pieces; ++i) {
    double const k = i % 2 == 0 ? curvature : -curvature;
    xml << "<geometry s=\"" << i * piece << "\" x=\"" << x << "\" y=\"" << y << "\" hdg=\"" << heading << "\" length=\""
        << piece << "\"><arc curvature=\"" << k << "\"/></geometry>";
    double const next = heading + k * piece;
    x += (std::sin(next) - std::sin(heading)) / k;
    y -= (std::cos(next) - std::cos(heading)) / k;
    heading = next;
  }
  xml << "</planView><lanes><laneSection s=\"0\"><center><lane id=\"0\" type=\"none\"/></center><right>";
  for (int lane = 1; lane <= 3; ++lane)
    xml << "<lane id=\"-" << lane
        << "\" type=\"driving\"><width sOffset=\"0\" a=\"3.5\" b=\"0\" c=\"0\" d=\"0\"/></lane>";
  xml << "</right></laneSection></lanes></road></OpenDRIVE>";
  return cambium::parse_opendrive(xml.str()).map;
}

}  // namespace yardstick
