// Recorded traffic: tables of tracks, CommonRoad files, and scenarios of them.
#include <doctest/doctest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <pugixml.hpp>

#include "cambium/behavior/behavior_set.hpp"
#include "cambium/behavior/open_loop/constant_acceleration.hpp"
#include "cambium/behavior/drivers.hpp"
#include "cambium/behavior/open_loop/static_trajectory.hpp"
#include "cambium/core/random.hpp"
#include "cambium/dynamics/single_track.hpp"
#include "cambium/execution/interpolate.hpp"
#include "cambium/map/lanelet/lanelet2.hpp"
#include "cambium/scenario/dataset/common_road.hpp"
#include "cambium/scenario/dataset/common_road_solution.hpp"
#include "cambium/scenario/dataset/common_road_writer.hpp"
#include "cambium/scenario/dataset/recorded_scenario.hpp"
#include "cambium/scenario/dataset/track_recorder.hpp"
#include "cambium/scenario/dataset/track_table.hpp"
#include "cambium/world/world.hpp"

#include "../support/corpus.hpp"
#include "../support/error_of.hpp"
#include "../support/maps.hpp"
#include "../support/xml_damage.hpp"

using namespace cambium;

namespace {

using Sim =
    World<BehaviorSet<StaticTrajectory, IdmClassic, Mobil, ConstantAcceleration>, InterpolateExecution, SingleTrack>;

std::string text_of(std::vector<Diagnostic> const& diagnostics) {
  std::string text;
  for (auto const& found : diagnostics) text += to_string(found) + "\n";
  return text;
}

/// Cars on `support::straight_road(2)`: 7 in the left lane, 9 in the right one from 2 s on, and a pedestrian beside
/// them.
RecordedTraffic cars() {
  RecordedTraffic traffic{.name = "cars", .map = support::straight_road(2)};
  auto const add = [&](std::int64_t id, TrackType type, double begin, double x, double y, double speed) {
    Track track{.id = id, .type = type};
    if (type == TrackType::pedestrian) track.length = track.width = 0.6;
    for (int k = 0; k <= 80; ++k) {
      double const passed = 0.1 * k;
      track.states.push_back({begin + passed, x + speed * passed, y, 0.0, speed});
    }
    traffic.tracks.push_back(track);
  };
  add(7, TrackType::car, 0.0, 20.0, -1.75, 10.0);
  add(9, TrackType::car, 2.0, 30.0, -5.25, 12.0);
  add(11, TrackType::pedestrian, 0.0, 60.0, 8.0, 1.5);
  traffic.tracks.push_back({21, TrackType::other, 2.0, 2.0, true, {State{0.0, 200.0, 5.0, 0.3, 0.0}}});
  return traffic;
}

std::string state_text(double x, double y, int time, double speed) {
  auto const n = [](double value) { return std::to_string(value); };
  return "<position><point><x>" + n(x) + "</x><y>" + n(y) + "</y></point></position><orientation><exact>0</exact>" +
         "</orientation><time><exact>" + std::to_string(time) + "</exact></time><velocity><exact>" + n(speed) +
         "</exact></velocity>";
}

std::string bound_text(std::string const& name, double y, std::string const& marking) {
  std::string text = "<" + name + ">";
  for (double const x : {0.0, 60.0, 120.0})
    text += "<point><x>" + std::to_string(x) + "</x><y>" + std::to_string(y) + "</y></point>";
  return text + "<lineMarking>" + marking + "</lineMarking></" + name + ">";
}

/// A CommonRoad 2020a scenario: two lanes, a car, a parked car, a planning problem with a goal in the left lane.
std::string common_road() {
  std::string text =
      "<?xml version='1.0'?>\n<commonRoad benchmarkID='ZAM_Own-1_1_T-1' commonRoadVersion='2020a' "
      "timeStepSize='0.2'>\n<location/><scenarioTags/>\n";
  text +=
      "<lanelet id='1'>" + bound_text("leftBound", 3.5, "solid") + bound_text("rightBound", 0.0, "dashed") +
      "<adjacentRight ref='2' drivingDir='same'/><laneletType>urban</laneletType><trafficSignRef ref='5'/></lanelet>\n";
  text += "<lanelet id='2'>" + bound_text("leftBound", 0.0, "dashed") + bound_text("rightBound", -3.5, "solid") +
          "<adjacentLeft ref='1' drivingDir='same'/><stopLine><point><x>110</x><y>0</y></point><point><x>110</x>"
          "<y>-3.5</y></point><lineMarking>solid</lineMarking></stopLine><trafficSignRef ref='6'/>"
          "<trafficLightRef ref='8'/></lanelet>\n";
  text +=
      "<trafficSign id='5'><trafficSignElement><trafficSignID>274</trafficSignID><additionalValue>14</additionalValue>"
      "</trafficSignElement></trafficSign>\n";
  text +=
      "<trafficSign id='6'><trafficSignElement><trafficSignID>206</trafficSignID></trafficSignElement></trafficSign>\n";
  text +=
      "<trafficLight id='8'><cycle><cycleElement><duration>50</duration><color>red</color></cycleElement>"
      "<cycleElement><duration>100</duration><color>green</color></cycleElement><cycleElement><duration>10</duration>"
      "<color>yellow</color></cycleElement><timeOffset>0</timeOffset></cycle></trafficLight>\n";
  std::string const shape = "<shape><rectangle><length>4.5</length><width>1.8</width></rectangle></shape>";
  text += "<staticObstacle id='30'><type>parkedVehicle</type>" + shape + "<initialState>" + state_text(100, -8, 0, 0) +
          "</initialState></staticObstacle>\n";
  text += "<dynamicObstacle id='31'><type>car</type>" + shape + "<initialState>" + state_text(40, -1.75, 0, 8) +
          "</initialState><trajectory>";
  for (int k = 1; k <= 30; ++k) text += "<state>" + state_text(40 + 1.6 * k, -1.75, k, 8) + "</state>";
  text += "</trajectory></dynamicObstacle>\n";
  return text + "<planningProblem id='40'><initialState>" + state_text(10, -1.75, 0, 10) +
         "</initialState><goalState><position><rectangle><length>20</length><width>3</width><orientation>0</"
         "orientation>"
         "<center><x>80</x><y>1.75</y></center></rectangle></position><orientation><intervalStart>-0.2</intervalStart>"
         "<intervalEnd>0.2</intervalEnd></orientation><time><intervalStart>20</intervalStart><intervalEnd>60</"
         "intervalEnd>"
         "</time><velocity><intervalStart>2</intervalStart><intervalEnd>20</intervalEnd></velocity></goalState>"
         "</planningProblem>\n</commonRoad>\n";
}

std::string replaced(std::string text, std::string const& what, std::string const& by) {
  auto const at = text.find(what);
  REQUIRE_MESSAGE(at != std::string::npos, what);
  return text.replace(at, what.size(), by);
}

char const* const table =
    "track_id,frame_id,timestamp_ms,agent_type,x,y,vx,vy,psi_rad,length,width\n"
    "3,2,200,car,1.5,2,5,0,0,4.2,1.7\n"
    "3,1,100,car,1,2,5,0,0,4.2,1.7\n"
    "4,1,100,truck,9.25,2,-3,0,0.0,8,2.5\n"
    "4,2,200,truck,8.95,2,-3,0,0.0,8,2.5\n"
    "\n"
    "3,3,300,car,2,2,5,0,0,4.2,1.7\n";

}  // namespace

