// What the fuzzers of the readers share: what every map has to do, and damage to the XML tree instead of to bytes.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>

#include <pugixml.hpp>

#include "../support/map_faults.hpp"
#include "../support/map_use.hpp"
#include "../support/xml_damage.hpp"
#include "cambium/core/hash.hpp"
#include "cambium/map/lanes/lane_network.hpp"
#include "cambium/map/map.hpp"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace xml_fuzz {

namespace cb = cambium;

[[noreturn]] inline void fail(std::string const& why) {
  std::fprintf(stderr, "%s\n", why.c_str());
  std::abort();
}

/// Every lane is found on its own path, with and without a previous hit.
inline void check_queries(cb::Map const& map) {
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
inline bool is_used(std::string_view text) { return (cb::detail::checksum_of(text) >> 16) % 16 == 0; }

inline void check_map(cb::Map const& map, bool used) {
  if (auto const fault = map_faults::first_fault(map); !fault.empty()) fail(fault);
  for (auto const& finding : cb::check_lane_network(map))
    if (finding.fault == cb::NetworkFault::one_sided || finding.fault == cb::NetworkFault::dangling)
      fail(map.describe(finding.lane) + ": " + std::string(to_string(finding.fault)));
  check_queries(map);
  if (!used) return;
  if (auto const failure = map_use::first_failure(map); !failure.empty()) fail(failure);
}

}  // namespace xml_fuzz

/// Damages the tree; what is no XML, and now and then what is, gets libFuzzer's own mutations.
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned seed) {
  cambium::RandomStream random(seed, 0, 0);
  pugi::xml_document xml;
  if (xml_damage::any_of(50, random) == 0 || !xml.load_buffer(data, size))
    return LLVMFuzzerMutate(data, size, max_size);
  for (auto left = 1 + xml_damage::any_of(3, random); left > 0; --left) (void)xml_damage::damage_once(xml, random);
  std::string const text = xml_damage::text_of(xml);
  if (text.size() > max_size) return size;
  std::memcpy(data, text.data(), text.size());
  return text.size();
}
