#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include <pugixml.hpp>

#include "cambium/core/error.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/core/stable_sort.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/map/opendrive/xml.hpp"
#include "cambium/scenario/dataset/common_road_solution.hpp"

namespace cambium::inline v0_1 {

namespace detail {

inline constexpr std::string_view common_road_costs[] = {"JB1", "SA1", "WX1", "SM1", "SM2", "SM3", "MW1", "TR1"};

/// Throws `Error` where the solution cannot be written.
inline void check_solution(CommonRoadSolution const& solution) {
  auto const where = "solution of planning problem " + std::to_string(solution.problem);
  if (solution.benchmark_id.empty())
    throw Error(where, "it names no benchmark", "set CommonRoadSolution::benchmark_id to the scenario's");
  if (solution.vehicle < 1 || solution.vehicle > 3)
    throw Error(where, "vehicle " + std::to_string(solution.vehicle) + " is unknown", "give 1, 2 or 3");
  if (std::find(std::begin(common_road_costs), std::end(common_road_costs), solution.cost_function) ==
      std::end(common_road_costs))
    throw Error(where, "the cost function " + solution.cost_function + " is unknown",
                "give JB1, SA1, WX1, SM1, SM2, SM3, MW1 or TR1");
  if (solution.states.size() < 2) throw Error(where, "it has fewer than two states", "give one a time step");
  if (!(solution.time_step > 0.0)) throw Error(where, "its time step is not above 0", "give the scenario's");
  for (std::size_t i = 0; i < solution.states.size(); ++i) {
    auto const& state = solution.states[i];
    if (!is_finite(state)) throw Error(where, "state " + std::to_string(i) + " is not finite", "leave it out");
    double const count = (state.time - solution.states.front().time) / solution.time_step;
    double const start = state.time / solution.time_step;
    if (!(std::abs(count - static_cast<double>(i)) <= 0.01 && std::abs(start - std::round(start)) <= 0.01))
      throw Error(where, "state " + std::to_string(i) + " is not one time step after the one before",
                  "give one state a time step of " + rounded_text(solution.time_step) + " s, at its multiples");
  }
}

}  // namespace detail

CAMBIUM_COLD std::string common_road_solution_text(CommonRoadSolution const& solution) {
  using detail::number_text;
  detail::check_solution(solution);
  constexpr std::array wheelbases{2.391, 2.578, 2.850};  // [m], of CommonRoad's vehicles 1 to 3: a + b
  double const wheelbase = wheelbases[static_cast<std::size_t>(solution.vehicle - 1)];
  auto const& states = solution.states;
  map::xml::XmlText text;
  auto const leaf = [&text](char const* name, std::string const& value) {
    text.element(name, [&] { text.text(value); });
  };
  text.element("CommonRoadSolution", [&] {
    text.attribute("benchmark_id", "KS" + std::to_string(solution.vehicle) + ":" + solution.cost_function + ":" +
                                       solution.benchmark_id + ":" + solution.version);
    if (solution.computation_time > 0.0) text.attribute("computation_time", number_text(solution.computation_time));
    if (!solution.date.empty()) text.attribute("date", solution.date);
    text.element("ksTrajectory", [&] {
      text.attribute("planningProblem", std::to_string(solution.problem));
      for (std::size_t i = 0; i < states.size(); ++i) {
        auto const &state = states[i], &a = states[i > 0 ? i - 1 : 0], &b = states[std::min(i + 1, states.size() - 1)];
        double const way = portable::hypot(b.x - a.x, b.y - a.y);
        double const turn = geometry::angle_difference(b.heading, a.heading);
        double const steering = way > 1e-3 ? portable::atan(wheelbase * turn / way) : 0.0;
        text.element("ksState", [&] {
          leaf("x", number_text(state.x));
          leaf("y", number_text(state.y));
          leaf("steeringAngle", number_text(steering));
          leaf("velocity", number_text(state.speed));
          leaf("orientation", number_text(state.heading));
          leaf("time", std::to_string(std::llround(state.time / solution.time_step)));
        });
      }
    });
  });
  return text.take();
}

CAMBIUM_COLD CommonRoadSolution parse_common_road_solution(std::string_view text, double time_step,
                                                           std::string const& file) {
  namespace xml = map::xml;
  pugi::xml_document document;
  auto const root = xml::parse_root(document, text, file, "CommonRoadSolution", "give a CommonRoad solution (.xml)");
  CommonRoadSolution solution;
  solution.time_step = time_step;
  auto const parts = detail::split(root.attribute("benchmark_id").value(), ":");
  if (parts.size() != 4 || parts[0].size() != 3 || parts[0][2] < '1' || parts[0][2] > '3')
    throw Error(file, "its benchmark_id is not of the form KS2:SM1:SCENARIO:2020a with one vehicle",
                "give a solution of one planning problem");
  solution.vehicle = parts[0][2] - '0';
  solution.cost_function = parts[1];
  solution.benchmark_id = parts[2];
  solution.version = parts[3];
  solution.date = root.attribute("date").value();
  solution.computation_time = xml::parse_number<double>(root.attribute("computation_time").value()).value_or(0.0);
  auto const trajectory = root.first_child();
  bool const is_point_mass = xml::local_name(trajectory) == "pmTrajectory";
  auto const problem = xml::parse_number<std::int64_t>(trajectory.attribute("planningProblem").value());
  if (!problem) throw Error(file, "its trajectory names no planning problem", "give the attribute planningProblem");
  solution.problem = *problem;
  xml::for_each_child(trajectory, [&](pugi::xml_node node, std::string_view name) {
    auto const number = [&](char const* of) {
      auto const value = xml::parse_number<double>(xml::trimmed(xml::find_child(node, of).child_value()));
      if (!value)
        throw Error(file, "state " + std::to_string(solution.states.size()) + " has no number as <" + of + ">",
                    "give " + std::string(name) + " elements with all numbers of their model");
      return *value;
    };
    State state{number("time") * time_step, number("x"), number("y"), 0.0, 0.0};
    if (is_point_mass) {
      double const vx = number("xVelocity"), vy = number("yVelocity");
      state.heading = portable::atan2(vy, vx);
      state.speed = portable::hypot(vx, vy);
    } else {
      state.heading = number("orientation");
      state.speed = number("velocity");
    }
    solution.states.push_back(state);
  });
  detail::stable_sort(solution.states, &State::time);
  detail::check_solution(solution);
  return solution;
}

}  // namespace cambium::inline v0_1
