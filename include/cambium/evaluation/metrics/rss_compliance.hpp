#pragma once

#include <algorithm>

#include "cambium/behavior/open_loop/constant_acceleration.hpp"
#include "cambium/behavior/wrap/rss_conformant.hpp"
#include "cambium/core/constants.hpp"
#include "cambium/core/ids.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/evaluation/evaluator.hpp"
#include "cambium/world/frame.hpp"

namespace cambium::inline v0_1 {

/// Counts the steps in which an agent does not respond to danger as Responsibility-Sensitive Safety requires: it has to
/// brake by `RssParameters::minimum_deceleration`, and brakes less while it is not standing. See `RssConformant`.
struct RssCompliance {
  RssParameters rss{};

  RssCompliance() = default;
  /// Judges by these assumptions on how vehicles brake and respond.
  explicit RssCompliance(RssParameters const& assumptions) : rss(assumptions) {}

  static constexpr char const* name = "rss_compliance";
  static constexpr char const* summary = "share of steps in which it braked where RSS demands it";
  static constexpr char const* source = "Shalev-Shwartz, Shammah, Shashua 2017";
  static constexpr auto parameters() {
    return parameter_list(parameter("rss", &RssCompliance::rss, "how vehicles brake and respond"));
  }

  template <class World>
  void observe(World& world, Slot slot, double dt) {
    auto const& record = world.frame().agents[slot];
    if (record.status != AgentStatus::driving) {
      has_to_brake_ = false;
      return;
    }
    if (dt > 0.0) {
      ++steps_;
      double const acceleration = (record.state.speed - speed_) / dt;
      violations_ +=
          has_to_brake_ && record.state.speed > blameless_speed && acceleration > -rss.minimum_deceleration + rounding;
    }
    auto const view = world.truth(slot);
    has_to_brake_ = RssConformant<ConstantAcceleration>{{}, rss}.response(view, record.state, dt).brake;
    dangers_ += has_to_brake_;
    speed_ = record.state.speed;
  }

  /// The share of steps in which the agent complied; 1 without any.
  [[nodiscard]] double value() const {
    return steps_ > 0 ? 1.0 - static_cast<double>(violations_) / static_cast<double>(steps_) : 1.0;
  }
  [[nodiscard]] int violations() const { return violations_; }
  [[nodiscard]] int dangers() const { return dangers_; }  ///< frames in which it had to brake

 private:
  static constexpr double rounding = 1e-3;  // [m/s^2]

  double speed_ = 0.0;
  bool has_to_brake_ = false;
  int steps_ = 0, violations_ = 0, dangers_ = 0;
};

}  // namespace cambium::inline v0_1
