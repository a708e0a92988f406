// What a CommonRoad file says in other words than usual: it is read as meant, or a finding names it.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "cambium/scenario/dataset/common_road.hpp"
#include "cambium/scenario/dataset/common_road_writer.hpp"

#include "../support/error_of.hpp"

using namespace cambium;
using map::LightColor;

namespace {

std::string bound(std::string const& name, double from, double to, double y, std::string const& marking = "") {
  std::string text = "<" + name + ">";
  for (double const x : {from, to})
    text += "<point><x>" + std::to_string(x) + "</x><y>" + std::to_string(y) + "</y></point>";
  if (!marking.empty()) text += "<lineMarking>" + marking + "</lineMarking>";
  return text + "</" + name + ">";
}

std::string lanelet(int id, double y, std::string const& rest = "", double from = 0.0) {
  return "<lanelet id='" + std::to_string(id) + "'>" + bound("leftBound", from, from + 50.0, y) +
         bound("rightBound", from, from + 50.0, y - 3.5) + rest + "</lanelet>\n";
}

RecordedTraffic read(std::string const& body) {
  return parse_common_road("<commonRoad benchmarkID='DEU_A-1_1_T-1' commonRoadVersion='2020a' timeStepSize='0.1'>\n" +
                           body + "</commonRoad>");
}

std::string text_of(std::vector<Diagnostic> const& diagnostics) {
  std::string text;
  for (auto const& found : diagnostics) text += to_string(found) + "\n";
  return text;
}

bool has(RecordedTraffic const& traffic, std::string const& words) {
  return text_of(traffic.diagnostics).find(words) != std::string::npos;
}

std::string cycle(std::vector<std::pair<int, std::string>> const& phases, std::string const& more = "") {
  std::string text = "<cycle>";
  for (auto const& [duration, color] : phases)
    text += "<cycleElement><duration>" + std::to_string(duration) + "</duration><color>" + color +
            "</color></cycleElement>";
  return text + more + "</cycle>";
}

std::string light(int id, std::string const& rest) {
  return "<trafficLight id='" + std::to_string(id) + "'>" + rest + "</trafficLight>\n";
}

std::string ref(int id) { return "<trafficLightRef ref='" + std::to_string(id) + "'/>"; }

/// A lanelet before a junction with one way straight on and one to the left, and lights for each; far from the origin.
std::string fork(std::string const& intersection) {
  std::string const curve =
      "<leftBound><point><x>50</x><y>500</y></point><point><x>55</x><y>501</y></point><point><x>60</x><y>530</y></"
      "point>"
      "</leftBound><rightBound><point><x>50</x><y>496.5</y></point><point><x>58</x><y>499</y></point><point><x>64</x>"
      "<y>530</y></point></rightBound>";
  return lanelet(1, 500, "<successor ref='2'/><successor ref='3'/>" + ref(61) + ref(62)) +
         lanelet(2, 500, "<predecessor ref='1'/>", 50.0) + "<lanelet id='3'>" + curve +
         "<predecessor ref='1'/></lanelet>" +
         light(61, cycle({{100, "red"}, {100, "green"}}) + "<direction>left</direction>") +
         light(62, cycle({{100, "green"}, {100, "red"}}) + "<direction>straight</direction>") + intersection;
}

}  // namespace

TEST_CASE("a light for one direction hangs over the ways that turn so") {
  auto const intersection = [](std::string const& left, std::string const& straight) {
    return "<intersection id='9'><incoming id='10'><incomingLanelet ref='1'/><successorsLeft ref='" + left +
           "'/><successorsStraight ref='" + straight + "'/></incoming></intersection>";
  };
  auto const lights = [](RecordedTraffic const& traffic, std::size_t i) {
    std::string text;
    for (auto const& signal : traffic.lanelets.at(i).signals) text += signal.light + " ";
    return text;
  };
  auto const named = read(fork(intersection("3", "2")));
  CHECK_MESSAGE(named.diagnostics.empty(), text_of(named.diagnostics));
  CHECK(lights(named, 0).empty());
  CHECK(lights(named, 1) == "62 ");
  CHECK(lights(named, 2) == "61 ");
  CHECK(named.lanelets[1].signals[0].before_end == doctest::Approx(50.0));
  auto const exchanged = read(fork(intersection("2", "3")));  // the file's word counts, not the bounds
  CHECK(lights(exchanged, 1) == "61 ");
  auto const by_bounds = read(fork(""));
  CHECK(lights(by_bounds, 1) == "62 ");
  CHECK(has(by_bounds, "for light 61 their bounds count"));
  auto const nowhere =
      read(lanelet(1, 0, ref(61)) + light(61, cycle({{10, "red"}, {10, "green"}}) + "<direction>left</direction>"));
  CHECK(lights(nowhere, 0) == "61 ");
  CHECK(has(nowhere, "no way behind lanelet 1 has the direction of light 61"));
  CHECK(has(read(lanelet(1, 0, ref(61)) + light(61, cycle({{10, "red"}, {10, "green"}}) + "<direction>up</direction>")),
            "\"up\" is no direction"));
}

