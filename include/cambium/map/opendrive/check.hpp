#pragma once

#include <string>
#include <vector>

#include "cambium/core/diagnostic.hpp"
#include "cambium/map/opendrive/document.hpp"

namespace cambium::inline v0_1::map {

/// Checks a document as a whole and appends what it finds: double ids (the later element is removed), links and
/// connections that lead nowhere (kept), lane sections beyond the road's end (removed) or before its start (moved
/// there), geometries that do not go on where the previous one ends (kept; the road is removed where that is 100 m
/// away), widths and lane offsets beyond 1 km, heights beyond 100 km, tilts beyond 10 rad, a header's offset beyond any
/// map (removed), lengths that contradict the geometries (kept; the geometries count). O(n log n) in the size of the
/// document.
void check_opendrive_document(OpenDriveDocument& document, std::string file_name, std::vector<Diagnostic>& diagnostics);

}  // namespace cambium::inline v0_1::map

#ifndef CAMBIUM_COMPILED
#include "cambium/map/opendrive/check_impl.hpp"
#endif
