#pragma once

#include <utility>

#include "cambium/core/macros.hpp"
#include "cambium/map/building/build_map.hpp"
#include "cambium/map/building/detail/map_build.hpp"
#include "cambium/map/building/detail/split_roads.hpp"
#include "cambium/map/detail/require_buildable.hpp"

namespace cambium::map {

CAMBIUM_COLD std::shared_ptr<Map const> build_map(OpenDriveDocument document, MapOptions const& options,
                                                  std::string file, std::vector<Diagnostic>& diagnostics) {
  detail::RequireBuildable::check(document);
  detail::split_roads(document);
  return detail::MapBuild(document, options, std::move(file), diagnostics).build();
}

}  // namespace cambium::map