TEST_CASE("a light shows what its cycle says at each time") {
  auto const same = [](std::vector<std::pair<int, std::string>> const& phases, std::string const& more = "") {
    auto const traffic = read(lanelet(1, 0, ref(8)) + light(8, cycle(phases, more)));
    REQUIRE(traffic.lights.size() == 1);
    CHECK_MESSAGE(traffic.diagnostics.empty(), text_of(traffic.diagnostics));
    int total = 0;
    for (auto const& [duration, color] : phases) total += duration;
    int step = 0;
    for (auto const& [duration, color] : phases)
      for (int k = 0; k < duration; ++k, ++step) {
        auto const shown = traffic.lights[0].at(0.1 * (step + total) + 0.05);
        CHECK(shown == (color == "green"    ? LightColor::green
                        : color == "yellow" ? LightColor::yellow
                                            : LightColor::red));
      }
  };
  same({{100, "red"}});
  same({{100, "green"}});
  same({{30, "yellow"}, {200, "red"}, {100, "green"}});
  same({{100, "green"}, {30, "yellow"}, {100, "red"}, {50, "green"}});
  same({{50, "red"}, {5, "redYellow"}, {40, "green"}, {10, "yellow"}});
  same({{10, "yellow"}, {30, "red"}});
  same({{10, "red"}, {5, "redYellow"}, {20, "red"}, {30, "green"}, {20, "green"}});
}

TEST_CASE("a light whose cycle is odd is a finding") {
  auto const found = [](std::string const& rest, std::string const& words) {
    auto const traffic = read(lanelet(1, 0, ref(8)) + light(8, rest));
    CHECK_MESSAGE(has(traffic, words), words, "\n", text_of(traffic.diagnostics));
  };
  found(cycle({{100, "purple"}, {10, "green"}}), "\"purple\" is no colour");
  found(cycle({{-5, "green"}, {10, "red"}}), "its duration -5 is not above 0");
  found(cycle({{0, "green"}, {10, "red"}}), "its duration 0 is not above 0");
  found(cycle({}), "neither green nor red; the light is off");
  found(cycle({{10, "yellow"}}), "neither green nor red; the light is off");
  found(cycle({{10, "inactive"}, {10, "green"}}), "inactive phases count as red");
  found(cycle({{10, "green"}, {10, "yellow"}, {10, "green"}, {10, "red"}}), "a second green phase was left out");
  found(cycle({{10, "green"}, {10, "red"}}, "<timeOffset>soon</timeOffset>"), "\"soon\" is no usable number");
  found("<active>true</active>", "it has no <cycle>; the light is off");
  found(cycle({{10, "green"}}) + "<active>maybe</active>", "neither true nor false");
}

