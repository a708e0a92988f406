#pragma once

#include <string>

#include "cambium/scenario/dataset/recorded_traffic.hpp"

namespace cambium::inline v0_1 {

/// The head of a CommonRoad file.
struct CommonRoadHeader {
  std::string benchmark_id{};  ///< such as "ZAM_Merge-1_1_T-1"; empty: the recording's name
  std::string author{}, affiliation{};
  std::string source = "cambium";
  std::string date{};  ///< such as "2026-11-24"; the library does not look at the clock
};

/// The text of a CommonRoad 2020a scenario: lanelets (of the map, where the recording has none itself), tracks as
/// static and dynamic obstacles, planning problems. Reading it gives the same lanelets, tracks and problems, bit by
/// bit, but for times, which become whole multiples of `RecordedTraffic::time_step`, and for ids that an obstacle,
/// lanelet or problem has already: CommonRoad wants each once, so the later one gets the next free number. Tracks that
/// stand come first; they are parked cars or of the type other. Stop lines may differ by a micrometre; a side of a
/// goal's speed that has no limit gets one of 1000 m/s; entries, exits and slip lanes become driving lanes. Throws
/// `Error` as `check_recorded_traffic`, where times are no multiples of the time step (to 1 % of it), and for what the
/// format cannot say: a lanelet with signals at several places, with lanelets that it goes before, or of a type without
/// a word; lanelets with one id; a goal without its first or last time.
[[nodiscard]] std::string common_road_text(RecordedTraffic const& traffic, CommonRoadHeader const& header = {});

}  // namespace cambium::inline v0_1

#ifndef CAMBIUM_COMPILED
#include "cambium/scenario/dataset/common_road_writer_impl.hpp"
#endif
