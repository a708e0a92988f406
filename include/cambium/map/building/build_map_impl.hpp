#pragma once

#include <utility>

#include "cambium/core/macros.hpp"
#include "cambium/map/building/build_map.hpp"
#include "cambium/map/building/detail/lane_merges.hpp"
#include "cambium/map/building/detail/lane_rules.hpp"
#include "cambium/map/building/detail/map_build.hpp"
#include "cambium/map/building/detail/split_roads.hpp"
#include "cambium/map/detail/require_buildable.hpp"

namespace cambium::inline v0_1::map {

CAMBIUM_COLD std::shared_ptr<Map const> build_map(OpenDriveDocument document, MapOptions const& options,
                                                  std::string file, std::vector<Diagnostic>& diagnostics) {
  detail::RequireBuildable::check(document);
  detail::split_roads(document);
  return detail::MapBuild(document, options, std::move(file), diagnostics).build();
}

CAMBIUM_COLD std::shared_ptr<Map const> build_linked_map(OpenDriveDocument const& document, MapOptions const& options,
                                                         std::string file, std::vector<Diagnostic>& diagnostics,
                                                         std::function<void(Map::Parts&)> const& link) {
  detail::RequireBuildable::check(document);
  detail::MapBuild build(document, options, std::move(file), diagnostics, true);
  build.add_lanes();
  link(build.parts());
  detail::merge_into_neighbors(build.parts(), build.lane_findings());
  detail::set_speed_limits(document, build.parts().lanes);
  return build.finish([](Lane const& lane, double s) { return lane.path.pose(s); });
}

}  // namespace cambium::inline v0_1::map
