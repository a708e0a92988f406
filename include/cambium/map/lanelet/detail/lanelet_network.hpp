#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "cambium/core/portable_math.hpp"
#include "cambium/core/text.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/geometry/box.hpp"
#include "cambium/map/detail/findings.hpp"
#include "cambium/map/lanelet/detail/lanelet_bounds.hpp"
#include "cambium/map/lanelet/lanelet.hpp"

namespace cambium::inline v0_1::map::detail {

/// Sets of numbers that are united pair by pair.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{});
  }

  [[nodiscard]] std::size_t find(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void unite(std::size_t a, std::size_t b) { parent_[std::max(find(a), find(b))] = std::min(find(a), find(b)); }

 private:
  std::vector<std::size_t> parent_;
};

/// Finds out which lanelets can be used, which follow each other, lie side by side, and meet in junctions. What is odd
/// becomes a finding.
class LaneletNetwork {
 public:
  static constexpr std::size_t nobody = std::numeric_limits<std::size_t>::max();

  /// A lanelet as it is driven.
  struct Way {
    std::size_t lanelet{};
    bool backwards = false;
    friend auto operator<=>(Way const&, Way const&) = default;
  };
  struct Link {
    Way from{}, to{};
    friend auto operator<=>(Link const&, Link const&) = default;
  };

  LaneletNetwork(std::vector<Lanelet> given, Findings& findings) : findings_(findings) {
    take(std::move(given));
    find_links();
    find_neighbors();
    find_junctions();
    turn_ends();
  }

  std::vector<Lanelet> lanelets;
  std::vector<LaneletCenter> centers;    ///< of each lanelet
  std::vector<Link> links;               ///< sorted
  std::set<Link> inferred;               ///< links that no lanelet names: each is a finding already
  std::vector<std::size_t> right_of;     ///< the neighbour of each lanelet; `nobody` without one
  std::vector<std::size_t> junction_of;  ///< lanelets of one number lie in one junction; `nobody`: in none
  /// Direction of each lanelet's path at its begin and end where it meets others [rad].
  std::vector<std::array<std::optional<double>, 2>> headings;

  void report(Severity severity, std::size_t lanelet, std::string sentence) {
    report(severity, lanelets[lanelet], std::move(sentence));
  }

 private:
  static constexpr double rounding = 0.1;  // [m] between bounds that meet

  void report(Severity severity, Lanelet const& lanelet, std::string sentence) {
    findings_.add(severity, lanelet.line, "lanelet", "lanelet " + std::to_string(lanelet.id), std::move(sentence));
  }

  [[nodiscard]] std::size_t find(std::int64_t id) const {
    auto const at = places_.find(id);
    return at == places_.end() ? nobody : at->second;
  }

  /// Heights count where all lanelets have them: a bridge over what has none is no bridge.
  void drop_some_heights(std::vector<Lanelet>& given) {
    auto const has = [](Lanelet const& lanelet) {
      auto const fit = [](auto const& heights, auto const& points) {
        return heights.size() == points.size() &&
               std::all_of(heights.begin(), heights.end(), [](double h) { return std::abs(h) < 1e5; });
      };
      return fit(lanelet.left_heights, lanelet.left) && fit(lanelet.right_heights, lanelet.right);
    };
    auto const without = std::find_if_not(given.begin(), given.end(), has);
    if (without == given.end()) return;
    if (std::any_of(given.begin(), given.end(), has))
      report(Severity::warning, *without, "it has no heights of all its points, and others have: the map is flat");
    for (auto& lanelet : given) {
      lanelet.left_heights.clear();
      lanelet.right_heights.clear();
    }
  }

  void take(std::vector<Lanelet> given) {
    drop_some_heights(given);
    for (auto& lanelet : given) {
      bool swapped = false, turned = false;
      if (auto const* const fault = fault_of_bounds(lanelet, swapped, turned)) {
        report(Severity::warning, lanelet, std::string(fault) + "; the lanelet was left out");
        continue;
      }
      if (bounds_cross(lanelet)) {
        report(Severity::warning, lanelet, "its bounds cross each other; the lanelet was left out");
        continue;
      }
      if (turned) report(Severity::warning, lanelet, "its bounds run opposite ways; one was turned");
      if (swapped) report(Severity::warning, lanelet, "its left bound lies to the right; the bounds were exchanged");
      if (!places_.emplace(lanelet.id, lanelets.size()).second) {
        report(Severity::warning, lanelet, "its id is taken already; the lanelet was left out");
        continue;
      }
      auto center = center_of(lanelet);
      if (center.points.size() < 2) {
        report(Severity::warning, lanelet, "it has no length; the lanelet was left out");
        places_.erase(lanelet.id);
        continue;
      }
      centers.push_back(std::move(center));
      lanelets.push_back(std::move(lanelet));
    }
  }

