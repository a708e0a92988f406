#pragma once

#include <cambium/cambium.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>

/// Drivers that game a judge: what others found planners to do, or could. All drive along +x. Those that crash or never
/// answer are in runner_test, because they need a process of their own.
namespace cheats {

struct Cheat {
  enum class Kind : std::uint8_t {
    honest,         ///< keeps a headway
    two_faced,      ///< the same, but its plans claim another acceleration
    statue,         ///< stops at once, and stays: whoever does not move hits nobody
    flincher,       ///< stands still in the last step before the impact, so that it is not to blame
    bumper,         ///< touches its leader slowly, then drives through it
    teleporter,     ///< its places run ahead of its speed
    escaper,        ///< leaves the road at once, over all that is in its way
    quitter,        ///< says that it has nothing more to do while something is in its way
    creeper,        ///< claims to stand, and moves by as much as a single step may be off
    liar,           ///< its speed jumps, its plans claim that it does not
    blinker,        ///< brakes hard for a step at a time, too short for filtered accelerations
    crab,           ///< goes sideways around its leader
    drifter,        ///< the same by as much as a single step may be off
    bullet,         ///< keeps its speed, whatever is in the way
    ghost,          ///< says that it has not started while something is in its way
    odd,            ///< plans a place that is no number
    thrower,        ///< throws in place of an answer
    judges_twin,    ///< accelerates and brakes as hard as the published score just permits
    brake_checker,  ///< brakes hard for nothing, so that whoever follows runs into it
    pulser,         ///< the same, but never when the other brakes
    late_stopper,   ///< stands in the end of the step of its impact, by braking as hard as it can
  };

  Kind kind = Kind::honest;
  static constexpr char const* name = "cheat";
  static constexpr auto parameters() {
    return cambium::parameter_list(
        cambium::choice("kind", &Cheat::kind,
                        "honest|two_faced|statue|flincher|bumper|teleporter|escaper|quitter|creeper|liar|"
                        "blinker|crab|drifter|bullet|ghost|odd|thrower|judges_twin|"
                        "brake_checker|pulser|late_stopper",
                        "what it does"));
  }

  template <class View>
  [[nodiscard]] cambium::Plan<View> plan(View const& view, cambium::NoMemory&, double dt) const {
    auto state = view.state();
    auto const ahead = view.ahead();
    double const gap = ahead ? ahead->gap : 1e3, speed = state.speed;
    auto const cycle = std::llround(state.time / dt);
    double next = speed, sideways = 0.0, way = std::numeric_limits<double>::quiet_NaN();
    switch (kind) {
      case Kind::honest:
      case Kind::two_faced:
        next = std::clamp(std::min(20.0, (gap - 3.0) / 1.5), std::max(0.0, speed - 4.0 * dt), speed + dt);
        break;
      case Kind::statue:
        next = std::max(0.0, speed - 4.0 * dt);
        break;
      case Kind::flincher:
        if (gap < speed * dt + 0.1) next = 0.0, way = std::max(0.0, gap - 0.1);
        break;
      case Kind::teleporter:
        way = 60.0 * dt;
        break;
      case Kind::escaper:
        way = 1000.0;
        break;
      case Kind::creeper:
        next = 0.0;
        way = 0.15;
        break;
      case Kind::liar:
        next = cycle % 2 == 0 ? 22.0 : 14.0;
        break;
      case Kind::blinker:
        next = speed + (cycle % 5 == 0 ? -7.0 : cycle % 5 < 3 ? 3.5 : 0.0) * dt;
        break;
      case Kind::crab:
      case Kind::drifter:
        sideways = gap < 40.0 && state.y > -6.0 ? (kind == Kind::crab ? -0.5 : -0.1) : 0.0;
        break;
      case Kind::judges_twin: {
        constexpr double most = 2.39, jerk = 4.12, period = 4.0 * most / jerk;  // [m/s^2], [m/s^3], [s]
        double const phase = std::fmod(state.time / period, 1.0);
        next = speed + most * (phase < 0.5 ? 4.0 * phase - 1.0 : 3.0 - 4.0 * phase) * dt;
        break;
      }
      case Kind::brake_checker:
        next = std::max(8.0, speed + (cycle % 25 < 5 ? -7.0 : 3.0) * dt);
        break;
      case Kind::pulser:
        next = speed + (cycle % 4 == 0 ? -8.0 : 8.0 / 3.0) * dt;
        break;
      case Kind::late_stopper:
        if (gap < speed * dt) next = std::max(0.0, speed - 8.0 * dt);
        break;
      case Kind::thrower:
        throw std::runtime_error("out of ideas");
      default:
        break;
    }
    if (kind != Kind::odd && std::isnan(way)) way = 0.5 * (speed + next) * dt;
    state.x += way * std::cos(state.heading) - sideways * std::sin(state.heading);
    state.y += way * std::sin(state.heading) + sideways * std::cos(state.heading);
    state.speed = next;
    state.time += dt;
    cambium::Plan<View> plan;
    plan.trajectory.push_back(state);
    if (kind == Kind::ghost && gap < 20.0) plan.status = cambium::PlanStatus::not_started;
    if (kind == Kind::quitter && gap < 20.0) plan.status = cambium::PlanStatus::expired;
    if (kind != Kind::honest) plan.action.acceleration = kind == Kind::two_faced && state.x > 100.0 ? -12.0 : 1e-9;
    if (kind == Kind::two_faced) plan.action.steering = 0.7;
    return plan;
  }
};

}  // namespace cheats
