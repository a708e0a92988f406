#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "cambium/core/ids.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/geometry/collision.hpp"
#include "cambium/geometry/oriented_box.hpp"
#include "cambium/geometry/polygon.hpp"
#include "cambium/geometry/pose.hpp"
#include "cambium/observer/observer_model.hpp"

namespace cambium::inline v0_1 {

namespace detail {

/// The interval of directions that a convex body covers in the view from the eye [rad], counter-clockwise from the
/// direction of the target's middle. Empty if `from` > `to`.
struct ViewInterval {
  double from = 1.0, to = -1.0;

  [[nodiscard]] bool empty() const { return !(from <= to); }
};

/// The directions in which the hull of `corners` appears from `eye`, relative to `axis` (a unit vector). The eye must
/// be outside the hull. If the body extends around behind the eye, the part at the back is cut off.
[[nodiscard]] inline ViewInterval interval_of(std::span<geometry::Point const> corners, geometry::Point const& eye,
                                              geometry::Point const& axis) {
  // Angles relative to the first corner differ by at most half a turn.
  auto const direction = [&](geometry::Point const& p, geometry::Point const& from) {
    return portable::atan2(from.x() * p.y() - from.y() * p.x(), from.x() * p.x() + from.y() * p.y());
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

/// Distance from `eye` to the hull of `corners` in direction `ray` (a unit vector) [m]; infinite if the ray misses it.
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

/// The view of one convex target of up to four corners: a vehicle, or an edge of a static object.
class Sight {
 public:
  Sight(geometry::Point const& eye, geometry::OrientedBox const& target)
      : eye_(eye),
        center_(target.center()),
        radius_(portable::hypot(target.half_length, target.half_width)),
        corners_(target.corners()) {
    look();
  }
  Sight(geometry::Point const& eye, geometry::Point const& a, geometry::Point const& b)
      : eye_(eye), center_(0.5 * (a + b)), radius_(0.5 * (b - a).norm()), corners_{a, b, a, b}, count_(2) {
    look();
  }

  /// The reference direction of all angles [rad], map frame.
  [[nodiscard]] double axis() const { return portable::atan2(axis_.y(), axis_.x()); }

  /// Calls `f(ViewInterval)` for each visible part of the target until `f` returns true; returns whether it did.
  /// `each_cover(g)` calls `g(ViewInterval)` for each body in front.
  template <class EachCover, class F>
  bool any_clear_part(EachCover const& each_cover, F const& f) const {
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
      if (f(ViewInterval{at, next})) return true;
      at = next;
    }
    return false;
  }

  /// False if a vehicle is clearly not between the eye and the target.
  template <MotionState S>
  [[nodiscard]] bool may_cover(geometry::Shape const& shape, S const& state) const {
    double const reach = std::max(shape.front, shape.rear) + std::max(shape.left, shape.right);
    return geometry::distance_to_segment({state.x, state.y}, eye_, center_) <= reach + radius_;
  }

  /// The interval that a body within `radius` of `middle` covers; empty unless it is between the eye and the target.
  [[nodiscard]] ViewInterval cover_of(std::span<geometry::Point const> corners, geometry::Point const& middle,
                                      double radius) const {
    if (geometry::distance_to_segment(middle, eye_, center_) > radius + radius_) return {};
    auto const body = interval_of(corners, eye_, axis_);
    for (double const turn : {-2 * geometry::pi, 0.0, 2 * geometry::pi}) {
      double const from = std::max(body.from + turn, seen_.from), to = std::min(body.to + turn, seen_.to);
      if (!(from < to)) continue;
      // Of two disjoint convex bodies, the same one is in front in all directions that they share.
      auto const [sin, cos] = portable::sin_cos(0.5 * (from + to));
      geometry::Point const ray{axis_.x() * cos - axis_.y() * sin, axis_.x() * sin + axis_.y() * cos};
      if (distance_along(corners, eye_, ray) < distance_along(corners_of_target(), eye_, ray)) return body;
    }
    return {};
  }

  /// The directions outside a field of view centred on `heading`.
  [[nodiscard]] ViewInterval outside(double heading, double field_of_view) const {
    double const half = geometry::pi - 0.5 * field_of_view;
    if (!(half > 0.0)) return {};
    double const back = geometry::normalize_angle(heading + geometry::pi - portable::atan2(axis_.y(), axis_.x()));
    return {back - half, back + half};
  }

 private:
  void look() {
    double const distance = (center_ - eye_).norm();
    if (distance > 0.0) axis_ = (center_ - eye_) / distance;
    seen_ = interval_of(corners_of_target(), eye_, axis_);
  }

  [[nodiscard]] std::span<geometry::Point const> corners_of_target() const { return {corners_.data(), count_}; }

  geometry::Point eye_, center_, axis_{1.0, 0.0};
  double radius_;
  std::array<geometry::Point, 4> corners_;
  std::size_t count_ = 4;
  ViewInterval seen_;
};

}  // namespace detail

/// Sees along lines of sight from the middle of its vehicle. An agent or static object is visible if it is within
/// `range` and a part of it, at least `resolution` wide, lies in the field of view and is not hidden by a vehicle or a
/// static object. The observer sees visible road users in their true states and the others not at all. Exact for the
/// rectangles of vehicles and the outlines of objects. An agent that overlaps the observer's middle is visible.
/// O(agents + edges of objects) for each hidden part; for static objects, times their edges.
///
///     eye >------------- [truck] - - - [a]     a is hidden behind the truck
///         `---------------------> [b]           b is visible: nothing covers its directions
struct OccludedObserver {
  double range = 150.0;
  double field_of_view = 2 * geometry::pi;
  double resolution = 1e-3;
  bool behind_vehicles = false;
  bool behind_objects = false;
  bool objects_known = false;