// --- tables ----------------------------------------------------------------------------------------------------------

TEST_CASE("INTERACTION's rows become tracks by time, in the order of their first rows") {
  auto const traffic = read_tracks(table);
  CHECK_MESSAGE(traffic.diagnostics.empty(), text_of(traffic.diagnostics));
  REQUIRE(traffic.tracks.size() == 2);
  auto const& car = traffic.track(3);
  CHECK(car.type == TrackType::car);
  CHECK(car.length == 4.2);
  REQUIRE(car.states.size() == 3);
  CHECK(car.states[0] == State{0.1, 1.0, 2.0, 0.0, 5.0});
  CHECK(car.states[1].x == 1.5);
  CHECK(car.at(0.15).x == doctest::Approx(1.25));
  CHECK(car.at(0.0) == car.states.front());
  CHECK(car.at(0.3) == State{0.3, 2.0, 2.0, 0.0, 5.0});
  CHECK(car.at(9.0) == car.states.back());
  CHECK(traffic.begin() == 0.1);
  CHECK(traffic.end() == 0.3);
  CHECK(traffic.time_step == doctest::Approx(0.1));
  CHECK(traffic.track(4).states[0].speed == -3.0);  // backwards
  CHECK(traffic.track(4).type == TrackType::truck);
  CHECK(support::error_of([&] { return traffic.track(5); }) == "text: track 5: there is no such track; there are 3, 4");
}

TEST_CASE("pedestrians and cyclists have neither size nor heading: both follow from type and motion") {
  auto const traffic = read_tracks(
      "track_id,frame_id,timestamp_ms,agent_type,x,y,vx,vy\n"
      "P1,1,100,pedestrian/bicycle,0,0,0,1.5\nP1,2,200,pedestrian/bicycle,0,0.15,0,1.5\n"
      "P1,3,300,pedestrian/bicycle,0,0.15,0,0\n");
  REQUIRE(traffic.tracks.size() == 1);
  auto const& walker = traffic.track(1);
  CHECK(walker.type == TrackType::pedestrian);
  CHECK(walker.length == doctest::Approx(0.6));
  CHECK(walker.states[0].heading == doctest::Approx(geometry::pi / 2));
  CHECK(walker.states[2].heading == doctest::Approx(geometry::pi / 2));  // who stands keeps it
}

TEST_CASE("tracks of several files are one recording, each with an id of its own") {
  auto traffic = read_tracks(table);
  add_tracks(traffic, read_tracks(replaced(table, "4,2,200", "9,2,200")));
  std::vector<std::int64_t> ids;
  for (auto const& track : traffic.tracks) ids.push_back(track.id);
  CHECK(ids == std::vector<std::int64_t>{3, 4, 10, 11, 9});
  check_recorded_traffic(traffic);
}

TEST_CASE("highD's corners in pictures and NGSIM's feet become middles in metres") {
  auto const highd = read_tracks(
      "frame,id,x,y,width,height,xVelocity,yVelocity\n25,1,100,20,5,2,-30,0\n26,1,98.8,20,5,2,-30,0\n", highd_tracks());
  auto const& car = highd.track(1);
  CHECK(car.states[0].time == doctest::Approx(1.0));
  CHECK(car.states[0].x == 102.5);
  CHECK(car.states[0].y == -21.0);
  CHECK(std::abs(car.states[0].heading) == doctest::Approx(geometry::pi));
  CHECK(car.states[0].speed == doctest::Approx(30.0));
  CHECK(car.width == 2.0);

  std::string rows = "Vehicle_ID,Frame_ID,Local_X,Local_Y,v_Length,v_Width,v_Class,v_Vel\n";
  for (int k = 0; k < 5; ++k)
    rows += "2," + std::to_string(10 + k) + ",18," + std::to_string(100 + 4 * k) + ",15,6,2,40\n";
  auto const ngsim = read_tracks(rows, ngsim_tracks());
  auto const& state = ngsim.track(2).states[0];
  CHECK(state.time == doctest::Approx(1.0));
  CHECK(state.x == doctest::Approx((100.0 - 7.5) * 0.3048));
  CHECK(state.y == doctest::Approx(-18.0 * 0.3048));
  CHECK(state.heading == doctest::Approx(0.0));
  CHECK(state.speed == doctest::Approx(12.192));
  CHECK(ngsim.track(2).length == doctest::Approx(4.572));
  CHECK(ngsim.track(2).width == doctest::Approx(1.8288));
}

