// Fuzzes the OpenDRIVE reader with libFuzzer. Any text gives a map whose numbers are all finite, or a MapError. What
// was read and written again is read as the same document. On any map everything that users do works: look-ups, and for
// one text in sixteen also routes, corridors, junctions and pictures. The damage is done to the XML tree, not to bytes.
//
// To run it for long (clang only): cmake --build build --target opendrive_fuzz, then, with a folder for its findings,
//   build/tests/fuzz/opendrive_fuzz -max_len=20000 -timeout=20 -rss_limit_mb=4096 -max_total_time=3600 FOUND/ maps/
// To repeat a finding, give its file as the only argument.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <pugixml.hpp>

#include "../support/map_faults.hpp"
#include "../support/map_use.hpp"
#include "../support/xml_damage.hpp"
#include "cambium/core/hash.hpp"
#include "cambium/map/lanes/lane_network.hpp"
#include "cambium/map/opendrive.hpp"
#include "cambium/map/opendrive/writer.hpp"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace {

namespace cb = cambium;

[[noreturn]] void fail(std::string const& why) {
  std::fprintf(stderr, "opendrive_fuzz: %s\n", why.c_str());
  std::abort();
}

/// Large maps are only read: small ones show the same faults, and a thousand times as often.
bool is_small(cb::map::OpenDriveDocument const& document) {
  double area = 0.0, turn = 0.0;
  std::size_t records = 0;
  for (auto const& road : document.roads) {
    std::size_t lanes = 0;
    for (auto const& section : road.lane_sections) lanes = std::max(lanes, section.lanes.size());
    area += road.geometry_length() * static_cast<double>(lanes);
    records += road.geometries.size() + road.lane_sections.size();
    for (auto const& g : road.geometries)
      turn += g.length * (std::abs(g.curvature_start) + std::abs(g.curvature_end)) * static_cast<double>(lanes);
  }
  return area < 5e3 && turn < 200.0 && records < 100;
}

/// Whether XML allows all characters of a text; the writer replaces the others.
bool is_plain(std::string_view text) {
  auto const is_odd = [](char c) { return (c < ' ' && c != '\n' && c != '\t' && c != '\r') || c == 0x7f; };
  return std::none_of(text.begin(), text.end(), is_odd) && text.find("&#") == text.npos;
}

void check_written(cb::map::OpenDriveDocument const& document, std::string_view original) {
  std::vector<cb::Diagnostic> diagnostics;
  std::string text;
  try {
    text = cb::write_opendrive(document);
  } catch (cb::MapError const&) {
    return;  // a name that XML does not allow
  }
  auto const again = cb::map::read_opendrive_document(text, "written", diagnostics);
  bool const same = is_plain(original) ? again == document : cb::write_opendrive(again) == text;
  if (!same) fail("what was written is read as something else:\n" + text);
}

/// Every lane is found on its own path, with and without a previous hit.
void check_queries(cb::Map const& map) {
  for (std::size_t i = 0; i < map.lanes().size(); i += 1 + map.lanes().size() / 3) {
    auto const& lane = map.lanes()[i];
    if (is_valid(lane.merges_into)) continue;  // its path leaves the lane
    auto pose = lane.path.pose(0.5 * lane.length());
    auto const& chord = lane.path.segments()[lane.path.find(0.5 * lane.length())];
    pose.heading = std::atan2(chord.uy, chord.ux);  // at a jump of the reference line the path's own is another one
    auto const near = map.lanes_near(pose.position(), 1.0);
    auto const is_it = [&](auto const& hit) { return hit.lane == lane.id; };
    if (std::none_of(near.begin(), near.end(), is_it)) fail(map.describe(lane.id) + ": not found on its own path");
    auto const hit = map.nearest_lane(pose);
    if (lane.drivable() && !hit) fail(map.describe(lane.id) + ": no lane is nearest on its own path");
    if (hit && !map.nearest_lane(pose, *hit)) fail(map.describe(lane.id) + ": lost where it was found");
  }
}

/// One text in sixteen, always the same ones: doing all that users do takes thirty times as long as reading.
bool is_used(std::string_view text) { return (cb::detail::checksum_of(text) >> 16) % 16 == 0; }

void check_map(cb::Map const& map, bool used) {
  if (auto const fault = map_faults::first_fault(map); !fault.empty()) fail(fault);
  for (auto const& finding : cb::check_lane_network(map))
    if (finding.fault == cb::NetworkFault::one_sided || finding.fault == cb::NetworkFault::dangling)
      fail(map.describe(finding.lane) + ": " + std::string(to_string(finding.fault)));
  check_queries(map);
  if (!used) return;
  if (auto const failure = map_use::first_failure(map); !failure.empty()) fail(failure);
}

/// The map of a text; null where the text is refused, or too large to check here. A document that was read makes a map,
/// unless it has no lane.
std::shared_ptr<cb::Map const> map_in(std::string_view text, bool infer_links) {
  bool is_read = false;
  try {
    std::vector<cb::Diagnostic> diagnostics;
    auto const document = cb::map::read_opendrive_document(text, "text", diagnostics);
    is_read = true;
    check_written(document, text);
    if (!is_small(document)) return nullptr;
    cb::MapOptions options;
    options.position_tolerance = 0.1;
    options.heading_tolerance = 0.05;
    options.infer_links = infer_links;
    return cb::map::build_map(document, options, "text", diagnostics);
  } catch (cb::MapError const& error) {
    if (is_read && std::string_view(error.what()).find("no lane with a length") == std::string_view::npos)
      fail(std::string("what was read makes no map: ") + error.what());
    return nullptr;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(std::uint8_t const* data, std::size_t size) {
  std::string_view const text(reinterpret_cast<char const*>(data), size);
  if (auto const map = map_in(text, size % 2 != 0)) check_map(*map, is_used(text));
  return 0;
}

/// Damages the tree; what is no XML, and now and then what is, gets libFuzzer's own mutations.
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned seed) {
  cb::RandomStream random(seed, 0, 0);
  pugi::xml_document xml;
  if (xml_damage::any_of(50, random) == 0 || !xml.load_buffer(data, size))
    return LLVMFuzzerMutate(data, size, max_size);
  for (auto left = 1 + xml_damage::any_of(3, random); left > 0; --left) (void)xml_damage::damage_once(xml, random);
  std::string const text = xml_damage::text_of(xml);
  if (text.size() > max_size) return size;
  std::memcpy(data, text.data(), text.size());
  return text.size();
}