  static constexpr bool perfect = false;
  static constexpr char const* name = "occluded";
  static constexpr char const* summary =
      "sees vehicles and static objects that are within range and field of view, and not hidden by others";
  static constexpr char const* source = "geometry of lines of sight";
  static constexpr auto parameters() {
    using P = OccludedObserver;
    return parameter_list(
        parameter("range", &P::range, "m", Range{0, 1e6}, "largest distance to the nearest point of a vehicle"),
        parameter("field_of_view", &P::field_of_view, "rad", Range{0, 7},
                  "angle centred on the heading; 2 pi: all around"),
        parameter("resolution", &P::resolution, "rad", Range{0, 1}, "smallest visible angle"),
        parameter("behind_vehicles", &P::behind_vehicles, "sees through vehicles"),
        parameter("behind_objects", &P::behind_objects, "sees through static objects"),
        parameter("objects_known", &P::objects_known, "knows all static objects, as if from a map"));
  }

  template <MotionState S>
  [[nodiscard]] S const& observe(S const& truth, bool, RandomStream const&) const {
    return truth;
  }

  template <class Scene>
  [[nodiscard]] bool sees(Scene const& scene, Slot own, Slot other) const {
    auto const eye = geometry::box_of(scene.shape(own), scene.state(own)).center();
    auto const target = geometry::box_of(scene.shape(other), scene.state(other));
    if (geometry::distance(target, eye) > range) return false;
    if (target.contains(eye)) return true;
    detail::Sight const sight(eye, target);
    return sight.any_clear_part([&](auto const& cover) { cover_all(scene, own, other, nobody, sight, eye, cover); },
                                [&](detail::ViewInterval const& part) { return part.to - part.from >= resolution; });
  }

