#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "cambium/core/text.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/geometry/box.hpp"
#include "cambium/map/detail/findings.hpp"
#include "cambium/map/lanelet/detail/lanelet_bounds.hpp"
#include "cambium/map/lanelet/lanelet.hpp"

namespace cambium::map::detail {

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

/// Lanelets side by side, from left to right, which become one road.
struct LaneletGroup {
  static constexpr std::size_t no_junction = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> lanelets{};
  std::size_t junction = no_junction;  ///< groups of one number lie in one junction
};

/// Finds out which lanelets can be used, which follow each other, lie side by side, and meet in junctions. What is odd
/// becomes a finding.
class LaneletGroups {
 public:
  struct Link {
    std::size_t from{}, to{};  ///< lanelets
    friend auto operator<=>(Link const&, Link const&) = default;
  };

  LaneletGroups(std::vector<Lanelet> given, Findings& findings) : findings_(findings) {
    take(std::move(given));
    find_links();
    find_neighbors();
    find_groups();
    find_junctions();
  }

  std::vector<Lanelet> lanelets;
  std::vector<LaneletCenter> centers;  ///< of each lanelet
  std::vector<Link> links;             ///< sorted
  std::vector<LaneletGroup> groups;
  std::vector<std::size_t> group_of;  ///< each lanelet

  void report(Severity severity, std::size_t lanelet, std::string sentence) {
    report(severity, lanelets[lanelet], std::move(sentence));
  }

 private:
  static constexpr std::size_t nobody = std::numeric_limits<std::size_t>::max();

  void report(Severity severity, Lanelet const& lanelet, std::string sentence) {
    findings_.add(severity, lanelet.line, "lanelet", "lanelet " + std::to_string(lanelet.id), std::move(sentence));
  }

  [[nodiscard]] std::size_t find(std::int64_t id) const {
    auto const at = places_.find(id);
    return at == places_.end() ? nobody : at->second;
  }

