#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "corpus_maps.hpp"
#include "cambium/map/building/detail/split_roads.hpp"
#include "cambium/map/opendrive.hpp"

using namespace cambium;
using namespace cambium::map;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

std::string mark(double s, std::string const& change) {
  return "<roadMark sOffset=\"" + std::to_string(s) + "\" type=\"broken\"" +
         (change.empty() ? "" : " laneChange=\"" + change + "\"") + "/>";
}

std::string lane(int id, std::string const& marks, std::string const& speeds = "") {
  return "<lane id=\"" + std::to_string(id) + "\" type=\"driving\">" +
         (id != 0 ? "<width sOffset=\"0\" a=\"3.5\" b=\"0\" c=\"0\" d=\"0\"/>" : "") + marks + speeds + "</lane>";
}

/// A road of 100 m; `rule` as an attribute.
std::shared_ptr<Map const> road(std::string const& left, std::string const& center, std::string const& right,
                                std::string const& types = "", std::string const& attributes = "",
                                std::string const& geometry = "<line/>") {
  std::string const text =
      "<OpenDRIVE><header revMajor=\"1\" revMinor=\"7\"/><road id=\"1\" length=\"100\" junction=\"-1\"" + attributes +
      ">" + types + "<planView><geometry s=\"0\" x=\"0\" y=\"0\" hdg=\"0\" length=\"100\">" + geometry +
      "</geometry></planView><lanes><laneSection s=\"0\">" + (left.empty() ? "" : "<left>" + left + "</left>") +
      "<center>" + center + "</center>" + (right.empty() ? "" : "<right>" + right + "</right>") +
      "</laneSection></lanes></road></OpenDRIVE>";
  return cambium::parse_opendrive(text).map;
}

using Stretches = std::vector<PathStretch>;

}  // namespace

TEST_CASE("the mark of the lane nearer to the middle says where lanes may be changed, from its place on") {
  auto const map = road("", lane(0, ""),
                        lane(-1, mark(0, "none") + mark(30, "both") + mark(60, "increase") + mark(80, "decrease")) +
                            lane(-2, mark(0, "none")) + lane(-3, ""));
  auto const& inner = map->lane(map->find_lane("1", 0, -1));
  auto const& middle = map->lane(map->find_lane("1", 0, -2));
  auto const& outer = map->lane(map->find_lane("1", 0, -3));
  CHECK(inner.left_changes.empty());
  CHECK(inner.right_changes == Stretches{{30, 60}, {80, 100}});  // towards smaller ids
  CHECK(middle.left_changes == Stretches{{30, 80}});
  CHECK(middle.right_changes.empty());
  CHECK(outer.left_changes.empty());
  CHECK_FALSE(inner.may_change_right(29));
  CHECK(inner.may_change_right(45));
  CHECK_FALSE(inner.may_change_right(70));
  CHECK_FALSE(inner.may_change_left(45));
}

TEST_CASE("a mark without a word about changes permits them, and so does a border without a mark") {
  for (auto const* marks : {"", "<roadMark sOffset=\"0\" type=\"solid\"/>"}) {
    auto const map = road("", lane(0, mark(0, "none")), lane(-1, marks) + lane(-2, ""));
    CHECK(map->lane(map->find_lane("1", 0, -1)).right_changes == Stretches{{0, 100}});
    CHECK(map->lane(map->find_lane("1", 0, -2)).left_changes == Stretches{{0, 100}});
  }
  auto const later = road("", lane(0, ""), lane(-1, mark(40, "none")) + lane(-2, ""));
  CHECK(later->lane(later->find_lane("1", 0, -1)).right_changes == Stretches{{0, 40}});
}

