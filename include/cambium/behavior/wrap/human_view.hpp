#pragma once

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "cambium/behavior/open_loop/constant_acceleration.hpp"
#include "cambium/behavior/view.hpp"
#include "cambium/core/constants.hpp"

namespace cambium {

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
/// others keep their acceleration until they stand; the own place and speed are the estimate's. Objects are known to
/// stand. Lateral positions and the answers of `View::state(user)`, `around(distance, f)`, `off_lanes`, `acceleration`
/// and `light` stay as they are. With a default `HumanEstimate` all answers equal those of `View`, to the last bit.
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
    return seen(View::ahead(moved(from, -estimate_.way), look), 1);
  }
  [[nodiscard]] std::optional<RoadUser> behind(map::LanePlace const& from, Look const& look = {}) const {
    return seen(View::behind(moved(from, -estimate_.way), look), -1);
  }
  [[nodiscard]] std::optional<RoadUser> merging(double merge, double limit) const {
    return seen(View::merging(merge, limit), 1);
  }
  template <class F>
  void each_ahead(Look const& look, F&& f) const {
    if (!estimate_.alone) View::each_ahead(look, [&](RoadUser const& user) { f(seen(user, 1)); });
  }
  template <class F>
  void around(map::LanePlace const& from, double distance, F&& f) const {
    auto const here = moved(from, -estimate_.way);
    if (!estimate_.alone)
      View::around(here, distance, [&](RoadUser const& user) { f(seen(user, user.s < here.s ? -1 : 1)); });
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
  template <class F>
  void on_lane(double index_begin, double index_end, F&& f) const {
    View::on_lane(index_begin, index_end, [&](RoadUser user) {
      user.s += estimate_.reach * user.speed;
      f(user);
    });
  }

 private:
  [[nodiscard]] map::LanePlace moved(map::LanePlace at, double by) const {
    if (by == 0.0) return at;
    at.s += by;
    at.index += by;
    at.piece = this->road().corridors[at.corridor].piece_at(at.s, at.piece);
    return at;
  }

  /// A road user found ahead (`sign` 1) or behind (-1), as estimated.
  [[nodiscard]] RoadUser seen(RoadUser user, int sign) const {
    double const before = user.gap;
    if (before > 0.0) {
      user.gap *= estimate_.gap_factor;
      if (is_valid(user.agent) && estimate_.rate_error != 0.0)
        user.speed = std::max(0.0, user.speed + before * estimate_.rate_error);
    }
    if (estimate_.reach > 0.0) {
      double const acceleration = is_valid(user.agent) ? View::acceleration(user) : 0.0;
      auto const motion = ConstantAcceleration{.acceleration = acceleration}.motion(user.speed, estimate_.reach);
      user.gap += sign * (motion.distance - estimate_.way);
      user.speed = motion.speed;
    }
    user.s += sign * (user.gap - before) + estimate_.way;
    return user;
  }
  [[nodiscard]] std::optional<RoadUser> seen(std::optional<RoadUser> const& user, int sign) const {
    return user && !estimate_.alone ? std::optional(seen(*user, sign)) : std::nullopt;
  }

  HumanEstimate estimate_;
  State state_;
  map::LanePlace place_;
};

}  // namespace cambium
