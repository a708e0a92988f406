#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cambium/core/diagnostic.hpp"
#include "cambium/map/lanelet/lanelet2_origin.hpp"
#include "cambium/map/lanelet/lanelet_map.hpp"
#include "cambium/map/map.hpp"

#ifdef CAMBIUM_COMPILED_WITHOUT_READER
#error "cambium::compiled has no Lanelet2 reader because CMake did not find pugixml: install it (libpugixml-dev)"
#endif

namespace cambium::inline v0_1::map {

/// The lanelets of a Lanelet2 file (OSM XML); `file` names it in messages. Nodes have `lat` and `lon`, or tags
/// `local_x` and `local_y` [m], which count where all nodes have them. A lanelet follows another where it begins at the
/// nodes where that ends, and lies beside it where they share a way. Read are: one way or both; subtypes and
/// participants, which give the kind of lane (who may neither drive, cycle nor walk there is left out); speed limits of
/// elements (by their German signs, or `sign_type`), of the tag `speed_limit`, else Lanelet2's German ones by location
/// and subtype; who may change lanes, by the tags `lane_change`, else by the lines; `turn_direction` (it lies in an
/// intersection); right of way (between ways through an intersection a priority, else signs), all-way stops, traffic
/// lights (those with the same heads are one) and signs (see `signal_codes`) with their stop lines. Throws `MapError`
/// where the text is no OSM file, has no lanelets, or a place is no number; what else is odd goes to `diagnostics`.
/// Linear in the text.
[[nodiscard]] std::vector<Lanelet> read_lanelet2(std::string_view text, std::optional<Lanelet2Origin> const& origin,
                                                 std::string const& file, std::vector<Diagnostic>& diagnostics);

/// The map of a Lanelet2 file. Throws as `read_lanelet2` and `build_lanelet_map`, and where the file cannot be read.
[[nodiscard]] LaneletMap load_lanelet2(std::string const& path, std::optional<Lanelet2Origin> const& origin = {},
                                       MapOptions const& options = {});

}  // namespace cambium::inline v0_1::map

namespace cambium::inline v0_1 {
using map::load_lanelet2;
}  // namespace cambium::inline v0_1

#ifndef CAMBIUM_COMPILED
#include "cambium/map/lanelet/lanelet2_impl.hpp"
#endif