TEST_CASE(
    "on the left side, and in left-hand traffic, increasing ids lead away from the middle and left is what it is") {
  // Against the road: path position 0 is at road s 100.
  auto const against = road(lane(2, "") + lane(1, mark(0, "both") + mark(30, "increase")), lane(0, ""), "");
  CHECK(against->lane(against->find_lane("1", 0, 1)).right_changes == Stretches{{0, 100}});
  CHECK(against->lane(against->find_lane("1", 0, 2)).left_changes == Stretches{{70, 100}});
  auto const left_hand =
      road(lane(2, "") + lane(1, mark(0, "both") + mark(30, "increase")), lane(0, ""), "", "", " rule=\"LHT\"");
  CHECK(left_hand->lane(left_hand->find_lane("1", 0, 1)).left_changes == Stretches{{0, 100}});
  CHECK(left_hand->lane(left_hand->find_lane("1", 0, 2)).right_changes == Stretches{{0, 30}});
}

TEST_CASE("between 1 and -1, driven the same way, lane 0's mark counts") {
  auto const one_way = [](std::string const& marks) {
    std::string reversed = lane(1, mark(0, "none"));
    reversed.replace(0, 5, "<lane direction=\"reversed\"");
    return road(reversed, lane(0, marks), lane(-1, mark(0, "none")));
  };
  auto const map = one_way(mark(0, "increase"));
  auto const& right = map->lane(map->find_lane("1", 0, -1));
  REQUIRE(is_valid(right.left_neighbor));
  CHECK(right.left_changes == Stretches{{0, 100}});
  CHECK(map->lane(right.left_neighbor).right_changes.empty());
}

TEST_CASE("a lane's speed limits are its own records', else the road's, along its path") {
  std::string const types =
      "<type s=\"0\" type=\"rural\"><speed max=\"20\"/></type><type s=\"50\" type=\"town\"><speed max=\"10\"/></type>"
      "<type s=\"90\" type=\"town\"/>";
  std::string const own =
      "<speed sOffset=\"30\" max=\"5\"/><speed sOffset=\"40\" max=\"no limit\"/>"
      "<speed sOffset=\"70\" max=\"undefined\"/>";
  auto const map = road(lane(1, "", own), lane(0, ""), lane(-1, "", own) + lane(-2, ""), types);
  using Steps = std::vector<SpeedStep>;
  auto const& right = map->lane(map->find_lane("1", 0, -1));
  CHECK(right.speed_limits == Steps{{0, 20}, {30, 5}, {40, infinity}, {70, 10}, {90, infinity}});
  CHECK(map->lane(map->find_lane("1", 0, -2)).speed_limits == Steps{{0, 20}, {50, 10}, {90, infinity}});
  auto const& left = map->lane(map->find_lane("1", 0, 1));
  CHECK(left.speed_limits == Steps{{0, infinity}, {10, 10}, {30, infinity}, {60, 5}, {70, 20}});
  CHECK(right.speed_limit_at(-1) == 20);
  CHECK(right.speed_limit_at(29.9) == 20);
  CHECK(right.speed_limit_at(30) == 5);
  CHECK(right.speed_limit_at(1000) == infinity);
  auto const free =
      road("", lane(0, ""), lane(-1, ""), "<type s=\"0\" type=\"motorway\"><speed max=\"no limit\"/></type>");
  CHECK(free->lanes()[0].speed_limits.empty());
  CHECK(free->lanes()[0].speed_limit_at(50) == infinity);
}

TEST_CASE("in a curve the places of records are those of their cross-sections") {
  auto const map = road("", lane(0, ""), lane(-1, mark(50, "none") + mark(75, "both")) + lane(-2, ""), "", "",
                        "<arc curvature=\"0.02\"/>");
  auto const& outer = map->lane(map->find_lane("1", 0, -2));  // 5.25 m right of the line: a radius of 55.25 m
  REQUIRE(outer.left_changes.size() == 2);
  CHECK(outer.left_changes[0].end == doctest::Approx(50 * 55.25 / 50).epsilon(1e-4));
  CHECK(outer.left_changes[1].begin == doctest::Approx(75 * 55.25 / 50).epsilon(1e-4));
}

