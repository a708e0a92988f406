#pragma once

#include <atomic>
#include <bit>
#include <cmath>
#include <cstdint>
#include <string_view>

#include "cambium/core/hash.hpp"
#include "cambium/map/map.hpp"

namespace cambium::inline v0_1::map {

/// Hash of what traffic knows of a map: lanes, their paths, widths, links, limits, signals and conflicts' rules; not of
/// the file's text. Numbers count by the thousandth, so equal files almost always give equal hashes, whatever the
/// compiler's flags and the mathematical library. O(path segments) at first, then O(1).
[[nodiscard]] inline std::uint64_t content_hash(Map const& map) {
  if (auto const known = map.known_content_hash().load(std::memory_order_relaxed); known != 0) return known;
  cambium::detail::Fnv1a<std::uint64_t> hash;
  auto const add = [&hash](auto... values) { (hash.add_bytes(static_cast<std::uint64_t>(values)), ...); };
  auto const add_numbers = [&](auto... numbers) {
    constexpr double off = 0.3719;  // else round numbers would lie where the last bit decides
    (add(std::bit_cast<std::uint64_t>(std::floor(1e3 * numbers + off) + 0.0)), ...);
  };
  auto const add_text = [&](std::string_view text) {
    for (char const c : text) add(static_cast<unsigned char>(c));
    add(text.size());
  };
  auto const add_lanes = [&](auto const& ids) {
    for (auto const id : ids) add(index_of(id));
    add(ids.size());
  };
  for (auto const& road : map.roads()) add_text(road.name);
  for (auto const& lane : map.lanes()) {
    add(index_of(lane.road), lane.section, lane.number, lane.type, lane.along_road);
    for (auto const& segment : lane.path.segments()) add_numbers(segment.x, segment.y, segment.length);
    for (auto const& width : lane.widths) add_numbers(width.left, width.right);
    for (auto const& limit : lane.speed_limits) add_numbers(limit.begin, limit.limit);
    for (auto const* changes : {&lane.left_changes, &lane.right_changes})
      for (auto const& stretch : *changes) add_numbers(stretch.begin, stretch.end);
    for (auto const id : {lane.left_neighbor, lane.right_neighbor, lane.opposite, lane.merges_into}) add(index_of(id));
    add_lanes(lane.successors);
    add_lanes(lane.predecessors);
    for (auto const& overlap : lane.overlaps) {
      add(index_of(overlap.other));
      add_numbers(overlap.begin, overlap.end);
    }
    for (auto const& signal : lane.signals) {
      add_numbers(signal.s);
      add(signal.kind, index_of(signal.light));
    }
  }
  for (auto const& junction : map.junctions())
    for (auto const& priority : junction.priorities) add(index_of(priority.high), index_of(priority.low));
  for (auto const& light : map.lights()) add_text(light.name);
  map.known_content_hash().store(hash.value(), std::memory_order_relaxed);
  return hash.value();
}

}  // namespace cambium::inline v0_1::map

namespace cambium::inline v0_1 {
using map::content_hash;
}
