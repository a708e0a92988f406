#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <utility>

namespace cambium::map {

/// What a lane is for: the types of OpenDRIVE 1.1 to 1.8. `other` stands for every other word.
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
inline constexpr std::array<std::pair<std::string_view, LaneType>, 31> lane_type_words{
    {{"driving", LaneType::driving},
     {"none", LaneType::none},
     {"shoulder", LaneType::shoulder},
     {"border", LaneType::border},
     {"sidewalk", LaneType::sidewalk},
     {"entry", LaneType::entry},
     {"exit", LaneType::exit},
     {"onRamp", LaneType::on_ramp},
     {"offRamp", LaneType::off_ramp},
     {"connectingRamp", LaneType::connecting_ramp},
     {"slipLane", LaneType::slip_lane},
     {"bidirectional", LaneType::bidirectional},
     {"stop", LaneType::stop},
     {"restricted", LaneType::restricted},
     {"parking", LaneType::parking},
     {"median", LaneType::median},
     {"biking", LaneType::biking},
     {"walking", LaneType::walking},
     {"curb", LaneType::curb},
     {"bus", LaneType::bus},
     {"taxi", LaneType::taxi},
     {"HOV", LaneType::hov},
     {"shared", LaneType::shared},
     {"special1", LaneType::special_1},
     {"special2", LaneType::special_2},
     {"special3", LaneType::special_3},
     {"roadWorks", LaneType::road_works},
     {"tram", LaneType::tram},
     {"rail", LaneType::rail},
     // Early revisions' words, last, so that `to_string` gives the current ones.
     {"mwyEntry", LaneType::entry},
     {"mwyExit", LaneType::exit}}};
}  // namespace detail

/// The type that OpenDRIVE writes as `word` (case matters, as in the format); `other` for an unknown word.
[[nodiscard]] constexpr LaneType lane_type_from_string(std::string_view word) {
  for (auto const& [name, type] : detail::lane_type_words)
    if (name == word) return type;
  return LaneType::other;
}

/// OpenDRIVE's word for the type, "other" for `other`.
[[nodiscard]] constexpr std::string_view to_string(LaneType type) {
  for (auto const& [name, known] : detail::lane_type_words)
    if (known == type) return name;
  return "other";
}

/// True for lanes that any motor vehicle may follow: driving, entry, exit, ramps, slip and bidirectional lanes. Not for
/// lanes reserved to some (bus, taxi, HOV, tram, rail), shared with the weak (shared, biking), closed (restricted, road
/// works), or beside the traffic (shoulder, stop, parking, ...).
[[nodiscard]] constexpr bool is_drivable(LaneType type) {
  switch (type) {
    case LaneType::driving:
    case LaneType::entry:
    case LaneType::exit:
    case LaneType::on_ramp:
    case LaneType::off_ramp:
    case LaneType::connecting_ramp:
    case LaneType::slip_lane:
    case LaneType::bidirectional:
      return true;
    default:
      return false;
  }
}

}  // namespace cambium::map