TEST_CASE("lanes are changed where the near line of their marking is dashed") {
  struct Case {
    char const* word;
    bool from_left, from_right, known;
  };
  for (auto const& [word, from_left, from_right, known] :
       {Case{"solid_solid", false, false, true}, Case{"lowered_curb", false, false, true},
        Case{"curb", false, false, true}, Case{"solid_dashed", false, true, true},
        Case{"dashed_solid", true, false, true}, Case{"dashed_dashed", true, true, true},
        Case{"broad_solid", false, false, true}, Case{"no_marking", true, true, true},
        Case{"nonsense", true, true, false}}) {
    std::string const marking = word;  // clang 14 captures no structured bindings
    CAPTURE(marking);
    auto const traffic = read(
        "<lanelet id='1'>" + bound("leftBound", 0, 50, 0) + bound("rightBound", 0, 50, -3.5, word) +
        "<adjacentRight ref='2' drivingDir='same'/></lanelet><lanelet id='2'>" + bound("leftBound", 0, 50, -3.5, word) +
        bound("rightBound", 0, 50, -7) + "<adjacentLeft ref='1' drivingDir='same'/></lanelet>");
    CHECK(traffic.lanelets.at(0).may_change_right == from_left);
    CHECK(traffic.lanelets.at(1).may_change_left == from_right);
    CHECK(traffic.diagnostics.empty() == known);
  }
}

TEST_CASE("lanelets for others than vehicles are no driving lanes") {
  using map::LaneType;
  auto const type = [](std::string const& rest) { return read(lanelet(1, 0, rest)).lanelets.at(0).type; };
  auto const named = [&](std::string const& word) { return type("<laneletType>" + word + "</laneletType>"); };
  CHECK(named("parking") == LaneType::parking);
  CHECK(named("border") == LaneType::border);
  CHECK(named("railway") == LaneType::rail);
  CHECK(named("restricted_area") == LaneType::restricted);
  CHECK(named("urban") == LaneType::driving);
  CHECK(type("<userOneWay>bicycle</userOneWay>") == LaneType::biking);
  CHECK(type("<userOneWay>pedestrian</userOneWay>") == LaneType::walking);
  CHECK(type("<userOneWay>pedestrian</userOneWay><userBidirectional>bicycle</userBidirectional>") == LaneType::shared);
  CHECK(type("<userOneWay>bus</userOneWay>") == LaneType::bus);
  CHECK(type("<userOneWay>vehicle</userOneWay><userOneWay>bicycle</userOneWay>") == LaneType::driving);
  CHECK(type("<userOneWay>vehicle</userOneWay><userBidirectional>bus</userBidirectional>") == LaneType::driving);
  CHECK(has(read(lanelet(1, 0, "<laneletType>nonsense</laneletType>")), "the type \"nonsense\" is not known"));
  CHECK(type("<userOneWay>bus</userOneWay><userOneWay>taxi</userOneWay>") == LaneType::bus);
  CHECK(type("<userOneWay>bicycle</userOneWay><userOneWay>taxi</userOneWay>") == LaneType::taxi);
  CHECK(type("<userOneWay>priorityVehicle</userOneWay>") == LaneType::restricted);
  CHECK(type("<userOneWay>motorcycle</userOneWay>") == LaneType::driving);
  CHECK(has(read(lanelet(1, 0, "<userOneWay>cra</userOneWay>")), "the user \"cra\" is not known"));
}

TEST_CASE("what is not read is a finding, once") {
  auto const state = [](std::string const& more) {
    return "<position><point><x>10</x><y>-1</y></point></position><orientation><exact>0</exact></orientation>"
           "<time><exact>0</exact></time><velocity><exact>0</exact></velocity>" +
           more;
  };
  auto const traffic = read(
      lanelet(1, 0, "<sucessor ref='2'/><adjacentLeft ref='2' drivingDir='opposite'/>") +
      lanelet(2, 3.5,
              "<adjacentRight ref='1' drivingDir='oposite'/><stopLine><lineMarking>solid</lineMarking>"
              "</stopLine><trafficSignRef ref='5'/>") +
      lanelet(3, -10, "<stopLine><lineMarking>solid</lineMarking></stopLine>") +
      "<trafficSign id='5'><trafficSignElement><trafficSignID>310</trafficSignID></trafficSignElement></trafficSign>"
      "<intersection id='9'><incoming id='10'><incomingLanelet ref='1'/><successorsLeft ref='77'/><isLeftOf ref='11'"
      "/></incoming><crossing><crossingLanelet ref='3'/></crossing></intersection>"
      "<staticObstacle id='12'><type>roadBoundary</type><shape><rectangle><length>4</length><width>2</width>"
      "</rectangle></shape><initialState>" +
      state("<yawRate><exact>0</exact></yawRate>") + "</initialState><initialSignalState/></staticObstacle>");
  for (char const* words :
       {"elements <sucessor> of lanelets are not read", "neighbours that are driven the other way are not read",
        "its drivingDir \"oposite\" is neither same nor opposite", "stop lines without a sign or light have no effect",
        "signs of the number 310 have no effect", "who comes from the left of whom is read from the geometry",
        "the crossings of intersections are not read", "the way through it, lanelet 77, is not there",
        "obstacles of the type \"roadBoundary\" count as others", "elements <yawRate> of states are not read",
        "elements <initialSignalState> of obstacles are not read"})
    CHECK_MESSAGE(has(traffic, words), words, "\n", text_of(traffic.diagnostics));
}

