#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <tuple>

#include "cambium/core/parameters.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/geometry/collision.hpp"
#include "cambium/geometry/oriented_box.hpp"
#include "cambium/geometry/polygon.hpp"
#include "cambium/geometry/pose.hpp"
#include "cambium/observer/observer_model.hpp"

namespace cambium {

namespace detail {

/// What a convex body covers of the view from a point, as seen towards another: directions [rad] from the middle of
/// that one, counter-clockwise. `from` > `to`: nothing.
struct ViewInterval {
  double from = 1.0, to = -1.0;

  [[nodiscard]] bool empty() const { return !(from <= to); }
};

/// The directions in which the hull of `corners` lies from `eye`, counted from `axis` (a unit vector). The eye is
/// outside of the hull; of a body all around behind it the part at the back is cut off.
[[nodiscard]] inline ViewInterval interval_of(std::span<geometry::Point const> corners, geometry::Point const& eye,
                                              geometry::Point const& axis) {
  // Relative to the first corner, so that none lies more than half a turn away from another.
  auto const direction = [&](geometry::Point const& p, geometry::Point const& from) {
    return std::atan2(from.x() * p.y() - from.y() * p.x(), from.x() * p.x() + from.y() * p.y());
  };
  geometry::Point const first = corners[0] - eye;
  double const base = direction(first, axis);
  ViewInterval interval{base, base};
  for (auto const& corner : corners.subspan(1)) {
    double const angle = base + direction(corner - eye, first);
    interval.from = std::min(interval.from, angle);
    interval.to = std::max(interval.to, angle);
  }
  return interval;
}

/// How far the hull of `corners` is from `eye` in direction `ray` (a unit vector) [m]; infinite where it is not there.
[[nodiscard]] inline double distance_along(std::span<geometry::Point const> corners, geometry::Point const& eye,
                                           geometry::Point const& ray) {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    geometry::Point const a = corners[i] - eye, b = corners[(i + 1) % corners.size()] - eye;
    double const left_a = ray.x() * a.y() - ray.y() * a.x(), left_b = ray.x() * b.y() - ray.y() * b.x();
    if ((left_a > 0.0) == (left_b > 0.0)) continue;
    double const u = left_a / (left_a - left_b);
    double const along = (a + u * (b - a)).dot(ray);
    if (along >= 0.0) nearest = std::min(nearest, along);
  }
  return nearest;
}

/// The look at one vehicle.
class Sight {
 public:
  Sight(geometry::Point const& eye, geometry::OrientedBox const& target)
      : eye_(eye),
        center_(target.center()),
        radius_(std::hypot(target.half_length, target.half_width)),
        corners_(target.corners()) {
    double const distance = (center_ - eye_).norm();
    if (distance > 0.0) axis_ = (center_ - eye_) / distance;
    seen_ = interval_of(corners_, eye_, axis_);
  }

  /// Whether a part at least `resolution` [rad] wide is left of it; `each_cover(f)` calls `f(ViewInterval)` for what
  /// lies in front.
  template <class EachCover>
  [[nodiscard]] bool has_clear_part(double resolution, EachCover const& each_cover) const {
    double at = seen_.from;
    while (at < seen_.to) {
      double covered = at, next = seen_.to;
      each_cover([&](ViewInterval const& cover) {
        for (double const turn : {-2 * geometry::pi, 0.0, 2 * geometry::pi}) {
          double const from = cover.from + turn, to = cover.to + turn;
          if (from <= at)
            covered = std::max(covered, to);
          else
            next = std::min(next, from);
        }
      });
      if (covered > at) {
        at = covered;
        continue;
      }
      if (next - at >= resolution) return true;
      at = next;
    }
    return false;
  }

  /// False where a vehicle is clearly not between the eye and the target.
  template <MotionState S>
  [[nodiscard]] bool may_cover(geometry::Shape const& shape, S const& state) const {
    double const reach = std::max(shape.front, shape.rear) + std::max(shape.left, shape.right);
    return geometry::distance_to_segment({state.x, state.y}, eye_, center_) <= reach + radius_;
  }

  /// What a body within `radius` of `middle` covers; nothing unless it is between the eye and the target.
  [[nodiscard]] ViewInterval cover_of(std::span<geometry::Point const> corners, geometry::Point const& middle,
                                      double radius) const {
    if (geometry::distance_to_segment(middle, eye_, center_) > radius + radius_) return {};
    auto const body = interval_of(corners, eye_, axis_);
    for (double const turn : {-2 * geometry::pi, 0.0, 2 * geometry::pi}) {
      double const from = std::max(body.from + turn, seen_.from), to = std::min(body.to + turn, seen_.to);
      if (!(from < to)) continue;
      // Of two convex bodies that do not meet the same one is in front wherever both are seen.
      auto const [sin, cos] = geometry::sin_cos(0.5 * (from + to));
      geometry::Point const ray{axis_.x() * cos - axis_.y() * sin, axis_.x() * sin + axis_.y() * cos};
      if (distance_along(corners, eye_, ray) < distance_along(corners_, eye_, ray)) return body;
    }
    return {};
  }

