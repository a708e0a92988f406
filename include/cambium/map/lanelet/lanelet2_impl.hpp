#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include <pugixml.hpp>

#include "cambium/core/error.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/map/lanelet/detail/lanelet_bounds.hpp"
#include "cambium/map/lanelet/detail/lanelet_tags.hpp"
#include "cambium/map/lanelet/detail/osm_ways.hpp"
#include "cambium/map/lanelet/lanelet2.hpp"
#include "cambium/map/lanes/signal_codes.hpp"
#include "cambium/map/opendrive/xml.hpp"

namespace cambium::map {

namespace detail {

/// Reads a Lanelet2 file, see `read_lanelet2`.
class Lanelet2Reader {
 public:
  Lanelet2Reader(std::string_view text, std::string const& file, std::vector<Diagnostic>& diagnostics)
      : context_(text, file, diagnostics), ways_(context_) {}

  [[nodiscard]] std::vector<Lanelet> read(pugi::xml_node root, std::optional<Lanelet2Origin> const& origin) {
    ways_.read(root, origin);
    for_each_child(root, "relation", [&](pugi::xml_node node) {
      if (osm_tag(node, "type") == "lanelet") read_lanelet(node);
    });
    link();
    for_each_child(root, "relation", [&](pugi::xml_node node) {
      if (osm_tag(node, "type") == "regulatory_element") read_rule(node);
    });
    report_missing_rules();
    set_priorities();
    report_unread();
    if (lanelets_.empty())
      throw MapError(context_.file(), "it has no usable lanelet",
                     "give a Lanelet2 map: relations with the tag type=lanelet and members left and right");
    std::vector<Lanelet> result;
    for (auto& read : lanelets_) result.push_back(std::move(read.lanelet));
    return result;
  }

 private:
  using Id = OsmId;

  void warn(pugi::xml_node node, std::string sentence) {
    context_.report(Severity::warning, node, std::move(sentence));
  }

  struct Read {
    Lanelet lanelet;
    OsmBound left, right;
    std::pair<Id, Id> begin, end;  ///< its nodes there, left and right
    std::vector<Id> rules;         ///< regulatory elements that it names
  };

  /// Calls `visit(member, ref)` for each member of a relation in `role` that is a `kind`: a way or a relation. Others
  /// have ids of their own, and are reported.
  template <class Visit>
  void for_each_member(pugi::xml_node node, std::string_view role, std::string_view kind, Visit const& visit) {
    for_each_child(node, "member", [&](pugi::xml_node member) {
      if (member.attribute("role").value() != role) return;
      if (std::string_view const type = member.attribute("type").value(); type != kind && !type.empty())
        return warn(member, "the member in the role " + std::string(role) + " is a " + std::string(type) + ", not a " +
                                std::string(kind) + "; it was left out");
      if (auto const ref = context_.number<Id>(member, "ref")) visit(member, *ref);
    });
  }

  /// The way that a relation has in `role`: the first; further ones are reported.
  [[nodiscard]] std::optional<Id> bound_way(pugi::xml_node node, std::string_view role) {
    std::optional<Id> found;
    for_each_member(node, role, "way", [&](pugi::xml_node member, Id ref) {
      if (found) return warn(member, "there is a second way in the role " + std::string(role) + "; it was left out");
      auto const* const way = ways_.find(ref);
      if (way == nullptr || way->nodes.size() < 2)
        return warn(member, "way " + std::to_string(ref) + " is not there, or has fewer than two nodes");
      found = ref;
    });
    return found;
  }

