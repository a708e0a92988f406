#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cambium/core/diagnostic.hpp"
#include "cambium/core/error.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/geometry/pose.hpp"
#include "cambium/map/build_map.hpp"
#include "cambium/map/curve_layout.hpp"
#include "cambium/map/detail/road_connector.hpp"
#include "cambium/map/map.hpp"
#include "cambium/map/opendrive_check.hpp"
#include "cambium/map/opendrive_document.hpp"
#include "cambium/map/road_plan.hpp"

namespace cambium::map {

/// A way through a junction to be made, see `MapBuilder::add_turn`.
struct TurnPlan {
  std::string id{};  ///< the connecting road's; empty: the next free number
  std::string name{};
  /// Lanes of the one road and of the other that it connects, from the middle of the road outwards and side by side.
  /// Empty: the drivable lanes that lead in and out, the first to the first and so on, while there are both.
  std::vector<opendrive::LaneLink> lanes{};
  std::optional<double> speed_limit{};  ///< [m/s]
};

/// Makes maps in code: roads, how they are linked, junctions. What it makes is an OpenDRIVE document (which can be
/// written to a file), and from that the map, just as from a file.
///
///     MapBuilder builder;
///     builder.add_road({.id = "1", .line = lay_from({}, {{500.0}}), .sections = {{.right = equal_lanes(2)}}});
///     auto const map = builder.build();
///
/// All functions throw `MapError` for roads and junctions that are not there, and for numbers that are not finite.
class MapBuilder {
 public:
  explicit MapBuilder(std::string name = "map") {
    document_.header.rev_major = 1;
    document_.header.rev_minor = 7;
    document_.header.name = std::move(name);
    document_.header.vendor = "cambium";
  }

  /// Adds a road; gives its id. Throws `MapError` where the id is taken, the line or the first section is missing,
  /// sections are not in order, or a width falls below 0.
  std::string add_road(RoadPlan plan) {
    if (plan.id.empty()) plan.id = free_id();
    if (index_of_road(plan.id)) throw MapError("road " + plan.id, "there is one of that id", "give another id");
    if (!plan.junction.empty()) (void)junction(plan.junction);
    document_.roads.push_back(detail::RoadMaker(std::move(plan)).make());
    return document_.roads.back().id;
  }

  /// Adds an empty junction; gives its id (without one, the next free number). Throws `MapError` where the id is taken.
  std::string add_junction(std::string id = {}, std::string name = {}) {
    if (id.empty()) id = free_id();
    for (auto const& other : document_.junctions)
      if (other.id == id) throw MapError("junction " + id, "there is one of that id", "give another id");
    document_.junctions.emplace_back();
    document_.junctions.back().id = id;
    document_.junctions.back().name = std::move(name);
    return id;
  }

  /// The end of a road's reference line, looking away from the road: where another road can begin.
  [[nodiscard]] geometry::Pose end_pose(RoadEnd const& end) const {
    return detail::pose_at(checked(end), end.end, 0.0);
  }

  /// The middle of a lane at a road's end, looking away from the road. Throws `MapError` where there is no such lane.
  [[nodiscard]] geometry::Pose lane_pose(RoadEnd const& end, int lane) const {
    auto const& road = checked(end);
    auto const span = detail::lane_span(road, end.end, lane);
    return detail::pose_at(road, end.end, 0.5 * (span.inner + span.outer));
  }

  /// Links the ends of two roads, and there the lanes named, or without any, those of the same place: of equal ids
  /// where an end meets a start, else of opposite ones; drivable lanes to drivable ones only.
  ///
  /// Where one of the roads is a connecting road, the other becomes linked to its junction, with connections for the
  /// lanes that lead in. Else, where an end is linked already to another road, the two links become connections of a
  /// direct junction: so forks and joints need nothing but a `connect` for each of their branches. Throws `MapError`
  /// where there is no such lane, or lanes to be linked lie more than 0.5 m or 0.5 rad apart.
  void connect(RoadEnd const& a, RoadEnd const& b, std::vector<opendrive::LaneLink> links = {}) {
    auto const& road_a = checked(a);
    auto const& road_b = checked(b);
    if (links.empty()) links = detail::facing_lanes(road_a, a.end, road_b, b.end);
    for (auto const& link : links) {
      auto const from = lane_pose(a, link.from), to = lane_pose(b, link.to);
      double const gap = (from.position() - to.position()).norm();
      double const turn = std::abs(geometry::angle_difference(from.heading + geometry::pi, to.heading));
      if (!(gap <= 0.5 && turn <= 0.5))
        throw MapError(detail::describe(a, link.from) + " and " + detail::describe(b, link.to),
                       "they do not meet: there are " + cambium::detail::rounded_text(gap) + " m and " +
                           cambium::detail::rounded_text(turn) + " rad between them",
                       "lay the one road out from the end of the other, see end_pose");
    }
    detail::RoadConnector(document_, [this] { return free_id(); }).connect(a, b, links);
  }

