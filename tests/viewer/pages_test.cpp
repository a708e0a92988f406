// Pages and pictures as they were looked at. After a change on purpose, look at the new ones in the build folder's
// pages/, and write their checksums here.
#include <cstdint>
#include <filesystem>
#include <string>

#include <doctest/doctest.h>

#include "cambium/core/hash.hpp"
#include "cambium/core/write_file.hpp"
#include "cambium/viewer/html_replay.hpp"
#include "cambium/viewer/map_picture.hpp"
#include "cambium/viewer/record_world.hpp"
#include "cambium/viewer/svg_picture.hpp"
#include "../support/maps.hpp"
#include "sample_recording.hpp"

using namespace cambium;

TEST_CASE("pages and pictures are byte for byte those that were looked at") {
  auto const busy = busy_recording();
  auto const crossing = support::own_map("intersection_4way.xodr"), merging = support::own_map("merging.xodr");
  Recording const lanes{
      .title = "a map", .lanes = recorded_lanes(*crossing), .stop_lines = recorded_stop_lines(*crossing)};
  Recording const long_road{.lanes = recorded_lanes(*merging)};
  auto const folder = std::filesystem::path(CAMBIUM_BUILD_DIR) / "pages";
  std::filesystem::create_directories(folder);
  struct Case {
    std::string file, text;
    std::uint64_t sum;
  };
  for (auto const& [file, text, sum] :
       {Case{"replay.html", html_replay(busy), 0x711c45bc0431ae7eu},
        Case{"junction.html", html_replay(lanes), 0x6a8ad8dc6740fa94u},
        Case{"frame.svg", svg_picture(busy, {.width = 700.0, .frame = 7}), 0x1b182ae06b2c4473u},
        Case{"later.svg", svg_picture(busy, {.labels = false, .frame = 20}), 0xe9ad3572a11bd763u},
        Case{"junction.svg", svg_picture(lanes), 0x15dc3c3d746ad393u},
        Case{"long_road.svg", svg_picture(long_road), 0xac3d226b0f666347u},
        Case{"nothing.svg", svg_picture(Recording{}), 0x08d600f96af111dfu},
        Case{"crossing.svg", svg_map_picture(*crossing), 0x29d731b33f635cc5u},
        Case{"merging.svg", svg_map_picture(*merging, {.width = 500.0, .title = "merging"}), 0xccc54b5cc5153f7eu},
        Case{"crossing.html", html_map_picture(*crossing, {.title = "crossing"}), 0x2509dd8d03059ef2u},
        Case{"merging.html", html_map_picture(*merging, {.legend = false}), 0x8be0c825231e9901u}}) {
    write_file(folder / file, text);
    CAPTURE(file);
    CHECK(detail::checksum_of(text) == sum);
  }
}