TEST_CASE("occupancies lie in the map's frame, and only rectangles say where they head") {
  auto const rectangle = [](double x, double y, double turn) {
    return "<rectangle><length>4</length><width>2</width><orientation>" + std::to_string(turn) +
           "</orientation><center><x>" + std::to_string(x) + "</x><y>" + std::to_string(y) +
           "</y></center></rectangle>";
  };
  auto const occupancy = [](int step, std::string const& shape) {
    return "<occupancy><shape>" + shape + "</shape><time><exact>" + std::to_string(step) +
           "</exact></time></occupancy>";
  };
  auto const obstacle = [](std::string const& shape, std::string const& set) {
    return read(lanelet(1, 0) + "<dynamicObstacle id='12'><type>car</type><shape>" + shape +
                "</shape><initialState><position><point><x>0</x><y>-1</y></point></position><orientation><exact>0.1"
                "</exact></orientation><time><exact>0</exact></time><velocity><exact>10</exact></velocity>"
                "</initialState><occupancySet>" +
                set + "</occupancySet></dynamicObstacle>")
        .track(12)
        .states;
  };
  auto const turned =
      obstacle(rectangle(1.5, 0, 0), occupancy(1, rectangle(2.5, -0.9, 0)) + occupancy(2, rectangle(3.5, -0.9, 0.2)));
  REQUIRE(turned.size() == 3);
  CHECK(turned[0].x == doctest::Approx(1.5 * std::cos(0.1)));
  CHECK(turned[1].x == doctest::Approx(2.5));
  CHECK(turned[1].heading == 0.0);
  CHECK(turned[2].x == doctest::Approx(3.5));
  CHECK(turned[2].heading == doctest::Approx(0.2));
  CHECK(turned[2].speed == doctest::Approx(10.0));
  std::string const circle = "<circle><radius>1</radius><center><x>0</x><y>0</y></center></circle>";
  auto const round = obstacle("<circle><radius>1</radius></circle>", occupancy(1, circle));
  REQUIRE(round.size() == 2);
  CHECK(round[1].heading == doctest::Approx(0.5 * geometry::pi));
}

