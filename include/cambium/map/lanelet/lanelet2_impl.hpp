#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>

#include <pugixml.hpp>

#include "cambium/core/error.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/core/text.hpp"
#include "cambium/map/lanelet/detail/lanelet_bounds.hpp"
#include "cambium/map/lanelet/detail/utm.hpp"
#include "cambium/map/lanelet/lanelet2.hpp"
#include "cambium/map/opendrive/xml.hpp"

namespace cambium::map {

namespace detail {

/// Reads a Lanelet2 file, see `read_lanelet2`.
class Lanelet2Reader {
 public:
  Lanelet2Reader(std::string_view text, std::string const& file, std::vector<Diagnostic>& diagnostics)
      : context_(text, file, diagnostics) {}

  [[nodiscard]] std::vector<Lanelet> read(pugi::xml_node root, Lanelet2Origin const& origin) {
    read_nodes(root, UtmProjection(origin.latitude, origin.longitude));
    for_each_child(root, "way", [&](pugi::xml_node node) { read_way(node); });
    for_each_child(root, "relation", [&](pugi::xml_node node) {
      if (tag(node, "type") == "lanelet") read_lanelet(node);
    });
    for_each_child(root, "relation", [&](pugi::xml_node node) {
      if (tag(node, "type") == "regulatory_element") read_rule(node);
    });
    link();
    if (lanelets_.empty())
      throw MapError(context_.file(), "it has no usable lanelet",
                     "give a Lanelet2 map: relations with the tag type=lanelet and members left and right");
    std::vector<Lanelet> result;
    for (auto& read : lanelets_) result.push_back(std::move(read.lanelet));
    return result;
  }

 private:
  using Id = std::int64_t;

  struct Way {
    std::vector<Id> nodes;
    std::string type, subtype;
  };
  /// A bound: the way, and the way round in which the lanelet has it.
  struct Bound {
    Id way{};
    bool reversed = false;
    friend auto operator<=>(Bound const&, Bound const&) = default;
  };
  struct Read {
    Lanelet lanelet;
    Bound left, right;
    std::pair<Id, Id> begin, end;  ///< its nodes there, left and right
    std::vector<Id> rules;         ///< regulatory elements that it names
  };

  [[nodiscard]] static std::string_view tag(pugi::xml_node node, std::string_view key) {
    for (auto child = node.first_child(); child; child = child.next_sibling())
      if (local_name(child) == "tag" && child.attribute("k").value() == key) return child.attribute("v").value();
    return {};
  }

  [[nodiscard]] std::string at(pugi::xml_node node) {
    return context_.file() + ":" + std::to_string(context_.line(node));
  }
  void warn(pugi::xml_node node, std::string sentence) {
    context_.report(Severity::warning, node, std::move(sentence));
  }

  /// The element's id; nothing, with a finding, where it is no whole number, or the element is marked as deleted.
  [[nodiscard]] std::optional<Id> id_of(pugi::xml_node node) {
    if (std::string_view(node.attribute("action").value()) == "delete") return std::nullopt;
    auto const id = context_.number<Id>(node, "id");
    if (!id) warn(node, "it was left out");
    return id;
  }

  void read_nodes(pugi::xml_node root, UtmProjection const& projection) {
    std::map<Id, Point> local;
    for_each_child(root, "node", [&](pugi::xml_node node) {
      auto const id = id_of(node);
      if (!id) return;
      auto const x = parse_number<double>(tag(node, "local_x")), y = parse_number<double>(tag(node, "local_y"));
      if (x && y) local.emplace(*id, Point{*x, *y});
      auto const latitude = parse_number<double>(node.attribute("lat").value()),
                 longitude = parse_number<double>(node.attribute("lon").value());
      Point const place = latitude && longitude && std::abs(*latitude) <= 84.0 && std::abs(*longitude) <= 180.0
                              ? projection(*latitude, *longitude)
                              : Point{std::nan(""), std::nan("")};
      if (!place.allFinite() && !(x && y))
        throw MapError(at(node),
                       "node " + std::to_string(*id) +
                           " has no place: lat and lon are not both numbers of degrees within the UTM grid",
                       "repair the node, or give it tags local_x and local_y in metres");
      nodes_.emplace(*id, place);
    });
    if (!local.empty() && local.size() == nodes_.size()) nodes_ = std::move(local);
    for (auto const& [id, place] : nodes_)
      if (!place.allFinite())
        throw MapError(context_.file(),
                       "node " + std::to_string(id) + " has only a local place, and other nodes have none",
                       "give all nodes local_x and local_y, or all lat and lon");
  }

