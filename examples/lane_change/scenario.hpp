#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "cambium/behavior/behavior_set.hpp"
#include "cambium/behavior/drivers.hpp"
#include "cambium/behavior/actions/macro_actions.hpp"
#include "cambium/core/distributions.hpp"
#include "cambium/dynamics/single_track.hpp"
#include "cambium/evaluation/course_end.hpp"
#include "cambium/execution/interpolate.hpp"
#include "cambium/map/road/curve_layout.hpp"
#include "cambium/planner/mcts/mcts.hpp"
#include "cambium/scenario/scenario.hpp"
#include "cambium/world/world.hpp"

#include "../common/parameter_file.hpp"

/// The lane change of Bernhard, Esterle, Hart, Kessler 2020 ("BARK: Open behavior benchmarking in multi-agent
/// environments", section V-A). Numbers that the paper does not give are those of BARK's configuration.
namespace lane_change {

namespace cb = cambium;

using PredictionSet = cb::BehaviorSet<cb::MacroActions, cb::IdmClassic, cb::HeadwayHypotheses<cb::IdmClassic>>;
using Prediction = cb::World<PredictionSet, cb::InterpolateExecution, cb::SingleTrack>;

/// The roll-out of the paper's planner. Its "random" heuristic drew the same action in every step, because each draw
/// started from the same seed; with the paper's five actions this is number 3, the lane change.
struct SameActionRollout {
  static constexpr char const* name = "same_action_rollout";
  static constexpr auto parameters() { return cb::parameter_list(); }