  void read_lanelet(pugi::xml_node node) {
    auto const id = osm_id(context_, node);
    if (!id) return;
    auto const word = osm_tag(node, "subtype");
    auto const* const subtype = lanelet_subtype(word);
    auto const type = lane_type_of(node, subtype);
    if (!type)
      return context_.report(Severity::info, node,
                             "lanelet " + std::to_string(*id) + " of the subtype " + std::string(word) +
                                 " is not for cars, buses, bicycles or pedestrians; it was left out");
    auto const left = bound_way(node, "left"), right = bound_way(node, "right");
    if (!left || !right) return warn(node, "lanelet " + std::to_string(*id) + " lacks a bound; it was left out");
    Read read;
    read.lanelet.id = *id;
    read.lanelet.line = context_.line(node);
    read.lanelet.type = *type;
    report_lanelet_tags(context_, node, *type);
    auto const one_way = osm_truth(osm_tag(node, "one_way:vehicle"));
    read.lanelet.both_directions =
        is_drivable(*type) && !one_way.value_or(osm_truth(osm_tag(node, "one_way")).value_or(true));
    read.lanelet.in_junction = !osm_tag(node, "turn_direction").empty();
    if (auto const limit = osm_tag(node, "speed_limit"); !limit.empty()) {
      read.lanelet.speed_limit = speed_of_text(limit);
      if (!read.lanelet.speed_limit) warn(node, "speed_limit=" + std::string(limit) + " is no speed; it was left out");
    }
    auto const* const usual = subtype != nullptr && is_drivable(subtype->type) ? subtype : lanelet_subtype("road");
    if (!read.lanelet.speed_limit && is_drivable(*type))
      read.lanelet.speed_limit = (osm_tag(node, "location") == "nonurban" ? usual->rural : usual->urban) / 3.6;
    set_bounds(read, *left, *right);
    for_each_member(node, "regulatory_element", "relation", [&](pugi::xml_node, Id ref) { read.rules.push_back(ref); });
    if (!places_.emplace(*id, lanelets_.size()).second)
      return warn(node, "lanelet " + std::to_string(*id) + " is there already; the second one was left out");
    for (auto const rule : read.rules) {
      auto& users = users_[rule].lanelets;
      if (users.empty() || users.back() != lanelets_.size()) users.push_back(lanelets_.size());
    }
    lanelets_.push_back(std::move(read));
  }

  void report_missing_rules() {
    for (auto const& [id, users] : users_)
      for (auto const i : users.lanelets)
        if (auto const& lanelet = lanelets_[i].lanelet; !users.rule_seen)
          context_.report(Severity::warning, lanelet.line, "relation",
                          "lanelet " + std::to_string(lanelet.id) + " names the rule " + std::to_string(id) +
                              ", which is not there");
  }

  /// Ways may be written either way round: the bounds are turned so that they run alike, left on the left.
  void set_bounds(Read& read, Id left, Id right) const {
    OsmBound l{left}, r{right};
    auto a = ways_.points_of(l), b = ways_.points_of(r);
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
    read.lanelet.left = ways_.points_of(l);
    read.lanelet.right = ways_.points_of(r);
    read.lanelet.left_heights = ways_.heights_of(l);
    read.lanelet.right_heights = ways_.heights_of(r);
    read.begin = {ways_.end_node(l, false), ways_.end_node(r, false)};
    read.end = {ways_.end_node(l, true), ways_.end_node(r, true)};
    read.lanelet.may_change_left = ways_.may_cross(l, false);
    read.lanelet.may_change_right = ways_.may_cross(r, true);
  }

  /// The lanelets that a regulatory element names in `role`.
  [[nodiscard]] std::vector<std::size_t> named(pugi::xml_node node, std::string_view role) {
    std::vector<std::size_t> found;
    for_each_member(node, role, "relation", [&](pugi::xml_node member, Id ref) {
      if (auto const place = places_.find(ref); place != places_.end())
        found.push_back(place->second);
      else
        warn(member,
             "lanelet " + std::to_string(ref) + " in the role " + std::string(role) + " is not there, or was left out");
    });
    return found;
  }

  /// How far before the lanelet's end the stop line of the element lies [m]: the one of `lines` next to its end. The
  /// whole length for a line behind its begin, as Autoware has for the lights of ways through junctions.
  [[nodiscard]] static double before_end(Lanelet const& lanelet, std::vector<Point> const& lines) {
    if (lines.empty() || fault_of_bound(lanelet.left) != nullptr || fault_of_bound(lanelet.right) != nullptr)
      return 0.0;
    FacingBounds const bounds(lanelet);
    Point const begin = bounds.middle(0.0), end = bounds.middle(1.0);
    Point const line = *std::min_element(
        lines.begin(), lines.end(), [&](auto const& a, auto const& b) { return (a - end).norm() < (b - end).norm(); });
    Point const way = bounds.middle(std::min(1.0, 1.0 / bounds.length())) - begin;  // over the first metre
    constexpr double farthest = 50.0;                                               // [m], else it is of another one
    if ((line - begin).dot(way) < 0.0 && (line - begin).norm() < std::min(farthest, (line - end).norm()))
      return bounds.length();
    return distance_before_end(lanelet, line);
  }