  void read_way(pugi::xml_node node) {
    auto const id = id_of(node);
    if (!id) return;
    Way way{{}, std::string(tag(node, "type")), std::string(tag(node, "subtype"))};
    for_each_child(node, "nd", [&](pugi::xml_node child) {
      auto const ref = context_.number<Id>(child, "ref");
      if (ref && nodes_.contains(*ref))
        way.nodes.push_back(*ref);
      else if (ref)
        warn(child, "way " + std::to_string(*id) + " names node " + std::to_string(*ref) +
                        ", which is not there; it was left out");
    });
    ways_.emplace(*id, std::move(way));
  }

  [[nodiscard]] std::vector<Point> points_of(Bound const& bound) const {
    std::vector<Point> points;
    for (auto const node : ways_.at(bound.way).nodes) points.push_back(nodes_.at(node));
    if (bound.reversed) std::reverse(points.begin(), points.end());
    return points;
  }
  [[nodiscard]] Id end_node(Bound const& bound, bool at_end) const {
    auto const& nodes = ways_.at(bound.way).nodes;
    return at_end != bound.reversed ? nodes.back() : nodes.front();
  }

  /// Calls `visit(member, ref)` for each member of a relation in `role`.
  template <class Visit>
  void for_each_member(pugi::xml_node node, std::string_view role, Visit const& visit) {
    for_each_child(node, "member", [&](pugi::xml_node member) {
      if (member.attribute("role").value() != role) return;
      if (auto const ref = context_.number<Id>(member, "ref")) visit(member, *ref);
    });
  }

  /// The way that a relation has in `role`: the first; further ones are reported.
  [[nodiscard]] std::optional<Id> bound_way(pugi::xml_node node, std::string_view role) {
    std::optional<Id> found;
    for_each_member(node, role, [&](pugi::xml_node member, Id ref) {
      if (found) return warn(member, "there is a second way in the role " + std::string(role) + "; it was left out");
      auto const way = ways_.find(ref);
      if (way == ways_.end() || way->second.nodes.size() < 2)
        return warn(member, "way " + std::to_string(ref) + " is not there, or has fewer than two nodes");
      found = ref;
    });
    return found;
  }

  [[nodiscard]] static std::optional<LaneType> type_of(std::string_view subtype) {
    constexpr std::pair<std::string_view, LaneType> types[] = {
        {"", LaneType::driving},        {"road", LaneType::driving},
        {"highway", LaneType::driving}, {"play_street", LaneType::driving},
        {"exit", LaneType::driving},    {"emergency_lane", LaneType::shoulder},
        {"bus_lane", LaneType::bus},    {"bicycle_lane", LaneType::biking},
        {"walkway", LaneType::walking}, {"shared_walkway", LaneType::walking},
        {"parking", LaneType::parking}};
    for (auto const& [word, type] : types)
      if (word == subtype) return type;
    return std::nullopt;
  }

  /// A speed as "50", "50 km/h", "30 mph" or "13.9 m/s"; km/h without a unit. [m/s]
  [[nodiscard]] static std::optional<double> speed_of(std::string_view text) {
    text = trimmed(text);
    auto const number_end = std::min(text.find_first_not_of("0123456789."), text.size());
    auto const value = parse_number<double>(text.substr(0, number_end));
    auto const unit = trimmed(text.substr(number_end));
    if (!value || !(*value > 0.0)) return std::nullopt;
    if (unit.empty() || unit == "km/h" || unit == "kmh" || unit == "kph") return *value / 3.6;
    if (unit == "mph") return *value * 0.44704;
    if (unit == "m/s" || unit == "mps") return value;
    return std::nullopt;
  }

  void read_lanelet(pugi::xml_node node) {
    auto const id = id_of(node);
    if (!id) return;
    auto const subtype = tag(node, "subtype");
    auto const type = type_of(subtype);
    if (!type)
      return context_.report(Severity::info, node,
                             "a lanelet of the subtype " + std::string(subtype) + " is no lane here; it was left out");
    auto const left = bound_way(node, "left"), right = bound_way(node, "right");
    if (!left || !right) return warn(node, "lanelet " + std::to_string(*id) + " lacks a bound; it was left out");
    Read read;
    read.lanelet.id = *id;
    read.lanelet.line = context_.line(node);
    read.lanelet.type = *type;
    read.lanelet.both_directions = tag(node, "one_way") == "no" && is_drivable(*type);
    read.lanelet.in_junction = !tag(node, "turn_direction").empty();
    if (auto const limit = tag(node, "speed_limit"); !limit.empty()) {
      read.lanelet.speed_limit = speed_of(limit);
      if (!read.lanelet.speed_limit) warn(node, "speed_limit=" + std::string(limit) + " is no speed; it was left out");
    }
    set_bounds(read, *left, *right);
    for_each_member(node, "regulatory_element", [&](pugi::xml_node, Id ref) { read.rules.push_back(ref); });
    if (!places_.emplace(*id, lanelets_.size()).second)
      return warn(node, "lanelet " + std::to_string(*id) + " is there already; the second one was left out");
    lanelets_.push_back(std::move(read));
  }

