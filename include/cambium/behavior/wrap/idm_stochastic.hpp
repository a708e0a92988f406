#pragma once

#include <algorithm>
#include <cstdint>

#include "cambium/behavior/behavior_model.hpp"
#include "cambium/behavior/drivers.hpp"
#include "cambium/core/described.hpp"
#include "cambium/core/distributions.hpp"
#include "cambium/core/random.hpp"

namespace cambium::inline v0_1 {

/// A driver whose law has parameters drawn from distributions, once for each agent or anew in every step. Draws are
/// clamped to the parameters' valid ranges. Reproducible: all random numbers come from the agent's own stream. With
/// `Driver` = `IdmClassic::Also<Yielding<>>`, it sometimes lets others in.
template <class Distribution, BehaviorModel Driver>
struct BasicIdmStochastic {
  enum class Drawn { per_agent, per_step };

  Drawn drawn = Drawn::per_agent;
  Distribution desired_speed{12.0, 18.0};
  Distribution time_headway{1.0, 2.0};
  Distribution minimum_gap{1.5, 2.5};
  Distribution maximum_acceleration{1.4, 2.0};
  Distribution comfortable_deceleration{1.4, 2.0};
  Driver driver{};

  static constexpr bool looks_beside = detail::looks_beside<Driver>();
  static constexpr bool looks_around = detail::looks_around<Driver>();
  static constexpr bool heeds_conflicts = detail::heeds_conflicts<Driver>();

  static constexpr char const* name = "idm_stochastic";
  static constexpr char const* summary =
      "a driver, by default by IDM, with parameters of its law drawn once for each agent or anew in every step";
  static constexpr char const* source = "law: Treiber, Hennecke, Helbing 2000; draws: own, after BARK";
  static constexpr auto parameters() {
    using Self = BasicIdmStochastic;
    return parameter_list(
        choice("drawn", &Self::drawn, "per_agent|per_step", "when parameters are drawn"),
        parameter("desired_speed", &Self::desired_speed, "m/s", {}, "as in IDM"),
        parameter("time_headway", &Self::time_headway, "s", {}, "as in IDM"),
        parameter("minimum_gap", &Self::minimum_gap, "m", {}, "as in IDM"),
        parameter("maximum_acceleration", &Self::maximum_acceleration, "m/s^2", {}, "as in IDM"),
        parameter("comfortable_deceleration", &Self::comfortable_deceleration, "m/s^2", {}, "as in IDM"),
        parameter("driver", &Self::driver, "everything else"));
  }

  struct Memory {
    std::uint32_t person{};  ///< key of the agent's own draws; 0: not drawn yet
    MemoryOf<Driver> driver{};

    void fell_short(double way, bool left_course) { cambium::fell_short(driver, way, left_course); }
    void was_set() { cambium::was_set(driver); }

    static constexpr char const* name = "idm_stochastic_memory";
    static constexpr auto parameters() {
      using P = Memory;
      return parameter_list(parameter("person", &P::person, "-", Range{0, 4294967295.0},
                                      "key of the agent's own draws; 0: not drawn yet"),
                            parameter("driver", &P::driver, "the driver's"));
    }

    friend bool operator==(Memory const&, Memory const&) = default;
  };

  /// The driver with parameters drawn from `stream`, each within its valid range.
  template <BitStream Stream>
  [[nodiscard]] Driver draw(Stream& stream) const {
    auto drawn_driver = driver;
    auto& law = drawn_driver.law;
    law.desired_speed = std::clamp(desired_speed(stream), 0.1, 100.0);
    law.time_headway = std::clamp(time_headway(stream), 0.0, 20.0);
    law.minimum_gap = std::clamp(minimum_gap(stream), 0.0, 100.0);
    law.maximum_acceleration = std::clamp(maximum_acceleration(stream), 0.01, 20.0);
    law.comfortable_deceleration = std::clamp(comfortable_deceleration(stream), 0.01, 20.0);
    return drawn_driver;
  }

  template <class View>
  [[nodiscard]] Plan<View> plan(View const& view, Memory& memory, double dt) const {
    constexpr std::uint32_t purpose = 0x1d5;
    auto stream = view.random(purpose);
    if (memory.person == 0) memory.person = static_cast<std::uint32_t>(stream() >> 32) | 1u;
    RandomStream own(memory.person, 0, 0, purpose);
    return (drawn == Drawn::per_agent ? draw(own) : draw(stream)).plan(view, memory.driver, dt);
  }
};

/// The usual variant, with uniform distributions.
using IdmStochastic = BasicIdmStochastic<Uniform, IdmClassic>;
static_assert(BehaviorModel<IdmStochastic>);

}  // namespace cambium::inline v0_1