  void take(std::vector<Lanelet> given) {
    for (auto& lanelet : given) {
      bool swapped = false;
      if (auto const* const fault = fault_of_bounds(lanelet, swapped)) {
        report(Severity::warning, lanelet, std::string(fault) + "; the lanelet was left out");
        continue;
      }
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

  void find_links() {
    for (std::size_t i = 0; i < lanelets.size(); ++i) {
      for (auto const id : lanelets[i].successors) add_link(i, id, find(id), i, "successor");
      for (auto const id : lanelets[i].predecessors) add_link(find(id), id, i, i, "predecessor");
    }
    join_dead_ends();
    std::sort(links.begin(), links.end());
    links.erase(std::unique(links.begin(), links.end()), links.end());
  }

  /// A lanelet whose named successors are not where it ends goes on as the one that begins there.
  void join_dead_ends() {
    constexpr double rounding = 0.05;  // [m]
    std::vector<bool> goes_on(lanelets.size());
    for (auto const& link : links) goes_on[link.from] = true;
    for (std::size_t i = 0; i < lanelets.size(); ++i) {
      if (goes_on[i] || lanelets[i].successors.empty()) continue;
      for (std::size_t k = 0; k < lanelets.size(); ++k) {
        if ((lanelets[i].left.back() - lanelets[k].left.front()).norm() > rounding ||
            (lanelets[i].right.back() - lanelets[k].right.front()).norm() > rounding || i == k)
          continue;
        report(Severity::warning, i,
               "lanelet " + std::to_string(lanelets[k].id) + " begins where it ends; the two were joined");
        links.push_back({i, k});
      }
    }
  }

  void add_link(std::size_t from, std::int64_t other, std::size_t to, std::size_t by, char const* what) {
    std::string const name = std::string("its ") + what + " " + std::to_string(other);
    if (from == nobody || to == nobody) return report(Severity::warning, by, name + " is not there");
    auto const end = end_pose(centers[from], true), begin = end_pose(centers[to], false);
    double const gap = (end.position() - begin.position()).norm();
    double const turn = std::abs(geometry::angle_difference(end.heading, begin.heading));
    if (gap <= 0.4 && turn <= 0.45) return links.push_back({from, to});
    report(Severity::warning, by,
           name + " does not meet it: there are " + cambium::detail::rounded_text(gap) + " m and " +
               cambium::detail::rounded_text(turn) + " rad between them; the link was left out");
  }

  /// Both sides name each other, or one does and the other names nobody; and they lie side by side.
  void find_neighbors() {
    right_of_.assign(lanelets.size(), nobody);
    has_left_.assign(lanelets.size(), false);
    auto const pair = [&](std::size_t left, std::size_t right, std::size_t by, std::int64_t id) {
      if (left == nobody || right == nobody)
        return report(Severity::warning, by, "its neighbour " + std::to_string(id) + " is not there");
      if (left == right || right_of_[left] == right) return;
      if (right_of_[left] != nobody || has_left_[right])
        return report(Severity::warning, by, "its neighbour " + std::to_string(id) + " has another one on that side");
      if (!is_beside(lanelets[left], lanelets[right]))
        return report(Severity::info, by,
                      "its neighbour " + std::to_string(id) +
                          " does not lie beside it from begin to end; nobody changes lanes between them");
      right_of_[left] = right;
      has_left_[right] = true;
    };
    for (std::size_t i = 0; i < lanelets.size(); ++i) {
      if (auto const id = lanelets[i].right_neighbor) pair(i, find(*id), i, *id);
      if (auto const id = lanelets[i].left_neighbor) pair(find(*id), i, i, *id);
    }
  }

  [[nodiscard]] static bool is_beside(Lanelet const& left, Lanelet const& right) {
    constexpr double apart = 1.0;  // [m] between the bounds' ends
    return (left.right.front() - right.left.front()).norm() <= apart &&
           (left.right.back() - right.left.back()).norm() <= apart;
  }

  void find_groups() {
    group_of.assign(lanelets.size(), nobody);
    auto const begin = [&](std::size_t first) {
      auto& group = groups.emplace_back();
      for (std::size_t at = first; at != nobody && group_of[at] == nobody; at = right_of_[at]) {
        group_of[at] = groups.size() - 1;
        group.lanelets.push_back(at);
      }
    };
    for (std::size_t i = 0; i < lanelets.size(); ++i)
      if (!has_left_[i]) begin(i);
    for (std::size_t i = 0; i < lanelets.size(); ++i)
      if (group_of[i] == nobody) begin(i);  // a ring of neighbours
  }

  /// Groups that cross each other lie in a junction, and so do those that leave or enter the same road beside them.
  void find_junctions() {
    DisjointSets sets(groups.size());
    std::vector<bool> inside(groups.size());
    std::vector<geometry::Box> boxes;
    for (auto const& center : centers) boxes.push_back(geometry::box_around(center.points));
    for (std::size_t i = 0; i < lanelets.size(); ++i) {
      if (!is_drivable(lanelets[i].type)) continue;
      if (lanelets[i].in_junction) inside[group_of[i]] = true;
      for (std::size_t k = i + 1; k < lanelets.size(); ++k) {
        if (!boxes[i].intersects(boxes[k]) || group_of[i] == group_of[k] || !is_drivable(lanelets[k].type)) continue;
        if (!cross_each_other(centers[i].points, centers[k].points)) continue;
        inside[group_of[i]] = inside[group_of[k]] = true;
        sets.unite(group_of[i], group_of[k]);
      }
    }
    for (bool found = true; found;) {
      found = false;
      for (bool const by_begin : {true, false}) {
        std::map<std::size_t, std::vector<std::size_t>> beside;  // groups, by the group where they begin or end
        for (auto const& link : links)
          beside[group_of[by_begin ? link.from : link.to]].push_back(group_of[by_begin ? link.to : link.from]);
        for (auto const& [road, ways] : beside) {
          auto const is_inside = [&](std::size_t way) { return inside[way]; };
          auto const first = std::find_if(ways.begin(), ways.end(), is_inside);
          if (first == ways.end() || inside[road]) continue;
          for (auto const way : ways) {
            found = found || !inside[way] || sets.find(way) != sets.find(*first);
            inside[way] = true;
            sets.unite(way, *first);
          }
        }
      }
    }
    for (std::size_t g = 0; g < groups.size(); ++g)
      if (inside[g]) groups[g].junction = sets.find(g);
  }

  Findings& findings_;
  std::map<std::int64_t, std::size_t> places_;
  std::vector<std::size_t> right_of_;
  std::vector<bool> has_left_;
};

}  // namespace cambium::map::detail
