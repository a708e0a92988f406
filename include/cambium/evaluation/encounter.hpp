#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

#include "cambium/core/ids.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/evaluation/collision.hpp"
#include "cambium/geometry/collision.hpp"
#include "cambium/geometry/oriented_box.hpp"
#include "cambium/geometry/polygon.hpp"
#include "cambium/geometry/shape.hpp"
#include "cambium/map/corridor/corridor.hpp"
#include "cambium/map/corridor/lane_place.hpp"
#include "cambium/world/frame.hpp"

// How near an agent is to all other road users and static objects: where these are, and where they will be.

namespace cambium::inline v0_1 {

namespace detail {

/// The area that an agent will cover if it keeps its speed and its lane: it follows the centre line of its lane
/// corridor at its distance from it. One that moves across its lane goes on to the middle of the lane that it moves
/// towards, ever more slowly. Beyond the ends of its corridor it goes straight on.
class PredictedArea {
 public:
  template <class World>
  PredictedArea(World const& world, Slot slot)
      : corridor_(&world.roster().agents[slot].road->corridors[world.frame().agents[slot].lane.corridor]),
        shape_(&world.roster().agents[slot].shape),
        place_(world.frame().agents[slot].lane),
        speed_(std::max(0.0, world.frame().agents[slot].state.speed)) {
    auto const direction = portable::sin_cos(place_.heading_error);
    along_ = speed_ * direction.cos;
    across_ = speed_ * direction.sin;
    auto const sides = corridor_->widths_at(place_.s, place_.segment);
    bool const returns = across_ * place_.lateral < 0.0;
    double const off = std::abs(place_.lateral), to_go = returns ? off : sides.left + sides.right - off;
    constexpr double slow = 1e-3, quickest = 2.0;  // [m/s], [1/s]
    if (std::abs(across_) > slow) rate_ = std::min(quickest, std::abs(across_) / std::max(slow, to_go));
    turn_ = speed_ * corridor_->sharpest_bend + std::abs(place_.heading_error) * rate_;
    widest_ = std::max(off, to_go);
  }

  /// After `time` [s], in which it brakes by `braking` [m/s^2] until it stands.
  [[nodiscard]] geometry::OrientedBox box(double time, double braking) {
    // A vehicle that brakes is where it would be earlier.
    double const moves = braking * time > speed_ ? speed_ / braking : time;
    double const then = speed_ > 0.0 ? moves - 0.5 * braking * moves * moves / speed_ : 0.0;
    double const s = place_.s + along_ * then;
    double const decay = rate_ > 0.0 ? portable::exp(-rate_ * then) : 1.0;
    double const lateral = place_.lateral + (rate_ > 0.0 ? across_ / rate_ * (1.0 - decay) : across_ * then);
    auto const center = corridor_->center.pose(s, place_.segment);
    auto const along = portable::sin_cos(center.heading);
    auto const heads = portable::sin_cos(center.heading + place_.heading_error * decay);
    speed_now_ = std::max(0.0, speed_ - braking * time);
    return geometry::box_of(*shape_, center.x - lateral * along.sin, center.y + lateral * along.cos, heads.cos,
                            heads.sin);
  }

  /// Its speed when `box` was asked last [m/s].
  [[nodiscard]] double speed_now() const { return speed_now_; }
  /// Bound on how far the velocities of its corners are from its speed along its heading [m/s].
  [[nodiscard]] double swing() const { return turn_ * (reach() + widest_) + speed_ - along_; }
  /// Bound on how fast its velocity turns [m/s^2].
  [[nodiscard]] double turning() const { return speed_ * turn_; }
  /// Bound on the distance of its corners from its reference point [m].
  [[nodiscard]] double reach() const {
    return std::max(shape_->front, shape_->rear) + std::max(shape_->left, shape_->right);
  }
  [[nodiscard]] double speed() const { return speed_; }

