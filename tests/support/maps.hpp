#pragma once

#include <memory>
#include <string>

#include "cambium/map/building/road_plan.hpp"
#include "cambium/map/map.hpp"

/// Maps for tests.
namespace support {

/// A road "1" from the origin along +x with `lanes` lanes of 3.5 m to the right of the reference line.
std::shared_ptr<cambium::Map const> straight_road(int lanes = 2, double length = 1000.0, double curvature = 0.0);

/// The same with one lane in each direction, the axis between them.
std::shared_ptr<cambium::Map const> two_way_road(double length);

/// A straight road of 500 m, as `straight_road`, with an OpenDRIVE signal of `type` for its lanes at 200 m.
std::shared_ptr<cambium::Map const> road_with_signal(std::string const& type, int lanes = 1);

/// The project's own map of that file name.
std::shared_ptr<cambium::Map const> own_map(std::string const& name);

/// The map of one road.
std::shared_ptr<cambium::Map const> map_of(cambium::map::RoadPlan road);

/// The map of an OpenDRIVE file of the corpus; null where there is no corpus (see `corpus::find`).
std::shared_ptr<cambium::Map const> corpus_map(std::string const& name);

}  // namespace support
