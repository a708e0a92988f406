#include <array>
#include <cmath>
#include <utility>

#include "maps.hpp"

namespace make_maps {
namespace {

using cambium::geometry::pi;
using cambium::geometry::Pose;

constexpr auto end = ContactPoint::end;
constexpr auto start = ContactPoint::start;

LanePlan median(double width, double end_width) {
  return {.type = LaneType::median, .width = width, .end_width = end_width};
}

/// A pose given in the frame of an arm: origin in the middle of the junction, x axis at `angle`, counter-clockwise from
/// east.
Pose seen_at(double angle, Pose const& local) {
  auto const p = cambium::geometry::to_map({0.0, 0.0, angle}, {local.x, local.y});
  return {p.x(), p.y(), local.heading + angle};
}

/// An arm that leads straight towards the middle of the junction and ends `distance` [m] before it. `angle`: the
/// direction that it comes from, counter-clockwise from east.
RoadPlan straight_arm(std::string id, std::string name, double angle, double distance, double length) {
  return {.id = std::move(id),
          .name = std::move(name),
          .line = lay_to(seen_at(angle, {distance, 0.0, pi}), {{length}}),
          .type = "town",
          .speed_limit = kmh(50.0)};
}

}  // namespace

// Arms 1 (east), 2 (north), 3 (west), 4 (south). On each arm, the inner lane leads left and straight on, the outer one
// straight on and right.
MapBuilder intersection_4way() {
  MapBuilder builder("intersection 4-way");
  std::array<std::string, 4> const names{"east", "north", "west", "south"};
  for (std::size_t i = 0; i < 4; ++i) {
    auto arm = straight_arm(std::to_string(i + 1), names[i], 0.5 * pi * static_cast<double>(i), 18.0, 100.0);
    arm.sections = {{.left = equal_lanes(2), .right = equal_lanes(2)}};
    builder.add_road(std::move(arm));
  }
  builder.add_junction("100", "crossing");
  for (std::size_t i = 0; i < 4; ++i) {
    auto const arm = [i](std::size_t further) { return RoadEnd{std::to_string((i + further) % 4 + 1), end}; };
    auto const id = [i](std::size_t turn) { return std::to_string(100 + 10 * (i + 1) + turn); };
    builder.add_turn("100", arm(0), arm(2), {id(0), names[i] + " straight on", {}, kmh(50.0)});
    builder.add_turn("100", arm(0), arm(1), {id(1), names[i] + " to the right", {{-2, 2}}, kmh(25.0)});
    builder.add_turn("100", arm(0), arm(3), {id(2), names[i] + " to the left", {{-1, 1}}, kmh(35.0)});
  }
  return builder;
}

// Opposite arms have green at the same time.
void add_lights(opendrive::Document& document) {
  document.controllers.resize(2);
  document.controllers[0].id = "east-west";
  document.controllers[1].id = "north-south";
  for (std::size_t i = 0; i < 4; ++i) {
    auto& arm = document.roads[i];
    opendrive::Signal light;
    light.id = "light " + arm.id;
    light.s = arm.length;
    light.orientation = opendrive::Orientation::along;
    light.type = "1000001";
    light.rest.attributes = {{"t", "-7.5"},      {"name", arm.name},       {"dynamic", "yes"},
                             {"zOffset", "2.5"}, {"country", "OpenDRIVE"}, {"subtype", "-1"}};
    document.controllers[i % 2].controls.push_back({.signal_id = light.id});
    arm.signals.push_back(std::move(light));
  }
}

// The main road comes from the east (1) and west (2), the side road from the south (3). The east arm has a separate
// lane for turning left; on the west arm an island takes up the same width.
MapBuilder intersection_3way() {
  constexpr double width = 3.25, distance = 16.0, length = 120.0, opens = 50.0, open = 80.0;
  MapBuilder builder("intersection 3-way");
  auto const lane = [] { return LanePlan{.width = width}; };
  auto const going_on_as = [](int next) { return LanePlan{.width = width, .next = next}; };

  auto east = straight_arm("1", "main east", 0.0, distance, length);
  east.sections = {{.s = 0.0, .left = {lane()}, .right = {going_on_as(-2)}},
                   {.s = opens, .left = {lane()}, .right = {{.width = 0.0, .end_width = width}, lane()}},
                   {.s = open, .left = {lane()}, .right = {lane(), lane()}}};
  auto west = straight_arm("2", "main west", pi, distance, length);
  west.sections = {{.s = 0.0, .left = {going_on_as(2)}, .right = {lane()}},
                   {.s = opens, .left = {median(0.0, width), lane()}, .right = {lane()}},
                   {.s = open, .left = {median(width, width), lane()}, .right = {lane()}}};
  auto south = straight_arm("3", "side road", -0.5 * pi, distance, 40.0);
  constexpr double bend = 1.0 / 60.0;
  south.line = lay_to(end_of(south.line), {{30.0}, {20.0, 0.0, bend}, {15.0, bend, bend}, {20.0, bend, 0.0}, {25.0}});
  south.sections = {{.left = {lane()}, .right = {lane()}}};
  for (auto* road : {&east, &west, &south}) builder.add_road(std::move(*road));

  builder.add_junction("100", "side road");
  builder.add_turn("100", {"1", end}, {"2", end}, {"10", "east straight on", {{-2, 2}}, kmh(50.0)});
  builder.add_turn("100", {"1", end}, {"3", end}, {"11", "east to the left", {{-1, 1}}, kmh(30.0)});
  builder.add_turn("100", {"2", end}, {"1", end}, {"20", "west straight on", {{-1, 1}}, kmh(50.0)});
  builder.add_turn("100", {"2", end}, {"3", end}, {"21", "west to the right", {{-1, 1}}, kmh(25.0)});
  builder.add_turn("100", {"3", end}, {"1", end}, {"30", "south to the right", {{-1, 1}}, kmh(25.0)});
  builder.add_turn("100", {"3", end}, {"2", end}, {"31", "south to the left", {{-1, 2}}, kmh(30.0)});
  // The main road has priority over the side road. On the main road, going straight on or right has priority over
  // turning left.
  auto& priorities = builder.document().junctions.back().priorities;
  for (auto const& [high, low] :
       {std::pair{"10", "31"}, {"11", "31"}, {"20", "11"}, {"20", "30"}, {"20", "31"}, {"21", "11"}})
    priorities.push_back({high, low});
  return builder;
}

// Arms 1 to 4 join the ring in junctions 100, 200, ... Junction 100 has the roads 101 (stays in the ring), 102 (leaves
// it) and 103 (enters it); ring road 11 leads from there to the next arm.
MapBuilder roundabout() {
  constexpr double radius = 20.0, ring_width = 4.5, width = 3.5, island = 1.0;  // [m]
  constexpr double distance = 32.0, length = 90.0;                              // [m]
  constexpr double half = 32.0 * pi / 180.0;  // half the angle that a junction takes up in the ring [rad]
  MapBuilder builder("roundabout");
  auto const ring = [&](std::string id, std::string name, double from, double angle) {
    RoadPlan road{.id = std::move(id), .name = std::move(name), .type = "town", .speed_limit = kmh(30.0)};
    road.line = lay_from(seen_at(from, {radius, 0.0, 0.5 * pi}),
                         {{std::round(radius * angle * 1e10) / 1e10, 1.0 / radius, 1.0 / radius}});
    road.lane_offset = {{0.0, 0.5 * ring_width, 0.0, 0.0, 0.0}};
    road.sections = {{.right = equal_lanes(1, ring_width)}};
    return road;
  };
  for (int i = 0; i < 4; ++i) {
    double const angle = 0.5 * pi * i;
    auto const number = std::to_string(i + 1);
    auto arm = straight_arm(number, "arm " + number, angle, distance, length);
    arm.sections = {{.s = 0.0, .left = {{.width = width, .next = 2}}, .right = {{.width = width, .next = -2}}},
                    {.s = length - 40.0,
                     .left = {median(0.0, island), {.width = width}},
                     .right = {median(0.0, island), {.width = width}}}};
    builder.add_road(std::move(arm));
    builder.add_road(ring("1" + number, "ring behind arm " + number, angle + half, 0.5 * pi - 2.0 * half));
  }
  for (int i = 0; i < 4; ++i) {
    auto const number = std::to_string(i + 1), before = "1" + std::to_string((i + 3) % 4 + 1), behind = "1" + number;
    auto const junction = builder.add_junction(number + "00", "arm " + number);
    auto way = ring(number + "01", "past arm " + number, 0.5 * pi * i - half, 2.0 * half);
    way.junction = junction;
    builder.add_road(std::move(way));
    builder.connect({before, end}, {number + "01", start});
    builder.connect({number + "01", end}, {behind, start});
    builder.add_turn(junction, {before, end}, {number, end},
                     {number + "02", "out to arm " + number, {{-1, 2}}, kmh(30.0)});
    builder.add_turn(junction, {number, end}, {behind, start},
                     {number + "03", "in from arm " + number, {{-2, -1}}, kmh(30.0)});
    builder.document().junctions.back().priorities.push_back({number + "01", number + "03"});
  }
  return builder;
}

}  // namespace make_maps