  /// What lies outside of a field of view about `heading`.
  [[nodiscard]] ViewInterval outside(double heading, double field_of_view) const {
    double const half = geometry::pi - 0.5 * field_of_view;
    if (!(half > 0.0)) return {};
    double const back = geometry::normalize_angle(heading + geometry::pi - std::atan2(axis_.y(), axis_.x()));
    return {back - half, back + half};
  }

 private:
  geometry::Point eye_, center_, axis_{1.0, 0.0};
  double radius_;
  std::array<geometry::Point, 4> corners_;
  ViewInterval seen_;
};

}  // namespace detail

/// Sees by line of sight from the middle of its vehicle: whoever is within `range` and of whom some part, `resolution`
/// wide at least, lies in its field of view and is hidden neither by a vehicle nor by a static object. Those it sees as
/// they are, the others not at all. Static objects are known, as the map is. Exact for the rectangles of vehicles. Who
/// overlaps with the observer's middle is seen. O(agents + edges of objects) for each part that is hidden.
struct OccludedObserver {
  double range = 150.0;
  double field_of_view = 2 * geometry::pi;
  double resolution = 1e-3;
  bool behind_vehicles = false;
  bool behind_objects = false;

  static constexpr bool perfect = false;
  static constexpr char const* name = "occluded";
  static constexpr char const* summary =
      "sees who is within range and field of view, and hidden neither by vehicles nor by static objects";
  static constexpr char const* source = "geometry of lines of sight";
  static constexpr auto parameters() {
    using P = OccludedObserver;
    return std::make_tuple(
        parameter("range", &P::range, "m", Range{0, 1e6}, "to the nearest point of a vehicle"),
        parameter("field_of_view", &P::field_of_view, "rad", Range{0, 7}, "about the own heading; 2 pi: all around"),
        parameter("resolution", &P::resolution, "rad", Range{0, 1}, "what appears smaller is not seen"),
        parameter("behind_vehicles", &P::behind_vehicles, "-", Range{0, 1}, "vehicles do not hide others"),
        parameter("behind_objects", &P::behind_objects, "-", Range{0, 1}, "static objects do not hide vehicles"));
  }

  template <MotionState S>
  [[nodiscard]] S const& observe(S const& truth, bool, RandomStream const&) const {
    return truth;
  }

  template <class Scene>
  [[nodiscard]] bool sees(Scene const& scene, std::uint32_t own, std::uint32_t other) const {
    auto const eye = geometry::box_of(scene.shape(own), scene.state(own)).center();
    auto const target = geometry::box_of(scene.shape(other), scene.state(other));
    if (geometry::distance(target, eye) > range) return false;
    if (target.contains(eye)) return true;
    detail::Sight const sight(eye, target);
    return sight.has_clear_part(resolution, [&](auto const& cover) {
      if (auto const hidden = sight.outside(scene.state(own).heading, field_of_view); !hidden.empty()) cover(hidden);
      if (!behind_vehicles) cover_by_vehicles(scene, own, other, sight, eye, cover);
      if (!behind_objects) cover_by_objects(scene, sight, cover);
    });
  }

 private:
  template <class Scene, class Cover>
  static void cover_by_vehicles(Scene const& scene, std::uint32_t own, std::uint32_t other, detail::Sight const& sight,
                                geometry::Point const& eye, Cover const& cover) {
    for (std::uint32_t i = 0; i < scene.size(); ++i) {
      if (i == own || i == other || !scene.in_traffic(i) || !sight.may_cover(scene.shape(i), scene.state(i))) continue;
      auto const box = geometry::box_of(scene.shape(i), scene.state(i));
      if (box.contains(eye)) continue;
      auto const corners = box.corners();
      auto const hidden = sight.cover_of(corners, box.center(), std::hypot(box.half_length, box.half_width));
      if (!hidden.empty()) cover(hidden);
    }
  }

  template <class Scene, class Cover>
  static void cover_by_objects(Scene const& scene, detail::Sight const& sight, Cover const& cover) {
    for (auto const& object : scene.objects())
      for (std::size_t i = 0; i < object.outline.size(); ++i) {
        auto const [a, b] = object.outline.edge(i);
        std::array<geometry::Point, 2> const ends{a, b};
        auto const hidden = sight.cover_of(ends, 0.5 * (a + b), 0.5 * (b - a).norm());
        if (!hidden.empty()) cover(hidden);
      }
  }
};
static_assert(ObserverModel<OccludedObserver>);

}  // namespace cambium
