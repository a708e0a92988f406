#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "cambium/core/diagnostic.hpp"
#include "cambium/map/map.hpp"
#include "cambium/map/opendrive/document.hpp"

namespace cambium::inline v0_1::map {

/// The map that a document describes; what was odd is added to `diagnostics`, with `file` as the place: links that lead
/// nowhere, that only one side knows, or that seem to be missing (see `MapOptions::infer_links`), joined lanes that do
/// not meet, a map without a lane to drive on. Throws `MapError` where no lane is left, and where a document, which may
/// have been made or changed in code, lacks what the reader guarantees: geometries and lane sections in order and
/// finite, a curve for each cubic, no id twice. (`check_opendrive_document` finds more, and mends some of it.)
///
/// A lane for both directions (`direction="both"`, type bidirectional) becomes two lanes, see `Lane::opposite`. Lanes
/// are linked at their ends only: a section is split where a connecting road of a virtual junction meets the middle of
/// a road, and in the middle of a road of one section that closes upon itself.
[[nodiscard]] std::shared_ptr<Map const> build_map(OpenDriveDocument document, MapOptions const& options,
                                                   std::string file, std::vector<Diagnostic>& diagnostics);

/// The map of a document whose roads are not linked: `link` enters in its lanes, which have their geometry by then, who
/// follows whom, who lies beside whom, where lanes may be changed, signs and lights. Afterwards lanes that end while a
/// neighbour goes on swing over onto that one. Findings and errors as those of `build_map`.
[[nodiscard]] std::shared_ptr<Map const> build_linked_map(OpenDriveDocument const& document, MapOptions const& options,
                                                          std::string file, std::vector<Diagnostic>& diagnostics,
                                                          std::function<void(Map::Parts&)> const& link);

}  // namespace cambium::inline v0_1::map

#ifndef CAMBIUM_COMPILED
#include "cambium/map/building/build_map_impl.hpp"
#include "cambium/map/map_impl.hpp"
#endif
