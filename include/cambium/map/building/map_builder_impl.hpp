#pragma once

#include <cmath>
#include <cstdlib>
#include <utility>

#include "cambium/core/error.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/core/text.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/map/building/build_map.hpp"
#include "cambium/map/building/detail/road_connector.hpp"
#include "cambium/map/building/detail/road_maker.hpp"
#include "cambium/map/building/detail/rollback.hpp"
#include "cambium/map/building/map_builder.hpp"
#include "cambium/map/opendrive/check.hpp"

namespace cambium::inline v0_1::map {

CAMBIUM_COLD MapBuilder::MapBuilder(std::string name) {
  document_.header.rev_major = 1;
  document_.header.rev_minor = 7;
  document_.header.name = std::move(name);
  document_.header.vendor = "cambium";
}

CAMBIUM_COLD std::string MapBuilder::add_road(RoadPlan plan) {
  index_.update(document_);
  if (plan.id.empty()) plan.id = index_.free_id(document_);
  check_id("road", plan.id);
  if (index_.has_road(plan.id)) throw MapError("road " + plan.id, "this id is already in use", "give another id");
  if (!plan.junction.empty()) (void)index_.junction(document_, plan.junction);
  document_.roads.push_back(detail::RoadMaker(std::move(plan)).make());
  index_.update(document_);
  return document_.roads.back().id;
}

CAMBIUM_COLD std::string MapBuilder::add_junction(std::string id, std::string name) {
  index_.update(document_);
  if (id.empty()) id = index_.free_id(document_);
  check_id("junction", id);
  if (index_.has_junction(id)) throw MapError("junction " + id, "this id is already in use", "give another id");
  opendrive::JunctionElement junction;
  junction.id = id;
  junction.name = std::move(name);
  document_.junctions.push_back(std::move(junction));
  index_.update(document_);
  return id;
}

CAMBIUM_COLD geometry::Pose MapBuilder::end_pose(RoadEnd const& end) const {
  return detail::pose_at(checked(end), end.end, 0.0);
}

CAMBIUM_COLD geometry::Pose MapBuilder::lane_pose(RoadEnd const& end, int lane) const {
  auto const& road = checked(end);
  auto const span = detail::lane_span(road, end.end, lane);
  return detail::pose_at(road, end.end, 0.5 * (span.inner + span.outer));
}

CAMBIUM_COLD void MapBuilder::connect(RoadEnd const& a, RoadEnd const& b, std::vector<opendrive::LaneLink> links) {
  index_.update(document_);
  auto const& road_a = checked(a);
  auto const& road_b = checked(b);
  if (links.empty()) links = detail::facing_lanes(road_a, a.end, road_b, b.end);
  if (links.empty())
    throw MapError("road " + a.road + " and road " + b.road, "no lane of one continues as a lane of the other",
                   "name the lanes, or turn one of the roads round");
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
  detail::Rollback rollback(document_, index_);
  for (auto const* end : {&a, &b}) rollback.watch_road(end->road);
  detail::RoadConnector(document_, index_).connect(a, b, links);
  rollback.keep();
}

CAMBIUM_COLD std::string MapBuilder::add_turn(std::string const& junction_id, RoadEnd const& from, RoadEnd const& to,
                                              TurnPlan plan) {
  index_.update(document_);
  (void)index_.junction(document_, junction_id);
  auto const lanes = detail::turn_lanes(checked(from), checked(to), from, to, std::move(plan.lanes));
  auto road = turn_plan(from, to, lanes, std::move(plan));
  road.junction = junction_id;
  int const step = road.sections.front().left.empty() ? -1 : 1;
  detail::Rollback rollback(document_, index_);
  for (auto const* end : {&from, &to}) rollback.watch_road(end->road);
  rollback.watch_junction(junction_id);
  auto const id = add_road(std::move(road));
  std::vector<opendrive::LaneLink> enter, leave;
  for (auto const& link : lanes) {
    int const own = step * (static_cast<int>(enter.size()) + 1);
    enter.push_back({link.from, own});
    leave.push_back({own, link.to});
  }
  connect(from, {id, opendrive::ContactPoint::start}, enter);
  connect({id, opendrive::ContactPoint::end}, to, leave);
  rollback.keep();
  return id;
}

CAMBIUM_COLD opendrive::Document& MapBuilder::document() {
  index_.forget();
  return document_;
}

CAMBIUM_COLD std::shared_ptr<Map const> MapBuilder::build(MapOptions const& options,
                                                          std::vector<Diagnostic>* diagnostics) const {
  if (document_.roads.empty())
    throw MapError("map '" + document_.header.name + "'", "no road has been added to it",
                   "call MapBuilder::add_road before build");
  std::vector<Diagnostic> unheard;
  auto& found = diagnostics != nullptr ? *diagnostics : unheard;
  auto document = document_;
  if (document.header.line == 0) document.header.line = 1;  // 0 would say that there is no header
  auto const name = document.header.name;
  check_opendrive_document(document, name, found);
  return build_map(std::move(document), options, name, found);
}

CAMBIUM_COLD void MapBuilder::check_id(std::string const& what, std::string const& id) {
  if (id == "-1" || cambium::detail::trimmed(id) != id)
    throw MapError(what + " '" + id + "'", "its id means none, or has blanks around it", "give another id, or none");
}

CAMBIUM_COLD RoadPlan MapBuilder::turn_plan(RoadEnd const& from, RoadEnd const& to,
                                            std::vector<opendrive::LaneLink> const& lanes, TurnPlan plan) const {
  bool const left_hand = checked(from).rule == opendrive::DrivingSide::left_hand;
  auto begin = lane_pose(from, lanes.front().from), end = lane_pose(to, lanes.front().to);
  end.heading += geometry::pi;
  RoadPlan road{.id = std::move(plan.id), .name = std::move(plan.name)};
  road.line = connecting_curve(begin, end, "turn from road " + from.road + " to road " + to.road);
  road.rule = checked(from).rule;
  road.speed_limit = plan.speed_limit;
  double const length = road.line.back().s + road.line.back().length;
  auto const unmarked = make_mark("none", opendrive::LaneChangePermission::none);
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
  return road;
}

CAMBIUM_COLD opendrive::RoadElement const& MapBuilder::checked(RoadEnd const& end) const {
  if (end.end == opendrive::ContactPoint::none)
    throw MapError("road " + end.road, "its end is not specified", "name start or end");
  return road(end.road);
}

}  // namespace cambium::inline v0_1::map
