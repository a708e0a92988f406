#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <tuple>

#include "cambium/core/ids.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/core/stable_sort.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/geometry/box.hpp"
#include "cambium/geometry/box_tree.hpp"
#include "cambium/map/lanes/detail/lane_chords.hpp"
#include "cambium/map/lanes/detail/overlap_ends.hpp"
#include "cambium/map/lanes/overlaps.hpp"

/// How overlaps are found. The paths of all drivable lanes become chords, straight to within 1 cm, and a tree of their
/// boxes gives the pairs of chords that come closer than the clearance. Each such pair is a contact: a stretch on
/// either lane. Contacts of the same two lanes that touch each other are joined, and the ends of what results are
/// refined on the exact paths. Lanes are also close for harmless reasons, and those contacts are dropped: lanes of one
/// road side by side, lanes one behind the other near their joint, and a bridge over a road. What is left is a merge, a
/// split or a crossing, told apart by the angle between the lanes and by the lanes that they share at their ends.
namespace cambium::inline v0_1::map {

namespace detail {

/// See `find_overlaps`.
class OverlapFinder {
 public:
  OverlapFinder(std::vector<Lane>& lanes, LaneElevation const& elevation, double clearance, ExactPath const& place)
      : lanes_(lanes), elevation_(elevation), clearance_(clearance), ends_(place, clearance) {}

  void find() {
    for (auto& lane : lanes_) lane.overlaps.clear();
    find_related();
    find_contacts();
    for (auto& lane : lanes_)
      cambium::detail::stable_sort(lane.overlaps,
                                   [](Overlap const& o) { return std::tuple(o.begin, o.other, o.other_begin); });
  }

 private:
  /// Stretches of the lanes `a` <= `b` that are close to each other.
  struct Contact {
    std::uint32_t a, b;
    PathStretch on_a, on_b;
  };

  /// A lane linked with another one, at a common joint.
  struct Linked {
    LaneId lane;
    double between;  ///< length of the lanes between the two [m]
  };

  /// A joint of a lane: near it, being close to `other` is no conflict.
  struct Joint {
    LaneId other;
    bool at_end, at_other_end;  ///< of the lane, of `other`; else at the begin
    double between;             ///< as in `Linked`
  };

  /// Finds the lanes that each lane is linked with, and those beside them.
  void find_related() {
    find_cross_sections();
    ahead_.assign(lanes_.size(), {});
    behind_ = ahead_;
    joints_.assign(lanes_.size(), {});
    for (std::size_t i = 0; i < lanes_.size(); ++i)
      for (bool const at_end : {true, false}) {
        std::vector<Linked> linked;
        add_linked(lanes_[i], at_end ? &Lane::successors : &Lane::predecessors, 0.0, linked);
        for (auto const& link : linked) {
          (at_end ? ahead_ : behind_)[i].push_back(link.lane);
          for (auto const id : cross_sections_[cross_section_of_[index_of(link.lane)]]) {
            bool const same_way = lanes_[index_of(id)].along_road == lanes_[index_of(link.lane)].along_road;
            joints_[i].push_back({id, at_end, at_end != same_way, link.between});
          }
        }
      }
  }

  /// The lanes of one section of a road, which are consecutive in `lanes_`, oncoming ones too; and their neighbours, of
  /// whatever road.
  void find_cross_sections() {
    std::vector<std::size_t> const unknown(lanes_.size(), lanes_.size());
    cross_section_of_ = unknown;
    cross_sections_.clear();
    for (std::size_t first = 0; first < lanes_.size(); ++first) {
      if (cross_section_of_[first] != lanes_.size()) continue;
      auto& members = cross_sections_.emplace_back();
      auto const add = [&](std::size_t i) {
        if (cross_section_of_[i] != lanes_.size()) return;
        cross_section_of_[i] = cross_sections_.size() - 1;
        members.push_back(lanes_[i].id);
      };
      add(first);
      for (std::size_t k = 0; k < members.size(); ++k) {
        auto const at = index_of(members[k]);
        auto const is_same = [&](std::size_t i) {
          return lanes_[i].road == lanes_[at].road && lanes_[i].section == lanes_[at].section;
        };
        for (auto i = at; i + 1 < lanes_.size() && is_same(i + 1); ++i) add(i + 1);
        for (auto i = at; i > 0 && is_same(i - 1); --i) add(i - 1);
        for (auto const side : {lanes_[at].left_neighbor, lanes_[at].right_neighbor})
          if (is_valid(side)) add(index_of(side));
      }
    }
  }

  /// The lanes behind a lane's end (or before its begin), and those behind them while they are too short to come
  /// between.
  void add_linked(Lane const& lane, std::vector<LaneId> Lane::*links, double between,
                  std::vector<Linked>& linked) const {
    for (auto const id : lane.*links) {
      linked.push_back({id, between});
      double const length = between + lanes_[index_of(id)].length();
      if (length < 2.0 * clearance_ && linked.size() < 64) add_linked(lanes_[index_of(id)], links, length, linked);
    }
  }

  [[nodiscard]] static bool has(std::vector<LaneId> const& list, LaneId id) {
    return std::find(list.begin(), list.end(), id) != list.end();
  }

