#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "cambium/behavior/behavior_model.hpp"
#include "cambium/behavior/actions/macro_actions.hpp"
#include "cambium/core/described.hpp"
#include "cambium/core/distributions.hpp"

namespace cambium::inline v0_1 {

/// Chooses one of the available macro actions at random every `interval`, with equal probability. The random numbers
/// are the agent's own: the same in every run, copy and thread.
struct RandomMacroActions {
  MacroActions macro{};
  double interval = 1.0;

  static constexpr char const* name = "random_macro_actions";
  static constexpr char const* summary = "one of the available macro actions every interval, with equal probability";
  static constexpr char const* source = "own";
  static constexpr auto parameters() {
    return parameter_list(parameter("macro", &RandomMacroActions::macro, "the actions"),
                          parameter("interval", &RandomMacroActions::interval, "s", Range{0, 3600},
                                    "time until the next choice; 0: each step"));
  }

  struct Memory {
    MacroActions::Memory macro{};
    float left{};  ///< time until the next choice [s]

    void fell_short(double way, bool left_course) { macro.fell_short(way, left_course); }
    void was_set() { macro.was_set(); }

    static constexpr char const* name = "random_macro_actions_memory";
    static constexpr auto parameters() {
      using P = Memory;
      return parameter_list(parameter("macro", &P::macro, "the macro action under way"),
                            parameter("left", &P::left, "s", any_finite, "until the next choice"));
    }

    friend bool operator==(Memory const&, Memory const&) = default;
  };

  template <class View>
  [[nodiscard]] Plan<View> plan(View const& view, Memory& memory, double dt) const {
    constexpr float rounding = 1e-4f;
    if (!(memory.left > rounding)) {
      choose(view, memory.macro);
      memory.left = std::max(0.0f, memory.left + static_cast<float>(interval));
    }
    memory.left -= static_cast<float>(dt);
    return macro.plan(view, memory.macro, dt);
  }

 private:
  template <class View>
  void choose(View const& view, MacroActions::Memory& memory) const {
    std::uint32_t available = 0;
    for (std::size_t i = 0; i < macro.size(); ++i) available += macro.available(view, i, memory.change) ? 1 : 0;
    if (available == 0) return;
    auto random = view.random(0);
    auto nth = uniform_index(random, available);
    for (std::size_t i = 0; i < macro.size(); ++i)
      if (macro.available(view, i, memory.change) && nth-- == 0) return memory.choose(i);
  }
};
static_assert(BehaviorModel<RandomMacroActions>);

}  // namespace cambium::inline v0_1
