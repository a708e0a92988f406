#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "cambium/core/diagnostic.hpp"
#include "cambium/map/opendrive/document.hpp"

#ifdef CAMBIUM_COMPILED_WITHOUT_READER
#error "cambium::compiled has no OpenDRIVE reader because CMake did not find pugixml: install it (libpugixml-dev)"
#endif

namespace cambium::inline v0_1::map {

/// Reads an OpenDRIVE file (revisions 1.1 to 1.8) from its text; `file_name` only names it in messages. Numbers are
/// read in the C locale. Oddities go to `diagnostics`, and what makes sense is read. Left out are bad records,
/// signals without an id or a place, controllers without an id, roads with an unusable geometry, the second of what may
/// occur once, the content of elements that should have attributes only (cubics, speeds, lane links, header offset,
/// curves), and what follows the root element. An XML namespace prefix is ignored. What the document has no field for
/// is kept in its `rest`s, except comments, text between elements, and unknown attributes of elements that have
/// attributes only; for the latter two there is one finding for each kind of element, with their number. Throws
/// `MapError` when the text is not XML, its root is not OpenDRIVE, no road is usable, or, before it takes memory, when
/// it exceeds `largest_map_file`, `deepest_element` or `most_elements`. Linear in the length of the text; lines are
/// counted in bytes of UTF-8.
[[nodiscard]] OpenDriveDocument read_opendrive_document(std::string_view text, std::string file_name,
                                                        std::vector<Diagnostic>& diagnostics);

}  // namespace cambium::inline v0_1::map

#ifndef CAMBIUM_COMPILED
#include "cambium/map/opendrive/reader_impl.hpp"
#endif
