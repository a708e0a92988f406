#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include <pugixml.hpp>

#include "cambium/core/error.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/map/lanelet/detail/lanelet_bounds.hpp"
#include "cambium/map/lanelet/detail/osm_lanelets.hpp"
#include "cambium/map/lanelet/lanelet2.hpp"
#include "cambium/map/lanes/signal_codes.hpp"
#include "cambium/map/opendrive/xml.hpp"

namespace cambium::inline v0_1::map {

namespace detail {

/// Reads a Lanelet2 file, see `read_lanelet2`.
class Lanelet2Reader : private OsmLanelets {
 public:
  using OsmLanelets::OsmLanelets;

  [[nodiscard]] std::vector<Lanelet> read(pugi::xml_node root, std::optional<Lanelet2Origin> const& origin) {
    read_lanelets(root, origin);
    for_each_child(root, "relation", [&](pugi::xml_node node) {
      if (osm_tag(node, "type") == "regulatory_element") read_rule(node);
    });
    report_missing_rules();
    set_priorities();
    counted_.report();
    if (lanelets_.empty())
      throw MapError(context_.file(), "it has no usable lanelet" + likely_cause(context_.found()),
                     "give a Lanelet2 map: relations with the tag type=lanelet and members left and right");
    std::vector<Lanelet> result;
    for (auto& read : lanelets_) result.push_back(std::move(read.lanelet));
    return result;
  }

 private:
  void report_missing_rules() {
    for (auto const& [id, users] : users_)
      for (auto const i : users.lanelets)
        if (auto const& lanelet = lanelets_[i].lanelet; !users.rule_seen)
          context_.report(Severity::warning, lanelet.line, "relation",
                          "lanelet " + std::to_string(lanelet.id) + " names the rule " + std::to_string(id) +
                              ", which is not there");
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
    constexpr std::string_view read[] = {"right_of_way", "all_way_stop", "traffic_light", "speed_limit",
                                         "traffic_sign"};
    if (std::find(std::begin(read), std::end(read), subtype) == std::end(read))
      return counted_.add(Severity::info, node,
                          subtype.empty() ? "rules without a subtype are not read"
                                          : "rules of the subtype " + std::string(subtype) + " are not read");
    count_other_roles(node, "rules", {"refers", "ref_line", "right_of_way", "yield"});
    if (subject.empty())
      return warn(node, "no lanelet refers to the rule " + std::to_string(*id) + "; it was left out");
    if (subtype == "right_of_way") {
      read_right_of_way(node);
    } else if (subtype == "all_way_stop") {
      auto const yielding = named(node, "yield");
      give(node, yielding.empty() ? subject : yielding, SignalKind::stop);
    } else if (subtype == "traffic_light") {
      give(node, subject, SignalKind::light, light_of(node, *id));
    } else if (subtype == "speed_limit") {
      auto const limit = sign_speed(node);
      if (!limit)
        return warn(node,
                    "neither its sign nor its sign_type is a speed, such as de274-50 or \"50 km/h\"; it was left out");
      for (auto const i : subject) {
        if (auto const [known, is_new] = limits_.emplace(i, *limit); !is_new && known->second != *limit)
          warn(node,
               "lanelet " + std::to_string(lanelets_[i].lanelet.id) + " has another limit already; this one counts");
        lanelets_[i].lanelet.speed_limit = limit;
      }
    } else {
      for (auto const kind : signs_of(node)) give(node, subject, kind);
    }
  }

  /// Gives a sign or light of an element to lanelets, at its stop line.
  void give(pugi::xml_node node, std::vector<std::size_t> const& to, SignalKind kind, std::string const& light = {}) {
    auto const lines = stop_lines(node);
    for (auto const i : to)
      for (auto const k : kind == SignalKind::light ? std::vector{i} : sign_places(i)) {
        LaneletSignal const signal{kind, before_end(lanelets_[k].lanelet, lines), light};
        auto& signals = lanelets_[k].lanelet.signals;
        if (std::find(signals.begin(), signals.end(), signal) == signals.end()) signals.push_back(signal);
      }
  }

  /// Right of way of ways inside a junction is theirs; else it becomes signs. Those that yield at a stop sign stop.
  void read_right_of_way(pugi::xml_node node) {
    auto const first = named(node, "right_of_way"), yielding = named(node, "yield");
    auto const is_inside = [&](std::size_t i) { return lanelets_[i].lanelet.in_junction; };
    bool const first_inside = !first.empty() && std::all_of(first.begin(), first.end(), is_inside);
    if (yielding.empty() && (first.empty() || first_inside)) return warn(node, "nobody yields by it; it was left out");
    auto const ways = through_junction(first), waiting = through_junction(yielding);
    bool const any_inside = first_inside || std::any_of(yielding.begin(), yielding.end(), is_inside);
    bool const holds_inside = any_inside && !ways.empty() && !waiting.empty();
    if (holds_inside)
      for (auto const i : ways)
        for (auto const k : waiting) go_before_.emplace(i, k);
    else
      give(node, first, SignalKind::priority);
    if (signs_of(node).contains(SignalKind::stop))
      give(node, yielding, SignalKind::stop);
    else if (!holds_inside)
      give(node, yielding, SignalKind::give_way);
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

  /// What its signs say about who goes first.
  [[nodiscard]] std::set<SignalKind> signs_of(pugi::xml_node node) {
    std::set<SignalKind> kinds;
    for_each_sign(node, [&](std::string_view code) {
      auto const sense = find_signal(code.substr(0, 2), code.size() > 2 ? code.substr(2) : code, "");
      auto const kind = sense ? kind_of(sense->meaning) : std::nullopt;
      auto const name = "its sign " + std::string(code);
      if (kind && kind != SignalKind::light)
        kinds.insert(*kind);
      else if (!sense && !code.starts_with("de274"))
        warn(node, name + " is not known; it was left out");
      else if (!sense || sense->meaning == SignalMeaning::speed_limit)
        warn(node, name + " is a speed, which only an element of the subtype speed_limit sets; it was left out");
      else
        counted_.add(Severity::info, node,
                     "signs " + std::string(code) + " have no effect: only those of priority and speed have");
    });
    return kinds;
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

  std::map<std::vector<Id>, std::string> lights_;            ///< by their heads
  std::map<std::size_t, double> limits_;                     ///< of lanelets, by the elements [m/s]
  std::set<std::pair<std::size_t, std::size_t>> go_before_;  ///< pairs of lanelets, as the elements say
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
  return build_lanelet_map(std::move(lanelets), options, path, std::move(diagnostics));
}

}  // namespace cambium::inline v0_1::map