  /// Ways may be written either way round: the bounds are turned so that they run alike, left on the left.
  void set_bounds(Read& read, Id left, Id right) const {
    Bound l{left}, r{right};
    auto a = points_of(l), b = points_of(r);
    auto const apart = [](Point const& p, Point const& q) { return (p - q).norm(); };
    if (apart(a.front(), b.front()) + apart(a.back(), b.back()) >
        apart(a.front(), b.back()) + apart(a.back(), b.front())) {
      r.reversed = true;
      std::reverse(b.begin(), b.end());
    }
    if (twice_area_between(a, b) > 0.0) {
      l.reversed = !l.reversed;
      r.reversed = !r.reversed;
    }
    read.left = l;
    read.right = r;
    read.lanelet.left = points_of(l);
    read.lanelet.right = points_of(r);
    read.begin = {end_node(l, false), end_node(r, false)};
    read.end = {end_node(l, true), end_node(r, true)};
    read.lanelet.may_change_left = may_cross(l, false);
    read.lanelet.may_change_right = may_cross(r, true);
  }

  /// Whether the line may be crossed, from its left side or from its right one as `bound` runs.
  [[nodiscard]] bool may_cross(Bound const& bound, bool from_left) const {
    auto const& way = ways_.at(bound.way);
    if (way.type == "virtual" || way.type.empty() || way.subtype == "dashed") return true;
    if (way.type != "line_thin" && way.type != "line_thick") return false;  // kerbs, borders, fences
    // "solid_dashed": solid on the left, as the way runs. The line that is nearer counts.
    bool const on_left = from_left != bound.reversed;
    if (way.subtype == "solid_dashed") return !on_left;
    if (way.subtype == "dashed_solid") return on_left;
    return way.subtype != "solid" && way.subtype != "solid_solid";
  }

  /// The lanelets that a regulatory element names in `role`.
  [[nodiscard]] std::vector<std::size_t> named(pugi::xml_node node, std::string_view role) {
    std::vector<std::size_t> found;
    for_each_member(node, role, [&](pugi::xml_node, Id ref) {
      if (auto const place = places_.find(ref); place != places_.end()) found.push_back(place->second);
    });
    return found;
  }

  /// How far before the lanelet's end the stop line of the element lies [m]: the one of `lines` next to its end.
  [[nodiscard]] double before_end(Lanelet const& lanelet, std::vector<Point> const& lines) const {
    Rail const left(evened(lanelet.left)), right(evened(lanelet.right));
    if (left.points.size() < 2 || right.points.size() < 2) return 0.0;
    double const length = 0.5 * (left.length() + right.length());
    Point const end = 0.5 * (left.points.back() + right.points.back()),
                begin = 0.5 * (left.points.front() + right.points.front());
    double best = 0.0, nearest = 1e300;
    for (auto const& line : lines) {
      double const to_end = (line - end).norm();
      if (to_end >= nearest) continue;
      nearest = to_end;
      best = (line - begin).norm() <= length ? std::min(to_end, length) : 0.0;
    }
    return best;
  }

  void read_rule(pugi::xml_node node) {
    auto const id = id_of(node);
    if (!id) return;
    auto const subtype = tag(node, "subtype");
    std::vector<std::size_t> subject;
    for (std::size_t i = 0; i < lanelets_.size(); ++i)
      if (std::find(lanelets_[i].rules.begin(), lanelets_[i].rules.end(), *id) != lanelets_[i].rules.end())
        subject.push_back(i);
    auto const lines = stop_lines(node);
    auto const give = [&](std::vector<std::size_t> const& to, SignalKind kind, std::string const& light = {}) {
      for (auto const i : to)
        lanelets_[i].lanelet.signals.push_back({kind, before_end(lanelets_[i].lanelet, lines), light});
    };
    if (subtype == "right_of_way") {
      give(named(node, "right_of_way"), SignalKind::priority);
      give(named(node, "yield"), SignalKind::give_way);
    } else if (subtype == "all_way_stop") {
      auto const yielding = named(node, "yield");
      give(yielding.empty() ? subject : yielding, SignalKind::stop);
    } else if (subtype == "traffic_light") {
      give(subject, SignalKind::light, std::to_string(*id));
    } else if (subtype == "speed_limit") {
      auto const limit = speed_of(tag(node, "sign_type"));
      if (!limit) return warn(node, "its sign_type is no speed, such as \"50 km/h\"; it was left out");
      for (auto const i : subject) lanelets_[i].lanelet.speed_limit = limit;
    } else if (subtype == "traffic_sign") {
      if (auto const kind = sign_of(node)) give(subject, *kind);
    } else {
      context_.report(Severity::info, node, "a rule of the subtype " + std::string(subtype) + " was left out");
    }
  }

