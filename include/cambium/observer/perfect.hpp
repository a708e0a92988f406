#pragma once

#include "cambium/observer/observer_model.hpp"

namespace cambium::inline v0_1 {

/// Sees all agents and objects in their true states.
struct PerfectObserver {
  static constexpr bool perfect = true;
  static constexpr char const* name = "perfect";
  static constexpr char const* summary = "sees the truth";
  static constexpr char const* source = "-";
  static constexpr auto parameters() { return parameter_list(); }

  template <MotionState S>
  [[nodiscard]] S const& observe(S const& truth, bool /*own*/, RandomStream const&) const {
    return truth;
  }
};
static_assert(ObserverModel<PerfectObserver>);

}  // namespace cambium::inline v0_1
