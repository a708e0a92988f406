#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cambium/core/error.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/geometry/pose.hpp"
#include "cambium/map/building/detail/document_index.hpp"
#include "cambium/map/building/detail/make_road.hpp"
#include "cambium/map/building/road_plan.hpp"
#include "cambium/map/opendrive/document.hpp"
#include "cambium/map/road/cubic.hpp"
#include "cambium/map/road/lane_type.hpp"
#include "cambium/map/road/reference_line.hpp"
#include "cambium/map/road/road.hpp"

/// Connecting roads. OpenDRIVE says in three places what follows what: in the link of a road, in the links of its
/// lanes, and in the connections of junctions. `RoadConnector` makes one call of `MapBuilder::connect` enter all that
/// belong together. Which ones these are depends on the two road ends:
///
///     both free                       road links and lane links, in both directions
///     one is of a connecting road     the other road is linked to the junction, which gets connections
///     one is linked elsewhere         a fork: the links that there are become connections of a direct junction
///
/// The functions before the class answer what it has to know of roads: which lanes leave an end, where their borders
/// are there, and which lanes of two roads face each other.
namespace cambium::inline v0_1::map {

namespace detail {

using opendrive::ContactPoint;

[[nodiscard]] inline std::string describe(RoadEnd const& end) {
  return "road " + end.road + ", " + (end.end == ContactPoint::end ? "end" : "start");
}
[[nodiscard]] inline std::string describe(RoadEnd const& end, int lane) {
  return describe(end) + ", lane " + std::to_string(lane);
}

/// The lane section at a road's end.
[[nodiscard]] inline auto& section_at(auto& road, ContactPoint end) {
  return end == ContactPoint::end ? road.lane_sections.back() : road.lane_sections.front();
}

[[nodiscard]] inline auto& find_lane(auto& road, ContactPoint end, int id) {
  auto& lanes = section_at(road, end).lanes;
  auto const found =
      std::find_if(lanes.begin(), lanes.end(), [id](opendrive::LaneElement const& l) { return l.id == id; });
  if (id == 0 || found == lanes.end())
    throw MapError(describe({road.id, end}, id), "there is no such lane", "name one that it has");
  return *found;
}

/// True when traffic in the lane leaves the road at that end.
[[nodiscard]] inline bool leaves(opendrive::RoadElement const& road, ContactPoint end,
                                 opendrive::LaneElement const& lane) {
  bool const along = ((lane.id < 0) != (road.rule == opendrive::DrivingSide::left_hand)) !=
                     (lane.direction == opendrive::LaneDirection::reversed);
  return along == (end == ContactPoint::end);
}

/// The borders of a lane at a road's end as t [m].
struct LaneSpan {
  double inner{}, outer{};
  [[nodiscard]] double width() const { return std::abs(outer - inner); }
};

[[nodiscard]] inline LaneSpan lane_span(opendrive::RoadElement const& road, ContactPoint end, int id) {
  (void)find_lane(road, end, id);
  double const s = end == ContactPoint::end ? road.geometry_length() : 0.0;
  auto const& section = section_at(road, end);
  int const sign = id < 0 ? -1 : 1;
  double const ds = s - section.s;
  Lateral outer{CubicProfile(road.lane_offset).value(s)}, inner = outer;
  for (int number = sign; number != id + sign; number += sign) {
    inner = outer;
    if (auto const* lane = section.find(number)) outer = clamped_outer_border(make_road_lane(*lane), inner, ds, ds);
  }
  return {inner.t, outer.t};
}

/// The pose `t` beside a road's end, looking away from the road.
[[nodiscard]] inline geometry::Pose pose_at(opendrive::RoadElement const& road, ContactPoint end, double t) {
  auto const& g = end == ContactPoint::end ? road.geometries.back() : road.geometries.front();
  auto const p = evaluate(g, end == ContactPoint::end ? g.length : 0.0);
  return {p.x - t * portable::sin(p.heading), p.y + t * portable::cos(p.heading),
          p.heading + (end == ContactPoint::end ? 0.0 : geometry::pi)};
}

/// The lanes that go on as each other where two road ends meet.
[[nodiscard]] inline std::vector<opendrive::LaneLink> facing_lanes(opendrive::RoadElement const& a, ContactPoint end_a,
                                                                   opendrive::RoadElement const& b,
                                                                   ContactPoint end_b) {
  std::vector<opendrive::LaneLink> links;
  for (auto const& lane : section_at(a, end_a).lanes) {
    int const there = end_a != end_b ? lane.id : -lane.id;
    auto const* other = section_at(b, end_b).find(there);
    if (lane.id != 0 && other != nullptr && is_drivable(lane.type) == is_drivable(other->type))
      links.push_back({lane.id, there});
  }
  return links;
}

/// The lanes of a turn, see `TurnPlan::lanes`.
[[nodiscard]] inline std::vector<opendrive::LaneLink> turn_lanes(opendrive::RoadElement const& a,
                                                                 opendrive::RoadElement const& b, RoadEnd const& from,
                                                                 RoadEnd const& to,
                                                                 std::vector<opendrive::LaneLink> wanted) {
  for (auto const& link : wanted)
    if (!leaves(a, from.end, find_lane(a, from.end, link.from)) || leaves(b, to.end, find_lane(b, to.end, link.to)))
      throw MapError(describe(from, link.from) + " to " + describe(to, link.to), "one of them leads the wrong way",
                     "name a lane that leaves the one road and one that begins at the other");
  if (!wanted.empty()) return wanted;
  auto const lanes = [](opendrive::RoadElement const& road, ContactPoint end, bool leaving) {
    std::vector<int> ids;
    for (auto const& lane : section_at(road, end).lanes)
      if (lane.id != 0 && is_drivable(lane.type) && leaves(road, end, lane) == leaving) ids.push_back(lane.id);
    std::sort(ids.begin(), ids.end(),
              [](int l, int r) { return std::pair(std::abs(l), l) < std::pair(std::abs(r), r); });
    return ids;
  };
  auto const out = lanes(a, from.end, true), in = lanes(b, to.end, false);
  for (std::size_t i = 0; i < std::min(out.size(), in.size()); ++i) wanted.push_back({out[i], in[i]});
  if (wanted.empty())
    throw MapError("road " + from.road + " to road " + to.road, "no drivable lane leads from the one to the other",
                   "name the lanes");
  return wanted;
}

/// Enters links between road ends into a document; what is there already is not entered again.
class RoadConnector {
 public:
  RoadConnector(opendrive::Document& document, DocumentIndex& index) : document_(document), index_(index) {}