 private:
  map::LaneCorridor const* corridor_;
  geometry::Shape const* shape_;
  map::LanePlace place_;
  double speed_, along_ = 0.0, across_ = 0.0;
  double rate_ = 0.0;    ///< by which its motion across dies away [1/s]
  double turn_ = 0.0;    ///< bound on how fast it turns [rad/s]
  double widest_ = 0.0;  ///< bound on its distance from the centre line [m]
  double speed_now_ = 0.0;
};

/// When a gap closes first [s]; `longest` if it does not by then. `look(time)` returns the gap [m], and a bound on how
/// fast it closes then [m/s], which grows by at most `quickening` [m/s^2]. Advances by steps in which it cannot close
/// (conservative advancement; Mirtich 1996), so that it misses nothing, to 1 cm.
template <class Look>
[[nodiscard]] double first_contact(double longest, double quickening, Look const& look) {
  constexpr double touching = 0.01, shortest_step = 1e-3;  // [m], [s]
  for (double time = 0.0; time < longest;) {
    auto const [gap, closing] = look(time);
    if (gap <= touching) return time;
    double const at_last = std::sqrt(closing * closing + 2.0 * quickening * gap);  // when it has closed
    time += std::max(shortest_step, 2.0 * gap / (closing + at_last));
  }
  return longest;
}

/// When an agent touches another one, or a static object, if it brakes by `braking` [m/s^2]; `longest` if it does not
/// by then [s]. O(steps): a few, more where the two stay near each other.
[[nodiscard]] inline double time_of_contact(PredictedArea& own, PredictedArea& other, double longest, double braking) {
  double const swing = own.swing() + other.swing();
  return first_contact(longest, own.turning() + other.turning() + braking, [&](double time) {
    auto const a = own.box(time, braking), b = other.box(time, 0.0);
    double const x = own.speed_now() * a.cos - other.speed_now() * b.cos;
    double const y = own.speed_now() * a.sin - other.speed_now() * b.sin;
    return std::pair(geometry::separation(a, b), portable::hypot(x, y) + swing);
  });
}
[[nodiscard]] inline double time_of_contact(PredictedArea& own, geometry::Polygon const& object, double longest,
                                            double braking) {
  return first_contact(longest, 0.0, [&](double time) {
    auto const gap = geometry::distance(own.box(time, braking), object);
    return std::pair(gap, own.speed_now() + own.swing());
  });
}

/// Calls `f(area)` for all that an agent may meet: the predicted areas of other road users that may reach it within
/// `longest` [s] and are at most `bearing` [rad] off its heading, and the outlines of static objects.
template <class World, class F>
void for_each_met(World const& world, Slot slot, PredictedArea const& own, double longest, double bearing, F const& f) {
  auto const& state = world.frame().agents[slot].state;
  for (Slot other{}; index_of(other) < world.size(); ++other) {
    if (other == slot || !in_traffic(world, other)) continue;
    PredictedArea its(world, other);
    auto const box = box_at(world, other);
    double const dx = box.x - state.x, dy = box.y - state.y;
    double const reach = own.reach() + 2.0 * its.reach() + (own.speed() + its.speed()) * longest;
    if (dx * dx + dy * dy > reach * reach) continue;
    if (bearing_of(world, slot, box) > bearing) continue;
    f(its);
  }
  for (auto const& object : world.roster().objects) f(object.outline);
}

}  // namespace detail

/// Distance from the agent's body to the nearest other one or static object, at most `farthest` [m]; 0 where they
/// touch. O(agents + objects).
struct Clearance {
  double farthest = 50.0;

  static constexpr char const* name = "clearance";
  static constexpr char const* summary = "distance to the nearest road user or object [m]";
  static constexpr auto parameters() {
    return parameter_list(parameter("farthest", &Clearance::farthest, "m", Range{0, 1e6}, "where nobody is nearer"));
  }

  template <class World>
  [[nodiscard]] double operator()(World const& world, Slot slot) const {
    if (!in_traffic(world, slot)) return farthest;
    auto const own = box_at(world, slot);
    double nearest = farthest;
    for (Slot other{}; index_of(other) < world.size(); ++other) {
      if (other == slot || !in_traffic(world, other)) continue;
      auto const box = box_at(world, other);
      if (geometry::separation(own, box) < nearest) nearest = std::min(nearest, geometry::distance(own, box));
    }
    for (auto const& object : world.roster().objects)
      nearest = std::min(nearest, geometry::distance(own, object.outline));
    return nearest;
  }
};

/// Time until the agent touches another road user or a static object if all keep their speeds and their lanes, at most
/// `longest` [s] (Hayward 1972, in two dimensions); 0 where they touch. Those behind it do not count. Exact to 1 cm of
/// way, on no grid of times. O(agents + objects), as `detail::time_of_contact`.
struct TimeToCollision {
  double longest = 10.0;
  double bearing = detail::behind_bearing;

