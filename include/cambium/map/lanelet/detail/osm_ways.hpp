#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <pugixml.hpp>

#include "cambium/core/diagnostic.hpp"
#include "cambium/core/error.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/core/text.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/geometry/box.hpp"
#include "cambium/map/lanelet/detail/lanelet_bounds.hpp"
#include "cambium/map/lanelet/detail/utm.hpp"
#include "cambium/map/lanelet/lanelet2_origin.hpp"
#include "cambium/map/opendrive/xml.hpp"

namespace cambium::inline v0_1::map::detail {

using OsmId = std::int64_t;

/// The value of the element's tag `key`; empty where it has none.
[[nodiscard]] inline std::string_view osm_tag(pugi::xml_node node, std::string_view key) {
  for (auto child = node.first_child(); child; child = child.next_sibling())
    if (local_name(child) == "tag" && child.attribute("k").value() == key) return child.attribute("v").value();
  return {};
}

/// What a tag says, as Lanelet2 reads it; nothing where it is no truth value.
[[nodiscard]] inline std::optional<bool> osm_truth(std::string_view word) {
  if (word == "yes" || word == "true" || word == "1") return true;
  if (word == "no" || word == "false" || word == "0") return false;
  return std::nullopt;
}

/// The element's id; nothing, with a finding, where it is no whole number, or the element is marked as deleted.
[[nodiscard]] inline std::optional<OsmId> osm_id(XmlContext& context, pugi::xml_node node) {
  if (std::string_view(node.attribute("action").value()) == "delete") return std::nullopt;
  auto const id = context.number<OsmId>(node, "id");
  if (!id) context.report(Severity::warning, node, "it was left out");
  return id;
}

/// A way: a line through nodes.
struct OsmWay {
  std::vector<OsmId> nodes;
  std::string type, subtype;
  std::optional<bool> change{}, change_left{}, change_right{};  ///< tags lane_change, :left, :right, as the way runs
};

/// A bound: the way, and the way round in which the lanelet has it.
struct OsmBound {
  OsmId way{};
  bool reversed = false;
  friend auto operator<=>(OsmBound const&, OsmBound const&) = default;
};

/// Findings to which many elements of a file may give rise: each is said once, where it comes first, and how often.
class CountedFindings {
 public:
  explicit CountedFindings(XmlContext& context) : context_(context) {}

  void add(Severity severity, pugi::xml_node node, std::string const& sentence) {
    ++found_.try_emplace(sentence, Found{severity, node, 0}).first->second.count;
  }
  void report() {
    for (auto const& [sentence, of] : found_)
      context_.report(of.severity, of.first,
                      sentence + (of.count > 1 ? " (" + std::to_string(of.count) + " of them)" : ""));
  }

 private:
  struct Found {
    Severity severity;
    pugi::xml_node first;
    int count;
  };

  XmlContext& context_;
  std::map<std::string, Found> found_;  ///< by sentence
};

/// The nodes and ways of a Lanelet2 file, in metres.
class OsmWays {
  using Id = OsmId;

 public:
  OsmWays(XmlContext& context, CountedFindings& counted) : context_(context), counted_(counted) {}

  /// Throws `MapError` where a node has no place.
  void read(pugi::xml_node root, std::optional<Lanelet2Origin> const& origin) {
    read_nodes(root, origin);
    for_each_child(root, "way", [&](pugi::xml_node node) { read_way(node); });
  }

  /// The way of that id; null where there is none.
  [[nodiscard]] OsmWay const* find(Id id) const {
    auto const at = ways_.find(id);
    return at == ways_.end() ? nullptr : &at->second;
  }

  /// The middle between the ends of a way; nothing where it is not there, or has no nodes.
  [[nodiscard]] std::optional<Point> middle_of_ends(Id id) const {
    auto const* const way = find(id);
    if (way == nullptr || way->nodes.empty()) return std::nullopt;
    return 0.5 * (nodes_.at(way->nodes.front()) + nodes_.at(way->nodes.back()));
  }

  [[nodiscard]] std::vector<Point> points_of(OsmBound const& bound) const {
    std::vector<Point> points;
    for (auto const node : ways_.at(bound.way).nodes) points.push_back(nodes_.at(node));
    if (bound.reversed) std::reverse(points.begin(), points.end());
    return points;
  }
  /// The heights of a bound's points; none where one has none.
  [[nodiscard]] std::vector<double> heights_of(OsmBound const& bound) const {
    std::vector<double> heights;
    for (auto const node : ways_.at(bound.way).nodes) {
      auto const height = heights_.find(node);
      if (height == heights_.end()) return {};
      heights.push_back(height->second);
    }
    if (bound.reversed) std::reverse(heights.begin(), heights.end());
    return heights;
  }
  [[nodiscard]] Id end_node(OsmBound const& bound, bool at_end) const {
    auto const& nodes = ways_.at(bound.way).nodes;
    return at_end != bound.reversed ? nodes.back() : nodes.front();
  }

