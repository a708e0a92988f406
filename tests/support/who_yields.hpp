#pragma once

#include <memory>
#include <string>
#include <utility>

#include "cambium/core/ids.hpp"
#include "cambium/map/corridor/corridor.hpp"
#include "cambium/map/routing/route.hpp"
#include "cambium/map/map.hpp"

namespace support {

/// The way of an agent through a junction of one of the project's maps, on which it yields to another one that crosses
/// it, and that one's way. Throws if there is none.
struct WhoYields {
  std::shared_ptr<cambium::Map const> map;
  cambium::map::Route own{}, other{};
  cambium::map::ConflictZone zone{};
  cambium::LightId light = cambium::none<cambium::LightId>;  ///< of the other one

  explicit WhoYields(std::string const& file = "intersection_3way.xodr");

  /// Lane and position there: `way` [m] before the zone, on the first two lanes of `own` or of `other`.
  [[nodiscard]] std::pair<cambium::LaneId, double> own_place(double way) const;
  [[nodiscard]] std::pair<cambium::LaneId, double> other_place(double way) const;
};

}  // namespace support
