#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "cambium/behavior/behavior_model.hpp"
#include "cambium/behavior/law/follow_lane.hpp"
#include "cambium/behavior/pedestrian/crossing.hpp"
#include "cambium/behavior/pedestrian/social_force.hpp"
#include "cambium/behavior/pedestrian/surroundings.hpp"
#include "cambium/core/distributions.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/geometry/collision.hpp"
#include "cambium/geometry/oriented_box.hpp"
#include "cambium/geometry/polygon.hpp"

namespace cambium::inline v0_1 {

/// A pedestrian that walks along its road corridor by social forces (see `SocialForceParameters`). It follows its way
/// at its desired speed, keeps its distance from others, from the way's borders and from static objects, and crosses
/// lanes when their traffic leaves a gap (see `CrossingParameters`). Others are assumed to move straight on within a
/// step. The way is a free corridor, or lanes for pedestrians.
///
/// Whatever pushes it, it does not walk into vehicles and objects, nor to where a vehicle can no longer stop, nor past
/// the kerb at which it waits: there it slides along, or stands. This holds while the others move as assumed.
///
/// The forces bend its course; its heading follows its velocity. It plans the motion of a point mass and ignores its
/// vehicle model (to execute its plans through the dynamics, give it a `KinematicPoint`).
struct Pedestrian {
  SocialForceParameters social{};
  CrossingParameters crossing{};
  double body_radius = 0.3;
  double look_ahead = 2.0;
  double range = 5.0;
  double fluctuation = 0.1;
  double longest_substep = 0.05;

  static constexpr bool looks_around = true;
  static constexpr char const* name = "pedestrian";
  static constexpr char const* summary =
      "walks along its way, a free corridor or lane, by social forces of others, borders and objects; crosses lanes in "
      "gaps of their traffic";
  static constexpr char const* source = "Helbing, Molnár 1995";
  static constexpr auto parameters() {
    using P = Pedestrian;
    return parameter_list(
        parameter("social", &P::social, "forces"), parameter("crossing", &P::crossing, "crossing lanes"),
        parameter("body_radius", &P::body_radius, "m", Range{0, 5},
                  "of its body; 0.25 to 0.35 in Helbing, Farkas, Vicsek 2000"),
        parameter("look_ahead", &P::look_ahead, "m", Range{0.1, 50},
                  "distance of the point on its way that it aims at"),
        parameter("range", &P::range, "m", Range{0, 50}, "others and objects within this distance count"),
        parameter("fluctuation", &P::fluctuation, "m/s^1.5", Range{0, 10},
                  "random part of its velocity: standard deviation after one second"),
        parameter("longest_substep", &P::longest_substep, "s", Range{0.001, 10},
                  "of the integration; at most 400 in a step"));
  }

  template <class View>
  [[nodiscard]] Plan<View> plan(View const& view, NoMemory&, double dt) const {
    auto const& start = view.state();
    detail::Surroundings around;
    gather(view, dt, around);
    around.sight_cosine = portable::cos(0.5 * social.sight_angle);
    Walk walk{{start.x, start.y}, velocity_of(start), view.place()};
    double const stop = detail::distance_to_stop(crossing, social, view, start.speed) + walk.at.s;
    double const substeps = std::clamp(std::ceil(dt / longest_substep), 1.0, 400.0), h = dt / substeps;
    auto const push = random_push(view, dt);
    for (int i = 0; i < static_cast<int>(substeps); ++i) advance(view, stop, push, h, around, walk);
    return plan_to(view, walk, dt);
  }

 private:
  using Vector = PlaneVector<double>;

  struct Walk {
    Vector position, velocity;
    map::LanePlace at;
  };

  template <MotionState State>
  [[nodiscard]] static Vector velocity_of(State const& state) {
    auto const [sin, cos] = portable::sin_cos(state.heading);
    return {state.speed * cos, state.speed * sin};
  }

  template <class View>
  void gather(View const& view, double dt, detail::Surroundings& around) const {
    geometry::Point const own{view.state().x, view.state().y};
    double const reach = std::max(range, body_of(view) + social.highest_speed_ratio * social.desired_speed * dt);
    view.around(reach, [&](RoadUser const& other) {
      constexpr double largest_body = 1.0;    // [m]
      auto const& state = view.state(other);  // a value if the observer is not perfect
      auto const& shape = view.shape(other);
      auto const box = geometry::box_of(shape, state);
      double const size = std::max(shape.length(), shape.width());
      auto const velocity = velocity_of(state);
      around.add({box, velocity, geometry::distance(box, own), size <= largest_body ? 0.5 * size : 0.0});
    });
    view.for_each_object([&](ObjectId, geometry::Polygon const& outline) {
      if (around.object_count < detail::Surroundings::most && outline.bounding_box().grown(reach).contains(own))
        around.objects[around.object_count++] = &outline;
    });
  }

  /// Radius [m] that holds its body however it is turned.
  template <class View>
  [[nodiscard]] double body_of(View const& view) const {
    return std::max(body_radius, view.shape().radius());
  }

  template <class View>
  [[nodiscard]] Vector random_push(View const& view, double dt) const {
    if (fluctuation == 0.0) return {};
    constexpr std::uint32_t purpose = 0x77616c6b;
    auto random = view.random(purpose);
    double const size = fluctuation / std::sqrt(dt);
    double const x = Normal{0.0, size}(random);
    return {x, Normal{0.0, size}(random)};
  }