TEST_CASE("a malformed table is an error with its line and a remedy") {
  auto const error = [](std::string const& text) {
    return support::error_of([&] { return read_tracks(text, {}, "a.csv"); });
  };
  CHECK(error("") == "a.csv: it has no row; give a table whose first row names the columns");
  CHECK(error("id,x,y\n").find("a.csv:1: there is no column \"track_id\"; name") == 0);
  CHECK(error(replaced(table, "1.5,2,5", "1.5,two,5")).find("a.csv:2: \"two\" is no number") == 0);
  CHECK(error(replaced(table, "3,1,100,car,1,2,5,0,0,4.2,1.7", "3,1,100,car,1")).find("a.csv:3: it has 5 cells") == 0);
  CHECK(error(replaced(table, "3,1,100", "x,1,100")).find("a.csv:3: \"x\" is no id") == 0);
  CHECK(error(replaced(table, "3,3,300", "3,3,200")).find("a.csv:7: track 3 has a row for 0.2 s already, in line 2") ==
        0);
  CHECK(error(replaced(replaced(table, "4.2", "0"), "4.2", "0")).find("track 3: its length or width is not above 0") !=
        std::string::npos);
  CHECK(support::error_of([] { return load_tracks("/nowhere.csv"); }).find("/nowhere.csv: the file cannot be opened") ==
        0);
}

TEST_CASE("what is odd in a table is a finding") {
  auto const traffic = read_tracks(replaced(replaced(table, "1,2,5,0,0,4.2", "1,2,25,0,0,5.2"), "3,3,300", "3,3,900"));
  auto const text = text_of(traffic.diagnostics);
  CHECK(text.find("track 3: its size changes") != std::string::npos);
  CHECK(text.find("text:3: warning: track 3: its speed contradicts its motion") != std::string::npos);
  CHECK(text.find("text:7: info: track 3: nothing is recorded for 0.7 s") != std::string::npos);
}

