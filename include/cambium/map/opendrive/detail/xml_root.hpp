#pragma once

#include <algorithm>
#include <string>
#include <string_view>

#include <pugixml.hpp>

#include "cambium/core/error.hpp"
#include "cambium/map/detail/read_map_file.hpp"
#include "cambium/map/opendrive/detail/xml_context.hpp"
#include "cambium/map/opendrive/detail/xml_limits.hpp"

namespace cambium::inline v0_1::map::detail {

/// The root element of `text`, which `xml` holds then. Throws `MapError` when the text is not XML, is beyond the
/// limits, or its root is not `name`; `remedy` says what to give: "give an OpenDRIVE file (usually named .xodr)".
[[nodiscard]] inline pugi::xml_node parse_root(pugi::xml_document& xml, std::string_view text, std::string const& file,
                                               std::string_view name, std::string const& remedy) {
  require_readable(text.size(), file);
  if (text.starts_with("\x1f\x8b")) throw MapError(file, "the file is compressed (gzip)", "unpack it first: gunzip");
  if (auto const narrow = narrowed(text); narrow.empty())
    XmlCounter(text).check(file);
  else
    XmlCounter(narrow).check(file);
  pugi::xml_parse_result const result =
      xml.load_buffer(text.data(), text.size(), pugi::parse_cdata | pugi::parse_escapes | pugi::parse_eol);
  if (!result) {
    int const line = LineTable(text).line(result.offset);
    throw MapError(file + ":" + std::to_string(std::max(1, line)),
                   "the file is not well-formed XML (" + std::string(result.description()) + ")",
                   "repair it there, or export it again");
  }
  pugi::xml_node const root = xml.document_element();
  if (local_name(root) != name)
    throw MapError(file + ":" + std::to_string(LineTable(text).line(root.offset_debug())),
                   "the root element is <" + std::string(root.name()) + ">, not <" + std::string(name) + ">", remedy);
  return root;
}

}  // namespace cambium::inline v0_1::map::detail