  void connect(RoadEnd const& a, RoadEnd const& b, std::vector<opendrive::LaneLink> const& links) {
    bool const through_a = !road(a).junction.empty(), through_b = !road(b).junction.empty();
    if (through_a != through_b) return through_a ? enter(b, a, reversed(links)) : enter(a, b, links);
    if (is_free_for(a, b) && is_free_for(b, a)) return link(a, b, links);
    auto& junction = direct_junction(a, b);
    add_connections(junction, a, b, links);
  }

 private:
  using Links = std::vector<opendrive::LaneLink>;

  [[nodiscard]] opendrive::RoadElement& road(RoadEnd const& end) const { return index_.road(document_, end.road); }
  [[nodiscard]] std::optional<opendrive::RoadLink>& link_of(RoadEnd const& end) const {
    return end.end == ContactPoint::end ? road(end).successor : road(end).predecessor;
  }
  [[nodiscard]] std::vector<int>& links_of(RoadEnd const& end, int lane) const {
    auto& l = find_lane(road(end), end.end, lane);
    return end.end == ContactPoint::end ? l.successors : l.predecessors;
  }
  [[nodiscard]] opendrive::JunctionElement& junction(std::string const& id) const {
    return index_.junction(document_, id);
  }
  [[nodiscard]] static opendrive::RoadLink to_road(RoadEnd const& end) {
    opendrive::RoadLink link;
    link.id = end.road;
    link.contact_point = end.end;
    return link;
  }
  [[nodiscard]] static Links reversed(Links links) {
    for (auto& link : links) std::swap(link.from, link.to);
    return links;
  }
  static void add(std::vector<int>& ids, int id) {
    if (std::find(ids.begin(), ids.end(), id) == ids.end()) ids.push_back(id);
  }

  [[nodiscard]] bool is_free_for(RoadEnd const& a, RoadEnd const& b) const {
    auto const& link = link_of(a);
    return !link ||
           (link->element_type == opendrive::ElementType::road && link->id == b.road && link->contact_point == b.end);
  }

  /// A road's end meets a road's end.
  void link(RoadEnd const& a, RoadEnd const& b, Links const& links) const {
    link_of(a) = to_road(b);
    link_of(b) = to_road(a);
    for (auto const& l : links) {
      add(links_of(a, l.from), l.to);
      add(links_of(b, l.to), l.from);
    }
  }

  void link_to_junction(RoadEnd const& end, std::string const& id) const {
    auto& link = link_of(end);
    if (link && (link->element_type != opendrive::ElementType::junction || link->id != id))
      throw MapError(describe(end), "it is linked to another road or junction", "connect each end to one junction");
    link.emplace();
    link->element_type = opendrive::ElementType::junction;
    link->id = id;
  }