  /// Where a way begins or ends: the ends of its left and right bound.
  [[nodiscard]] std::pair<Point, Point> gate(Way way, bool at_end) const {
    auto const& lanelet = lanelets[way.lanelet];
    if (at_end == way.backwards)
      return way.backwards ? std::pair(lanelet.right.front(), lanelet.left.front())
                           : std::pair(lanelet.left.front(), lanelet.right.front());
    return way.backwards ? std::pair(lanelet.right.back(), lanelet.left.back())
                         : std::pair(lanelet.left.back(), lanelet.right.back());
  }

  /// How far apart the bounds are where one way should go on as another [m].
  [[nodiscard]] double apart(Way from, Way to) const {
    auto const end = gate(from, true), begin = gate(to, false);
    return std::max((end.first - begin.first).norm(), (end.second - begin.second).norm());
  }

  /// The height where a way begins or ends [m]; 0 where none is known.
  [[nodiscard]] double height(Way way, bool at_end) const {
    auto const& heights = centers[way.lanelet].heights;
    if (heights.empty()) return 0.0;
    return at_end == way.backwards ? heights.front() : heights.back();
  }

  void find_links() {
    for (std::size_t i = 0; i < lanelets.size(); ++i) {
      for (auto const id : lanelets[i].successors) add_link(i, id, find(id), i, "successor");
      for (auto const id : lanelets[i].predecessors) add_link(find(id), id, i, i, "predecessor");
    }
    sort_links();
    join_those_that_meet();
    sort_links();
  }

  void sort_links() {
    std::sort(links.begin(), links.end());
    links.erase(std::unique(links.begin(), links.end()), links.end());
  }

  void add_link(std::size_t from, std::int64_t other, std::size_t to, std::size_t by, char const* what) {
    std::string const name = std::string("its ") + what + " " + std::to_string(other);
    if (from == nobody || to == nobody) return report(Severity::warning, by, name + " is not there");
    if (from == to) return report(Severity::warning, by, name + " is itself; the link was left out");
    constexpr double farthest = 0.4;  // [m] between the middles of what is joined all the same
    auto const end = gate({from}, true), begin = gate({to}, false);
    double const gap = 0.5 * ((end.first + end.second) - (begin.first + begin.second)).norm();
    if (gap > farthest)
      return report(Severity::warning, by,
                    name + " does not begin where it ends, but " + cambium::detail::rounded_text(gap) +
                        " m away; the link was left out");
    Link const link{{from}, {to}};
    if (!seen_.insert(link).second) return;
    links.push_back(link);
    if (double const step = apart({from}, {to}); step > rounding)
      report(Severity::info, by,
             "its bounds and those of its " + std::string(what) + " " + std::to_string(other) + " are " +
                 cambium::detail::rounded_text(step) + " m apart where they meet; the two were joined");
  }

  /// Joins ways whose bounds meet: lanelets driven backwards, of which no file says what they go on as; and those that
  /// the file should have linked, with a finding.
  void join_those_that_meet() {
    std::vector<Way> ways;
    for (std::size_t i = 0; i < lanelets.size(); ++i) {
      ways.push_back({i});
      if (lanelets[i].both_directions) ways.push_back({i, true});
    }
    auto const place = [&](Way way) { return gate(way, false).first.x(); };
    std::sort(ways.begin(), ways.end(), [&](Way a, Way b) { return std::pair(place(a), a) < std::pair(place(b), b); });
    auto const named = links;
    for (auto const from : ways) {
      double const x = gate(from, true).first.x();
      auto to = std::partition_point(ways.begin(), ways.end(), [&](Way way) { return place(way) < x - rounding; });
      for (; to != ways.end() && place(*to) <= x + rounding; ++to) {
        if (from.lanelet == to->lanelet || !(apart(from, *to) <= rounding)) continue;
        if (std::abs(height(from, true) - height(*to, false)) > clear_height) continue;  // on different decks
        Link const link{from, *to};
        bool const fits = is_drivable(lanelets[from.lanelet].type) == is_drivable(lanelets[to->lanelet].type);
        if (!fits || std::binary_search(named.begin(), named.end(), link)) continue;
        links.push_back(link);
        if (from.backwards || to->backwards) continue;
        inferred.insert(link);
        report(Severity::warning, from.lanelet,
               "lanelet " + std::to_string(lanelets[to->lanelet].id) +
                   " begins where it ends, and neither names the other; the two were joined");
      }
    }
  }

  /// Lanelets that lie side by side, where at least one names the other: those first that name each other.
  void find_neighbors() {
    right_of.assign(lanelets.size(), nobody);
    std::vector<bool> has_left(lanelets.size());
    auto const pair = [&](std::size_t left, std::size_t right, std::size_t by, std::int64_t id) {
      if (left == nobody || right == nobody)
        return report(Severity::warning, by, "its neighbour " + std::to_string(id) + " is not there");
      if (left == right || right_of[left] == right) return;
      if (right_of[left] != nobody || has_left[right])
        return report(Severity::warning, by, "its neighbour " + std::to_string(id) + " has another one on that side");
      if (!runs_along(centers[left], false, lanelets[right].left) &&
          !runs_along(centers[right], true, lanelets[left].right))
        return report(Severity::warning, by,
                      "its neighbour " + std::to_string(id) + " does not lie beside it; they were kept apart");
      right_of[left] = right;
      has_left[right] = true;
    };
    for (bool const mutual : {true, false})
      for (std::size_t i = 0; i < lanelets.size(); ++i)
        for (bool const to_right : {true, false}) {
          auto const id = to_right ? lanelets[i].right_neighbor : lanelets[i].left_neighbor;
          if (!id) continue;
          auto const other = find(*id);
          bool const is_mutual = other != nobody && (to_right ? lanelets[other].left_neighbor
                                                              : lanelets[other].right_neighbor) == lanelets[i].id;
          if (is_mutual == mutual) pair(to_right ? i : other, to_right ? other : i, i, *id);
        }
  }