  template <class View>
  void advance(View const& view, double stop, Vector const& push, double h, detail::Surroundings& around,
               Walk& walk) const {
    auto const& way = view.corridor();
    auto const sides = way.widths_at(walk.at.s, walk.at.segment);
    // It aims at a point ahead on the way with its own lateral offset, if that is within the way.
    double const aside =
        std::clamp(walk.at.lateral, -std::max(0.0, sides.right - body_radius), std::max(0.0, sides.left - body_radius));
    State aim;
    place_on_lane(way, walk.at.s + look_ahead, aside, 0.0, walk.at.segment, aim);
    Vector const ahead = Vector{aim.x, aim.y} - walk.position;
    // Slow enough not to overshoot the place to stop: critically damped.
    double const room = std::max(0.0, stop - walk.at.s - crossing.stop_margin);
    double const speed = std::min(social.desired_speed, room / (4.0 * social.relaxation_time));
    double const distance = ahead.norm();
    Vector const desired = distance > 1e-9 ? (speed / distance) * ahead : Vector{};
    auto force = push + limited(force_of(around, ahead, walk) + borders(way, sides, stop, walk));
    auto const velocity = social_velocity(social, walk.velocity, desired, force, h);
    auto const wanted = walk.position + h * velocity;
    auto const& along = way.center.segments()[walk.at.segment];
    around.advance(h);
    auto const next = around.way_past(walk.position, wanted, body_of(view), {{along.ux, along.uy}, stop - walk.at.s});
    walk.velocity = velocity + (1.0 / h) * (next - wanted);
    walk.position = next;
    walk.at = map::locate(view.road(), walk.at.corridor, {walk.position.x, walk.position.y, 0.0}, walk.at);
  }

  /// A stride ends at the range of the force, because nothing farther counts.
  [[nodiscard]] Vector stride_of(detail::Surroundings::Other const& other, Walk const& walk) const {
    Vector const velocity = social.relative_stride ? other.velocity - walk.velocity : other.velocity;
    return std::min(social.stride_time, range / std::max(1e-3, velocity.norm())) * velocity;
  }

  [[nodiscard]] Vector limited(Vector const& force) const {
    double const size = force.norm();
    return size > social.highest_acceleration ? (social.highest_acceleration / size) * force : force;
  }

  /// Force of other road users and of objects.
  [[nodiscard]] Vector force_of(detail::Surroundings const& around, Vector const& ahead, Walk const& walk) const {
    Vector sum;
    geometry::Point const own{walk.position.x, walk.position.y};
    for (std::size_t i = 0; i < around.other_count; ++i) {
      auto const& other = around.others[i];
      bool const is_round = other.radius > 0.0 || other.box.contains(own);
      geometry::Point const from = is_round ? other.box.center() : geometry::nearest_point(other.box, own);
      Vector const apart{own.x() - from.x(), own.y() - from.y()};
      double const distance = apart.norm();
      if (!(distance > 1e-9)) continue;
      auto const social_part = social_repulsion(social, apart, stride_of(other, walk));
      sum = sum + sight_weight(social, around.sight_cosine, ahead, social_part) * social_part;
      sum = sum + (contact_repulsion(social, distance - other.radius - body_radius) / distance) * apart;
    }
    for (std::size_t i = 0; i < around.object_count; ++i) {
      geometry::Point const from = geometry::nearest_border_point(*around.objects[i], own);
      bool const is_inside = around.objects[i]->contains(own);
      Vector const apart{own.x() - from.x(), own.y() - from.y()};
      double const distance = apart.norm();
      if (!(distance > 1e-9)) continue;
      double const free = is_inside ? 0.0 : distance;
      double const size = border_repulsion(social, free) + contact_repulsion(social, free - body_radius);
      sum = sum + ((is_inside ? -size : size) / distance) * apart;
    }
    return sum;
  }

  /// Force of the way's borders, and of the kerb where it has to stop. Below its desired speed the borders count less,
  /// below half of it not at all: two who meet on a way too narrow for both step over them.
  [[nodiscard]] Vector borders(map::LaneCorridor const& way, map::SideWidths const& sides, double stop,
                               Walk const& walk) const {
    auto const& g = way.center.segments()[walk.at.segment];
    double const pace = std::clamp(2.0 * walk.velocity.norm() / social.desired_speed - 1.0, 0.0, 1.0);
    double const leftwards = pace * (border_repulsion(social, sides.right + walk.at.lateral) -
                                     border_repulsion(social, sides.left - walk.at.lateral));
    double const back =
        stop < std::numeric_limits<double>::infinity() ? border_repulsion(social, stop - walk.at.s) : 0.0;
    return {-leftwards * g.uy - back * g.ux, leftwards * g.ux - back * g.uy};
  }

  template <class View>
  [[nodiscard]] Plan<View> plan_to(View const& view, Walk const& walk, double dt) const {
    constexpr double turning = 0.02;  // [m/s] a slower pedestrian keeps its heading: its velocity points anywhere
    auto next = view.state();
    next.time = view.time() + dt;
    next.x = walk.position.x;
    next.y = walk.position.y;
    next.speed = walk.velocity.norm();
    if (next.speed > turning)
      next.heading += geometry::angle_difference(portable::atan2(walk.velocity.y, walk.velocity.x), next.heading);
    return detail::plan_to(view, next, dt);
  }
};
static_assert(BehaviorModel<Pedestrian>);

}  // namespace cambium::inline v0_1
