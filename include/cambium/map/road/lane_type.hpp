#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <string_view>

namespace cambium::inline v0_1::map {

/// What a lane is for: the types of OpenDRIVE 1.1 to 1.8. `other` stands for every other word; those from `driving` to
/// `bidirectional` are drivable.
enum class LaneType : std::uint8_t {
  none,
  driving,
  entry,
  exit,
  on_ramp,
  off_ramp,
  connecting_ramp,
  slip_lane,
  bidirectional,
  shoulder,
  border,
  stop,
  restricted,
  parking,
  median,
  biking,
  sidewalk,
  walking,
  curb,
  bus,
  taxi,
  hov,
  shared,
  special_1,
  special_2,
  special_3,
  road_works,
  tram,
  rail,
  other
};

namespace detail {
/// OpenDRIVE's words, by the number of the type.
inline constexpr std::string_view lane_type_words[] = {
    "none",          "driving",  "entry",     "exit", "onRamp",     "offRamp", "connectingRamp", "slipLane",
    "bidirectional", "shoulder", "border",    "stop", "restricted", "parking", "median",         "biking",
    "sidewalk",      "walking",  "curb",      "bus",  "taxi",       "HOV",     "shared",         "special1",
    "special2",      "special3", "roadWorks", "tram", "rail",       "other"};
static_assert(std::size(lane_type_words) == static_cast<std::size_t>(LaneType::other) + 1);
}  // namespace detail

/// The type that OpenDRIVE writes as `word` (case matters, as in the format); `other` for an unknown word.
[[nodiscard]] constexpr LaneType lane_type_from_string(std::string_view word) {
  if (word == "mwyEntry") return LaneType::entry;  // early revisions' words
  if (word == "mwyExit") return LaneType::exit;
  for (std::size_t i = 0; i < std::size(detail::lane_type_words); ++i)
    if (detail::lane_type_words[i] == word) return static_cast<LaneType>(i);
  return LaneType::other;
}

/// OpenDRIVE's word for the type, "other" for `other`.
[[nodiscard]] constexpr std::string_view to_string(LaneType type) {
  return detail::lane_type_words[std::min(static_cast<std::size_t>(type), std::size(detail::lane_type_words) - 1)];
}

/// True for lanes that any motor vehicle may follow: driving, entry, exit, ramps, slip and bidirectional lanes. Not for
/// lanes reserved to some (bus, taxi, HOV, tram, rail), shared with the weak (shared, biking), closed (restricted, road
/// works), or beside the traffic (shoulder, stop, parking, ...).
[[nodiscard]] constexpr bool is_drivable(LaneType type) {
  return type >= LaneType::driving && type <= LaneType::bidirectional;
}

}  // namespace cambium::inline v0_1::map