  /// `outside` meets the connecting road `way`.
  void enter(RoadEnd const& outside, RoadEnd const& way, Links const& links) const {
    if (!is_free_for(way, outside))
      throw MapError("road " + way.road, "this end of the connecting road is linked already", "add another one");
    auto const& id = road(way).junction;
    link_to_junction(outside, id);
    link_of(way) = to_road(outside);
    for (auto const& l : links) add(links_of(way, l.to), l.from);
    add_connection(junction(id), outside, way, links);
  }

  /// A connection for those of the lanes that lead from `incoming` onto `way`, where one of them is drivable.
  void add_connection(opendrive::JunctionElement& at, RoadEnd const& incoming, RoadEnd const& way,
                      Links const& links) const {
    opendrive::Connection connection;
    bool const is_direct = at.type == opendrive::JunctionType::direct;
    connection.incoming_road = incoming.road;
    (is_direct ? connection.linked_road : connection.connecting_road) = way.road;
    connection.contact_point = way.end;
    bool leads_on = false;
    for (auto const& link : links) {
      auto const& lane = find_lane(road(incoming), incoming.end, link.from);
      if (!leaves(road(incoming), incoming.end, lane) || is_in(connection.lane_links, link)) continue;
      if (std::any_of(at.connections.begin(), at.connections.end(), [&](opendrive::Connection const& there) {
            return there.incoming_road == incoming.road && there.entered_road() == way.road &&
                   there.contact_point == way.end && is_in(there.lane_links, link);
          }))
        continue;
      connection.lane_links.push_back(link);
      leads_on = leads_on || is_drivable(lane.type);
    }
    if (!leads_on) return;
    connection.id = std::to_string(at.connections.size());
    at.connections.push_back(std::move(connection));
  }

  [[nodiscard]] static bool is_in(Links const& links, opendrive::LaneLink const& link) {
    return std::any_of(links.begin(), links.end(),
                       [&link](auto const& l) { return l.from == link.from && l.to == link.to; });
  }

  void add_connections(opendrive::JunctionElement& at, RoadEnd const& a, RoadEnd const& b, Links const& links) const {
    add_connection(at, a, b, links);
    add_connection(at, b, a, reversed(links));
  }

  /// The direct junction at both ends; the links that they had become its connections.
  [[nodiscard]] opendrive::JunctionElement& direct_junction(RoadEnd const& a, RoadEnd const& b) const {
    std::optional<std::string> id;
    for (auto const& end : {a, b}) {
      auto const& link = link_of(end);
      if (!link || link->element_type != opendrive::ElementType::junction) continue;
      if (junction(link->id).type != opendrive::JunctionType::direct || (id && *id != link->id))
        throw MapError("road " + end.road, "it is linked to a junction already",
                       "connect it to a connecting road of that junction");
      id = link->id;
    }
    if (!id) {
      id = index_.free_id(document_);
      document_.junctions.emplace_back();
      document_.junctions.back().id = *id;
      document_.junctions.back().type = opendrive::JunctionType::direct;
    }
    auto& result = junction(*id);
    for (auto const& end : {a, b}) {
      if (auto const link = link_of(end); link && link->element_type == opendrive::ElementType::road)
        dissolve(end, {link->id, link->contact_point}, result);
      link_to_junction(end, *id);
    }
    return result;
  }

  /// Turns a plain link into connections; either side may have been the only one to name a pair of lanes.
  void dissolve(RoadEnd const& a, RoadEnd const& b, opendrive::JunctionElement& into) const {
    if (!is_free_for(b, a))
      throw MapError("road " + a.road + " and road " + b.road, "only one of them is linked to the other",
                     "repair that link in the document first");
    auto links = named_links(a, b);
    for (auto const& link : reversed(named_links(b, a)))
      if (!is_in(links, link)) links.push_back(link);
    link_of(a).reset();
    link_of(b).reset();
    link_to_junction(a, into.id);
    link_to_junction(b, into.id);
    add_connections(into, a, b, links);
  }

  /// Takes from the lanes at `a` their links to lanes at `b`.
  [[nodiscard]] Links named_links(RoadEnd const& a, RoadEnd const& b) const {
    Links links;
    for (auto const& lane : section_at(road(a), a.end).lanes) {
      if (lane.id == 0) continue;
      for (int const to : std::exchange(links_of(a, lane.id), {}))
        links.push_back({lane.id, find_lane(road(b), b.end, to).id});
    }
    return links;
  }

  opendrive::Document& document_;
  DocumentIndex& index_;
};

}  // namespace detail
}  // namespace cambium::inline v0_1::map
