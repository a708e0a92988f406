// cambium inside an existing planner stack: lanes come as polylines from the stack's map, objects from its perception;
// no OpenDRIVE file is needed. The code between the two marks is all that the stack needs; the rest imitates the stack.

#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "cambium/execution/interpolate.hpp"
#include "cambium/map/building/map_builder.hpp"
#include "cambium/map/building/polyline_roads.hpp"
#include "cambium/planner/mcts/mcts.hpp"
#include "cambium/world/world.hpp"

#include "common/command_line.hpp"

namespace stack {

struct Point {
  double x, y;
};

/// An object that perception tracks: centre of its box, in m, rad, m/s, m/s^2.
struct TrackedObject {
  unsigned id;
  double x, y, yaw, speed, acceleration, length, width;
};

/// The vehicle's pose and speed from localisation, at the middle of its rear axle.
struct Ego {
  double x, y, yaw, speed;
};

}  // namespace stack

namespace {

// [embed
namespace cb = cambium;
using World = cb::World<cb::BehaviorSet<cb::MacroActions, cb::IdmClassic>, cb::InterpolateExecution, cb::SingleTrack>;
using Planner = cb::Mcts<World>;

/// Called once per map. `borders`: of the lanes, from left to right, in travel direction.
std::shared_ptr<cb::Map const> map_of(std::vector<std::vector<stack::Point>> const& borders) {
  std::vector<std::vector<cb::geometry::Point>> lines;
  for (auto const& border : borders) {
    lines.emplace_back();
    for (auto const& p : border) lines.back().emplace_back(p.x, p.y);
  }
  cb::map::MapBuilder builder;
  builder.add_road(cb::map::lanes_between(lines));
  return builder.build();
}

/// Called once per planning cycle. The ego is agent 0.
World world_of(std::shared_ptr<cb::Map const> const& map, stack::Ego const& ego,
               std::vector<stack::TrackedObject> const& objects, cb::Goal const& goal) {
  World world(map);
  world.add({.position = {ego.x, ego.y}, .heading = ego.yaw, .speed = ego.speed, .goal = goal, .id = cb::AgentId{0}});
  for (auto const& o : objects) {
    auto const shape = cb::geometry::Shape{
        .front = 0.5 * o.length, .rear = 0.5 * o.length, .left = 0.5 * o.width, .right = 0.5 * o.width};
    if (!map->nearest_lane({o.x, o.y, o.yaw}, 0.0)) continue;  // beside the road
    world.add({.position = {o.x, o.y},
               .heading = o.yaw,
               .speed = o.speed,
               .acceleration = o.acceleration,
               .shape = shape,
               .behavior = cb::IdmClassic{},
               .id = cb::AgentId{o.id}});
  }
  return world;
}
// embed]

/// The stack's map: a bend to the left with two lanes of 3.5 m. On it, a slow truck ahead and a car beside the ego.
std::vector<std::vector<stack::Point>> borders() {
  std::vector<std::vector<stack::Point>> lines;
  for (double const radius : {300.0, 303.5, 307.0}) {
    lines.emplace_back();
    for (double angle = 0.0; angle <= 1.0; angle += 0.02)
      lines.back().push_back({radius * std::sin(angle), 300.0 - radius * std::cos(angle)});
  }
  return lines;
}

stack::TrackedObject object(unsigned id, double lane_radius, double along, double speed, double length) {
  double const angle = along / lane_radius;
  return {id, lane_radius * std::sin(angle), 300.0 - lane_radius * std::cos(angle), angle, speed, 0.0, length, 2.0};
}

void plan() {
  auto const map = map_of(borders());
  stack::Ego const ego{305.25 * std::sin(0.1), 300.0 - 305.25 * std::cos(0.1), 0.1, 14.0};
  std::vector<stack::TrackedObject> const objects{object(7, 305.25, 75.0, 8.0, 12.0),
                                                  object(12, 301.75, 5.0, 13.0, 4.5)};
  auto const left = map->nearest_lane({301.75 * std::sin(0.1), 300.0 - 301.75 * std::cos(0.1), 0.1})->lane;
  auto world = world_of(map, ego, objects, cb::LaneLimits{.lane = left, .left = 0.5, .right = 0.5});

  Planner planner;
  planner.options.budget.iterations = 2000;
  planner.reward.progress = 0.1;
  Planner::Workspace workspace;
  auto const report = planner.think(world.observe(cb::AgentId{0}), {}, workspace);

  std::printf("%zu iterations, %zu nodes\n\n  visits   return  action\n", report.result.iterations,
              report.result.nodes);
  for (std::size_t i = 0; i < report.candidates.size(); ++i) {
    auto const& arm = report.result.of(0)[i];
    std::printf("%8u %8.2f  %s%s\n", arm.visits, arm.mean_return, report.candidates[i].name.c_str(),
                i == report.chosen ? "   <- chosen" : "");
  }
  std::printf("\nexpected motion of all agents\n    time");
  for (auto const id : report.agents) std::printf("          agent %-8s", to_string(id).c_str());
  std::printf("\n");
  for (auto const& frame : report.course) {
    std::printf("%7.1f s", frame.time);
    for (auto const& agent : frame.agents)
      std::printf("   (%6.1f, %5.1f) %4.1f m/s", agent.state.x, agent.state.y, agent.state.speed);
    std::printf("\n");
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App program("Embeds a tree search in a planner stack that has a map and objects of its own.",
                   "embed_in_planner");
  return examples::run_program(program, argc, argv, plan);
}