  /// Adds a connecting road to a junction: a smooth way (`connecting_curve`) from lanes that leave `from` to lanes that
  /// begin at `to`, along the middle of the first of them, and connects it to both. Its lanes' widths go smoothly from
  /// the one's to the other's. Gives its id. Throws `MapError` as `connect`, for lanes that lead the wrong way, and
  /// where there are none.
  std::string add_turn(std::string const& junction_id, RoadEnd const& from, RoadEnd const& to, TurnPlan plan = {}) {
    (void)junction(junction_id);
    auto const lanes = detail::turn_lanes(checked(from), checked(to), from, to, std::move(plan.lanes));
    bool const left_hand = checked(from).rule == opendrive::TrafficRule::left_hand;
    auto begin = lane_pose(from, lanes.front().from), end = lane_pose(to, lanes.front().to);
    end.heading += geometry::pi;
    RoadPlan road{.id = plan.id.empty() ? free_id() : plan.id, .name = std::move(plan.name)};
    road.line = connecting_curve(begin, end);
    road.rule = checked(from).rule;
    road.speed_limit = plan.speed_limit;
    road.junction = junction_id;
    double const length = road.line.back().s + road.line.back().length;
    auto const unmarked = make_mark("none", opendrive::LaneChange::none);
    SectionPlan section{.middle_mark = unmarked};
    auto& side = left_hand ? section.left : section.right;
    for (auto const& link : lanes)
      side.push_back({.type = detail::find_lane(checked(from), from.end, link.from).type,
                      .width = detail::lane_span(checked(from), from.end, link.from).width(),
                      .end_width = detail::lane_span(checked(to), to.end, link.to).width(),
                      .mark = unmarked});
    double const sign = left_hand ? -0.5 : 0.5;
    road.lane_offset = {smooth_step(0.0, sign * side.front().width, sign * *side.front().end_width, length)};
    road.sections = {std::move(section)};
    auto const id = add_road(std::move(road));
    int const step = left_hand ? 1 : -1;
    std::vector<opendrive::LaneLink> enter, leave;
    for (auto const& link : lanes) {
      int const own = step * (static_cast<int>(enter.size()) + 1);
      enter.push_back({link.from, own});
      leave.push_back({own, link.to});
    }
    connect(from, {id, opendrive::ContactPoint::start}, enter);
    connect({id, opendrive::ContactPoint::end}, to, leave);
    return id;
  }

  /// What has been made so far. Whoever needs more than the functions above (elevations, marks, a header offset) may
  /// change it.
  [[nodiscard]] opendrive::Document const& document() const { return document_; }
  [[nodiscard]] opendrive::Document& document() { return document_; }

  /// A road of the document. Throws `MapError` where there is none of that id.
  [[nodiscard]] opendrive::Road& road(std::string const& id) { return document_.roads[checked_index(id)]; }
  [[nodiscard]] opendrive::Road const& road(std::string const& id) const { return document_.roads[checked_index(id)]; }

  /// The map of what has been made so far, checked as a file would be; what is odd goes to `diagnostics`. Throws
  /// `MapError` where there is no lane.
  [[nodiscard]] std::shared_ptr<Map const> build(MapOptions const& options = {},
                                                 std::vector<Diagnostic>* diagnostics = nullptr) const {
    std::vector<Diagnostic> unheard;
    auto& found = diagnostics != nullptr ? *diagnostics : unheard;
    auto document = document_;
    if (document.header.line == 0) document.header.line = 1;  // 0 would say that there is no header
    check_opendrive_document(document, document.header.name, found);
    return build_map(document, options, document.header.name, found);
  }

 private:
  [[nodiscard]] std::optional<std::size_t> index_of_road(std::string const& id) const {
    for (std::size_t i = 0; i < document_.roads.size(); ++i)
      if (document_.roads[i].id == id) return i;
    return std::nullopt;
  }

  [[nodiscard]] std::size_t checked_index(std::string const& id) const {
    auto const index = index_of_road(id);
    if (!index) throw MapError("road " + id, "there is none of that id", "add it first");
    return *index;
  }

  [[nodiscard]] opendrive::Road const& checked(RoadEnd const& end) const {
    if (end.end == opendrive::ContactPoint::none)
      throw MapError("road " + end.road, "it is not said which end of it is meant", "name start or end");
    return road(end.road);
  }

  [[nodiscard]] opendrive::Junction const& junction(std::string const& id) const {
    for (auto const& junction : document_.junctions)
      if (junction.id == id) return junction;
    throw MapError("junction " + id, "there is none of that id", "add it first, see add_junction");
  }

  /// The smallest number from 1 on that no road and no junction has.
  [[nodiscard]] std::string free_id() const {
    auto const is_taken = [this](std::string const& id) {
      auto const same = [&id](auto const& element) { return element.id == id; };
      return std::any_of(document_.roads.begin(), document_.roads.end(), same) ||
             std::any_of(document_.junctions.begin(), document_.junctions.end(), same);
    };
    auto number = document_.roads.size() + 1;
    while (is_taken(std::to_string(number))) ++number;
    return std::to_string(number);
  }

  opendrive::Document document_;
};

}  // namespace cambium::map

namespace cambium {
using map::MapBuilder;
}  // namespace cambium