  template <class Scene>
  [[nodiscard]] bool sees_object(Scene const& scene, Slot own, Slot object) const {
    if (objects_known) return true;
    auto const eye = geometry::box_of(scene.shape(own), scene.state(own)).center();
    auto const& outline = scene.objects()[object].outline;
    if (geometry::distance(outline, eye) > range) return false;
    if (outline.contains(eye)) return true;
    // Adjacent visible parts of its edges count as one part.
    return any_clear_edge(scene, own, object, eye, [&](detail::ViewInterval part) {
      bool grows = part.to - part.from < resolution;
      while (grows) {
        grows = any_clear_edge(scene, own, object, eye, [&](detail::ViewInterval const& next) {
          for (double const turn : {-2 * geometry::pi, 0.0, 2 * geometry::pi}) {
            if (next.from + turn > part.to + 1e-9 || next.to + turn <= part.to + 1e-9) continue;
            part.to = next.to + turn;
            return true;
          }
          return false;
        });
        grows = grows && part.to - part.from < resolution;
      }
      return part.to - part.from >= resolution;
    });
  }

 private:
  static constexpr Slot nobody = none<Slot>;

  /// Calls `f(ViewInterval)`, map frame, for each visible part of the object's edges until `f` returns true; returns
  /// whether it did.
  template <class Scene, class F>
  bool any_clear_edge(Scene const& scene, Slot own, Slot object, geometry::Point const& eye, F const& f) const {
    auto const& outline = scene.objects()[object].outline;
    for (std::size_t i = 0; i < outline.size(); ++i) {
      auto const ends = outline.edge(i);
      detail::Sight const sight(eye, ends.first, ends.second);
      bool const done =
          sight.any_clear_part([&](auto const& cover) { cover_all(scene, own, nobody, object, sight, eye, cover); },
                               [&](detail::ViewInterval const& part) {
                                 double const axis = sight.axis();
                                 return f(detail::ViewInterval{axis + part.from, axis + part.to});
                               });
      if (done) return true;
    }
    return false;
  }

  /// Calls `cover(ViewInterval)` for each body that hides the target of `sight`: agent `other`, or object `object`.
  template <class Scene, class Cover>
  void cover_all(Scene const& scene, Slot own, Slot other, Slot object, detail::Sight const& sight,
                 geometry::Point const& eye, Cover const& cover) const {
    if (auto const hidden = sight.outside(scene.state(own).heading, field_of_view); !hidden.empty()) cover(hidden);
    if (!behind_vehicles) cover_by_vehicles(scene, own, other, sight, eye, cover);
    if (!behind_objects) cover_by_objects(scene, object, sight, cover);
  }

  template <class Scene, class Cover>
  static void cover_by_vehicles(Scene const& scene, Slot own, Slot other, detail::Sight const& sight,
                                geometry::Point const& eye, Cover const& cover) {
    for (Slot i{}; index_of(i) < scene.size(); ++i) {
      if (i == own || i == other || !scene.in_traffic(i) || !sight.may_cover(scene.shape(i), scene.state(i))) continue;
      auto const box = geometry::box_of(scene.shape(i), scene.state(i));
      if (box.contains(eye)) continue;
      auto const corners = box.corners();
      auto const hidden = sight.cover_of(corners, box.center(), portable::hypot(box.half_length, box.half_width));
      if (!hidden.empty()) cover(hidden);
    }
  }

  template <class Scene, class Cover>
  static void cover_by_objects(Scene const& scene, Slot except, detail::Sight const& sight, Cover const& cover) {
    auto const& objects = scene.objects();
    for (Slot k{}; index_of(k) < objects.size(); ++k) {
      if (k == except) continue;
      auto const& outline = objects[k].outline;
      for (std::size_t i = 0; i < outline.size(); ++i) {
        auto const [a, b] = outline.edge(i);
        std::array<geometry::Point, 2> const ends{a, b};
        auto const hidden = sight.cover_of(ends, 0.5 * (a + b), 0.5 * (b - a).norm());
        if (!hidden.empty()) cover(hidden);
      }
    }
  }
};
static_assert(ObserverModel<OccludedObserver>);

}  // namespace cambium::inline v0_1