TEST_CASE("values that cannot be meant, links given once and ids given twice are findings") {
  auto const sign = [](std::string const& value) {
    return lanelet(1, 0, "<trafficSignRef ref='5'/>") +
           "<trafficSign id='5'><trafficSignElement><trafficSignID>274</trafficSignID><additionalValue>" + value +
           "</additionalValue></trafficSignElement></trafficSign>";
  };
  CHECK(has(read(sign("-3")), "its limit -3 m/s is not between 0.1 and 200"));
  CHECK(has(read(sign("13.9") + "<trafficSign id='6'/>" + light(7, cycle({{10, "red"}}))),
            "<trafficSign>: no lanelet refers to it"));
  CHECK(has(read(lanelet(1, 0) + light(7, cycle({{10, "red"}}))), "<trafficLight>: no lanelet refers to it"));
  CHECK(
      has(read(lanelet(1, 0, ref(8)) + light(8, cycle({{10, "red"}}) + "<active>false</active>")), "the light is off"));
  CHECK(has(
      read(lanelet(1, 0, "<stopLine><point><x>900</x><y>0</y></point><point><x>900</x><y>3</y></point></stopLine>")),
      "it lies 850 m from the end of lanelet 1, where it counts"));
  std::string const problem =
      "<planningProblem "
      "id='60'><initialState><position><point><x>1</x><y>-1</y></point></position><orientation><exact>0"
      "</exact></orientation><time><exact>0</exact></time><velocity><exact>5</exact></velocity></"
      "initialState><goalState>"
      "<time><intervalStart>10</intervalStart><intervalEnd>20</intervalEnd></time></goalState></planningProblem>";
  CHECK(has(read(lanelet(1, 0) + problem + problem), "planning problem 60 is there already"));
  CHECK(has(read(sign("250")), "its limit 250 m/s is not between 0.1 and 200"));
  CHECK(has(read(sign("500")), "its limit 500 m/s is not between 0.1 and 200"));
  for (std::string const word : {"-4", "abc"})
    CHECK(has(read(lanelet(1, 0, "<speedLimit>" + word + "</speedLimit>")), "\"" + word + "\" is no speed"));
  CHECK(has(read(lanelet(1, 0, "<stopLine><point><x>40</x><y>0</y></point></stopLine>")), "it has 1 points, not two"));
  CHECK(read(lanelet(1, 0, ref(8)) + light(8, cycle({{10, "red"}}) + "<active>0</active>")).lights.at(0) ==
        map::LightPlan{});

  auto const links = read(lanelet(1, 0, "<successor ref='2'/>") + lanelet(2, 0, "", 50.0) +
                          lanelet(3, 0, "<predecessor ref='2'/>", 100.0) +
                          lanelet(4, -3.5, "<adjacentLeft ref='1' drivingDir='same'/>"));
  CHECK(has(links, "info: <lanelet> of lanelet 1: it names lanelet 2 as its successor, which does not name it"));
  CHECK(has(links, "lanelet 3: it names lanelet 2 as its predecessor, which does not name it as its successor"));
  CHECK(has(links, "lanelet 4: it names lanelet 1 as its left neighbour, which does not name it as its right one"));
  CHECK(has(links, "lanelet 4: it ends beside lanelet 1, and was merged into that one"));
  CHECK(links.diagnostics.size() == 4);

  auto const red = cycle({{10, "red"}});
  auto const twice = read(lanelet(1, 0) + lanelet(1, -20) + light(8, red) + light(8, red));
  CHECK(has(twice, "lanelet 1 is there already"));
  CHECK(has(twice, "id 8 is taken already"));
  CHECK(twice.lanelets.size() == 1);
}

TEST_CASE("the first of several shapes is an obstacle's, and those that move keep their outline") {
  std::string const polygon =
                        "<polygon><point><x>0</x><y>0</y></point><point><x>10</x><y>10</y></point><point><x>10</x>"
                        "<y>10.5</y></point><point><x>0</x><y>0.5</y></point></polygon>",
                    rectangle = "<rectangle><length>4</length><width>2</width></rectangle>";
  auto const obstacle = [&](std::string const& kind, std::string const& shape) {
    return read(lanelet(1, 0) + "<" + kind + " id='12'><type>car</type><shape>" + shape +
                "</shape><initialState><position><point><x>10</x><y>-1</y></point></position><orientation><exact>0"
                "</exact></orientation><time><exact>0</exact></time><velocity><exact>0</exact></velocity>"
                "</initialState></" +
                kind + ">");
  };
  auto const wall = obstacle("staticObstacle", polygon + rectangle);
  CHECK(wall.track(12).outline.size() == 4);
  CHECK(has(wall, "it has several shapes; the first one, a polygon, was taken"));
  CHECK(obstacle("staticObstacle", rectangle + polygon).track(12).outline.empty());
  auto const moving = obstacle("dynamicObstacle", polygon);
  CHECK(moving.track(12).outline.size() == 4);
  CHECK(has(moving, "obstacle 12 drives as the rectangle around it"));
  CHECK(parse_common_road(common_road_text(moving)).tracks == moving.tracks);
}

