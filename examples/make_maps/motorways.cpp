#include "maps.hpp"

namespace make_maps {
namespace {

constexpr double lane_width = 3.5;      // [m]
constexpr double inner_shoulder = 1.0;  // [m]
constexpr double outer_shoulder = 2.5;  // [m]

LanePlan shoulder(double width) { return {.type = LaneType::shoulder, .width = width}; }

/// `count` driving lanes between two shoulders.
SectionPlan carriageway(double s, std::size_t count, double width) {
  SectionPlan section{s, {shoulder(inner_shoulder)}, equal_lanes(count, width)};
  section.right.push_back(shoulder(outer_shoulder));
  return section;
}

/// Three sections of a carriageway that loses its outermost lane `-count`: full width up to `begin`, tapering up to
/// `end`, then without it. The tapering lane has no successor; the outer shoulder takes over its number.
std::vector<SectionPlan> ending_lane(std::size_t count, double width, LaneType type, double begin, double end) {
  std::vector<SectionPlan> sections{carriageway(0.0, count, width), carriageway(begin, count, width),
                                    carriageway(end, count - 1, width)};
  for (std::size_t i : {0u, 1u}) sections[i].right[count - 1].type = type;
  auto& right = sections[1].right;
  right[count - 1].end_width = 0.0;
  // Lane changes are allowed out of the ending lane, but not into it.
  right[count - 2].mark = make_mark("broken", LaneChangePermission::increase);
  right[count].next = -static_cast<int>(count);
  return sections;
}

RoadPlan motorway(std::string id, std::string name, double limit) {
  return {.id = std::move(id), .name = std::move(name), .type = "motorway", .speed_limit = kmh(limit)};
}

/// The main road 10 in junction 100, without a shoulder on the side of the ramp.
RoadPlan through_junction(double limit, std::vector<Geometry> line, std::size_t count, double width) {
  RoadPlan road = motorway("10", "main through junction", limit);
  road.line = std::move(line);
  road.junction = "100";
  road.sections = {carriageway(0.0, count, width)};
  road.sections[0].right.pop_back();
  return road;
}

}  // namespace

MapBuilder highway() {
  constexpr double left = 1.0 / 640.0, right = -1.0 / 800.0;
  RoadPlan road = motorway("1", "highway", 120.0);
  road.line = lay_from({}, {{300.0},
                            {150.0, 0.0, left},
                            {400.0, left, left},
                            {150.0, left, 0.0},
                            {150.0, 0.0, right},
                            {350.0, right, right},
                            {150.0, right, 0.0},
                            {350.0}});
  road.sections = {carriageway(0.0, 3, 3.75)};
  MapBuilder builder("highway");
  builder.add_road(std::move(road));
  return builder;
}

MapBuilder lane_drop() {
  constexpr double left = 1.0 / 1000.0;
  RoadPlan road = motorway("1", "lane drop", 120.0);
  road.line = lay_from({}, {{160.0}, {80.0, 0.0, left}, {120.0, left, left}, {80.0, left, 0.0}, {360.0}});
  road.sections = ending_lane(3, 3.75, LaneType::driving, 400.0, 480.0);
  MapBuilder builder("lane drop");
  builder.add_road(std::move(road));
  return builder;
}

// Main road 1, ramp 2, junction 100 with the roads 10 (main) and 11 (ramp), and road 3 after it, whose lane -3 is the
// acceleration lane.
MapBuilder merging() {
  constexpr double left = 1.0 / 640.0, right = -1.0 / 800.0, ramp_right = -1.0 / 250.0;
  MapBuilder builder("merging");
  RoadPlan before = motorway("1", "main before", 100.0);
  before.line = lay_from({}, {{100.0}, {50.0, 0.0, left}, {50.0, left, left}, {50.0, left, 0.0}, {50.0}});
  before.sections = {carriageway(0.0, 2, lane_width), carriageway(240.0, 2, lane_width)};
  before.sections[1].right.back().end_width = 0.0;  // makes room for the ramp

  RoadPlan through = through_junction(100.0, lay_from(end_of(before.line), {{50.0}}), 2, lane_width);

  RoadPlan after = motorway("3", "main after", 100.0);
  after.line =
      lay_from(end_of(through.line), {{280.0}, {60.0, 0.0, right}, {120.0, right, right}, {60.0, right, 0.0}, {130.0}});
  after.sections = ending_lane(3, lane_width, LaneType::entry, 200.0, 260.0);

  // The ramp ends where the acceleration lane begins, and stays clear of the main lanes.
  auto const begin = end_of(through.line);
  auto const corner = cambium::geometry::to_map(begin, {0.0, -2.0 * lane_width});
  SectionPlan const ramp_lanes{0.0, {}, {{.type = LaneType::on_ramp, .width = lane_width}, shoulder(outer_shoulder)}};
  RoadPlan ramp_way = motorway("11", "ramp through junction", 80.0);
  ramp_way.line = lay_to({corner.x(), corner.y(), begin.heading}, {{50.0, ramp_right, 0.0}});
  ramp_way.junction = "100";
  ramp_way.sections = {ramp_lanes};
  RoadPlan ramp = motorway("2", "on-ramp", 80.0);
  auto const& next = ramp_way.line.front();
  ramp.line =
      lay_to({next.x, next.y, next.heading}, {{110.0}, {50.0, 0.0, ramp_right}, {40.0, ramp_right, ramp_right}});
  ramp.sections = {ramp_lanes};

  builder.add_junction("100", "ramp");
  for (auto* road : {&before, &ramp, &after, &through, &ramp_way}) builder.add_road(std::move(*road));
  builder.connect({"1", ContactPoint::end}, {"10", ContactPoint::start});
  builder.connect({"10", ContactPoint::end}, {"3", ContactPoint::start});
  builder.connect({"2", ContactPoint::end}, {"11", ContactPoint::start});
  builder.connect({"11", ContactPoint::end}, {"3", ContactPoint::start}, {{-1, -3}, {-2, -4}});
  return builder;
}

// Main road 1, whose lane -4 is the deceleration lane, junction 100 with the roads 10 (main) and 11 (ramp), road 3
// after it, and ramp 2.
MapBuilder highway_exit() {
  constexpr double left = 1.0 / 900.0, ramp_right = -1.0 / 120.0, width = 3.75;
  MapBuilder builder("highway exit");
  RoadPlan before = motorway("1", "main before", 120.0);
  before.line = lay_from({}, {{100.0}, {80.0, 0.0, left}, {120.0, left, left}, {80.0, left, 0.0}, {220.0}});
  before.sections = {carriageway(0.0, 3, width), carriageway(320.0, 4, width), carriageway(390.0, 4, width)};
  before.sections[0].right.back().next = -5;
  for (std::size_t i : {1u, 2u}) before.sections[i].right[3].type = LaneType::exit;
  before.sections[1].right[3].end_width = width;
  before.sections[1].right[3].width = 0.0;

  RoadPlan through = through_junction(120.0, lay_from(end_of(before.line), {{70.0}}), 3, width);

  RoadPlan after = motorway("3", "main after", 120.0);
  after.line = lay_from(end_of(through.line), {{150.0}, {80.0, 0.0, left}, {70.0, left, left}});
  after.sections = {carriageway(0.0, 3, width), carriageway(60.0, 3, width)};
  after.sections[0].right.back().width = 0.0;
  after.sections[0].right.back().end_width = outer_shoulder;

  auto const end = end_of(before.line);
  auto const corner = cambium::geometry::to_map(end, {0.0, -3.0 * width});
  SectionPlan const ramp_lanes{0.0, {}, {{.type = LaneType::off_ramp, .width = width}, shoulder(outer_shoulder)}};
  RoadPlan ramp_way = motorway("11", "ramp through junction", 80.0);
  ramp_way.line = lay_from({corner.x(), corner.y(), end.heading}, {{70.0, 0.0, -1.0 / 250.0}});
  ramp_way.junction = "100";
  ramp_way.sections = {ramp_lanes};
  RoadPlan ramp = motorway("2", "off-ramp", 60.0);
  ramp.line =
      lay_from(end_of(ramp_way.line),
               {{50.0, -1.0 / 250.0, ramp_right}, {80.0, ramp_right, ramp_right}, {50.0, ramp_right, 0.0}, {40.0}});
  ramp.sections = {ramp_lanes};

  builder.add_junction("100", "exit");
  for (auto* road : {&before, &ramp, &after, &through, &ramp_way}) builder.add_road(std::move(*road));
  builder.connect({"1", ContactPoint::end}, {"10", ContactPoint::start});
  builder.connect({"10", ContactPoint::end}, {"3", ContactPoint::start});
  builder.connect({"1", ContactPoint::end}, {"11", ContactPoint::start}, {{-4, -1}, {-5, -2}});
  builder.connect({"11", ContactPoint::end}, {"2", ContactPoint::start});
  return builder;
}

}  // namespace make_maps