  /// Whether the lanes are close because they are linked: the contact reaches their common joint, or nearly so.
  [[nodiscard]] bool is_at_joint(Contact const& c) const { return is_at_joint(c.a, c.on_a, c.b, c.on_b); }

  [[nodiscard]] bool is_at_joint(std::uint32_t a, PathStretch const& on_a, std::uint32_t b,
                                 PathStretch const& on_b) const {
    constexpr double near = 10.0;  // [m] along the paths: no loop is so short
    auto const left = [&](std::uint32_t i, PathStretch const& on, bool to_end) {
      return to_end ? lanes_[i].length() - on.end : on.begin;
    };
    auto const holds = [&](std::uint32_t i, PathStretch const& on, std::uint32_t j, PathStretch const& on_other) {
      return std::any_of(joints_[i].begin(), joints_[i].end(), [&](Joint const& joint) {
        return index_of(joint.other) == j &&
               left(i, on, joint.at_end) + joint.between + left(j, on_other, joint.at_other_end) < near;
      });
    };
    return holds(a, on_a, b, on_b) || holds(b, on_b, a, on_a);
  }

  [[nodiscard]] static bool have_common(std::vector<LaneId> const& l, std::vector<LaneId> const& r) {
    return std::any_of(l.begin(), l.end(), [&r](LaneId id) { return has(r, id); });
  }

  /// Lanes of one road are side by side, one after the other, or the same where their stations are about the same.
  [[nodiscard]] bool are_beside(LaneChord const& a, LaneChord const& b) const {
    auto const &la = lanes_[a.lane], &lb = lanes_[b.lane];
    if (la.merges_into == lb.id || lb.merges_into == la.id) return false;
    if (la.road == lb.road) return a.on_road.gap(b.on_road) < 10.0;
    return cross_section_of_[a.lane] == cross_section_of_[b.lane];
  }

  void find_contacts() {
    constexpr double tolerance = 0.01, longest = 50.0;  // [m] of chords; the overlaps' ends are refined afterwards
    std::vector<LaneChord> chords;
    for (auto const& lane : lanes_)
      if (lane.drivable()) add_chords(lane, tolerance, longest, chords);
    std::vector<geometry::Box> boxes(chords.size());
    for (std::size_t i = 0; i < chords.size(); ++i) {
      auto const& c = chords[i];
      boxes[i].add(c.x, c.y);
      boxes[i].add(c.x + c.ux * c.length, c.y + c.uy * c.length);
    }
    last_contact_.assign(lanes_.size(), 0);
    geometry::BoxTree const tree(boxes);
    for (std::size_t i = 0; i < chords.size(); ++i) {
      tree.visit(boxes[i].grown(clearance_), [&](std::uint32_t j) {
        if (std::tie(chords[i].lane, i) < std::tuple<std::uint32_t, std::size_t>(chords[j].lane, j))
          add_contact(chords[i], chords[j]);
        return false;
      });
      if (i + 1 == chords.size() || chords[i + 1].lane != chords[i].lane) join_contacts();
    }
  }

  /// Joins the contacts of one lane with all others: they would fill the memory where many lanes lie on each other.
  void join_contacts() {
    std::sort(contacts_.begin(), contacts_.end(), [](Contact const& l, Contact const& r) {
      return std::tie(l.b, l.on_a.begin, l.on_b.begin) < std::tie(r.b, r.on_a.begin, r.on_b.begin);
    });
    for (auto begin = contacts_.begin(); begin != contacts_.end();) {
      auto const end = std::find_if(begin, contacts_.end(), [&](Contact const& c) { return c.b != begin->b; });
      join(std::span<Contact const>(begin, end));
      begin = end;
    }
    contacts_.clear();
  }

  /// Whether the two have a point in common, up to a millimetre.
  [[nodiscard]] static bool touch(PathStretch const& l, PathStretch const& r) {
    return l.begin <= r.end + 1e-3 && r.begin <= l.end + 1e-3;
  }

  void add_contact(LaneChord const& a, LaneChord const& b) {
    if (auto const* last = last_contact(b); last && last->on_a.has(a.on_path) && last->on_b.has(b.on_path)) return;
    if (are_beside(a, b)) return;
    auto const on_a = stretch_near(a, b, clearance_);
    if (!on_a) return;
    auto const on_b = stretch_near(b, a, clearance_);
    if (!on_b || pass_over(a, *on_a, b, *on_b)) return;
    if (auto* last = last_contact(b); last && touch(last->on_a, *on_a) && touch(last->on_b, *on_b)) {
      last->on_a.add(*on_a);
      last->on_b.add(*on_b);
      return;
    }
    last_contact_[b.lane] = contacts_.size();
    contacts_.push_back({a.lane, b.lane, *on_a, *on_b});
  }

