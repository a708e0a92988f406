#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "cambium/core/state.hpp"
#include "cambium/map/map.hpp"
#include "cambium/scenario/dataset/recorded_traffic.hpp"

#ifdef CAMBIUM_COMPILED_WITHOUT_READER
#error "cambium::compiled has no CommonRoad reader because CMake did not find pugixml: install it (libpugixml-dev)"
#endif

namespace cambium {

/// Reads a CommonRoad scenario (XML of the versions 2018b and 2020a; Althoff, Koschi, Manzinger 2017): lanelets, which
/// become the map (null without any), signs, lights and intersections as far as `map::Lanelet` has them, static and
/// dynamic obstacles as tracks, planning problems. `file` names the text in messages.
///
/// An interval or area where one value is wanted counts as its middle; of occupancy sets the middles of the shapes are
/// taken. A rotated or shifted rectangle keeps its own middle and heading; circles and polygons of obstacles become the
/// rectangle around them, circles of goals polygons of 32 corners. Each of these, what is left out (an obstacle without
/// a state, a goal without a time) and unknown elements are diagnostics. Throws `Error` (file, line, what, remedy)
/// where the text is no XML or no CommonRoad, or has no time step; and as `build_lanelet_map`. Linear in the text, but
/// for the map.
[[nodiscard]] RecordedTraffic parse_common_road(std::string_view text, map::MapOptions const& options = {},
                                                std::string const& file = "text");

/// As `parse_common_road`, from a file. Throws `Error` where it cannot be read, too.
[[nodiscard]] RecordedTraffic load_common_road(std::string const& path, map::MapOptions const& options = {});

/// What the head of a CommonRoad file says.
struct CommonRoadHeader {
  std::string benchmark_id{};  ///< such as "ZAM_Merge-1_1_T-1"; empty: the recording's name
  std::string author{}, affiliation{};
  std::string source = "cambium";
  std::string date{};  ///< such as "2026-11-24"; the library does not look at the clock
};

/// The text of a CommonRoad 2020a scenario: lanelets (of the map, where the recording has none itself), tracks as
/// static and dynamic obstacles, planning problems. Reading it gives the same lanelets, tracks and problems, bit by
/// bit, but for times, which become whole multiples of `RecordedTraffic::time_step`, and for ids that an obstacle,
/// lanelet or problem has already: CommonRoad wants each once, so the later one gets the next free number. Throws
/// `Error` as `check_recorded_traffic`, and where times are no multiples of the time step (to 1 % of it).
[[nodiscard]] std::string common_road_text(RecordedTraffic const& traffic, CommonRoadHeader const& header = {});

/// How a solution is judged by those who collect them.
struct CommonRoadSolution {
  std::string benchmark_id{};         ///< of the scenario
  std::int64_t problem = 0;           ///< the planning problem's id
  double time_step = 0.1;             ///< of the scenario [s]
  std::vector<State> states{};        ///< of the middle of the body, one a time step
  int vehicle = 2;                    ///< 1: Ford Escort, 2: BMW 320i, 3: VW Vanagon
  std::string cost_function = "SM1";  ///< JB1, SA1, WX1, SM1, SM2, SM3, MW1 or TR1
  std::string version = "2020a";      ///< of the scenario
  std::string date{};                 ///< such as "2026-11-24T12:00:00"; empty: none
  double computation_time = 0.0;      ///< [s]; 0: not written
};

/// The text of a CommonRoad solution file: a trajectory of the kinematic single track model (KS). Steering angles
/// follow from the headings: atan(wheelbase * curvature), with the wheelbase of the vehicle. Throws `Error` for fewer
/// than two states, states that are not finite or not one a time step, an unknown vehicle or cost function, and no
/// benchmark.
[[nodiscard]] std::string common_road_solution_text(CommonRoadSolution const& solution);

/// Reads what `common_road_solution_text` writes, and other solutions of one KS, ST or PM trajectory; without the
/// steering angles. Throws `Error` where there is none.
[[nodiscard]] CommonRoadSolution parse_common_road_solution(std::string_view text, double time_step,
                                                            std::string const& file = "text");

}  // namespace cambium

#ifndef CAMBIUM_COMPILED
#include "cambium/scenario/dataset/common_road_impl.hpp"
#endif
