#include "maps.hpp"

#include <cstddef>
#include <utility>

#include "cambium/map/building/map_builder.hpp"
#include "cambium/map/opendrive.hpp"
#include "corpus.hpp"

namespace support {

std::shared_ptr<cambium::Map const> map_of(cambium::map::RoadPlan road) {
  cambium::MapBuilder builder;
  builder.add_road(std::move(road));
  return builder.build();
}

std::shared_ptr<cambium::Map const> straight_road(int lanes, double length, double curvature) {
  return map_of({.id = "1",
                 .line = cambium::map::lay_from({}, {{length, curvature, curvature}}),
                 .sections = {{.right = cambium::map::equal_lanes(static_cast<std::size_t>(lanes))}}});
}

std::shared_ptr<cambium::Map const> two_way_road(double length) {
  auto const lane = cambium::map::equal_lanes(1);
  return map_of(
      {.id = "1", .line = cambium::map::lay_from({}, {{length}}), .sections = {{.left = lane, .right = lane}}});
}

std::shared_ptr<cambium::Map const> road_with_signal(std::string const& type, int lanes) {
  std::string text;
  for (int lane = 1; lane <= lanes; ++lane)
    text +=
        "<lane id='-" + std::to_string(lane) + "' type='driving'><width sOffset='0' a='3.5' b='0' c='0' d='0'/></lane>";
  return cambium::parse_opendrive(
             "<OpenDRIVE><road id='0' length='500' junction='-1'><planView><geometry s='0' x='0' y='0' hdg='0' "
             "length='500'><line/></geometry></planView><lanes><laneSection s='0'><center><lane id='0'/></center>"
             "<right>" +
             text + "</right></laneSection></lanes><signals><signal id='1' s='200' t='-4' type='" + type +
             "' subtype='-1' orientation='+' dynamic='no'/></signals></road></OpenDRIVE>")
      .map;
}

std::shared_ptr<cambium::Map const> own_map(std::string const& name) {
  return cambium::load_opendrive(CAMBIUM_SOURCE_DIR "/maps/" + name).map;
}

std::shared_ptr<cambium::Map const> corpus_map(std::string const& name) {
  auto const file = corpus::find("opendrive/" + name);
  return file ? cambium::load_opendrive(file->string()).map : nullptr;
}

}  // namespace support