TEST_CASE("an id that comes again after a long time is another road user") {
  std::string text = table;
  for (auto const& [time, x] : {std::pair{300'000, 400}, {300'100, 401}})
    text += "3,9," + std::to_string(time) + ",car," + std::to_string(x) + ",2,5,0,0,4.2,1.7\n";
  auto const traffic = read_tracks(text);
  REQUIRE(traffic.tracks.size() == 3);
  CHECK(traffic.track(3).end() == doctest::Approx(0.3));
  CHECK(traffic.track(5).begin() == doctest::Approx(300.0));
  CHECK(traffic.track(5).at(300.0).x == doctest::Approx(400.0));
  CHECK(text_of(traffic.diagnostics).find("from here on it is another one, track 5") != std::string::npos);
  CHECK(read_tracks(text, {.longest_gap = 1000.0}).tracks.size() == 2);
  std::string torn = "track_id,frame_id,timestamp_ms,agent_type,x,y,vx,vy,psi_rad,length,width\n";
  for (int k = 0; k < 20'000; ++k)
    torn += "3," + std::to_string(k) + "," + std::to_string(100'000 * k) + ",car,0,0,0,0,0,4,2\n";
  auto const parts = read_tracks(torn);
  CHECK(parts.tracks.size() == 20'000);
  CHECK(parts.tracks.back().begin() == doctest::Approx(1'999'900.0));
  CHECK(parts.diagnostics.size() < 10);
  CHECK(text_of(parts.diagnostics).find("it has 19999 gaps of more than") != std::string::npos);
}

TEST_CASE("another road user with an id seen before has its own size and type") {
  std::string const big = std::to_string(std::numeric_limits<std::int64_t>::max());
  for (std::string const& id : {std::string("3"), big}) {
    std::string text = "track_id,frame_id,timestamp_ms,agent_type,x,y,vx,vy,psi_rad,length,width\n" + id +
                       ",1,100,car,0,0,5,0,0,4,2\n" + id + ",2,200,car,0.5,0,5,0,0,4,2\n";
    text += id + ",3,9000,truck,10,0,5,0,0,12,2.5\n" + id + ",4,9100,truck,10.5,0,5,0,0,12,2.5\n";
    auto const traffic = read_tracks(text);
    REQUIRE(traffic.tracks.size() == 2);
    CHECK(traffic.tracks[0].type == TrackType::car);
    CHECK(traffic.tracks[0].length == 4.0);
    CHECK(traffic.tracks[1].id == (id == "3" ? 4 : 0));
    CHECK(traffic.tracks[1].type == TrackType::truck);
    CHECK(traffic.tracks[1].length == 12.0);
    CHECK(traffic.tracks[1].width == 2.5);
    CHECK(text_of(traffic.diagnostics).find("size changes") == std::string::npos);
  }
  auto const pictures = read_tracks(
      "frame,id,x,y,width,height,xVelocity,yVelocity\n1,1,10,5,4.5,2,25,0\n2,1,11,5,4.5,2,25,0\n"
      "100,1,300,9,16,2.5,-25,0\n101,1,299,9,16,2.5,-25,0\n",
      highd_tracks());
  REQUIRE(pictures.tracks.size() == 2);
  CHECK(pictures.tracks[0].type == TrackType::car);
  CHECK(pictures.tracks[1].type == TrackType::truck);
  CHECK(pictures.tracks[1].states[0].x == doctest::Approx(308.0));  // the middle of its own body
}

TEST_CASE("tracks that are written as a table read back the same") {
  auto traffic = cars();
  traffic.tracks.pop_back();  // what stands is a track like others there
  traffic.tracks[0].states[3].x += 1.0 / 3.0;
  auto const again = read_tracks(interaction_text(traffic));
  REQUIRE(again.tracks.size() == 3);
  for (std::size_t i = 0; i < 3; ++i) {
    auto const &a = traffic.tracks[i], &b = again.tracks[i];
    REQUIRE(a.states.size() == b.states.size());
    CHECK(a.id == b.id);
    CHECK(a.type == b.type);
    for (std::size_t k = 0; k < a.states.size(); ++k) {
      CHECK(a.states[k].x == b.states[k].x);
      CHECK(a.states[k].speed == doctest::Approx(b.states[k].speed));
    }
  }
}

// --- CommonRoad ------------------------------------------------------------------------------------------------------

TEST_CASE("what stands keeps its outline, in a scenario and in a file") {
  std::string const box = "<rectangle><length>4.5</length><width>1.8</width></rectangle>";
  for (auto const& [shape, area] :
       {std::pair{std::string("<polygon><point><x>0</x><y>0</y></point><point><x>10</x><y>10</y></point>"
                              "<point><x>10</x><y>10.5</y></point><point><x>0</x><y>0.5</y></point></polygon>"),
                  5.0},
        {std::string("<circle><radius>2</radius></circle>"), 12.5}}) {
    auto const traffic = parse_common_road(replaced(common_road(), box, shape));
    auto const objects = recorded_scenario<Sim>(traffic).objects;
    REQUIRE(objects.size() == 1);
    CHECK(0.5 * std::abs(geometry::twice_area(objects[0].points())) == doctest::Approx(area).epsilon(0.01));
    CHECK(parse_common_road(common_road_text(traffic)).track(30).outline == traffic.track(30).outline);
  }
}

TEST_CASE("lights are written in whole steps, from the begin of green, or not at all") {
  auto traffic = parse_common_road(common_road());
  for (auto const& plan : {map::LightPlan{.cycle = 20.4, .green_begin = 25.0, .green_end = 33.2, .yellow = 3.0},
                           map::LightPlan{.cycle = 60.0, .green_begin = -4.0, .green_end = 20.0, .yellow = 0.0}}) {
    traffic.lights[0] = plan;
    auto const again = parse_common_road(common_road_text(traffic)).lights[0];
    for (double time = 0.1; time < 130.0; time += 0.2) CHECK(again.at(time) == plan.at(time));
  }
  traffic.lights[0] = {.cycle = 20.0, .green_begin = 0.0, .green_end = 9.9, .yellow = 3.0};
  CHECK(support::error_of([&] { return common_road_text(traffic); }).find("light 8: its time 9.9 s is no multiple") !=
        std::string::npos);
}

TEST_CASE("a CommonRoad scenario has lanes, limits, signs, lights, tracks and a planning problem") {
  auto const traffic = parse_common_road(common_road());
  CHECK_MESSAGE(traffic.diagnostics.empty(), text_of(traffic.diagnostics));
  CHECK(traffic.name == "ZAM_Own-1_1_T-1");
  CHECK(traffic.time_step == 0.2);
  REQUIRE(traffic.lanes.size() == 2);
  auto const &left = traffic.map->lane(traffic.lanes.at(1)), &right = traffic.map->lane(traffic.lanes.at(2));
  CHECK(left.right_neighbor == right.id);
  CHECK(left.speed_limit_at(5.0) == 14.0);
  REQUIRE(right.signals.size() == 2);
  CHECK(right.signals[0].kind == map::SignalKind::stop);
  CHECK(right.signals[0].s == doctest::Approx(110.0));
  REQUIRE(traffic.lights.size() == 1);
  CHECK(traffic.lights[0].at(5.0) == map::LightColor::red);
  CHECK(traffic.lights[0].at(15.0) == map::LightColor::green);
  CHECK(traffic.lights[0].at(31.0) == map::LightColor::yellow);
  auto const late = parse_common_road(replaced(common_road(), "<timeOffset>0", "<timeOffset>20"));
  CHECK(late.lights[0].at(13.0) == map::LightColor::red);
  CHECK(late.lights[0].at(33.0) == map::LightColor::green);
  CHECK(recorded_scenario<Sim>(traffic, {.begin = 5.0}).scenario.lights[0].at(5.5) == map::LightColor::green);
  REQUIRE(traffic.tracks.size() == 2);
  CHECK(traffic.tracks[0].stands);
  CHECK(traffic.track(31).states.size() == 31);
  CHECK(traffic.track(31).states[30] == State{6.0, 88.0, -1.75, 0.0, 8.0});
  REQUIRE(traffic.problems.size() == 1);
  auto const& goal = traffic.problems[0].goals.at(0);
  CHECK(goal.first_time == 4.0);
  CHECK(goal.lanes(*traffic.map) == std::vector{left.id});
  GoalSituation at{.pose = {78.65, 1.75, 0.0}, .shape = geometry::car(), .speed = 10.0};  // the middle is at 80
  CHECK(goal.at_goal(at));
  CHECK(goal.holds(at, 5.0));
  CHECK_FALSE(goal.holds(at, 3.0));
  at.speed = 1.0;
  CHECK_FALSE(goal.at_goal(at));
}

TEST_CASE("a CommonRoad scenario of 2018b reads alike") {
  auto text = replaced(common_road(), "2020a", "2018b");
  text = replaced(text, "<staticObstacle id='30'>", "<obstacle id='30'><role>static</role>");
  text = replaced(text, "</staticObstacle>", "</obstacle>");
  text = replaced(text, "<dynamicObstacle id='31'>", "<obstacle id='31'><role>dynamic</role>");
  text = replaced(text, "</dynamicObstacle>", "</obstacle>");
  text = replaced(text, "<trafficSignRef ref='5'/>", "<speedLimit>14</speedLimit>");
  auto const old = parse_common_road(text), now = parse_common_road(common_road());
  CHECK(old.tracks == now.tracks);
  CHECK(old.lanelets == now.lanelets);
  CHECK(old.problems == now.problems);
}

TEST_CASE("uncertain values become their middles, shifted shapes their own, and oddities are findings") {
  auto text = replaced(common_road(), "<velocity><exact>8.000000</exact>",
                       "<velocity><intervalStart>7</intervalStart><intervalEnd>10</intervalEnd>");
  text = replaced(text,
                  "<dynamicObstacle id='31'><type>car</type><shape><rectangle><length>4.5</length><width>1.8</width>",
                  "<dynamicObstacle id='31'><type>bus</type><shape><rectangle><length>4.5</length><width>1.8</width>"
                  "<center><x>1</x><y>0.5</y></center>");
  text = replaced(text, "<scenarioTags/>", "<scenarioTags/><phantomObstacle id='3'/>");
  text = replaced(text, "ref='6'", "ref='66'");
  auto const traffic = parse_common_road(text, {}, "a.xml");
  auto const& bus = traffic.track(31);
  CHECK(bus.type == TrackType::bus);
  CHECK(bus.states[0] == State{0.0, 41.0, -1.25, 0.0, 8.5});
  auto const found = text_of(traffic.diagnostics);
  for (char const* words : {"velocity is an interval", "<phantomObstacle>", "a.xml:5: warning: <trafficSignRef>"})
    CHECK_MESSAGE(found.find(words) != std::string::npos, words, "\n", found);
}

TEST_CASE("a malformed CommonRoad file is an error with file, line and remedy") {
  auto const error = [](std::string const& text) {
    return support::error_of([&] { return parse_common_road(text, {}, "a.xml"); });
  };
  CHECK(error("<osm/>").find("a.xml:1: the root element is <osm>, not <commonRoad>; give") == 0);
  CHECK(error(replaced(common_road(), "timeStepSize='0.2'", "")).find("a.xml:2: timeStepSize is missing") == 0);
  CHECK(error(common_road().substr(0, 900)).find("a.xml:") == 0);
  CHECK(support::error_of([] { return load_common_road("/nowhere.xml"); }).find("/nowhere.xml: the file") == 0);
}

TEST_CASE("what is written as CommonRoad reads back the same, bit by bit") {
  std::vector<std::string> texts{common_road(), common_road()};
  for (auto at = texts[1].find("</point>"); at < texts[1].find("<trafficSign ");
       at = texts[1].find("</point>", at + 20))
    texts[1].insert(at, "<z>4.5</z>");
  CHECK(parse_common_road(texts[1]).lanelets[1].right_heights == std::vector<double>(3, 4.5));
  for (char const* name : {"DEU_Test-1_1_T-1", "ZAM-Ramp-1_1-T-1", "ZAM_Over-1_1", "ZAM_Tjunction-1_42_T-1",
                           "ZAM_Tutorial-1_2_T-1", "test_reading_all", "test_reading_planning_problem"})
    if (auto const file = corpus::find("scenarios/commonroad/" + std::string(name) + ".xml"))
      texts.push_back(corpus::read(*file));
    else
      break;
  for (auto const& text : texts) {
    auto const traffic = parse_common_road(text);
    CAPTURE(traffic.name);
    auto const written = common_road_text(traffic);
    auto const again = parse_common_road(written);
    CHECK(again.tracks == traffic.tracks);
    CHECK(again.problems == traffic.problems);
    CHECK(again.lanelets == traffic.lanelets);
    CHECK(again.lanes == traffic.lanes);
    CHECK(common_road_text(again) == written);
  }
}

TEST_CASE("a run on an OpenDRIVE map is a CommonRoad scenario with its lanes, and ids that are taken get others") {
  Sim world(support::own_map("merging.xodr"));
  world.add({.position = {10.0, -5.25}, .speed = 12.0, .behavior = IdmClassic{}, .id = AgentId{2}});
  TrackRecorder recorder(world, 0.2, "run");
  for (int k = 0; k < 20; ++k) {
    REQUIRE(world.step(0.2));
    recorder.record(world);
  }
  auto const again = parse_common_road(common_road_text(recorder.traffic()));
  REQUIRE(again.tracks.size() == 1);
  CHECK(again.lanelets.size() > 3);
  CHECK(again.tracks[0].id != 2);  // a lanelet has it
  auto const &was = recorder.traffic().tracks[0], &is = again.tracks[0];
  REQUIRE(is.states.size() == 21);
  for (std::size_t k = 0; k < is.states.size(); ++k) {
    CHECK(is.states[k].x == was.states[k].x);
    CHECK(is.states[k].speed == was.states[k].speed);
  }
  auto const& s = world.state(AgentId{2});
  CHECK(was.states.back().x == doctest::Approx(s.x + geometry::car().center_offset() * std::cos(s.heading)));
  recorder.traffic().time_step = 0.3;
  CHECK(support::error_of([&] {
          return common_road_text(recorder.traffic());
        }).find("is no multiple of the time step") != std::string::npos);
}

TEST_CASE("a CommonRoad solution reads back the same, and its steering fits the curve") {
  CommonRoadSolution solution{.benchmark_id = "ZAM_Own-1_1_T-1",
                              .problem = 40,
                              .time_step = 0.1,
                              .date = "2026-11-24T12:00:00",
                              .computation_time = 1.5};
  double const radius = 30.0, speed = 6.0;
  for (int k = 0; k < 20; ++k) {
    double const angle = speed * 0.1 * k / radius;
    solution.states.push_back({0.1 * k, radius * std::sin(angle), radius * (1.0 - std::cos(angle)), angle, speed});
  }
  auto const text = common_road_solution_text(solution);
  CHECK(text.find("benchmark_id=\"KS2:SM1:ZAM_Own-1_1_T-1:2020a\"") != std::string::npos);
  auto const again = parse_common_road_solution(text, 0.1);
  CHECK(again.problem == 40);
  CHECK(again.vehicle == 2);
  CHECK(again.states == solution.states);
  CHECK(again.date == solution.date);
  CHECK(again.computation_time == 1.5);
  auto const at = text.rfind("<steeringAngle>", text.size() / 2) + 15;
  CHECK(std::stod(text.substr(at)) == doctest::Approx(std::atan(2.578 / radius)).epsilon(1e-3));
  auto bad = solution;
  bad.states[5].time += 0.05;
  CHECK(support::error_of([&] { return common_road_solution_text(bad); }).find("state 5 is not one time step after") !=
        std::string::npos);
  bad = solution;
  bad.cost_function = "XX";
  CHECK(support::error_of([&] { return common_road_solution_text(bad); }).find("cost function XX is unknown") !=
        std::string::npos);
  CHECK(support::error_of([&] {
          return parse_common_road_solution("<CommonRoadSolution/>", 0.1);
        }).find("benchmark_id") != std::string::npos);
}

// --- scenarios -------------------------------------------------------------------------------------------------------

TEST_CASE("replays end where they were recorded, come and go with their tracks, and obstacles stand") {
  auto const traffic = cars();
  auto const recorded = recorded_scenario<Sim>(traffic, {.begin = 1.0});
  CHECK(recorded.diagnostics.empty());
  CHECK(recorded.duration() == doctest::Approx(9.0));
  auto world = recorded.make_world();
  CHECK(world.size() == 3);
  CHECK(world.roster().objects.size() == 1);
  CHECK(world.status(AgentId{9}) == AgentStatus::not_started);
  auto const walker = *world.roster().slot_of(AgentId{11});  // 0.6 m wide, on a way of its own
  CHECK(world.roster().agents[walker].road->corridors.front().width_at(1.0) == doctest::Approx(1.1));
  TrackRecorder recorder(world, 0.25);
  for (int k = 0; k < 36; ++k) {
    REQUIRE(world.step(0.25));
    recorder.record(world);
  }
  CHECK(world.status(AgentId{7}) == AgentStatus::expired);
  for (auto const id : {7, 9, 11}) {
    CAPTURE(id);
    auto const way = *way_of(*traffic.map, traffic.track(id), 1.0, 10.0);
    CHECK(way.states.front().time == std::max(1.0, traffic.track(id).begin()));
    CHECK(way.states.back() == reference_state(traffic.track(id).states.back(), reference_shape(traffic.track(id))));
    auto const &is = recorder.traffic().track(id), &was = traffic.track(id);
    CHECK(is.begin() + 1.0 == doctest::Approx(std::max(1.0, was.begin())));
    CHECK(is.states.size() >= 28);
    for (auto const& state : is.states) {
      CHECK(state.x == doctest::Approx(was.at(state.time + 1.0).x));
      CHECK(state.y == doctest::Approx(was.at(state.time + 1.0).y));
    }
  }
}

TEST_CASE("an agent that is replaced starts in its recorded state, at once or when its track begins") {
  auto const traffic = cars();
  auto const recorded = recorded_scenario<Sim>(traffic, {}, [](Track const& track) -> std::optional<Sim::Behavior> {
    if (track.type == TrackType::pedestrian) return std::nullopt;
    return IdmClassic{.law = {.desired_speed = 5.0}};
  });
  REQUIRE(recorded.later.size() == 1);
  CHECK(recorded.later[0].time == 2.0);
  auto world = recorded.make_world();
  CHECK(world.size() == 2);
  CHECK(world.state(AgentId{7}).x == doctest::Approx(20.0 - 1.35));  // the rear axle
  std::size_t entered = 0;
  for (int k = 0; k < 11; ++k) {
    entered = recorded.enter(world, entered);
    CHECK(entered == (world.time() < 1.9 ? 0u : 1u));
    if (k < 10) REQUIRE(world.step(0.2));
  }
  REQUIRE(world.size() == 3);
  CHECK(world.state(AgentId{9}).x == doctest::Approx(30.0 - 1.35));
  CHECK(world.state(AgentId{9}).speed == 12.0);
  CHECK(world.state(AgentId{7}).speed < 9.0);  // it drives itself
}

TEST_CASE("a replaced agent's goal is where its track ends, and its route the lanes of its track") {
  auto traffic = cars();
  auto& changing = traffic.tracks[0];
  for (auto& state : changing.states) state.y -= std::min(3.5, 0.7 * state.time);
  auto const replace_7 = [](Track const& track) {
    return track.id == 7 ? std::optional<Sim::Behavior>(IdmClassic{.law = {.desired_speed = 10.0}}) : std::nullopt;
  };
  auto const recorded = recorded_scenario<Sim>(traffic, {.ego = 7}, replace_7);
  CHECK(recorded.scenario.ego == AgentId{7});
  auto const& agent = recorded.scenario.agents[0];
  auto const lane = [&](int number) { return traffic.map->find_lane("1", 50.0, number); };
  REQUIRE(agent.route);
  CHECK(agent.route->lanes == std::vector{lane(-1), lane(-2)});
  auto const* const goal = std::get_if<ReachLane>(&agent.goal);
  REQUIRE(goal);
  CHECK(goal->lane == lane(-2));
  CHECK(goal->from == doctest::Approx(100.0 - 1.35 - 1.0));

  auto world = recorded_scenario<Sim>(cars(), {.ego = 7}, replace_7).make_world();
  while (world.time() < 20.0 && !world.reached_goal(AgentId{7})) REQUIRE(world.step(0.2));
  CHECK(world.reached_goal(AgentId{7}));
  CHECK(world.state(AgentId{7}).x < 101.0);
}

TEST_CASE("a vehicle that heads against its lane gets a way of its own, and one that jumps is named") {
  auto traffic = cars();
  for (auto& state : traffic.tracks[0].states) state.heading += geometry::pi;
  auto const recorded = recorded_scenario<Sim>(traffic, {});
  REQUIRE(recorded.diagnostics.size() == 1);
  CHECK(recorded.diagnostics[0].sentence.find("it got a way of its own") != std::string::npos);
  auto world = recorded.make_world();
  CHECK(world.size() > 0);
  traffic.tracks.resize(1);
  auto& states = traffic.tracks[0].states;
  for (int k = 1; k < 100; ++k) {  // and stands there for long
    states.push_back(states.back());
    states.back().time += 0.2;
    states.back().speed = 0.0;
  }
  CHECK_FALSE(way_of(*traffic.map, traffic.tracks[0], 0.0, 100.0)->route);
  auto turned = cars();  // a car that drives, and stands with a wrong heading
  turned.tracks.resize(1);
  for (int k = 1; k < 100; ++k) {
    turned.tracks[0].states.push_back(turned.tracks[0].states.back());
    turned.tracks[0].states.back().time += 0.2;
    turned.tracks[0].states.back().speed = 0.0;
    turned.tracks[0].states.back().heading = 2.0;
  }
  CHECK(way_of(*turned.map, turned.tracks[0], 0.0, 100.0)->route);
  auto waiting = cars();  // one that stands so before it drives
  auto& moving = waiting.tracks[0].states;
  for (auto& state : moving) state.time += 20.0;
  for (int k = 0; k < 100; ++k) {
    auto state = moving.front();
    state.time = moving.front().time - 0.2;
    state.speed = 0.0;
    state.heading = 2.0;
    moving.insert(moving.begin(), state);
  }
  auto const way = way_of(*waiting.map, waiting.tracks[0], 0.0, 100.0);
  CHECK(way->route);
  CHECK(way->states.size() == moving.size());
  traffic.tracks[0].states.back().x += 20'000.0;
  traffic.tracks[0].states.back().y += 20'000.0;
  CHECK(support::error_of([&] {
          (void)recorded_scenario<Sim>(traffic, {});
        }).find("track " + std::to_string(traffic.tracks[0].id) + ": free corridor: it is longer than 10 km") == 0);
}

TEST_CASE("the route of a track on lanelets counts lanes side by side once") {
  std::vector<map::Lanelet> lanelets;
  for (auto const& [id, x, y] : {std::tuple{1, 0.0, 0.0}, {2, 0.0, -3.5}, {3, 100.0, 0.0}})
    lanelets.push_back(
        {.id = id, .left = {{x, y + 1.75}, {x + 100, y + 1.75}}, .right = {{x, y - 1.75}, {x + 100, y - 1.75}}});
  lanelets[0].successors = {3};
  lanelets[0].right_neighbor = 2;
  lanelets[1].left_neighbor = 1;
  lanelets[2].predecessors = {1};
  RecordedTraffic traffic = cars();
  auto made = map::build_lanelet_map(lanelets);
  traffic.map = made.map;
  traffic.tracks.resize(1);
  auto& track = traffic.tracks[0];
  track.states.clear();
  for (int k = 0; k <= 150; ++k) track.states.push_back({0.1 * k, 5.0 + k, k > 30 && k < 60 ? -3.5 : 0.0, 0.0, 10.0});
  auto const recorded = recorded_scenario<Sim>(traffic, {.ego = track.id}, [](Track const&) {
    return std::optional<Sim::Behavior>(IdmClassic{.law = {.desired_speed = 10.0}});
  });
  auto const& route = recorded.scenario.agents.at(0).route;
  REQUIRE(route);
  CHECK(route->lanes == std::vector{made.lanes.at(1), made.lanes.at(3)});
  CHECK(route->length == doctest::Approx(200.0).epsilon(0.01));
}

TEST_CASE("a vehicle that does not keep to the lanes gets a way of its own, and is replayed all the same") {
  auto traffic = cars();
  for (auto& state : traffic.tracks[0].states) state.y = 30.0;
  auto const recorded = recorded_scenario<Sim>(traffic);
  CHECK(text_of(recorded.diagnostics).find("track 7: it does not keep to the lanes") != std::string::npos);
  auto world = recorded.make_world();
  for (int k = 0; k < 30; ++k) REQUIRE(world.step(0.2));
  CHECK(world.status(AgentId{7}) == AgentStatus::driving);
  CHECK(world.state(AgentId{7}).y == 30.0);
}

TEST_CASE("a planning problem's ego has its start and goal, and reaches it among the tracks") {
  auto const traffic = parse_common_road(common_road());
  auto const recorded = problem_scenario<Sim>(
      traffic, traffic.problems[0], Mobil{}, [](Track const&) -> std::optional<Sim::Behavior> { return std::nullopt; });
  auto const ego = recorded.scenario.ego;
  CHECK(ego == AgentId{40});
  auto other = traffic.problems[0];
  for (auto const& [wanted, given] : {std::pair{31, 32}, {-5, 0}}) {  // 31 is a track
    other.id = wanted;
    CHECK(problem_scenario<Sim>(traffic, other, Mobil{}, [](Track const&) {
            return std::optional<Sim::Behavior>();
          }).scenario.ego == AgentId(given));
  }
  CHECK(recorded.duration() == doctest::Approx(12.0));
  auto world = recorded.make_world();
  CHECK(world.state(ego).x == doctest::Approx(10.0 - 1.35));
  CHECK(world.size() == 2);
  bool there = false;
  while (world.time() < recorded.duration() && !there) {
    REQUIRE(world.step(0.2));
    there = traffic.problems[0].goals[0].holds(world.situation(ego), world.time());
  }
  CHECK(there);
}

TEST_CASE("windows cover the recording, and each track has one") {
  auto const traffic = cars();
  auto const windows = windows_of(traffic, 4.0, 2.0);
  REQUIRE(windows.size() == 4);
  CHECK(windows[1] == RecordingWindow{2.0, 6.0, std::nullopt});
  CHECK(windows_of(traffic, 4.0, 2.0, 4).empty());
  auto const egos = ego_windows(traffic);
  REQUIRE(egos.size() == 3);
  CHECK(egos[1] == RecordingWindow{2.0, 10.0, 9});
  CHECK(support::error_of([&] { return windows_of(traffic, 0.0, 1.0); }).find("give seconds") != std::string::npos);
  CHECK(support::error_of([&] {
          return recorded_scenario<Sim>(traffic, {.ego = 99});
        }).find("track 99, is not there") != std::string::npos);
  CHECK(support::error_of([] { return recorded_scenario<Sim>(RecordedTraffic{}); }).find("there is no map") !=
        std::string::npos);
}

TEST_CASE("the corpus' scenarios replay to the last state of each track") {
  for (char const* name : {"DEU_Test-1_1_T-1", "ZAM-Ramp-1_1-T-1", "ZAM_Tjunction-1_42_T-1", "ZAM_Tutorial-1_2_T-1"}) {
    auto const file = corpus::find("scenarios/commonroad/" + std::string(name) + ".xml");
    if (!file) return;
    CAPTURE(name);
    auto const traffic = load_common_road(file->string());
    auto const recorded = recorded_scenario<Sim>(traffic);
    CHECK(recorded.diagnostics.empty());
    auto world = recorded.make_world();
    for (int k = 0; k < std::lround(recorded.duration() / traffic.time_step); ++k)
      REQUIRE(world.step(traffic.time_step));
    for (auto const& track : traffic.tracks) {
      if (track.stands) continue;
      auto const id = static_cast<AgentId>(track.id);
      CHECK(world.status(id) == AgentStatus::driving);
      auto const& s = world.state(id);
      auto const is = middle_state({s.time, s.x, s.y, s.heading, s.speed}, reference_shape(track));
      CHECK(is.x == doctest::Approx(track.states.back().x));
      CHECK(is.y == doctest::Approx(track.states.back().y));
    }
  }
}

// --- hostile input ---------------------------------------------------------------------------------------------------

TEST_CASE("1000 damaged files of each kind are an error or a result, never a crash") {
  RandomStream random(17, 0, 0);
  std::string const osm = [] {
    auto const file = corpus::find("scenarios/interaction/TestScenarioForScripts.osm");
    return file ? corpus::read(*file) : std::string("<osm><node id='1' lat='0' lon='0'/></osm>");
  }();
  int errors = 0, results = 0;
  auto const attempt = [&](auto const& read) {
    try {
      read();
      ++results;
    } catch (Error const&) {
      ++errors;
    }
  };
  auto const damaged = [&](std::string text) {
    if (xml_damage::any_of(4, random) == 0) text.resize(xml_damage::any_of(text.size(), random));
    for (std::size_t k = xml_damage::any_of(4, random) + 1; k > 0 && !text.empty(); --k)
      text[xml_damage::any_of(text.size(), random)] = "0129.,-e<>\"'/ x\n"[xml_damage::any_of(16, random)];
    return text;
  };
  auto const damaged_xml = [&](std::string const& text) {
    pugi::xml_document xml;
    xml.load_string(text.c_str());
    for (int k = 0; k < 3; ++k) xml_damage::damage_once(xml, random);
    return xml_damage::text_of(xml);
  };
  auto const own = common_road();
  std::vector<Diagnostic> unheard;
  for (int k = 0; k < 1000; ++k) {
    CAPTURE(k);
    auto const rows = damaged(table);
    attempt([&] { (void)read_tracks(rows); });
    auto const text = k % 2 == 0 ? damaged(own) : damaged_xml(own);
    attempt([&] {
      auto const traffic = parse_common_road(text);
      (void)common_road_text(traffic);
      if (traffic.map) (void)recorded_scenario<Sim>(traffic);
    });
    auto const map = k % 2 == 0 ? damaged(osm) : damaged_xml(osm);
    attempt([&] { (void)map::build_lanelet_map(map::read_lanelet2(map, {}, "map", unheard)); });
  }
  CHECK(errors > 500);
  CHECK(results > 500);
}
