#pragma once

#include "cambium/map/detail/read_map_file.hpp"
#include "cambium/map/opendrive/detail/xml_context.hpp"
#include "cambium/map/opendrive/detail/xml_root.hpp"
#include "cambium/map/opendrive/detail/xml_text.hpp"

/// What readers and writers of other XML formats share with those of OpenDRIVE: limits, lines, findings, numbers.
namespace cambium::inline v0_1::map::xml {

using detail::find_child;
using detail::for_each_child;
using detail::local_name;
using detail::parse_number;
using detail::parse_root;
using detail::read_map_file;
using detail::trimmed;
using detail::XmlContext;
using detail::XmlText;

}  // namespace cambium::inline v0_1::map::xml