  /// Whether one of the lanes is a bridge over the other, all along the stretches.
  [[nodiscard]] bool pass_over(LaneChord const& a, PathStretch const& on_a, LaneChord const& b,
                               PathStretch const& on_b) const {
    if (!elevation_) return false;
    bool const same_way = a.ux * b.ux + a.uy * b.uy > 0.0;
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (double const u : {0.0, 0.5, 1.0}) {
      double const s = on_a.begin + u * (on_a.end - on_a.begin);
      double const other_s = on_b.begin + (same_way ? u : 1.0 - u) * (on_b.end - on_b.begin);
      double const above = elevation_(lanes_[a.lane], s) - elevation_(lanes_[b.lane], other_s);
      low = std::min(low, above);
      high = std::max(high, above);
    }
    return low > clear_height || high < -clear_height;
  }

  /// The last contact of the present lane with that of `b`: mostly the one that they continue.
  [[nodiscard]] Contact* last_contact(LaneChord const& b) {
    auto const i = last_contact_[b.lane];
    return i < contacts_.size() && contacts_[i].b == b.lane ? &contacts_[i] : nullptr;
  }

  /// Adds a contact of one pair of lanes, joined with those that it touches on both of them.
  static void add_joined(Contact contact, std::vector<Contact>& groups) {
    for (std::size_t i = 0; i < groups.size();) {
      if (!touch(groups[i].on_a, contact.on_a) || !touch(groups[i].on_b, contact.on_b)) {
        ++i;
        continue;
      }
      contact.on_a.add(groups[i].on_a);
      contact.on_b.add(groups[i].on_b);
      groups.erase(groups.begin() + static_cast<std::ptrdiff_t>(i));
      i = 0;  // the larger one may touch others
    }
    groups.push_back(contact);
  }

  /// Enters the overlaps of one pair of lanes.
  void join(std::span<Contact const> contacts) {
    std::vector<Contact> groups, refined;
    for (auto const& contact : contacts) add_joined(contact, groups);
    for (auto& g : groups)  // ends that were apart on the chords may prove to be one stretch
      if (!is_at_joint(g) && ends_.refine(lanes_[g.a], g.on_a, lanes_[g.b], g.on_b)) add_joined(g, refined);
    for (auto& g : refined) {
      auto &a = lanes_[g.a], &b = lanes_[g.b];
      bool const is_crossing = turn_between(a, g.on_a, b, g.on_b) > geometry::pi / 3;
      if (!is_crossing) {
        ends_.trim(a, g.on_a, b, g.on_b);
        ends_.trim(b, g.on_b, a, g.on_a);
      }
      constexpr double shortest = 0.01;  // [m]
      if (g.on_a.end - g.on_a.begin < shortest || g.on_b.end - g.on_b.begin < shortest) continue;
      auto const kind = is_crossing ? OverlapKind::crossing : kind_of(g);
      a.overlaps.push_back({b.id, kind, g.on_a.begin, g.on_a.end, g.on_b.begin, g.on_b.end});
      b.overlaps.push_back({a.id, kind, g.on_b.begin, g.on_b.end, g.on_a.begin, g.on_a.end});
    }
  }

  /// Angle between the lanes' directions in the middle of the stretches [rad].
  [[nodiscard]] static double turn_between(Lane const& a, PathStretch const& on_a, Lane const& b,
                                           PathStretch const& on_b) {
    return std::abs(geometry::angle_difference(a.path.pose(on_a.middle()).heading, b.path.pose(on_b.middle()).heading));
  }

  /// Kind of an overlap of lanes with about the same direction.
  [[nodiscard]] OverlapKind kind_of(Contact const& g) const {
    auto const &a = lanes_[g.a], &b = lanes_[g.b];
    constexpr double close = 0.1;  // [m] to a lane's end
    bool const to_the_end = g.on_a.end > a.length() - close && g.on_b.end > b.length() - close;
    bool const from_the_begin = g.on_a.begin < close && g.on_b.begin < close;
    if (to_the_end && have_common(ahead_[g.a], ahead_[g.b])) return OverlapKind::merge;
    if (from_the_begin && have_common(behind_[g.a], behind_[g.b])) return OverlapKind::split;
    auto const distance = [&](double s, double t) {
      return (a.path.pose(s).position() - b.path.pose(t).position()).norm();
    };
    double const at_begin = distance(g.on_a.begin, g.on_b.begin), at_end = distance(g.on_a.end, g.on_b.end);
    return at_begin < at_end - 0.01 ? OverlapKind::split : OverlapKind::merge;
  }

  std::vector<Lane>& lanes_;
  LaneElevation const& elevation_;
  double clearance_;
  OverlapEnds ends_;
  std::vector<std::size_t> cross_section_of_;        ///< each lane
  std::vector<std::vector<LaneId>> cross_sections_;  ///< lanes side by side
  std::vector<std::vector<LaneId>> ahead_, behind_;  ///< by lane
  std::vector<std::vector<Joint>> joints_;           ///< by lane
  std::vector<Contact> contacts_;                    ///< of the present lane with others
  std::vector<std::size_t> last_contact_;            ///< by the other lane
};

}  // namespace detail

CAMBIUM_COLD void find_overlaps(std::vector<Lane>& lanes, LaneElevation const& elevation, double clearance,
                                ExactPath const& place) {
  detail::OverlapFinder(lanes, elevation, clearance, place).find();
}

}  // namespace cambium::inline v0_1::map
