#pragma once

#include <cmath>
#include <memory>
#include <sstream>
#include <string>

#include "cambium/behavior/behavior_set.hpp"
#include "cambium/behavior/constant_acceleration.hpp"
#include "cambium/behavior/external_input.hpp"
#include "cambium/behavior/idm_classic.hpp"
#include "cambium/dynamics/single_track.hpp"
#include "cambium/execution/interpolate.hpp"
#include "cambium/map/opendrive.hpp"
#include "cambium/world/world.hpp"

namespace fixtures {

namespace cb = cambium;

using Sim = cb::World<cb::BehaviorSet<cb::IdmClassic, cb::ConstantAcceleration, cb::ExternalInput>, cb::InterpolateExecution, cb::SingleTrack>;

/// A road from the origin along +x with `lanes` lanes of 3.5 m to the right of the reference line.
inline std::shared_ptr<cb::Map const> straight_road(int lanes = 2, double length = 1000.0, double curvature = 0.0) {
  std::ostringstream xml;
  xml.precision(17);
  xml << R"(<OpenDRIVE><header revMajor="1" revMinor="6"/><road id="1" junction="-1" length=")" << length
      << R"("><planView><geometry s="0" x="0" y="0" hdg="0" length=")" << length << R"(">)";
  if (curvature == 0.0)
    xml << "<line/>";
  else
    xml << R"(<arc curvature=")" << curvature << R"("/>)";
  xml << R"(</geometry></planView><lanes><laneSection s="0"><center><lane id="0" type="none"/></center><right>)";
  for (int lane = 1; lane <= lanes; ++lane)
    xml << R"(<lane id="-)" << lane << R"(" type="driving"><width sOffset="0" a="3.5" b="0" c="0" d="0"/></lane>)";
  xml << "</right></laneSection></lanes></road></OpenDRIVE>";
  return cb::parse_opendrive(xml.str()).map;
}

inline std::shared_ptr<cb::Map const> own_map(std::string const& name) {
  return cb::load_opendrive(CAMBIUM_SOURCE_DIR "/maps/" + name).map;
}

/// A shape that reaches `front` and `rear` from its reference point, 1 m to either side.
inline cb::geometry::Shape box(double front, double rear) { return {front, rear, 1.0, 1.0}; }

}  // namespace fixtures