  /// The ways through the junction that a lanelet leads to: itself, where it lies inside.
  [[nodiscard]] std::vector<std::size_t> through_junction(std::vector<std::size_t> const& given) const {
    std::vector<std::size_t> ways;
    for (auto const i : given) {
      if (lanelets_[i].lanelet.in_junction)
        ways.push_back(i);
      else
        for (auto const next : lanelets_[i].lanelet.successors)
          if (auto const k = places_.at(next); lanelets_[k].lanelet.in_junction) ways.push_back(k);
    }
    return ways;
  }

  /// The lanelets at whose end a sign for lanelet `i` stands: those before the junction, where it lies inside.
  [[nodiscard]] std::vector<std::size_t> sign_places(std::size_t i) const {
    std::vector<std::size_t> approaches;
    if (lanelets_[i].lanelet.in_junction)
      for (auto const before : lanelets_[i].lanelet.predecessors)
        if (auto const k = places_.at(before); !lanelets_[k].lanelet.in_junction) approaches.push_back(k);
    return approaches.empty() ? std::vector{i} : approaches;
  }

  void read_rule(pugi::xml_node node) {
    auto const id = osm_id(context_, node);
    if (!id) return;
    auto const subtype = osm_tag(node, "subtype");
    auto const users = users_.try_emplace(*id).first;
    if (users->second.rule_seen)
      return warn(node, "rule " + std::to_string(*id) + " is there already; the second one was left out");
    users->second.rule_seen = true;
    auto const& subject = users->second.lanelets;
    for_each_member(node, "cancels", "way", [&](pugi::xml_node member, Id) {
      context_.report(Severity::info, member, "the role cancels is not read: signs hold for their lanelets");
    });
    bool const is_read = subtype == "right_of_way" || subtype == "all_way_stop" || subtype == "traffic_light" ||
                         subtype == "speed_limit" || subtype == "traffic_sign";
    if (!is_read)
      return static_cast<void>(++unread_.try_emplace(std::string(subtype), Unread{node, 0}).first->second.count);
    if (subject.empty())
      return warn(node, "no lanelet refers to the rule " + std::to_string(*id) + "; it was left out");
    auto const lines = stop_lines(node);
    auto const give = [&](std::vector<std::size_t> const& to, SignalKind kind, std::string const& light = {}) {
      for (auto const i : to)
        for (auto const k : kind == SignalKind::light ? std::vector{i} : sign_places(i)) {
          LaneletSignal const signal{kind, before_end(lanelets_[k].lanelet, lines), light};
          auto& signals = lanelets_[k].lanelet.signals;
          if (std::find(signals.begin(), signals.end(), signal) == signals.end()) signals.push_back(signal);
        }
    };
    if (subtype == "right_of_way") {
      auto const first = named(node, "right_of_way"), yielding = named(node, "yield");
      auto const is_inside = [&](std::size_t i) { return lanelets_[i].lanelet.in_junction; };
      bool const first_inside = !first.empty() && std::all_of(first.begin(), first.end(), is_inside);
      if (yielding.empty() && (first.empty() || first_inside))
        return warn(node, "nobody yields by it; it was left out");
      auto const ways = through_junction(first), waiting = through_junction(yielding);
      bool const any_inside = first_inside || std::any_of(yielding.begin(), yielding.end(), is_inside);
      if (any_inside && !ways.empty() && !waiting.empty()) {
        for (auto const i : ways)
          for (auto const k : waiting) go_before_.emplace(i, k);
      } else {
        give(first, SignalKind::priority);
        give(yielding, SignalKind::give_way);
      }
    } else if (subtype == "all_way_stop") {
      auto const yielding = named(node, "yield");
      give(yielding.empty() ? subject : yielding, SignalKind::stop);
    } else if (subtype == "traffic_light") {
      give(subject, SignalKind::light, light_of(node, *id));
    } else if (subtype == "speed_limit") {
      auto const limit = sign_speed(node);
      if (!limit)
        return warn(node,
                    "neither its sign nor its sign_type is a speed, such as de274-50 or \"50 km/h\"; it was left out");
      for (auto const i : subject) lanelets_[i].lanelet.speed_limit = limit;
    } else if (auto const kind = sign_of(node)) {
      give(subject, *kind);
    }
  }

