// Fuzzes the readers of Lanelet2 and CommonRoad with libFuzzer. Any text gives a map, or a recording, whose numbers are
// all finite, or an Error. On any map everything that users do works, as for OpenDRIVE; a recording that was read is
// written, or refused with an Error, and read again as the same.
//
// To run it for long (clang only): cmake --build build --target lanelet_fuzz, then, with a folder for its findings,
//   build/tests/fuzz/lanelet_fuzz -max_len=20000 -timeout=20 -rss_limit_mb=4096 -max_total_time=3600 FOUND/
//     tests/fuzz/lanelet_seeds
// To repeat a finding, give its file as the only argument.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "cambium/map/lanelet/lanelet2.hpp"
#include "cambium/scenario/dataset/common_road.hpp"
#include "cambium/scenario/dataset/common_road_writer.hpp"
#include "xml_fuzz.hpp"

namespace {

namespace cb = cambium;

void check_tracks(cb::RecordedTraffic const& traffic) {
  for (auto const& track : traffic.tracks)
    for (auto const& state : track.states)
      if (!is_finite(state)) xml_fuzz::fail("track " + std::to_string(track.id) + ": a state is not finite");
  if (!std::isfinite(traffic.begin() + traffic.end())) xml_fuzz::fail("the recording does not begin or end");
}

/// The lanelets as a writer may change them: where their signals count may differ by rounding.
std::vector<cb::map::Lanelet> rounded(std::vector<cb::map::Lanelet> lanelets) {
  for (auto& lanelet : lanelets) {
    lanelet.line = {};
    for (auto& signal : lanelet.signals) signal.before_end = std::round(signal.before_end * 1e3) * 1e-3;
  }
  return lanelets;
}

void check_written(cb::RecordedTraffic const& traffic) {
  std::string text;
  try {
    text = cb::common_road_text(traffic);
  } catch (cb::Error const&) {
    return;  // the format cannot say it
  }
  cb::RecordedTraffic once;
  try {
    once = cb::parse_common_road(text);
    auto const twice = cb::parse_common_road(cb::common_road_text(once));
    if (rounded(once.lanelets) != rounded(twice.lanelets)) xml_fuzz::fail("lanelets changed:\n" + text);
    if (once.tracks != twice.tracks) xml_fuzz::fail("tracks changed:\n" + text);
    if (once.problems != twice.problems) xml_fuzz::fail("planning problems changed:\n" + text);
  } catch (cb::Error const& error) {
    xml_fuzz::fail("what was written is refused: " + std::string(error.what()) + "\n" + text);
  }
}

std::shared_ptr<cb::Map const> map_in(std::string_view text) {
  try {
    if (text.find("<osm") != text.npos) {
      std::vector<cb::Diagnostic> diagnostics;
      auto const lanelets = cb::map::read_lanelet2(text, {}, "text", diagnostics);
      return cb::map::build_lanelet_map(lanelets, {}, "text").map;
    }
    auto const traffic = cb::parse_common_road(text);
    check_tracks(traffic);
    check_written(traffic);
    return traffic.map;
  } catch (cb::Error const&) {
    return nullptr;
  }
}

/// Large maps are only read: small ones show the same faults, and a thousand times as often.
bool is_small(cb::Map const& map) {
  double length = 0.0;
  for (auto const& lane : map.lanes()) length += lane.length();
  return length < 5e3;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(std::uint8_t const* data, std::size_t size) {
  std::string_view const text(reinterpret_cast<char const*>(data), size);
  if (auto const map = map_in(text); map && is_small(*map)) xml_fuzz::check_map(*map, xml_fuzz::is_used(text));
  return 0;
}
