#include "maps.hpp"

#include <sstream>

#include "cambium/map/opendrive.hpp"
#include "corpus.hpp"

namespace support {

std::shared_ptr<cambium::Map const> map_of(std::string const& text) { return cambium::parse_opendrive(text).map; }

std::shared_ptr<cambium::Map const> straight_road(int lanes, double length, double curvature) {
  std::ostringstream xml;
  xml.precision(17);
  xml << R"(<OpenDRIVE><header revMajor="1" revMinor="6"/><road id="1" junction="-1" length=")" << length
      << R"("><planView><geometry s="0" x="0" y="0" hdg="0" length=")" << length << R"(">)";
  if (curvature == 0.0)
    xml << "<line/>";
  else
    xml << R"(<arc curvature=")" << curvature << R"("/>)";
  xml << R"(</geometry></planView><lanes><laneSection s="0"><center><lane id="0" type="none"/></center><right>)";
  for (int lane = 1; lane <= lanes; ++lane)
    xml << R"(<lane id="-)" << lane << R"(" type="driving"><width sOffset="0" a="3.5" b="0" c="0" d="0"/></lane>)";
  xml << "</right></laneSection></lanes></road></OpenDRIVE>";
  return map_of(xml.str());
}

std::shared_ptr<cambium::Map const> own_map(std::string const& name) {
  return cambium::load_opendrive(CAMBIUM_SOURCE_DIR "/maps/" + name).map;
}

std::shared_ptr<cambium::Map const> corpus_map(std::string const& name) {
  auto const file = corpus::find("opendrive/" + name);
  return file ? cambium::load_opendrive(file->string()).map : nullptr;
}

}  // namespace support
