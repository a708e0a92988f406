#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <tuple>
#include <vector>

#include "cambium/core/ids.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/map/detail/box_tree.hpp"
#include "cambium/map/lane.hpp"

namespace cambium::map {

/// Height of a lane's path at path position `s` [m].
using LaneElevation = std::function<double(Lane const&, double s)>;

namespace detail {

/// A stretch of something [m].
struct Stretch {
  double begin{}, end{};

  [[nodiscard]] double middle() const { return 0.5 * (begin + end); }
  /// Whether the two have a point in common, up to a millimetre.
  [[nodiscard]] bool touches(Stretch const& o) const { return begin <= o.end + 1e-3 && o.begin <= end + 1e-3; }
  void add(Stretch const& o) {
    begin = std::min(begin, o.begin);
    end = std::max(end, o.end);
  }
};

/// The stretch of segment `a` (path positions) that is closer than `clearance` to segment `b`, exactly: what is that close to `b`
/// is convex, a rectangle with two half discs. Nothing where it is shorter than a micrometre.
[[nodiscard]] inline std::optional<Stretch> stretch_near(geometry::Line::Segment const& a, geometry::Line::Segment const& b,
                                                         double clearance) {
  double const dx = a.x - b.x, dy = a.y - b.y;
  Stretch result{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  auto const add_disc = [&](double cx, double cy) {  // |(c + u a)| < clearance, from its centre
    double const half = cx * a.ux + cy * a.uy;
    double const root = half * half - (cx * cx + cy * cy - clearance * clearance);
    if (root > 0.0) result.add({-half - std::sqrt(root), -half + std::sqrt(root)});
  };
  add_disc(dx, dy);
  add_disc(dx - b.ux * b.length, dy - b.uy * b.length);
  Stretch inside{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  auto const cut = [&inside](double value, double slope, double low, double high) {
    if (std::abs(slope) < 1e-12) {
      if (value <= low || value >= high) inside = {1.0, 0.0};
      return;
    }
    double const p = (low - value) / slope, q = (high - value) / slope;
    inside = {std::max(inside.begin, std::min(p, q)), std::min(inside.end, std::max(p, q))};
  };
  cut(dx * b.ux + dy * b.uy, a.ux * b.ux + a.uy * b.uy, 0.0, b.length);
  cut(b.ux * dy - b.uy * dx, b.ux * a.uy - b.uy * a.ux, -clearance, clearance);
  if (inside.begin < inside.end) result.add(inside);
  result = {std::max(result.begin, 0.0), std::min(result.end, a.length)};
  if (!(result.end - result.begin > 1e-6)) return std::nullopt;
  return Stretch{a.s + result.begin, a.s + result.end};
}

/// See `find_overlaps`.
class OverlapFinder {
 public:
  OverlapFinder(std::vector<Lane>& lanes, LaneElevation const& elevation, double clearance)
      : lanes_(lanes), elevation_(elevation), clearance_(clearance) {}

  void find() {
    for (auto& lane : lanes_) lane.overlaps.clear();
    find_related();
    find_contacts();
    std::sort(contacts_.begin(), contacts_.end(), [](Contact const& l, Contact const& r) {
      return std::tie(l.a, l.b, l.on_a.begin, l.on_b.begin) < std::tie(r.a, r.b, r.on_a.begin, r.on_b.begin);
    });
    for (auto begin = contacts_.begin(); begin != contacts_.end();) {
      auto const end = std::find_if(begin, contacts_.end(), [&](Contact const& c) { return c.a != begin->a || c.b != begin->b; });
      join({begin, end});
      begin = end;
    }
    for (auto& lane : lanes_)
      std::sort(lane.overlaps.begin(), lane.overlaps.end(), [](Overlap const& l, Overlap const& r) {
        return std::tie(l.begin, l.other, l.other_begin) < std::tie(r.begin, r.other, r.other_begin);
      });
  }

 private:
  /// Stretches of the lanes `a` < `b` that are close to each other.
  struct Contact {
    std::uint32_t a, b;
    Stretch on_a, on_b;
  };
  struct Place {
    std::uint32_t lane, segment;
  };

  /// For each lane those that it hangs together with: being close to them is no conflict.
  void find_related() {
    related_.assign(lanes_.size(), {});
    for (std::size_t i = 0; i < lanes_.size(); ++i) {
      auto& related = related_[i];
      add_successors(lanes_[i], 0.0, related);
      for (auto const next : lanes_[i].successors) {
        add_if_valid(lanes_[index_of(next)].left_neighbor, related);
        add_if_valid(lanes_[index_of(next)].right_neighbor, related);
      }
      for (auto const before : lanes_[i].predecessors) {
        add_if_valid(lanes_[index_of(before)].left_neighbor, related);
        add_if_valid(lanes_[index_of(before)].right_neighbor, related);
      }
    }
  }

  static void add_if_valid(LaneId id, std::vector<std::uint32_t>& related) {
    if (is_valid(id)) related.push_back(static_cast<std::uint32_t>(id));
  }

  /// The lanes behind this one's end, and those behind them while they are too short to come between.
  void add_successors(Lane const& lane, double between, std::vector<std::uint32_t>& related) const {
    for (auto const next : lane.successors) {
      related.push_back(static_cast<std::uint32_t>(next));
      double const length = between + lanes_[index_of(next)].length();
      if (length < 2.0 * clearance_ && related.size() < 64) add_successors(lanes_[index_of(next)], length, related);
    }
  }

  [[nodiscard]] bool are_related(std::uint32_t a, std::uint32_t b) const {
    auto const has = [](std::vector<std::uint32_t> const& list, std::uint32_t id) { return std::find(list.begin(), list.end(), id) != list.end(); };
    return has(related_[a], b) || has(related_[b], a);
  }

  /// The segment's range of road stations [m].
  [[nodiscard]] static Stretch stations(Lane const& lane, geometry::Line::Segment const& g) {
    double const scale = (lane.road_end - lane.road_begin) / lane.length();
    if (lane.along_road) return {lane.road_begin + scale * g.s, lane.road_begin + scale * (g.s + g.length)};
    return {lane.road_end - scale * (g.s + g.length), lane.road_end - scale * g.s};
  }

  /// Lanes of one road are side by side, or one after the other, where their stations are about the same.
  [[nodiscard]] bool are_beside(Lane const& a, geometry::Line::Segment const& ga, Lane const& b, geometry::Line::Segment const& gb) const {
    if (a.road != b.road || a.merges_into == b.id || b.merges_into == a.id) return false;
    auto const on_a = stations(a, ga), on_b = stations(b, gb);
    return std::max(on_a.begin, on_b.begin) - std::min(on_a.end, on_b.end) < 10.0;
  }

  void find_contacts() {
    std::vector<Box> boxes;
    std::vector<Place> places;
    for (std::uint32_t i = 0; i < lanes_.size(); ++i) {
      if (!lanes_[i].drivable()) continue;
      auto const segments = lanes_[i].path.segments();
      for (std::uint32_t k = 0; k < segments.size(); ++k) {
        auto const& g = segments[k];
        Box box;
        box.add(g.x, g.y);
        box.add(g.x + g.ux * g.length, g.y + g.uy * g.length);
        boxes.push_back(box);
        places.push_back({i, k});
      }
    }
    BoxTree const tree(boxes);
    for (std::uint32_t i = 0; i < boxes.size(); ++i)
      tree.visit(boxes[i].grown(clearance_), [&](std::uint32_t j) {
        if (places[i].lane < places[j].lane) add_contact(places[i], places[j]);
        return false;
      });
  }

  void add_contact(Place const& pa, Place const& pb) {
    auto const &a = lanes_[pa.lane], &b = lanes_[pb.lane];
    auto const &ga = a.path.segments()[pa.segment], &gb = b.path.segments()[pb.segment];
    if (are_beside(a, ga, b, gb) || are_related(pa.lane, pb.lane)) return;
    auto const on_a = stretch_near(ga, gb, clearance_);
    if (!on_a) return;
    auto const on_b = stretch_near(gb, ga, clearance_);
    if (!on_b) return;
    constexpr double clear_height = 3.0;  // [m] enough for one to pass under the other
    if (elevation_ && std::abs(elevation_(a, on_a->middle()) - elevation_(b, on_b->middle())) > clear_height) return;
    contacts_.push_back({pa.lane, pb.lane, *on_a, *on_b});
  }

  /// Joins the contacts of one pair of lanes that touch on both of them, and enters an overlap for each group.
  void join(std::vector<Contact> contacts) {
    std::vector<Contact> groups;
    for (auto contact : contacts) {
      for (std::size_t i = 0; i < groups.size();) {
        if (!groups[i].on_a.touches(contact.on_a) || !groups[i].on_b.touches(contact.on_b)) {
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
    for (auto const& g : groups) {
      auto &a = lanes_[g.a], &b = lanes_[g.b];
      auto const kind = kind_of(a, g.on_a, b, g.on_b);
      a.overlaps.push_back({b.id, kind, g.on_a.begin, g.on_a.end, g.on_b.begin, g.on_b.end});
      b.overlaps.push_back({a.id, kind, g.on_b.begin, g.on_b.end, g.on_a.begin, g.on_a.end});
    }
  }

  [[nodiscard]] static OverlapKind kind_of(Lane const& a, Stretch const& on_a, Lane const& b, Stretch const& on_b) {
    auto const heading = [](Lane const& lane, Stretch const& on) { return lane.path.pose(on.middle()).heading; };
    double const turn = std::abs(geometry::angle_difference(heading(a, on_a), heading(b, on_b)));
    if (turn > geometry::pi / 3) return OverlapKind::crossing;
    auto const share = [](std::vector<LaneId> const& l, std::vector<LaneId> const& r) {
      return std::any_of(l.begin(), l.end(), [&r](LaneId id) { return std::find(r.begin(), r.end(), id) != r.end(); });
    };
    constexpr double close = 0.1;  // [m] to a lane's end
    bool const to_the_end = on_a.end > a.length() - close && on_b.end > b.length() - close;
    bool const from_the_begin = on_a.begin < close && on_b.begin < close;
    if (to_the_end && share(a.successors, b.successors)) return OverlapKind::merge;
    if (from_the_begin && share(a.predecessors, b.predecessors)) return OverlapKind::split;
    auto const distance = [&](double s, double t) { return (a.path.pose(s).position() - b.path.pose(t).position()).norm(); };
    double const at_begin = distance(on_a.begin, on_b.begin), at_end = distance(on_a.end, on_b.end);
    return at_begin < at_end - 0.01 ? OverlapKind::split : OverlapKind::merge;
  }

  std::vector<Lane>& lanes_;
  LaneElevation const& elevation_;
  double clearance_;
  std::vector<std::vector<std::uint32_t>> related_;
  std::vector<Contact> contacts_;
};

}  // namespace detail

/// Fills `Lane::overlaps` of the drivable lanes: the stretches on which two lanes' paths are closer than `clearance` [m], on both
/// lanes, exactly for the sampled paths. `elevation` may be empty; where it is given, paths more than 3 m above each other do
/// not overlap. A lane's number must be its place in `lanes`. O((n + k) log n) for n path segments, k pairs of them that are close.
///
/// Left out are lanes that belong together anyway: one behind the other (also with lanes in between that are shorter than twice
/// the clearance), neighbours of those, and lanes of the same road at the same station, unless one merges into the other.
/// Kinds: crossing where the directions differ by more than 60 degrees in the middle of the stretch; else merge where both end in
/// a common successor; else split where both begin behind a common predecessor; else split where they are closer at the stretch's
/// begin than at its end; else merge.
inline void find_overlaps(std::vector<Lane>& lanes, LaneElevation const& elevation, double clearance) {
  detail::OverlapFinder(lanes, elevation, clearance).find();
}

}  // namespace cambium::map
