#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "cambium/behavior/behavior_model.hpp"
#include "cambium/behavior/lane_change/macro_actions.hpp"
#include "cambium/core/error.hpp"
#include "cambium/core/parameters.hpp"

namespace cambium {

/// `MacroActions`, and one more choice: to drive like `Driver`, by default what a search expects of ego where it has
/// nothing else in mind. With `Intersection` as the driver, a search can give way, wait its turn and stop at red lights
/// without finding out by itself how that is done. A lane change in progress is completed first, keeping the gap; and
/// behind one who stands it keeps a gap that leaves room for a change (`LaneChangeCourse::may_pass`).
template <BehaviorModel Driver>
struct DriverActions {
  static constexpr std::uint8_t drive = MacroActions::nothing;  ///< chosen instead of the number of a macro action

  struct Memory {
    MacroActions::Memory macro{};
    MemoryOf<Driver> driver{};
    bool drives = true;

    /// `number`: of one of `MacroActions::actions`, or `drive`.
    void choose(std::size_t number) {
      drives = number == drive;
      if (!drives) macro.choose(number);
    }

    void fell_short(double way, bool left_course) {
      macro.fell_short(way, left_course);
      cambium::fell_short(driver, way, left_course);
    }
    void was_set() {
      macro.was_set();
      cambium::was_set(driver);
    }

    friend bool operator==(Memory const&, Memory const&) = default;
  };

  MacroActions macro{};
  Driver driver{};

  static constexpr char const* name = "driver_actions";
  static constexpr char const* summary = "carries out what a search chooses: a macro action, or to drive like a driver";
  static constexpr char const* source = "own";
  static constexpr auto parameters() {
    using P = DriverActions;
    return parameter_list(parameter("macro", &P::macro, "-", {}, "the macro actions to choose from"),
                          parameter("driver", &P::driver, "-", {}, "who drives otherwise"));
  }

  void check(std::string const& where) const {
    if (macro.keeping_gap() == MacroActions::nothing)
      throw ParameterError(where + ".macro.actions", "has no keep_gap, by which a lane change is completed", "add it");
  }

  template <class View>
  [[nodiscard]] Plan<View> plan(View const& view, Memory& memory, double dt) const {
    if (memory.drives && !memory.macro.change.active() && !may_pass_next(view))
      return driver.plan(view, memory.driver, dt);
    if (memory.drives) memory.macro.choose(macro.keeping_gap());
    return macro.plan(view, memory.macro, dt);
  }

 private:
  template <class View>
  [[nodiscard]] bool may_pass_next(View const& view) const {
    auto const next = view.ahead({.merging = macro.rules.merging});
    return next && macro.course.may_pass(view, *next);
  }
};

}  // namespace cambium