TEST_CASE("outlines of any numbers are read as they were written") {
  int same = 0;
  for (int k = 0; k < 100; ++k) {
    std::string shape = "<polygon>";
    for (int i = 0; i < 3; ++i)
      shape += "<point><x>" + std::to_string(3.0 * std::cos(2.1 * i + k)) + "</x><y>" +
               std::to_string(7.0 * std::sin(2.1 * i + k) + 0.1 * k) + "</y></point>";
    auto const traffic = read(lanelet(1, 0) + "<dynamicObstacle id='12'><type>car</type><shape>" + shape +
                              "</polygon></shape><initialState><position><point><x>10</x><y>-1</y></point></position>"
                              "<orientation><exact>0.3</exact></orientation><time><exact>0</exact></time><velocity>"
                              "<exact>0</exact></velocity></initialState></dynamicObstacle>");
    REQUIRE(traffic.track(12).outline.size() == 3);
    same += parse_common_road(common_road_text(traffic)).tracks == traffic.tracks;
  }
  CHECK(same == 100);
}

TEST_CASE("a goal whose time ends before it begins is left out") {
  auto const traffic = read(
      lanelet(1, 0) +
      "<planningProblem id='50'><initialState><position><point><x>1</x><y>-1</y></point></position><orientation><exact>"
      "0</exact></orientation><time><exact>0</exact></time><velocity><exact>5</exact></velocity></initialState>"
      "<goalState><time><intervalStart>20</intervalStart><intervalEnd>10</intervalEnd></time></goalState>"
      "</planningProblem>");
  CHECK(traffic.problems.at(0).goals.empty());
  CHECK(has(traffic, "its time ends before it begins; the goal was left out"));
}

TEST_CASE("lanelets of all types that have words are written as they are read") {
  using map::LaneType;
  for (auto const type : {LaneType::driving, LaneType::shoulder, LaneType::sidewalk, LaneType::bus, LaneType::biking,
                          LaneType::on_ramp, LaneType::off_ramp, LaneType::walking, LaneType::parking, LaneType::border,
                          LaneType::restricted, LaneType::rail, LaneType::taxi, LaneType::shared})
    for (bool const inside : {false, true})
      for (bool const both : {false, true}) {
        auto traffic = read(lanelet(1, 0));
        traffic.lanelets[0].type = type;
        traffic.lanelets[0].in_junction = inside;
        traffic.lanelets[0].both_directions = both;
        auto const text = common_road_text(traffic);
        CAPTURE(text);
        CHECK(parse_common_road(text).lanelets == traffic.lanelets);
      }
}

TEST_CASE("what CommonRoad cannot say is an error of the writer") {
  auto const error = [](auto const& change) {
    auto traffic = read(lanelet(1, 0) + lanelet(2, -20));
    traffic.problems.push_back({.id = 100, .initial = {0.0, 1.0, -1.0, 0.0, 5.0}, .goals = {GoalState{}}});
    auto& goal = traffic.problems[0].goals[0];
    std::tie(goal.first_time, goal.last_time) = std::pair(1.0, 4.0);
    change(traffic, goal);
    return support::error_of([&] { return common_road_text(traffic); });
  };
  auto const fails = [&](auto const& change, std::string const& words) {
    auto const text = error(change);
    CHECK_MESSAGE(text.find(words) != std::string::npos, words, "\n", text);
  };
  fails(
      [](RecordedTraffic& traffic, GoalState&) {
        traffic.lanelets[0].signals = {{map::SignalKind::stop, 0.0, {}}, {map::SignalKind::light, 20.0, "7"}};
      },
      "lanelet 1: its signals are at several places");
  fails([](RecordedTraffic& traffic, GoalState&) { traffic.lanelets[1].goes_before = {1}; },
        "lanelet 2: CommonRoad cannot say which lanelets it goes before");
  fails([](RecordedTraffic& traffic, GoalState&) { traffic.lanelets[1].id = 1; },
        "lanelet 1: there is another one of that id");
  fails([](RecordedTraffic& traffic, GoalState&) { traffic.lanelets[1].type = map::LaneType::median; },
        "lanelet 2: CommonRoad has no word for its type, \"median\"");
  fails([](RecordedTraffic&, GoalState& goal) { goal.last_time = std::numeric_limits<double>::infinity(); },
        "planning problem 100: a goal has no first or no last time");
  CHECK(error([](RecordedTraffic& traffic, GoalState& goal) {
          goal.limits.lowest_speed = 2000.0;
          auto const limits = parse_common_road(common_road_text(traffic)).problems.at(0).goals.at(0).limits;
          CHECK(limits.lowest_speed == 2000.0);
          CHECK(limits.highest_speed == 3000.0);
        }) == "no error");
}