namespace {

/// The station of the road's cross-section that holds `p`, by bisection on [from, to].
double station_of(Road const& road, geometry::Point const& p, double from, double to) {
  for (int i = 0; i < 50; ++i) {
    double const s = 0.5 * (from + to);
    auto const line = road.reference_line.at(s);
    bool const is_behind = (p.x() - line.x) * std::cos(line.heading) + (p.y() - line.y) * std::sin(line.heading) > 0.0;
    (is_behind ? from : to) = s;
  }
  return 0.5 * (from + to);
}

/// What the document says at a station, read plainly.
struct Plain {
  OpenDriveDocument const& document;
  Lane const& lane;
  double s;

  [[nodiscard]] opendrive::LaneSection const& section() const {
    auto const* found = &document.roads[index_of(lane.road)].lane_sections.front();
    for (auto const& section : document.roads[index_of(lane.road)].lane_sections)
      if (section.s <= s) found = &section;
    return *found;  // the map may have split it
  }
  [[nodiscard]] double limit() const {
    double limit = infinity;
    for (auto const& type : document.roads[index_of(lane.road)].types)
      if (type.s <= s) limit = type.limit && *type.limit > 0 ? *type.limit : infinity;
    std::optional<double> own;
    for (auto const& speed : section().find(lane.number)->speeds)
      if (section().s + speed.s <= s) own = speed.limit;
    return own && *own > 0 ? *own : limit;
  }
  [[nodiscard]] bool permits(int to) const {
    bool const away = std::abs(to) > std::abs(lane.number);
    int const border = to * lane.number < 0 ? 0 : (away ? lane.number : to);
    auto change = opendrive::LaneChangePermission::both;
    for (auto const& mark : section().find(border)->road_marks)
      if (section().s + mark.s_offset <= s) change = mark.lane_change;
    if (change == opendrive::LaneChangePermission::increase) return to > lane.number;
    if (change == opendrive::LaneChangePermission::decrease) return to < lane.number;
    return change != opendrive::LaneChangePermission::none;
  }
  /// Whether a record begins near by, so that rounding decides.
  [[nodiscard]] bool is_doubtful() const {
    auto const near = [this](double at) { return std::abs(at - s) < 0.3; };
    for (auto const& type : document.roads[index_of(lane.road)].types)
      if (near(type.s)) return true;
    for (auto const& written : section().lanes) {
      for (auto const& mark : written.road_marks)
        if (near(section().s + mark.s_offset)) return true;
      for (auto const& speed : written.speeds)
        if (near(section().s + speed.s)) return true;
    }
    return false;
  }
};

}  // namespace

TEST_CASE("on real maps lanes say what the records at each of their places say") {
  std::size_t forbidden = 0, permitted = 0, limited = 0, wrong = 0;
  bool const is_there = for_each_corpus_map([&](auto const& file, Map const& map) {
    std::vector<Diagnostic> diagnostics;
    auto document = load_opendrive_document(file.string(), diagnostics);
    map::detail::split_roads(document);  // with the map's sections
    for (auto const& lane : map.lanes()) {
      if (is_valid(lane.merges_into)) continue;  // its path leaves its cross-sections' order a little
      for (double const share : {0.1, 0.37, 0.5, 0.93}) {
        double const s = share * lane.length();
        auto const p = lane.path.pose(s).position();
        Plain const plain{document, lane, station_of(map.road(lane.road), p, lane.road_begin, lane.road_end)};
        if (plain.is_doubtful()) continue;
        wrong += lane.speed_limit_at(s) != plain.limit();
        limited += std::isfinite(plain.limit());
        for (auto const& [side, may] : {std::pair(lane.left_neighbor, lane.may_change_left(s)),
                                        std::pair(lane.right_neighbor, lane.may_change_right(s))}) {
          bool const expected = is_valid(side) && plain.permits(map.lane(side).number);
          wrong += may != expected;
          permitted += expected;
          forbidden += is_valid(side) && !expected;
        }
      }
    }
  });
  if (!is_there) return;
  CHECK(wrong == 0);
  CHECK(forbidden > 100);
  CHECK(permitted > 1000);
  CHECK(limited > 1000);
}
