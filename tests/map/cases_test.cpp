// Small maps that once failed, each for a kind of fault: what is right.
#include <doctest/doctest.h>

#include <optional>
#include <string>
#include <vector>

#include "cambium/map/lanelet/lanelet2.hpp"
#include "cambium/map/opendrive.hpp"

#include "../support/corpus.hpp"
#include "../support/text.hpp"

using namespace cambium;

namespace {

struct Loaded {
  std::shared_ptr<Map const> map;
  std::string findings;
  int count = 0;
};

std::optional<Loaded> opendrive(std::string const& name) {
  auto const file = corpus::find("cases/odr_" + name + ".xodr");
  if (!file) return std::nullopt;
  auto loaded = load_opendrive(file->string());
  Loaded result{loaded.map, {}, static_cast<int>(loaded.diagnostics.size())};
  for (auto const& found : loaded.diagnostics) result.findings += to_string(found) + "\n";
  return result;
}

std::optional<map::LaneletMap> lanelet2(std::string const& name) {
  auto const file = corpus::find("cases/ll2_" + name + ".osm");
  return file ? std::optional(load_lanelet2(file->string())) : std::nullopt;
}

/// All signals of drivable lanes.
std::vector<map::LaneSignal> signals_of(Map const& map) {
  std::vector<map::LaneSignal> all;
  for (auto const& lane : map.lanes()) all.insert(all.end(), lane.signals.begin(), lane.signals.end());
  return all;
}

}  // namespace

TEST_CASE("tags say who may change lanes, else the look of the line; nobody crosses a virtual one") {
  struct Row {
    char const* name;
    bool to_right, to_left;
  };
  for (auto const& row : {Row{"lane_change_yes_on_solid", true, true}, Row{"lane_change_no_on_dashed", false, false},
                          Row{"lane_change_right_only", true, false}, Row{"virtual_border", false, false}}) {
    auto const made = lanelet2(row.name);
    if (!made) return;
    CAPTURE(row.name);
    auto const &left = made->map->lane(made->lanes.at(300)), &right = made->map->lane(made->lanes.at(301));
    CHECK(left.right_neighbor == right.id);
    CHECK(left.may_change_right(5.0) == row.to_right);
    CHECK(right.may_change_left(5.0) == row.to_left);
  }
}

TEST_CASE("parallel lanes stay parallel through a junction, and lanes are linked where they meet at an angle") {
  auto const junction = lanelet2("junction_then_square_end");
  if (!junction) return;
  auto const lane = [&](std::int64_t id) { return junction->lanes.at(id); };
  for (std::int64_t const id : {300, 301, 310, 311})
    CHECK(junction->map->lane(lane(id)).successors == std::vector{lane(id + 10)});
  for (std::int64_t const id : {300, 310, 320}) CHECK(junction->map->lane(lane(id)).right_neighbor == lane(id + 1));
  CHECK(junction->diagnostics.empty());
  for (char const* name : {"kink_048rad", "kink_055rad"}) {
    auto const made = lanelet2(name);
    CHECK(made->map->lane(made->lanes.at(21)).successors == std::vector{made->lanes.at(22)});
    CHECK(made->diagnostics.size() <= 1);
  }
}

TEST_CASE("the lanes that a light is valid for have it, whatever its orientation") {
  for (std::string const name : {"light_plain", "light_orientation_against_validity"}) {
    auto const made = opendrive(name);
    if (!made) return;
    CAPTURE(name);
    auto const signals = signals_of(*made->map);
    REQUIRE(signals.size() == 1);
    CHECK(signals[0].kind == map::SignalKind::light);
    CHECK(made->map->lights().size() == 1);
    CHECK(made->count == (name == "light_plain" ? 0 : 1));
  }
}

TEST_CASE("a stop sign is one by any country's code") {
  for (std::string const name : {"stop_206_DE", "stop_R1-1_US"}) {
    auto const made = opendrive(name);
    if (!made) return;
    CAPTURE(name);
    auto const signals = signals_of(*made->map);
    REQUIRE(signals.size() == 1);
    CHECK(signals[0].kind == map::SignalKind::stop);
    CHECK(made->count == 0);
  }
}

TEST_CASE("links that a file gives once join lanes, with one finding") {
  struct Row {
    char const *name, *words;
  };
  for (auto const& row : {Row{"links_only_in_junction", "begins where it ends; the two were joined"},
                          Row{"links_only_in_road", "it names no lanes"}, Row{"link_one_sided", "names none back"}}) {
    auto const made = opendrive(row.name);
    if (!made) return;
    CAPTURE(row.name);
    CAPTURE(made->findings);
    int ends = 0;
    for (auto const& lane : made->map->lanes()) ends += lane.successors.empty() ? 1 : 0;
    CHECK(ends == 1);
    CHECK(made->count == 1);
    CHECK(made->findings.find(row.words) != std::string::npos);
  }
}

TEST_CASE("oddities that are read rightly stay so") {
  auto const empty = opendrive("empty_lane_link_elements"), outgoing = opendrive("lanelink_names_outgoing_lane"),
             number = opendrive("number_without_e");
  if (!empty || !outgoing || !number) return;
  CHECK(empty->findings.find("attribute id is missing") != std::string::npos);
  CHECK(outgoing->findings.find("lane -4 of road 3 does not exist") != std::string::npos);
  CHECK(number->findings.find("is not a finite number") != std::string::npos);
}

TEST_CASE("roads that cross without a junction have lanes that cross") {
  for (std::string const name : {"all_way_stop_no_junction", "crossing_no_signs_no_junction"}) {
    auto const made = opendrive(name);
    if (!made) return;
    CAPTURE(name);
    CHECK_MESSAGE(made->count == 0, made->findings);
    std::size_t crossings = 0;
    for (auto const& lane : made->map->lanes())
      for (auto const& overlap : lane.overlaps) crossings += overlap.kind == map::OverlapKind::crossing ? 1 : 0;
    CHECK(crossings >= 8);  // both ways of both roads
    CHECK(signals_of(*made->map).empty() == (name == "crossing_no_signs_no_junction"));
  }
}

TEST_CASE("a lane that folds on the inner side of a bend is a warning with its place") {
  auto const text = [](double curvature) {
    return "<OpenDRIVE><header revMajor=\"1\" revMinor=\"6\"/><road name=\"\" length=\"6\" id=\"1\" junction=\"-1\">"
           "<planView><geometry s=\"0\" x=\"0\" y=\"0\" hdg=\"0\" length=\"6\"><arc curvature=\"" +
           std::to_string(curvature) +
           "\"/></geometry></planView><lanes><laneSection s=\"0\"><center><lane id=\"0\" "
           "type=\"none\"/></center><right>"
           "<lane id=\"-1\" type=\"driving\"><width sOffset=\"0\" a=\"3.5\" b=\"0\" c=\"0\" d=\"0\"/></lane>"
           "<lane id=\"-2\" type=\"driving\"><width sOffset=\"0\" a=\"3.5\" b=\"0\" c=\"0\" d=\"0\"/></lane>"
           "</right></laneSection></lanes></road></OpenDRIVE>";
  };
  auto const findings = [&](double curvature) {
    std::string all;
    for (auto const& found : map::parse_opendrive(text(curvature)).diagnostics) all += to_string(found) + "\n";
    return all;
  };
  CHECK(findings(-0.1).empty());
  auto const tight = findings(-0.5);
  CHECK(tight.find("road 1, section 0, lane -1: its path turns by 3 rad within a metre") != std::string::npos);
  CHECK(tight.find("road 1, section 0, lane -2: its path runs backwards") != std::string::npos);
}