  /// Lanelets that cross each other lie in a junction, and so do those that leave or enter the same road beside them
  /// and are not much longer.
  void find_junctions() {
    std::vector<bool> inside(lanelets.size());
    DisjointSets junctions(lanelets.size()), roads(lanelets.size());
    for (std::size_t i = 0; i < lanelets.size(); ++i)
      if (right_of[i] != nobody) roads.unite(i, right_of[i]);
    std::vector<geometry::Box> boxes;
    for (auto const& center : centers) boxes.push_back(geometry::box_around(center.points));
    for (std::size_t i = 0; i < lanelets.size(); ++i) {
      if (!is_drivable(lanelets[i].type)) continue;
      if (lanelets[i].in_junction) inside[i] = true;
      for (std::size_t k = i + 1; k < lanelets.size(); ++k) {
        if (!boxes[i].intersects(boxes[k]) || !is_drivable(lanelets[k].type) || roads.find(i) == roads.find(k))
          continue;
        if (!cross_each_other(centers[i], centers[k])) continue;
        inside[i] = inside[k] = true;
        junctions.unite(i, k);
      }
    }
    for (bool found = true; found;) {
      found = false;
      for (bool const by_begin : {true, false}) {
        std::map<std::size_t, std::vector<std::size_t>> beside;  // lanelets, by the road where they begin or end
        for (auto const& [from, to] : links) {
          auto const road = by_begin ? from.lanelet : to.lanelet, way = by_begin ? to.lanelet : from.lanelet;
          if (!from.backwards && !to.backwards && !inside[road]) beside[roads.find(road)].push_back(way);
        }
        for (auto const& [road, ways] : beside) {
          auto const first = std::find_if(ways.begin(), ways.end(), [&](std::size_t way) { return inside[way]; });
          if (first == ways.end()) continue;
          double longest = 50.0;
          for (auto const way : ways)
            if (inside[way]) longest = std::max(longest, 2.0 * length_of(way));
          for (auto const way : ways) {
            if (!inside[way] && length_of(way) > longest) continue;
            found = found || !inside[way] || junctions.find(way) != junctions.find(*first);
            inside[way] = true;
            junctions.unite(way, *first);
          }
        }
      }
    }
    junction_of.assign(lanelets.size(), nobody);
    for (std::size_t i = 0; i < lanelets.size(); ++i)
      if (inside[i]) junction_of[i] = junctions.find(i);
  }

  [[nodiscard]] double length_of(std::size_t lanelet) const { return Rail(centers[lanelet].points).length(); }

  /// Lets paths that meet at a joint have one direction there, between those of what ends and what begins; each turns
  /// by `most` at the most, so that a lane keeps to the shape of its own bounds.
  void turn_ends() {
    constexpr double most = 0.1;  // [rad]
    auto const end = [](std::size_t lanelet, bool at_end) { return 2 * lanelet + (at_end ? 1 : 0); };
    DisjointSets joints(2 * lanelets.size());
    for (auto const& [from, to] : links)
      if (!from.backwards && !to.backwards) joints.unite(end(from.lanelet, true), end(to.lanelet, false));
    std::vector<std::array<Point, 2>> ways(2 *
                                           lanelets.size());  // of each joint: of what begins there, what ends there
    for (std::size_t i = 0; i < lanelets.size(); ++i)
      for (std::size_t const at_end : {0u, 1u}) {
        auto& sum = ways[joints.find(end(i, at_end != 0))][at_end];
        sum = sum + end_way(centers[i], at_end != 0);
      }
    headings.resize(lanelets.size());
    for (std::size_t i = 0; i < lanelets.size(); ++i)
      for (std::size_t const at_end : {0u, 1u}) {
        auto const& [begins, ends] = ways[joints.find(end(i, at_end != 0))];
        if (begins == Point{} || ends == Point{}) continue;
        auto const way = end_way(centers[i], at_end != 0), common = begins.normalized() + ends.normalized();
        double const own = portable::atan2(way.y(), way.x()), wanted = portable::atan2(common.y(), common.x());
        headings[i][at_end] = own + std::clamp(geometry::angle_difference(wanted, own), -most, most);
      }
  }

  Findings& findings_;
  std::map<std::int64_t, std::size_t> places_;
  std::set<Link> seen_;
};

}  // namespace cambium::inline v0_1::map::detail
