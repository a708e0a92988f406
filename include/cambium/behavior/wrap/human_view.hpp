#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "cambium/behavior/open_loop/constant_acceleration.hpp"
#include "cambium/behavior/view.hpp"
#include "cambium/core/constants.hpp"

namespace cambium::inline v0_1 {

/// A driver's estimation errors at one moment, and how far ahead it extrapolates what it sees.
struct HumanEstimate {
  double gap_factor = 1.0;  ///< estimated gap / true gap [-]
  double rate_error = 0.0;  ///< error of the other's estimated speed, per metre of gap [1/s]
  double reach = 0.0;       ///< the estimate is for this time ahead [s]
  double way = 0.0;         ///< own, driven until then [m]
  double speed = 0.0;       ///< own, then, where `reach` is not 0 [m/s]
  bool alone = false;       ///< sees no road users, but where ways cross
  bool decides = false;     ///< for later: the present acceleration bounds nothing
};

/// A view as an imperfect driver has it: like `View`, but lengthwise distances and speeds of road users in lanes are
/// estimated with the driver's errors, and extrapolated to a time ahead (after Treiber, Kesting, Helbing 2006): the
/// others keep their acceleration until they stand; the own place and speed are the estimate's. Who is ahead or behind
/// now stays so: the gap becomes 0 at most. Objects are known to stand. Lateral positions and the answers of
/// `View::state(user)`, `around(distance, f)`, `off_lanes`, `on_lane`, `acceleration` and `light` stay as they are.
/// With a default `HumanEstimate` all answers equal those of `View`, to the last bit.
template <class View>
class HumanView : public View {
 public:
  using State = typename View::State;

  HumanView(View const& view, HumanEstimate const& estimate)
      : View(view), estimate_(estimate), state_(view.state()), place_(view.place()) {
    if (!(estimate.reach > 0.0)) return;
    state_.speed = estimate.speed;
    place_ = moved(place_, estimate.way);
  }

  [[nodiscard]] State const& state() const { return state_; }
  [[nodiscard]] double last_acceleration() const {
    return estimate_.decides ? std::numeric_limits<double>::quiet_NaN() : View::last_acceleration();
  }
  using View::shape;
  [[nodiscard]] decltype(auto) state(RoadUser const& agent) const { return View::state(agent); }
  [[nodiscard]] map::LanePlace const& place() const { return place_; }
  [[nodiscard]] map::LanePlace place(CorridorId corridor) const { return moved(View::place(corridor), estimate_.way); }

  [[nodiscard]] std::optional<RoadUser> ahead(Look const& look = {}) const { return seen(View::ahead(look), 1); }
  [[nodiscard]] std::optional<RoadUser> behind(Look const& look = {}) const { return seen(View::behind(look), -1); }
  [[nodiscard]] std::optional<RoadUser> ahead(map::LanePlace const& from, Look const& look = {}) const {
    return next(from, 1, [&](map::LanePlace const& at) { return View::ahead(at, look); });
  }
  [[nodiscard]] std::optional<RoadUser> behind(map::LanePlace const& from, Look const& look = {}) const {
    return next(from, -1, [&](map::LanePlace const& at) { return View::behind(at, look); });
  }
  [[nodiscard]] std::optional<RoadUser> merging(double merge, double limit) const {
    return seen(View::merging(merge, limit - estimate_.way), 1);
  }
  template <class F>
  void each_ahead(Look const& look, F&& f) const {
    if (!estimate_.alone) View::each_ahead(look, [&](RoadUser const& user) { f(seen(user, 1)); });
  }
  template <class F>
  void around(map::LanePlace const& from, double distance, F&& f) const {
    auto const here = moved(from, -estimate_.way);
    if (!estimate_.alone)
      View::around(here, distance,
                   [&](RoadUser const& user) { f(seen(user, user.s < here.s ? -1 : 1, beyond(here))); });
  }
  template <class F>
  void around(double distance, F&& f) const {
    if (!estimate_.alone) View::around(distance, std::forward<F>(f));
  }
  template <class F>
  void off_lanes(double distance, F&& f) const {
    if (!estimate_.alone) View::off_lanes(distance, std::forward<F>(f));
  }
  [[nodiscard]] bool anybody_off_lanes() const { return !estimate_.alone && View::anybody_off_lanes(); }
  template <class F>
  void for_each_object(F&& f) const {
    if (!estimate_.alone) View::for_each_object(std::forward<F>(f));
  }

 private:
  [[nodiscard]] map::LanePlace moved(map::LanePlace at, double by) const {
    if (by == 0.0) return at;
    at.s += by;
    at.index += by;
    at.piece = this->road().corridors[at.corridor].piece_at(at.s, at.piece);
    return at;
  }

  /// Whether nothing is estimated.
  [[nodiscard]] bool is_plain() const {
    return estimate_.gap_factor == 1.0 && estimate_.rate_error == 0.0 && !(estimate_.reach > 0.0);
  }

  /// How far a place is beyond the own one now [m].
  [[nodiscard]] double beyond(map::LanePlace const& at) const { return at.s - View::place(at.corridor).s; }

  /// The first road user that `find` finds from a place on, and whose estimate lies beyond that. From the own place it
  /// is the first one found. O(those found).
  template <class Find>
  [[nodiscard]] std::optional<RoadUser> next(map::LanePlace const& from, int sign, Find const& find) const {
    constexpr double rounding = 1e-7, beyond_it = 1e-6, least = 0.1;  // [m]
    if (estimate_.alone) return std::nullopt;
    if (is_plain()) return find(from);
    auto const start = moved(from, -estimate_.way);
    double const way = beyond(start);
    for (auto at = start;;) {
      auto user = find(at);
      if (!user) return user;
      // An observer that errs may see it behind.
      double const step = std::max(sign * (user->s - at.s) + beyond_it, least);
      user->gap += sign * (at.s - start.s);
      user = seen(*user, sign, way);
      if (std::abs(way) < rounding || sign * (user->s - from.s) > 0.0) return user;
      at = moved(at, sign * step);
    }
  }

  /// A road user found ahead (`sign` 1) or behind (-1) of a place `way` [m] beyond the own one, as estimated. The
  /// estimate does not depend on that place.
  [[nodiscard]] RoadUser seen(RoadUser user, int sign, double way = 0.0) const {
    if (is_plain()) return user;
    bool const is_agent = is_valid(user.agent);
    double const now = user.gap + sign * way;
    double gap = now;  // from the own place
    if (now > 0.0) {
      gap *= estimate_.gap_factor;
      double const speed = user.speed + (is_agent ? now * estimate_.rate_error : 0.0);
      user.speed = user.speed < 0.0 ? std::min(0.0, speed) : std::max(0.0, speed);
    }
    if (estimate_.reach > 0.0) {
      double const along = user.speed < 0.0 ? -1.0 : 1.0;
      ConstantAcceleration const course{.acceleration = is_agent ? View::acceleration(user) : 0.0};
      auto const motion = course.motion(along * user.speed, estimate_.reach);
      gap += sign * (along * motion.distance - estimate_.way);
      if (now > 0.0) gap = std::max(0.0, gap);
      user.speed = along * motion.speed;
    }
    user.gap += gap - now;
    user.s += sign * (gap - now) + estimate_.way;
    return user;
  }
  [[nodiscard]] std::optional<RoadUser> seen(std::optional<RoadUser> const& user, int sign) const {
    return user && !estimate_.alone ? std::optional(seen(*user, sign)) : std::nullopt;
  }

  HumanEstimate estimate_;
  State state_;
  map::LanePlace place_;
};

}  // namespace cambium::inline v0_1
