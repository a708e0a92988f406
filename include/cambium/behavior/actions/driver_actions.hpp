#pragma once

#include <cstddef>
#include <cstdint>

#include "cambium/behavior/actions/macro_actions.hpp"
#include "cambium/behavior/behavior_model.hpp"
#include "cambium/behavior/heed/bends.hpp"
#include "cambium/behavior/heed/signals.hpp"
#include "cambium/behavior/heed/speed_limit.hpp"
#include "cambium/behavior/law/idm.hpp"
#include "cambium/core/parameters.hpp"

namespace cambium::inline v0_1 {

/// `MacroActions`, and one more choice: to drive like `Driver`, by default what a search expects of ego where it has
/// nothing else in mind. With `Intersection` as the driver, a search can give way, wait its turn and stop at red lights
/// without finding out by itself how that is done. A change that leaves the lane is completed first, keeping the gap.
/// Close behind a road user that stands, a driver that does not change lanes by itself keeps a gap that leaves room for
/// a change (`LaneChangeCourse::may_pass`), unless pedestrians are in the world. The macro actions heed the
/// speed limit, bends and lights, whatever the driver does.
template <BehaviorModel Driver>
struct DriverActions {
  using Macro = BasicMacroActions<Idm, Bends, Signals, SpeedLimit>;
  static constexpr std::uint8_t drive = Macro::nothing;  ///< chosen instead of the number of a macro action

  struct Memory {
    Macro::Memory macro{};
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

    static constexpr char const* name = "driver_actions_memory";
    static constexpr auto parameters() {
      using P = Memory;
      return parameter_list(parameter("macro", &P::macro, "the macro action under way"),
                            parameter("driver", &P::driver, "the driver's"),
                            parameter("drives", &P::drives, "as the driver does"));
    }

    friend bool operator==(Memory const&, Memory const&) = default;
  };

  Macro macro{.stops_before_end = true};
  Driver driver{};

  static constexpr char const* name = "driver_actions";
  static constexpr char const* summary = "carries out what a search chooses: a macro action, or to drive like a driver";
  static constexpr char const* source = "own";
  static constexpr auto parameters() {
    using P = DriverActions;
    return parameter_list(parameter("macro", &P::macro, "the macro actions to choose from"),
                          parameter("driver", &P::driver, "who drives otherwise"));
  }

  template <class View>
  [[nodiscard]] Plan<View> plan(View const& view, Memory& memory, double dt) const {
    bool const is_driver = memory.drives && (driver_changes_lanes ? !leaves_lane(view, memory.macro.change)
                                                                  : !memory.macro.change.active() && !needs_room(view));
    hand_over(memory, is_driver);
    if (is_driver) return driver.plan(view, memory.driver, dt);
    return memory.drives ? macro.keep_gap(view, memory.macro, dt) : macro.plan(view, memory.macro, dt);
  }

 private:
  static constexpr bool driver_changes_lanes = requires(MemoryOf<Driver> memory) { memory.lateral.change; };

  /// Gives the lane change under way to whoever drives next: there is only one, and the other one's would be stale when
  /// it drives again.
  static void hand_over(Memory& memory, bool to_driver) {
    if constexpr (driver_changes_lanes) {
      auto &of_macro = memory.macro.change, &of_driver = memory.driver.lateral.change;
      auto &from = to_driver ? of_macro : of_driver, &to = to_driver ? of_driver : of_macro;
      if (from == LaneChange{}) return;
      if (!to.active()) to = from;
      from = {};
    }
  }

  template <class View>
  [[nodiscard]] static bool leaves_lane(View const& view, LaneChange const& change) {
    return change.active() && change.target != view.place().corridor;
  }

  /// Whether the next road user in the lane is one to pass, and so near that the driver may have to brake for it.
  template <class View>
  [[nodiscard]] bool needs_room(View const& view) const {
    constexpr double gentle = 1.5;  // [m/s^2]
    auto const next = view.ahead();
    if (!next || next->speed > LaneChangeCourse::slow || view.anybody_off_lanes()) return false;
    double const speed = std::max(0.0, view.state().speed);
    return next->gap < speed * speed / (2.0 * gentle) + macro.course.least_length(view.shape()) &&
           macro.course.may_pass(view, *next);
  }
};

}  // namespace cambium::inline v0_1