  /// Whether a vehicle may cross the line to its right side as `bound` runs, or to its left one: what its tags say,
  /// else its look (Lanelet2's GenericTrafficRules). Virtual lines are for junctions: nobody changes lanes there.
  [[nodiscard]] bool may_cross(OsmBound const& bound, bool to_right) const {
    auto const& way = ways_.at(bound.way);
    if (way.change) return *way.change;
    bool const rightwards = to_right != bound.reversed;  // as the way runs
    if (way.change_left || way.change_right) return (rightwards ? way.change_right : way.change_left).value_or(false);
    if (way.type != "line_thin" && way.type != "line_thick") return false;
    return way.subtype == "dashed" || way.subtype == (rightwards ? "dashed_solid" : "solid_dashed");
  }

 private:
  [[nodiscard]] std::string at(pugi::xml_node node) {
    return context_.file() + ":" + std::to_string(context_.line(node));
  }
  void warn(pugi::xml_node node, std::string sentence) {
    context_.report(Severity::warning, node, std::move(sentence));
  }

  /// The nodes of bounds: others do not say where a map lies.
  [[nodiscard]] static std::set<Id> nodes_of_lanelets(pugi::xml_node root) {
    std::set<Id> ways, nodes;
    for_each_child(root, "relation", [&](pugi::xml_node relation) {
      for_each_child(relation, "member", [&](pugi::xml_node member) {
        std::string_view const role = member.attribute("role").value();
        if (role != "left" && role != "right") return;
        if (auto const id = parse_number<Id>(member.attribute("ref").value())) ways.insert(*id);
      });
    });
    for_each_child(root, "way", [&](pugi::xml_node way) {
      auto const id = parse_number<Id>(way.attribute("id").value());
      if (!id || !ways.contains(*id)) return;
      for_each_child(way, "nd", [&](pugi::xml_node node) {
        if (auto const ref = parse_number<Id>(node.attribute("ref").value())) nodes.insert(*ref);
      });
    });
    return nodes;
  }

  void read_nodes(pugi::xml_node root, std::optional<Lanelet2Origin> const& given) {
    std::map<Id, Point> local, degrees;  // of these x is the longitude
    geometry::Box box;  // of the nodes that count; longitudes relative to the first one's turn of the globe
    auto const used = nodes_of_lanelets(root);
    std::optional<double> first;
    bool is_local = true;  // all nodes that count have local places
    for_each_child(root, "node", [&](pugi::xml_node node) {
      auto const id = osm_id(context_, node);
      if (!id) return;
      if (degrees.contains(*id))
        return warn(node, "node " + std::to_string(*id) + " is there already; the second one was left out");
      auto const x = parse_number<double>(osm_tag(node, "local_x")), y = parse_number<double>(osm_tag(node, "local_y"));
      if (x && y) local.emplace(*id, Point{*x, *y});
      if (auto const height = parse_number<double>(osm_tag(node, "ele"))) heights_.emplace(*id, *height);
      auto const latitude = parse_number<double>(node.attribute("lat").value()),
                 longitude = parse_number<double>(node.attribute("lon").value());
      bool const is_placed = latitude && longitude && std::abs(*latitude) <= 84.0 && std::abs(*longitude) <= 180.0;
      bool const counts = used.empty() || used.contains(*id);
      if (!is_placed && !(x && y) && !counts)
        return warn(node, "node " + std::to_string(*id) + " has no place; it was left out, for no bound needs it");
      if (!is_placed && !(x && y))
        throw MapError(at(node),
                       "node " + std::to_string(*id) +
                           " has no place: lat and lon are not both numbers of degrees within the UTM grid",
                       "repair the node, or give it tags local_x and local_y in metres");
      degrees.emplace(*id, is_placed ? Point{*longitude, *latitude} : Point{std::nan(""), std::nan("")});
      if (counts) is_local = is_local && x && y;
      if (!is_placed || !counts) return;
      first = first.value_or(*longitude);
      box.add(*first + std::remainder(*longitude - *first, 360.0), *latitude);
    });
    is_local_ = is_local && !local.empty();
    if (is_local_) return static_cast<void>(nodes_ = std::move(local));
    for (auto const& [id, place] : degrees)
      if (!place.allFinite() && (used.empty() || used.contains(id)))
        throw MapError(context_.file(),
                       "node " + std::to_string(id) + " has only a local place, and other nodes have none",
                       "give all nodes local_x and local_y, or all lat and lon");
    if (degrees.empty()) return;
    if (!local.empty())
      for (auto const& [id, place] : degrees)
        if (!local.contains(id)) {
          context_.report(Severity::warning, 0, "node",
                          "node " + std::to_string(id) +
                              " has no local_x and local_y, as others have: all places come from lat and lon");
          break;
        }
    if (!local.empty() && first && box.min_x == box.max_x && box.min_y == box.max_y)
      throw MapError(context_.file(),
                     "its nodes have no places: " + context_.found().back().sentence + ", which are all one",
                     "give all nodes of lanelets numbers as local_x and local_y");
    auto const origin = given.value_or(first ? middle_of(box) : Lanelet2Origin{});
    if (first) warn_if_far(box, origin);
    UtmProjection const projection(origin.latitude, origin.longitude);
    for (auto const& [id, place] : degrees)
      if (place.allFinite()) nodes_.emplace(id, projection(place.y(), place.x()));
  }

