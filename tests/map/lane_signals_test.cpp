// Which lanes OpenDRIVE's signs and lights count for, and joints of roads that the file links in part.
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "cambium/map/lanes/signal_codes.hpp"
#include "cambium/map/opendrive.hpp"

namespace {

using cambium::LoadedMap;
using cambium::map::Arrow;
using cambium::map::SignalMeaning;

std::string lane(std::string const& link = "<predecessor id=\"-1\"/><successor id=\"-1\"/>") {
  return "<center><lane id=\"0\" type=\"none\"/></center><right><lane id=\"-1\" type=\"driving\"><link>" + link +
         "</link><width sOffset=\"0\" a=\"3.5\" b=\"0\" c=\"0\" d=\"0\"/></lane></right>";
}

struct RoadText {
  std::string id{}, junction = "-1", link{}, geometry = "x=\"0\" y=\"0\" hdg=\"0\" length=\"100\"><line/>",
                    length = "100", sections = "<laneSection s=\"0\">" + lane() + "</laneSection>", signals{};

  [[nodiscard]] std::string text() const {
    return "<road id=\"" + id + "\" length=\"" + length + "\" junction=\"" + junction + "\"><link>" + link +
           "</link><planView><geometry s=\"0\" " + geometry + "</geometry></planView><lanes><laneOffset s=\"0\" " +
           "a=\"1.75\" b=\"0\" c=\"0\" d=\"0\"/>" + sections + "</lanes><signals>" + signals + "</signals></road>";
  }
};

std::string end(std::string const& which, std::string const& road, std::string const& contact) {
  return "<" + which + " elementType=\"road\" elementId=\"" + road + "\" contactPoint=\"" + contact + "\"/>";
}

std::string signal(std::string const& id, double s, std::string const& type, std::string const& subtype,
                   double t = -4.0) {
  return "<signal id=\"" + id + "\" name=\"\" s=\"" + std::to_string(s) + "\" t=\"" + std::to_string(t) +
         "\" dynamic=\"yes\" orientation=\"+\" zOffset=\"3\" country=\"OpenDRIVE\" type=\"" + type + "\" subtype=\"" +
         subtype + "\" value=\"-1\"/>";
}

LoadedMap load(std::string const& body) {
  return cambium::parse_opendrive("<OpenDRIVE><header revMajor=\"1\" revMinor=\"6\"/>" + body + "</OpenDRIVE>");
}

/// A lane of two sections of 60 and 40 m, behind which one drives straight on (road 11) or turns left (12).
LoadedMap fork(std::string const& signals, std::string const& controllers = "") {
  RoadText in{.id = "1", .link = "<successor elementType=\"junction\" elementId=\"5\"/>"};
  in.sections += "<laneSection s=\"60\">" + lane() + "</laneSection>";
  in.signals = signals;
  auto const link = end("predecessor", "1", "end");
  RoadText const ahead{.id = "11",
                       .junction = "5",
                       .link = link,
                       .geometry = "x=\"100\" y=\"0\" hdg=\"0\" length=\"30\"><line/>",
                       .length = "30"};
  RoadText const left{.id = "12",
                      .junction = "5",
                      .link = link,
                      .geometry = "x=\"100\" y=\"0\" hdg=\"0\" length=\"30\"><arc curvature=\"0.05\"/>",
                      .length = "30"};
  std::string junction = "<junction id=\"5\" name=\"\">";
  for (auto const* road : {"11", "12"})
    junction += "<connection id=\"" + std::string(road) + "\" incomingRoad=\"1\" connectingRoad=\"" + road +
                "\" contactPoint=\"start\"><laneLink from=\"-1\" to=\"-1\"/></connection>";
  return load(in.text() + ahead.text() + left.text() + junction + "</junction>" + controllers);
}

/// The names of the lights of a road's lanes.
std::multiset<std::string> lights(LoadedMap const& loaded, std::string const& road) {
  std::multiset<std::string> names;
  for (auto const& one : loaded.map->lanes())
    if (loaded.map->road(one.road).name == road)
      for (auto const& of : one.signals) names.insert(loaded.map->lights()[cambium::index_of(of.light)].name);
  return names;
}

std::size_t count(LoadedMap const& loaded, std::string const& words) {
  std::size_t found = 0;
  for (auto const& d : loaded.diagnostics) found += d.sentence.find(words) != std::string::npos ? 1 : 0;
  return found;
}

using Names = std::multiset<std::string>;

TEST_CASE("an arrow light binds the ways that turn so behind the next fork, and nobody else") {
  auto const both = fork(signal("a", 30.0, "1.000.011", "10") + signal("b", 95.0, "1000011", "30"));
  CHECK(lights(both, "1").empty());
  CHECK(lights(both, "11") == Names{"signal b"});
  CHECK(lights(both, "12") == Names{"signal a"});
  auto const all = fork(signal("a", 95.0, "1000011", "40"));
  CHECK(lights(all, "1") == Names{"signal a"});
  auto const none = fork(signal("a", 95.0, "1000011", "20"));
  CHECK(lights(none, "1").empty());
  CHECK(none.map->lights().empty());
  CHECK(count(none, "no way behind lane -1 turns as its arrow says") == 1);
}

TEST_CASE("bulbs of one arrow within half a metre are one light") {
  auto const heads = fork(signal("a", 98.49, "1000020", "10") + signal("b", 98.51, "1000012", "10", -4.1) +
                          signal("c", 98.5, "1000020", "30") + signal("d", 98.5, "1000012", "30") +
                          signal("e", 97.5, "1000012", "30"));
  CHECK(heads.map->lights().size() == 3);
  CHECK(lights(heads, "12") == Names{"signal a"});
  CHECK(lights(heads, "11") == Names{"signal c", "signal e"});
}

TEST_CASE("lights of a controller are one; a second controller and a missing signal are findings") {
  auto const signals = signal("a", 98, "1000001", "-1") + signal("b", 97, "1000001", "-1");
  auto const made = fork(signals,
                         "<controller id=\"7\"><control signalId=\"a\"/><control signalId=\"b\"/></controller>"
                         "<controller id=\"8\"><control signalId=\"b\"/><control signalId=\"z\"/></controller>");
  CHECK(lights(made, "1") == Names{"7", "7"});
  CHECK(made.map->lights().size() == 1);
  CHECK(count(made, "controller 7 controls signal b, too") == 1);
  CHECK(count(made, "signal z is not there") == 1);
}

TEST_CASE("impossible limits, priorities of nobody and signals of one id are findings") {
  RoadText road{.id = "1",
                .signals = signal("a", 50, "206", "-1") + signal("a", 60, "205", "-1") +
                           "<signalReference id=\"a\" s=\"70\" t=\"0\" orientation=\"+\"/>"};
  auto const limit = [](std::string const& speed) {
    return "<lane id=\"-1\" type=\"driving\"><width sOffset=\"0\" a=\"3.5\" b=\"0\" c=\"0\" d=\"0\"/><speed "
           "sOffset=\"0\" max=\"" +
           speed + "\"/></lane>";
  };
  std::string const begin = "<laneSection s=\"0\"><center><lane id=\"0\" type=\"none\"/></center><right>",
                    end = "</right></laneSection>";
  for (std::string const speed : {"0", "1e308", "0.01"}) {
    road.sections = begin + limit(speed) + end;
    auto const made = load(road.text() +
                           "<junction id=\"5\" name=\"\"><connection id=\"0\" incomingRoad=\"1\" connectingRoad=\"1\" "
                           "contactPoint=\"start\"/><priority high=\"1\" low=\"77\"/></junction>");
    CHECK(count(made, "1 speed limits are not between 0.1 and 200 m/s and count as none; the first: road 1") == 1);
    CHECK(made.map->lanes()[0].speed_limits.empty());
    CHECK(count(made, "road 77 of a priority is not there") == 1);
    CHECK(count(made, "references to an id of several signals mean the first one") == 1);
  }
  road.sections = begin + limit("no limit") + end;
  CHECK(count(load(road.text()), "speed limits are not") == 0);
}

TEST_CASE("lights of one id on two roads are two lights") {
  RoadText one{.id = "1", .signals = signal("0", 90, "1000001", "-1")},
      two{.id = "2", .geometry = "x=\"0\" y=\"50\" hdg=\"0\" length=\"100\"><line/>", .signals = one.signals};
  auto const made = load(one.text() + two.text());
  CHECK(made.map->lights().size() == 2);
  CHECK(lights(made, "1") == Names{"signal 0 of road 1 at 90 m"});
  CHECK(lights(made, "2") == Names{"signal 0 of road 2 at 90 m"});
  one.signals = signal("0", 30, "1000001", "-1") + signal("0", 90, "1000001", "-1");
  CHECK(load(one.text()).map->lights().size() == 2);
  one.signals = two.signals;
  auto const controlled = load(one.text() + two.text() + "<controller id=\"7\"><control signalId=\"0\"/></controller>");
  CHECK(controlled.map->lights().size() == 1);
  CHECK(count(controlled, "controls of an id of several signals mean all of them (2 of them)") == 1);
}

TEST_CASE("codes are found in the spellings of files") {
  auto const meaning = [](char const* country, char const* type, char const* subtype = "") {
    auto const sense = cambium::map::find_signal(country, type, subtype);
    return sense ? std::optional(sense->meaning) : std::nullopt;
  };
  CHECK(meaning("DEU", "274-55") == SignalMeaning::speed_limit);
  CHECK(meaning("Germany", "206", "-1") == SignalMeaning::stop);
  for (auto const* country : {"US", "usa", "United States", "PRI"}) CHECK(meaning(country, "R1-1"));
  CHECK(meaning("AUS", "R1-2") == SignalMeaning::give_way);
  CHECK(meaning("ESP", "r2") == SignalMeaning::stop);
  CHECK(meaning("SE", "C", "31") == SignalMeaning::speed_limit);
  CHECK(meaning("FRA", "B14") == SignalMeaning::speed_limit);
  CHECK(meaning("GRC", "\xCE\xA1-32") == SignalMeaning::speed_limit);
  CHECK_FALSE(meaning("DE", "R1-1"));
  CHECK_FALSE(meaning("", "-1"));
  std::map<std::string, Arrow> const arrows{{"10", Arrow::left},
                                            {"60", Arrow::left},
                                            {"80", Arrow::left},
                                            {"20", Arrow::right},
                                            {"70", Arrow::right},
                                            {"90", Arrow::right},
                                            {"30", Arrow::straight},
                                            {"", Arrow::none},
                                            {"40", Arrow::straight | Arrow::left},
                                            {"50", Arrow::straight | Arrow::right},
                                            {"100", Arrow::left | Arrow::right}};
  for (auto const* type : {"1000008", "1000010", "1000011", "1000012", "1000020"})
    for (auto const& [subtype, arrow] : arrows) CHECK(cambium::map::find_signal("", type, subtype)->arrow == arrow);
  CHECK(cambium::map::find_signal("", "1.000.011-10", "-1")->arrow == Arrow::left);
  CHECK(cambium::map::find_signal("", "1000001", "10")->arrow == Arrow::none);
}

TEST_CASE("a sign between two sections counts once, and one that has no effect is a finding") {
  auto const sign = fork(signal("a", 60.0, "206", "-1") + signal("b", 59.8, "205", "-1"));
  using cambium::map::SignalKind;
  std::multiset<SignalKind> kinds;
  for (auto const& one : sign.map->lanes())
    for (auto const& of : one.signals) kinds.insert(of.kind);
  CHECK(kinds == std::multiset<SignalKind>{SignalKind::give_way, SignalKind::stop});
  auto const behind = fork(signal("a", 100.2, "206", "-1"));
  CHECK(std::any_of(behind.map->lanes().begin(), behind.map->lanes().end(),
                    [](auto const& one) { return !one.signals.empty(); }));
  auto const idle = fork(signal("a", 50.0, "1000002", "-1") + signal("b", 50.0, "1000002", "") +
                         signal("c", 50.0, "-1", "") + signal("d", 50.0, "", ""));
  CHECK(count(idle,
              "signals of type 1000002 of country \"OpenDRIVE\" have no effect: only signs of priority and lights for "
              "vehicles have "
              "(2 of them)") == 1);
  CHECK(count(idle, "signals without a type have no effect (2 of them)") == 1);
}

TEST_CASE("lanes of linked roads that meet are joined without links of their own, whatever the turn") {
  for (double const turn : {0.1, 0.3, 0.6, 1.5}) {
    CAPTURE(turn);
    auto const heading = std::to_string(turn);
    auto const pair = [&](std::string const& link, std::string const& back) {
      RoadText const a{.id = "1", .link = link, .sections = "<laneSection s=\"0\">" + lane("") + "</laneSection>"};
      RoadText const b{.id = "2",
                       .link = back,
                       .geometry = "x=\"100\" y=\"0\" hdg=\"" + heading + "\" length=\"100\"><line/>",
                       .sections = a.sections};
      return load(a.text() + b.text());
    };
    auto const linked = pair(end("successor", "2", "start"), end("predecessor", "1", "end"));
    CHECK(linked.map->lanes()[0].successors == std::vector{cambium::LaneId{1}});
    CHECK(count(linked, "the two were joined") == 1);
    auto const unlinked = pair("", "");
    CHECK(unlinked.map->lanes()[0].successors.empty());
  }
}

TEST_CASE("links that only a junction gives join lanes where they meet") {
  auto const into = [](std::string const& link, std::string const& lane_link) {
    RoadText const a{.id = "1", .link = link}, way{.id = "11",
                                                   .junction = "5",
                                                   .geometry = "x=\"100\" y=\"0\" hdg=\"0.1\" length=\"30\"><line/>",
                                                   .length = "30",
                                                   .sections = "<laneSection s=\"0\">" + lane("") + "</laneSection>"};
    auto const x = std::to_string(100.0 + 30.0 * std::cos(0.1)), y = std::to_string(30.0 * std::sin(0.1));
    RoadText const out{.id = "2",
                       .link = "<predecessor elementType=\"junction\" elementId=\"5\"/>",
                       .geometry = "x=\"" + x + "\" y=\"" + y + "\" hdg=\"0.1\" length=\"100\"><line/>",
                       .sections = way.sections};
    return load(a.text() + way.text() + out.text() +
                "<junction id=\"5\" name=\"\"><connection id=\"0\" incomingRoad=\"1\" connectingRoad=\"11\" "
                "contactPoint=\"start\">" +
                lane_link + "</connection></junction>");
  };
  std::string const names = "<successor elementType=\"junction\" elementId=\"5\"/>";
  for (auto const& made : {into(names, "<laneLink from=\"-1\" to=\"-1\"/>"), into(names, ""),
                           into("", "<laneLink from=\"-1\" to=\"-1\"/>"), into("", "")}) {
    CHECK(made.map->lanes()[0].successors == std::vector{cambium::LaneId{1}});
    CHECK(made.map->lanes()[1].successors == std::vector{cambium::LaneId{2}});
    CHECK(count(made, "left out") == 0);
  }
}

}  // namespace