  template <class Run>
  bool roll_out(Run& run) const {
    return cb::play(run, run.steps, [](std::size_t, int) { return std::uint8_t{3}; }) == 0.0;
  }
};

using PaperPlanner = cb::Mcts<Prediction, cb::MacroActions, cb::TrafficReward, cb::IdmClassic,
                              cb::MctsOptions<cb::Ucb1, SameActionRollout>>;
using OwnPlanner = cb::Mcts<Prediction, cb::MacroActions, cb::TrafficReward, cb::HeadwayHypotheses<cb::IdmClassic>,
                            cb::MctsOptions<cb::Ucb1, cb::RandomRollout>>;
using Sim =
    cb::World<cb::BehaviorSet<PaperPlanner, OwnPlanner, cb::IdmClassic>, cb::InterpolateExecution, cb::SingleTrack>;

inline constexpr double step = 0.2;     // [s]
inline constexpr double way = 186.0;    // length of the paper's road [m]; ours goes on, so that no vehicle vanishes
inline constexpr double headway = 3.0;  // of the others, as the planner assumes [s]
inline constexpr int most_steps = 30;

/// A cell of the experiment's grid.
struct Cell {
  bool is_paper = false;
  std::size_t iterations = 2000;
  double variation = 0.0;  ///< by how much the others' headways are shorter than the planner assumes, as a share
  examples::ParameterFile parameters{};
};

inline cb::IdmClassic driver(double time_headway) {
  return {.law = {.desired_speed = 17.0,
                  .time_headway = time_headway,
                  .minimum_gap = 2.0,
                  .maximum_acceleration = 1.7,
                  .comfortable_deceleration = 1.67,
                  .lowest_acceleration = -15.0}};
}

/// A brisk lane change. One of 4 s would leave no time to find a gap.
inline constexpr cb::LaneChangeCourse course{.duration = 2.0, .shortest_duration = 1.5};

using Kind = cb::MacroAction::Kind;

inline cb::MacroActions paper_actions() {
  auto actions = cb::MacroActions::of(
      {{Kind::stay, 0.0}, {Kind::stay, 1.0}, {Kind::stay, -1.0}, {Kind::change_left}, {Kind::change_right}});
  actions.course = course;
  return actions;
}

/// More actions than the paper's: harder braking in the lane, because others may brake hard when someone cuts in, and
/// accelerating and braking during the lane change.
inline cb::MacroActions own_actions() {
  auto actions = cb::MacroActions::of({{Kind::stay, 0.0},
                                       {Kind::stay, 1.5},
                                       {Kind::stay, -2.0},
                                       {Kind::stay, -4.0},
                                       {Kind::change_left, 0.0},
                                       {Kind::change_left, 1.5},
                                       {Kind::change_left, -3.0},
                                       {Kind::change_right, 0.0}});
  actions.course = course;
  return actions;
}

/// The others, but for their shorter headways.
inline cb::IdmClassic driver(Cell const& cell) {
  auto usual = driver(headway);
  cell.parameters.set(usual);
  return usual;
}

/// The paper's reward: a collision is part of the return (the search gives costs no weight), and only events count.
inline cb::TrafficReward paper_reward() {
  auto reward = cb::TrafficReward::events();
  reward.collision = reward.off_road = -1000.0;
  return reward;
}

inline PaperPlanner paper_planner() {
  PaperPlanner paper{
      .actions = paper_actions(), .others = driver(headway), .others_keep_speed = false, .reward = paper_reward()};
  paper.options.search = {.horizon = most_steps,
                          .discount = 0.9,
                          .lowest_return = -1000.0,
                          .highest_return = 100.0,
                          .final_move = cb::FinalMove::best_return,
                          .constraint = {.weight = 0.0}};
  paper.options.hold = 1;
  paper.options.selection.exploration = 2.0 * 0.7 * std::sqrt(2.0);
  return paper;
}

inline OwnPlanner own_planner() {
  OwnPlanner own{.actions = own_actions(), .others_keep_speed = false, .reward = paper_reward()};
  own.options.selection.exploration = 0.3;
  own.reward.desired_speed = 14.0;  // the goal requires 11 to 17 m/s
  own.reward.speed_deviation = -5.0;
  own.others = {.driver = driver(headway), .shortest_headway = 0.5, .longest_headway = 3.5, .regions = 4};
  // A decision lasts two steps of the world: the same 6 s at half the depth.
  own.options.step = 2.0 * step;
  own.options.hold = 1;
  own.options.search = {.horizon = most_steps / 2, .discount = 0.9, .constraint = {.weight = 0.0}};
  own.options.rollout.hold = 3;
  return own;
}

inline Sim::Behavior planner(Cell const& cell) {
  auto const made = [&](auto planner) -> Sim::Behavior {
    cell.parameters.set(planner);
    planner.options.budget.iterations = cell.iterations;
    return planner;
  };
  return cell.is_paper ? made(paper_planner()) : made(own_planner());
}

/// Fills a lane with vehicles from `begin` to `end` [m]: gaps of 20 to 30 m, speeds of 11 to 17 m/s. This is the
/// procedure of the paper, from the rear to the front; a recipe's flow (examples/benchmark/sets/lane_change) draws from
/// the front to the rear.
inline void fill_lane(cb::Scenario<Sim>& scenario, double begin, double end, double y, Cell const& cell,
                      cb::RandomStream& random) {
  auto other = driver(cell);
  other.law.time_headway *= 1.0 - cell.variation;
  cb::geometry::Shape const shape{.front = 3.85, .rear = 1.12, .left = 0.955, .right = 0.955};
  for (double s = begin + cb::Uniform{0.0, 10.0}(random); s <= end;
       s += shape.length() + cb::Uniform{20.0, 30.0}(random))
    scenario.agents.push_back({.position = {s, y},
                               .speed = cb::Uniform{11.0, 17.0}(random),
                               .shape = shape,
                               .behavior = other,
                               .id = static_cast<cb::AgentId>(scenario.agents.size())});
}

/// Samples scenario `number`: the ego is one of those on the right. All cells of one variation get the same traffic.
inline cb::Scenario<Sim> sample(std::shared_ptr<cb::Map const> const& map, Cell const& cell, std::uint64_t seed,
                                std::uint32_t number) {
  cb::RandomStream random(seed, 0, number);
  cb::Scenario<Sim> scenario{.map = map, .seed = seed + number};
  fill_lane(scenario, 0.1 * way, 0.9 * way, -1.75, cell, random);
  auto const left = scenario.agents.size();
  fill_lane(scenario, 0.2 * way, 0.5 * way, -5.25, cell, random);
  auto const right = static_cast<std::uint32_t>(scenario.agents.size() - left);
  auto const number_of_ego = left + cb::uniform_index(random, right);
  auto& ego = scenario.agents[number_of_ego];
  ego.behavior = planner(cell);
  ego.goal = cb::LaneLimits{.lane = map->nearest_lane({0.5 * way, -1.75, 0.0})->lane,
                            .from = 0.2 * way,
                            .left = 0.5,
                            .right = 0.5,
                            .heading_error = 0.08,
                            .lowest_speed = 11.0,
                            .highest_speed = 17.0};
  scenario.ego = static_cast<cb::AgentId>(number_of_ego);
  return scenario;
}

enum class End { success, collision, time_out };

struct Outcome {
  End end = End::time_out;
  int steps = 0;
};

/// Simulates a scenario to its end. Leaving the road counts as a collision; both count in the step that reaches the
/// goal, too.
inline Outcome play(cb::Scenario<Sim> const& scenario) {
  auto world = scenario.make_world();
  auto const ego = world.slot_of(scenario.ego);
  for (int k = 1; k <= most_steps; ++k) {
    if (auto const result = world.step(step); !result)
      throw cb::WorldError("step " + std::to_string(k), to_string(result.problem));
    auto const end = cb::course_end(world, ego);
    if (end == cb::CourseEnd::collision || end == cb::CourseEnd::off_road) return {End::collision, k};
    if (world.reached_goal(scenario.ego)) return {End::success, k};
  }
  return {End::time_out, most_steps};
}

}  // namespace lane_change
