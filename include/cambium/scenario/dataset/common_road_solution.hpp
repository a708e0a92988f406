#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "cambium/core/state.hpp"

namespace cambium::inline v0_1 {

/// A solution of a CommonRoad planning problem, and how it is to be judged.
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

}  // namespace cambium::inline v0_1

#ifndef CAMBIUM_COMPILED
#include "cambium/scenario/dataset/common_road_solution_impl.hpp"
#endif
