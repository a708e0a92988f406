// Fuzzes the OpenDRIVE reader with libFuzzer. Any text gives a map whose numbers are all finite, or a MapError. What
// was read and written again is read as the same document. On any map everything that users do works: look-ups, and for
// one text in sixteen also routes, corridors, junctions and pictures.
//
// To run it for long (clang only): cmake --build build --target opendrive_fuzz, then, with a folder for its findings,
//   build/tests/fuzz/opendrive_fuzz -max_len=20000 -timeout=20 -rss_limit_mb=4096 -max_total_time=3600 FOUND/ maps/
// To repeat a finding, give its file as the only argument.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "cambium/map/opendrive.hpp"
#include "cambium/map/opendrive/writer.hpp"
#include "xml_fuzz.hpp"

namespace {

namespace cb = cambium;

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
  if (!same) xml_fuzz::fail("what was written is read as something else:\n" + text);
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
      xml_fuzz::fail(std::string("what was read makes no map: ") + error.what());
    return nullptr;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(std::uint8_t const* data, std::size_t size) {
  std::string_view const text(reinterpret_cast<char const*>(data), size);
  if (auto const map = map_in(text, size % 2 != 0)) xml_fuzz::check_map(*map, xml_fuzz::is_used(text));
  return 0;
}