  /// The middle of a map [degrees]; (0, 0) for one near there.
  [[nodiscard]] static Lanelet2Origin middle_of(geometry::Box const& degrees) {
    constexpr double near = 0.9;  // [degrees], 100 km
    if (geometry::Box{-near, -near, near, near}.contains(degrees)) return {};
    return {.latitude = degrees.center().y(), .longitude = degrees.center().x()};
  }

  void warn_if_far(geometry::Box const& degrees, Lanelet2Origin const& origin) {
    constexpr double far = 100.0, of_degree = 111.2;  // [km]
    double const north = std::max(std::abs(degrees.max_y - origin.latitude), std::abs(degrees.min_y - origin.latitude)),
                 east = std::max(std::abs(std::remainder(degrees.max_x - origin.longitude, 360.0)),
                                 std::abs(std::remainder(degrees.min_x - origin.longitude, 360.0)));
    double const way = of_degree * portable::hypot(north, east * portable::cos(origin.latitude * geometry::pi / 180));
    if (way > far)
      context_.report(Severity::warning, 0, "node",
                      "places lie up to " + cambium::detail::rounded_text(std::round(way)) +
                          " km from the origin, where the projection distorts lengths; give one near the map");
  }

  void read_way(pugi::xml_node node) {
    auto const id = osm_id(context_, node);
    if (!id) return;
    OsmWay way{{}, std::string(osm_tag(node, "type")), std::string(osm_tag(node, "subtype"))};
    for (char const* key : {"lane_change", "lane_change:left", "lane_change:right"})
      if (auto const word = osm_tag(node, key); !word.empty() && !osm_truth(word))
        warn(node, "way " + std::to_string(*id) + ": " + key + "=" + std::string(word) +
                       " is neither yes nor no; it was left out");
    constexpr std::string_view looks[] = {"", "solid", "solid_solid", "dashed", "dashed_solid", "solid_dashed"};
    if ((way.type == "line_thin" || way.type == "line_thick") &&
        std::find(std::begin(looks), std::end(looks), way.subtype) == std::end(looks))
      counted_.add(Severity::warning, node,
                   "lines of the subtype " + way.subtype +
                       " are not known; nobody crosses one, unless its tag lane_change permits it");
    way.change = osm_truth(osm_tag(node, "lane_change"));
    way.change_left = osm_truth(osm_tag(node, "lane_change:left"));
    way.change_right = osm_truth(osm_tag(node, "lane_change:right"));
    if (!way.change && way.change_left.has_value() != way.change_right.has_value())
      warn(node, "way " + std::to_string(*id) + " has lane_change:" + (way.change_left ? "left" : "right") +
                     " without the other side; nobody changes lanes that way");
    for_each_child(node, "nd", [&](pugi::xml_node child) {
      auto const ref = context_.number<Id>(child, "ref");
      if (ref && nodes_.contains(*ref))
        way.nodes.push_back(*ref);
      else if (ref)
        warn(child, "way " + std::to_string(*id) + " names node " + std::to_string(*ref) +
                        ", which is not there, or has no place of the kind that bounds have (" +
                        (is_local_ ? "local_x and local_y" : "lat and lon") + "); it was left out");
    });
    if (!ways_.emplace(*id, std::move(way)).second)
      warn(node, "way " + std::to_string(*id) + " is there already; the second one was left out");
  }

  XmlContext& context_;
  CountedFindings& counted_;
  bool is_local_ = false;  ///< places are those of local_x and local_y
  std::map<Id, Point> nodes_;
  std::map<Id, double> heights_;  ///< of nodes that have one
  std::map<Id, OsmWay> ways_;
};

}  // namespace cambium::inline v0_1::map::detail
