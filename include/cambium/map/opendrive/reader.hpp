#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "cambium/core/diagnostic.hpp"
#include "cambium/core/error.hpp"
#include "cambium/map/opendrive/document.hpp"
#include "cambium/map/opendrive/reading_limits.hpp"

#ifdef CAMBIUM_COMPILED_WITHOUT_READER
#error "cambium::compiled holds no reader of OpenDRIVE, for CMake did not find pugixml: install it (libpugixml-dev)"
#endif

namespace cambium::map {

/// Reads an OpenDRIVE file (revisions 1.1 to 1.8) from its text; `file_name` only names it in messages. Numbers are
/// read in the C locale. What is odd goes to `diagnostics`, and is read as far as it makes sense: a bad record is left
/// out, so is a signal, object or controller without an id or a place, a road with an unusable geometry, the second of
/// what may be there once, what stands in an element that has attributes only (cubics, speeds, lane links, header
/// offset, curves), and what follows the root element. An XML namespace prefix is ignored. What the
/// document has no field for is kept in its `rest`s, but for comments, text between elements, and attributes that are
/// not known of an element that has attributes only; of the latter two there is one finding for each kind of element,
/// with their number. Throws `MapError` when the text is no XML, its root is not
/// OpenDRIVE, no road is usable, or, before it takes memory, where it is beyond `largest_map_file`, `deepest_element`
/// or `most_elements`. Linear in the length of the text; lines are counted in bytes of UTF-8.
[[nodiscard]] OpenDriveDocument read_opendrive_document(std::string_view text, std::string file_name,
                                                        std::vector<Diagnostic>& diagnostics);

}  // namespace cambium::map

#ifndef CAMBIUM_COMPILED
#include "cambium/map/opendrive/reader_impl.hpp"
#endif
