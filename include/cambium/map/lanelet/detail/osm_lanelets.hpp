#pragma once

#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <pugixml.hpp>

#include "cambium/core/diagnostic.hpp"
#include "cambium/map/lanelet/detail/lanelet_bounds.hpp"
#include "cambium/map/lanelet/detail/lanelet_tags.hpp"
#include "cambium/map/lanelet/detail/osm_ways.hpp"
#include "cambium/map/lanelet/lanelet.hpp"
#include "cambium/map/opendrive/xml.hpp"

namespace cambium::inline v0_1::map::detail {

/// The lanelets of a Lanelet2 file, without the rules that they name.
class OsmLanelets {
 public:
  OsmLanelets(std::string_view text, std::string const& file, std::vector<Diagnostic>& diagnostics)
      : context_(text, file, diagnostics), counted_(context_), ways_(context_, counted_) {}

 protected:
  using Id = OsmId;

  struct Read {
    Lanelet lanelet;
    OsmBound left, right;
    std::pair<Id, Id> begin, end;  ///< its nodes there, left and right
  };

  /// The lanelets that name a rule, and whether the file has it.
  struct Users {
    std::vector<std::size_t> lanelets;
    bool rule_seen = false;
  };

  void read_lanelets(pugi::xml_node root, std::optional<Lanelet2Origin> const& origin) {
    ways_.read(root, origin);
    for_each_child(root, "relation", [&](pugi::xml_node node) {
      if (osm_tag(node, "type") == "lanelet") read_lanelet(node);
    });
    link();
  }

  void warn(pugi::xml_node node, std::string sentence) {
    context_.report(Severity::warning, node, std::move(sentence));
  }

  void count_other_roles(pugi::xml_node node, std::string const& of, std::initializer_list<std::string_view> known) {
    for_each_child(node, "member", [&](pugi::xml_node member) {
      std::string_view const role = member.attribute("role").value();
      if (std::find(known.begin(), known.end(), role) == known.end())
        counted_.add(Severity::info, member,
                     "members in the role \"" + std::string(role) + "\" of " + of + " are not read");
    });
  }

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

  XmlContext context_;
  CountedFindings counted_;
  OsmWays ways_;
  std::vector<Read> lanelets_;
  std::map<Id, std::size_t> places_;
  std::map<Id, Users> users_;  ///< by rule

 private:
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
    report_participants(counted_, node);
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
    report_lanelet_tags(counted_, node, *type);
    read.lanelet.both_directions = goes_both_ways(node, *type);
    read.lanelet.in_junction = !osm_tag(node, "turn_direction").empty();
    if (auto const limit = osm_tag(node, "speed_limit"); !limit.empty()) {
      read.lanelet.speed_limit = speed_of_text(limit);
      if (!read.lanelet.speed_limit) warn(node, "speed_limit=" + std::string(limit) + " is no speed; it was left out");
    }
    auto const* const usual = subtype != nullptr && is_drivable(subtype->type) ? subtype : lanelet_subtype("road");
    if (!read.lanelet.speed_limit && is_drivable(*type))
      read.lanelet.speed_limit = (osm_tag(node, "location") == "nonurban" ? usual->rural : usual->urban) / 3.6;
    set_bounds(read, *left, *right);
    std::vector<Id> rules;  // that it names
    for_each_member(node, "regulatory_element", "relation", [&](pugi::xml_node, Id ref) { rules.push_back(ref); });
    count_other_roles(node, "lanelets", {"left", "right", "regulatory_element"});
    if (!places_.emplace(*id, lanelets_.size()).second)
      return warn(node, "lanelet " + std::to_string(*id) + " is there already; the second one was left out");
    for (auto const rule : rules) {
      auto& users = users_[rule].lanelets;
      if (users.empty() || users.back() != lanelets_.size()) users.push_back(lanelets_.size());
    }
    lanelets_.push_back(std::move(read));
  }

  /// Ways may be written either way round: the bounds are turned so that they run alike, left on the left.
  void set_bounds(Read& read, Id left, Id right) const {
    OsmBound l{left}, r{right};
    auto a = ways_.points_of(l), b = ways_.points_of(r);
    if (run_opposite_ways(a, b)) {
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
};

}  // namespace cambium::inline v0_1::map::detail