  /// The places of an element's stop lines: the middles of the ways in the role ref_line.
  [[nodiscard]] std::vector<Point> stop_lines(pugi::xml_node node) {
    std::vector<Point> lines;
    for_each_member(node, "ref_line", [&](pugi::xml_node, Id ref) {
      auto const way = ways_.find(ref);
      if (way == ways_.end() || way->second.nodes.empty()) return;
      lines.push_back(0.5 * (nodes_.at(way->second.nodes.front()) + nodes_.at(way->second.nodes.back())));
    });
    return lines;
  }

  /// What a sign of the element says: its subtype is a country and a number of its catalogue, such as de205.
  [[nodiscard]] std::optional<SignalKind> sign_of(pugi::xml_node node) {
    std::optional<SignalKind> kind;
    for_each_member(node, "refers", [&](pugi::xml_node, Id ref) {
      auto const way = ways_.find(ref);
      if (way == ways_.end()) return;
      auto const& word = way->second.subtype;
      if (word == "de205" || word == "usR1-2") kind = SignalKind::give_way;
      if (word == "de206" || word == "usR1-1") kind = SignalKind::stop;
      if (word == "de301" || word == "de306") kind = SignalKind::priority;
    });
    return kind;
  }

  /// Who follows whom, and who lies beside whom.
  void link() {
    std::multimap<std::pair<Id, Id>, std::size_t> begins;
    std::map<Bound, std::size_t> by_left;
    for (std::size_t i = 0; i < lanelets_.size(); ++i) {
      begins.emplace(lanelets_[i].begin, i);
      by_left.try_emplace(lanelets_[i].left, i);
    }
    for (auto& read : lanelets_) {
      auto const [first, last] = begins.equal_range(read.end);
      for (auto next = first; next != last; ++next) {
        auto& other = lanelets_[next->second].lanelet;
        if (is_drivable(other.type) != is_drivable(read.lanelet.type)) continue;
        read.lanelet.successors.push_back(other.id);
        other.predecessors.push_back(read.lanelet.id);
      }
      auto const beside = by_left.find(read.right);
      if (beside == by_left.end() || lanelets_[beside->second].lanelet.id == read.lanelet.id) continue;
      auto& other = lanelets_[beside->second].lanelet;
      if (other.left_neighbor) continue;
      read.lanelet.right_neighbor = other.id;
      other.left_neighbor = read.lanelet.id;
    }
  }

  XmlContext context_;
  std::map<Id, Point> nodes_;
  std::map<Id, Way> ways_;
  std::vector<Read> lanelets_;
  std::map<Id, std::size_t> places_;
};

}  // namespace detail

CAMBIUM_COLD std::vector<Lanelet> read_lanelet2(std::string_view text, Lanelet2Origin const& origin,
                                                std::string const& file, std::vector<Diagnostic>& diagnostics) {
  check_parameters(origin, file);
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  pugi::xml_document xml;
  auto const root = detail::parse_root(xml, text, file, "osm", "give a Lanelet2 map in OSM's XML (.osm)");
  return detail::Lanelet2Reader(text, file, diagnostics).read(root, origin);
}

CAMBIUM_COLD LaneletMap load_lanelet2(std::string const& path, Lanelet2Origin const& origin,
                                      MapOptions const& options) {
  std::vector<Diagnostic> diagnostics;
  auto lanelets =
      read_lanelet2(detail::read_map_file(path, "give a Lanelet2 map in OSM's XML (.osm)"), origin, path, diagnostics);
  auto result = build_lanelet_map(std::move(lanelets), options, path);
  result.diagnostics.insert(result.diagnostics.begin(), diagnostics.begin(), diagnostics.end());
  return result;
}

}  // namespace cambium::map