  /// The name of the light: elements with the same heads are one.
  [[nodiscard]] std::string light_of(pugi::xml_node node, Id id) {
    std::vector<Id> heads;
    for_each_member(node, "refers", "way", [&](pugi::xml_node member, Id ref) {
      heads.push_back(ref);
      if (ways_.find(ref) == nullptr) warn(member, "way " + std::to_string(ref) + " in the role refers is not there");
    });
    std::sort(heads.begin(), heads.end());
    if (heads.empty()) return std::to_string(id);
    return lights_.try_emplace(std::move(heads), std::to_string(id)).first->second;
  }

  /// What the elements of right of way between ways through junctions say. Autoware lists there whom a way may ignore,
  /// often in both directions, and beside lights: only a pair without its reverse, and without lights, is a priority.
  void set_priorities() {
    std::size_t both_ways = 0;
    auto const has_light = [&](std::size_t i) {
      auto const& signals = lanelets_[i].lanelet.signals;
      return std::any_of(signals.begin(), signals.end(),
                         [](LaneletSignal const& signal) { return signal.kind == SignalKind::light; });
    };
    auto const is_lit = [&](std::size_t i) {  // by its own light, or one on the way to it
      auto const& before = lanelets_[i].lanelet.predecessors;
      return has_light(i) ||
             std::any_of(before.begin(), before.end(), [&](Id id) { return has_light(places_.at(id)); });
    };
    for (auto const& [first, second] : go_before_)
      if (go_before_.contains({second, first}))
        both_ways += first < second ? 1 : 0;
      else if (!is_lit(first) || !is_lit(second))
        lanelets_[first].lanelet.goes_before.push_back(lanelets_[second].lanelet.id);
    if (both_ways > 0)
      context_.report(
          Severity::warning, 0, "relation",
          std::to_string(both_ways) + " pairs of lanelets each have priority over the other; both rules were ignored");
  }

  void report_unread() {
    for (auto const& [subtype, unread] : unread_)
      context_.report(Severity::info, unread.node,
                      (subtype.empty() ? "rules without a subtype" : "rules of the subtype " + subtype) +
                          " are not read: " + std::to_string(unread.count));
  }

  /// The places of an element's stop lines: the middles of the ways in the role ref_line.
  [[nodiscard]] std::vector<Point> stop_lines(pugi::xml_node node) {
    std::vector<Point> lines;
    for_each_member(node, "ref_line", "way", [&](pugi::xml_node member, Id ref) {
      if (auto const middle = ways_.middle_of_ends(ref))
        lines.push_back(*middle);
      else
        warn(member, "way " + std::to_string(ref) + " in the role ref_line is not there, or has no nodes");
    });
    return lines;
  }

  /// Calls `visit(code)` for each sign of an element: its subtype, a country and a number of its catalogue, as de205.
  template <class Visit>
  void for_each_sign(pugi::xml_node node, Visit const& visit) {
    for_each_member(node, "refers", "way", [&](pugi::xml_node member, Id ref) {
      if (auto const* const way = ways_.find(ref))
        visit(std::string_view(way->subtype));
      else
        warn(member, "way " + std::to_string(ref) + " in the role refers is not there");
    });
  }

  [[nodiscard]] std::optional<SignalKind> sign_of(pugi::xml_node node) {
    std::optional<SignalKind> kind;
    for_each_sign(node, [&](std::string_view code) {
      auto const* const known = find_signal_code(code.substr(0, 2), code.size() > 2 ? code.substr(2) : code, "");
      if (known == nullptr && code.starts_with("de274"))
        return warn(node, "its sign " + std::string(code) +
                              " is a speed, which only an element of the subtype speed_limit sets; it was left out");
      if (known == nullptr) return warn(node, "its sign " + std::string(code) + " is not known; it was left out");
      if (auto const found = kind_of(known->meaning); found && found != SignalKind::light) kind = found;
    });
    return kind;
  }

