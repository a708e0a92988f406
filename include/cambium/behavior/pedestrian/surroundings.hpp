#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "cambium/behavior/pedestrian/social_force.hpp"
#include "cambium/geometry/box.hpp"
#include "cambium/geometry/collision.hpp"
#include "cambium/geometry/oriented_box.hpp"
#include "cambium/geometry/polygon.hpp"

namespace cambium::inline v0_1::detail {

/// A line that a pedestrian must not pass: at most `room` [m] in the direction of the unit vector `across`. Below 0 it
/// has passed the line already, and goes no farther.
struct KerbLine {
  PlaneVector<double> across;
  double room;
};

/// Road users and objects around a pedestrian, without heap.
struct Surroundings {
  using Vector = PlaneVector<double>;

  static constexpr std::size_t most = 32;

  struct Other {
    geometry::OrientedBox box;
    Vector velocity;
    double distance;
    double radius;  ///< of a round body; 0 for a rectangle
  };

  std::array<Other, most> others;
  std::array<geometry::Polygon const*, most> objects;
  std::size_t other_count = 0, object_count = 0;
  double sight_cosine = 0.0;  ///< cosine of half the angle in which others count fully
  double elapsed = 0.0;       ///< since the others were where they were seen [s]

  /// Adds a road user; keeps the nearest ones if there are too many.
  void add(Other const& other) {
    if (other_count < most) {
      others[other_count++] = other;
      return;
    }
    auto const farthest = std::max_element(others.begin(), others.end(),
                                           [](Other const& a, Other const& b) { return a.distance < b.distance; });
    if (other.distance < farthest->distance) *farthest = other;
  }

  /// Others move straight on for `h` [s].
  void advance(double h) {
    elapsed += h;
    for (std::size_t i = 0; i < other_count; ++i) {
      others[i].box.x += h * others[i].velocity.x;
      others[i].box.y += h * others[i].velocity.y;
    }
  }

  /// Where somebody gets who wants to go straight `from` there `to` here: beside all vehicles and objects, which it
  /// comes no nearer than `body` [m], or than it was; and not past `kerb`. It slides along what is in its way, and
  /// stays where it is if it cannot. From inside of one it may walk out. O(others + corners of objects).
  [[nodiscard]] Vector way_past(Vector const& from, Vector to, double body, KerbLine const& kerb) const {
    constexpr int passes = 4;  // a corner between two vehicles takes two
    for (int pass = 0; pass < passes; ++pass) {
      bool is_clear = true;
      for (std::size_t i = 0; i < other_count; ++i)
        if (others[i].radius == 0.0) is_clear &= keep_beside(kept_free(others[i], from), from, to, body);
      for (std::size_t i = 0; i < object_count; ++i)
        if (objects[i]->bounding_box().grown(body).intersects(box_around(from, to)))
          is_clear &= keep_beside(*objects[i], from, to, body);
      double const over = dot(to - from, kerb.across) - std::max(0.0, kerb.room);
      if (over > rounding) {
        to = to - over * kerb.across;
        is_clear = false;
      }
      if (is_clear) return to;
    }
    return from;
  }

 private:
  static constexpr double rounding = 1e-7;  // [m] coordinates may have seven digits before the point

  [[nodiscard]] static geometry::Box box_around(Vector const& a, Vector const& b) {
    return {std::min(a.x, b.x), std::min(a.y, b.y), std::max(a.x, b.x), std::max(a.y, b.y)};
  }
  /// A stride so long that it could lead through an object.
  [[nodiscard]] static bool is_far(Vector const& from, Vector const& to, double body) {
    return dot(to - from, to - from) > body * body;
  }

  /// What a vehicle covers even if it brakes: from where it was seen to where it can stop. Who is already in front of
  /// it looks out for the vehicle alone.
  [[nodiscard]] geometry::OrientedBox kept_free(Other const& other, Vector const& from) const {
    constexpr double hardest = 5.0;  // [m/s^2] as `Idm::lowest_acceleration`
    auto const& now = other.box;
    double const speed = other.velocity.x * now.cos + other.velocity.y * now.sin;
    double const back = -speed * elapsed, stop = speed * std::abs(speed) / (2.0 * hardest);
    auto const stretched = [&now](double a, double b) {
      double const low = std::min({a, b, 0.0}), high = std::max({a, b, 0.0}), middle = 0.5 * (low + high);
      auto box = now;
      box.x += middle * now.cos;
      box.y += middle * now.sin;
      box.half_length += 0.5 * (high - low);
      return box;
    };
    auto const all = stretched(back, stop);
    return all.contains({from.x, from.y}) ? stretched(back, 0.0) : all;
  }

  /// Moves `to` out of `region`, grown by `body` [m] but no nearer than `from` is; returns whether it is out already.
  template <class Region>
  [[nodiscard]] static bool keep_beside(Region const& region, Vector const& from, Vector& to, double body) {
    geometry::Point const begin{from.x, from.y}, end{to.x, to.y};
    double const room = std::min(body, geometry::distance(region, begin));
    if (!(room > 0.0)) return true;
    auto const near = geometry::nearest_point(region, end);
    Vector const apart{end.x() - near.x(), end.y() - near.y()};
    double const distance = apart.norm();
    bool const leads_through = is_far(from, to, body) && meets(region, begin, end);
    if (distance + rounding >= room && !leads_through) return true;
    bool const has_side = distance > rounding && !leads_through;
    to = has_side ? Vector{near.x(), near.y()} + (room / distance) * apart : from;
    return false;
  }

  [[nodiscard]] static bool meets(geometry::OrientedBox const& box, geometry::Point const& a,
                                  geometry::Point const& b) {
    return geometry::detail::segment_meets_box<true>(a, b, box);
  }
  [[nodiscard]] static bool meets(geometry::Polygon const& polygon, geometry::Point const& a,
                                  geometry::Point const& b) {
    for (std::size_t i = 0; i < polygon.size(); ++i)
      if (geometry::segments_intersect(a, b, polygon.edge(i).first, polygon.edge(i).second)) return true;
    return false;
  }
};

}  // namespace cambium::inline v0_1::detail