  static constexpr char const* name = "time_to_collision";
  static constexpr char const* summary = "to any road user or object ahead, at constant speeds along the lanes [s]";
  static constexpr char const* source = "Hayward 1972";
  static constexpr auto parameters() {
    using P = TimeToCollision;
    return parameter_list(parameter("longest", &P::longest, "s", Range{0, 1000}, "where it meets nobody, or later"),
                          parameter("bearing", &P::bearing, "rad", Range{0, 3.2}, "who is farther off does not count"));
  }

  template <class World>
  [[nodiscard]] double operator()(World const& world, Slot slot) const {
    if (!in_traffic(world, slot)) return longest;
    if (Collision{}(world, slot)) return 0.0;
    detail::PredictedArea own(world, slot);
    double least = longest;
    detail::for_each_met(world, slot, own, longest, bearing, [&](auto& other) {
      least = std::min(least, detail::time_of_contact(own, other, least, 0.0));
    });
    return least;
  }
};

/// Constant deceleration at which the agent does not touch another road user or an object within `longest` [s] if the
/// other keeps its speed and both keep their lanes; the largest of those that each other one asks for alone, at most
/// `most` [m/s^2]; 0 where it touches nobody anyway. For a leader it is that of Almqvist, Hyden, Risser 1991 (DRAC).
/// Those behind it do not count. To 0.1 % of `most`. O(agents + objects).
struct RequiredDeceleration {
  double most = 50.0;
  double longest = 10.0;
  double bearing = detail::behind_bearing;

  static constexpr char const* name = "required_deceleration";
  static constexpr char const* summary = "to touch nobody, where others keep their speeds and lanes [m/s^2]";
  static constexpr char const* source = "Almqvist, Hyden, Risser 1991";
  static constexpr auto parameters() {
    using P = RequiredDeceleration;
    return parameter_list(
        parameter("most", &P::most, "m/s^2", Range{0, 1e6}, "where more is required, or the two touch"),
        parameter("longest", &P::longest, "s", Range{0, 1000}, "later contacts do not count"),
        parameter("bearing", &P::bearing, "rad", Range{0, 3.2}, "who is farther off does not count"));
  }

  template <class World>
  [[nodiscard]] double operator()(World const& world, Slot slot) const {
    if (!in_traffic(world, slot)) return 0.0;
    detail::PredictedArea own(world, slot);
    double required = 0.0;
    detail::for_each_met(world, slot, own, longest, bearing, [&](auto& other) {
      auto const meets = [&](double braking) {
        return detail::time_of_contact(own, other, longest, braking) < longest;
      };
      if (required >= most || !meets(0.0)) return;
      double low = 0.0, high = most;
      if (meets(high)) low = high;
      while (high - low > 1e-3 * most) {
        double const middle = 0.5 * (low + high);
        (meets(middle) ? low : high) = middle;
      }
      required = std::max(required, high);
    });
    return required;
  }
};

/// The deceleration that an agent needs to touch nobody over the one that it can have: above 1, braking alone does not
/// help (brake threat number, BTN; Brannstrom, Sjoberg, Coelingh 2008). Complexity of `RequiredDeceleration`.
struct BrakeThreatNumber {
  RequiredDeceleration required{};
  double possible = 8.0;

  static constexpr char const* name = "brake_threat_number";
  static constexpr char const* summary = "required over possible deceleration";
  static constexpr char const* source = "Brannstrom, Sjoberg, Coelingh 2008";
  static constexpr auto parameters() {
    using P = BrakeThreatNumber;
    return parameter_list(parameter("required", &P::required, "how the required one is found"),
                          parameter("possible", &P::possible, "m/s^2", Range{0.1, 50}, "hardest braking"));
  }

  template <class World>
  [[nodiscard]] double operator()(World const& world, Slot slot) const {
    return required(world, slot) / possible;
  }
};

}  // namespace cambium::inline v0_1