  /// The limit of a speed element: that of its sign (German ones), else its sign_type. [m/s]
  [[nodiscard]] std::optional<double> sign_speed(pugi::xml_node node) {
    std::optional<double> limit;
    for_each_sign(node, [&](std::string_view code) {
      if (code.starts_with("de274-")) limit = speed_of_text(code.substr(6));
      if (code.starts_with("de274_1") || code.starts_with("de274.1")) limit = 30.0 / 3.6;  // a zone
      if (code == "de310") limit = 50.0 / 3.6;
    });
    return limit ? limit : speed_of_text(osm_tag(node, "sign_type"));
  }

  /// Who follows whom, and who lies beside whom.
  void link() {
    std::multimap<std::pair<Id, Id>, std::size_t> begins;
    std::map<std::pair<bool, OsmBound>, std::size_t> by_left;  // drivable lanes, and the others beside them
    for (std::size_t i = 0; i < lanelets_.size(); ++i) {
      begins.emplace(lanelets_[i].begin, i);
      by_left.try_emplace({is_drivable(lanelets_[i].lanelet.type), lanelets_[i].left}, i);
    }
    for (auto& read : lanelets_) {
      auto const [first, last] = begins.equal_range(read.end);
      for (auto next = first; next != last; ++next) {
        auto& other = lanelets_[next->second].lanelet;
        if (is_drivable(other.type) != is_drivable(read.lanelet.type)) continue;
        read.lanelet.successors.push_back(other.id);
        other.predecessors.push_back(read.lanelet.id);
      }
      auto const beside = by_left.find({is_drivable(read.lanelet.type), read.right});
      if (beside == by_left.end() || lanelets_[beside->second].lanelet.id == read.lanelet.id) continue;
      auto& other = lanelets_[beside->second].lanelet;
      if (other.left_neighbor) continue;
      read.lanelet.right_neighbor = other.id;
      other.left_neighbor = read.lanelet.id;
    }
  }

  /// Rules of a subtype that is not read: the first, and how many.
  struct Unread {
    pugi::xml_node node;
    int count = 0;
  };

  /// The lanelets that name a rule, and whether the file has it.
  struct Users {
    std::vector<std::size_t> lanelets;
    bool rule_seen = false;
  };

  XmlContext context_;
  OsmWays ways_;
  std::map<Id, Users> users_;
  std::map<std::string, Unread> unread_;
  std::map<std::vector<Id>, std::string> lights_;            ///< by their heads
  std::set<std::pair<std::size_t, std::size_t>> go_before_;  ///< pairs of lanelets, as the elements say
  std::vector<Read> lanelets_;
  std::map<Id, std::size_t> places_;
};

}  // namespace detail

CAMBIUM_COLD std::vector<Lanelet> read_lanelet2(std::string_view text, std::optional<Lanelet2Origin> const& origin,
                                                std::string const& file, std::vector<Diagnostic>& diagnostics) {
  if (origin) check_parameters(*origin, file);
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  pugi::xml_document xml;
  auto const root = detail::parse_root(xml, text, file, "osm", "give a Lanelet2 map in OSM's XML (.osm)");
  return detail::Lanelet2Reader(text, file, diagnostics).read(root, origin);
}

CAMBIUM_COLD LaneletMap load_lanelet2(std::string const& path, std::optional<Lanelet2Origin> const& origin,
                                      MapOptions const& options) {
  std::vector<Diagnostic> diagnostics;
  auto lanelets =
      read_lanelet2(detail::read_map_file(path, "give a Lanelet2 map in OSM's XML (.osm)"), origin, path, diagnostics);
  auto result = build_lanelet_map(std::move(lanelets), options, path);
  result.diagnostics.insert(result.diagnostics.begin(), diagnostics.begin(), diagnostics.end());
  return result;
}

}  // namespace cambium::map
