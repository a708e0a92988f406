#pragma once

#include <algorithm>
#include <concepts>
#include <string>

#include "cambium/behavior/behavior_model.hpp"
#include "cambium/behavior/driver/driver_text.hpp"
#include "cambium/behavior/driver/heeding.hpp"
#include "cambium/behavior/driver/limits.hpp"
#include "cambium/core/described.hpp"
#include "cambium/core/error.hpp"
#include "cambium/core/parameters.hpp"

namespace cambium::inline v0_1 {

namespace detail {
/// The lateral part of a driver whose limits are `Limits`, see `Driver`.
template <class L, class Limits>
concept LateralPart = std::copyable<L> && Described<L> && std::copyable<MemoryOf<L>> &&
    requires(L const lateral, ViewArchetype const view, MemoryOf<L> memory, Limits limits, double dt) {
  {
    lateral.drive(view, memory, lateral.look(view, memory, limits, dt), limits, dt)
    } -> std::same_as<Plan<ViewArchetype>>;
  { lateral.counted() } -> std::same_as<Merging>;
};

/// Returns true; fails to compile with a sentence that names the part that is wrong.
template <class Law, class Lateral>
[[nodiscard]] constexpr bool check_driver() {
  static_assert(
      CarFollowingLaw<Law>,
      "cambium::Driver<Law, Lateral, Heeds...>: the law must be a copyable struct with `static constexpr char const* "
      "name`, `static constexpr auto parameters()`, public desired_speed, time_headway, minimum_gap, "
      "maximum_acceleration, comfortable_deceleration and lowest_acceleration, and `double acceleration(double speed, "
      "double desired_speed, cambium::Constraint const& leader) const` (see CarFollowingLaw)");
  if constexpr (CarFollowingLaw<Law>)
    static_assert(
        LateralPart<Lateral, Limits<Law>>,
        "cambium::Driver<Law, Lateral, Heeds...>: the lateral part, after the law, must be a described struct with "
        "public const functions look(view, memory, limits, dt), drive(view, memory, seen, limits, dt) and counted(), "
        "such as cambium::KeepLane or cambium::ChangeLanes<Rule> (see Driver)");
  return true;
}

/// Throws `ParameterError` if a parameter that every law has is out of range. Checked here, because a law's description
/// need not list it.
template <CarFollowingLaw Law>
void check_law(Law const& law, std::string const& where) {
  constexpr Range negative{-positive.high, -0.01};
  struct {
    ParameterInfo info;
    double value;
  } const all[] = {
      {{"desired_speed", "m/s", positive, ""}, static_cast<double>(law.desired_speed)},
      {{"time_headway", "s", non_negative, ""}, static_cast<double>(law.time_headway)},
      {{"minimum_gap", "m", non_negative, ""}, static_cast<double>(law.minimum_gap)},
      {{"maximum_acceleration", "m/s^2", positive, ""}, static_cast<double>(law.maximum_acceleration)},
      {{"comfortable_deceleration", "m/s^2", positive, ""}, static_cast<double>(law.comfortable_deceleration)},
      {{"lowest_acceleration", "m/s^2", negative, ""}, static_cast<double>(law.lowest_acceleration)}};
  for (auto const& [info, value] : all)
    if (!(value >= info.range.low && value <= info.range.high))
      throw ParameterError(where + ".law." + info.name, "is " + with_unit(number_text(value), info.unit),
                           "give a value in " + with_unit(range_text(info), info.unit));
}
}  // namespace detail

/// A driver composed of a law by which it follows, a lateral part that decides where across the road it drives, and
/// what it heeds besides.
///
///     view --> desired speed, by heeds --> law at that speed
///                  lateral.look: leader, lanes that merge, lane changes --.
///                  heeds: lane end, bends, signals, conflicts, ...      ----> Limits --> lateral.drive --> Plan
///
/// - `Law`: a `CarFollowingLaw`, such as `Idm`.
/// - `Lateral`: `KeepLane`, `TrackLine`, `ChangeLanes<Rule>`, or a described struct of your own with
///   - `look(view, memory, limits, dt)`: decides on the course, adds who is in its way to the limits, and
///     returns what `drive` should know;
///   - `drive(view, memory, seen, limits, dt)`: the plan that drives `limits.within(limits.motion(dt), dt)` there;
///   - `Merging counted() const`: how road users count that merge into the lane.
/// - `Heeds`: see `Heeding`.
template <class Law, class Lateral, class... Heeds>
struct Driver {
  static_assert(detail::check_driver<Law, Lateral>() && detail::check_heeds<Heeds...>());

  Law law{};
  Lateral lateral{};
  [[no_unique_address]] Heeding<Heeds...> heeds{};
  double jerk = 2.5;  ///< see `Limits::within` [m/s^3]; 1e6: no bound

  /// The same driver, heeding more.
  template <class... More>
  using Also = Driver<Law, Lateral, Heeds..., More...>;

  struct Memory {
    [[no_unique_address]] MemoryOf<Lateral> lateral{};
    [[no_unique_address]] typename Heeding<Heeds...>::Memory heeds{};

    void fell_short(double way, bool left_course) { cambium::fell_short(lateral, way, left_course); }
    void was_set() { cambium::was_set(lateral); }

    static constexpr char const* name = detail::memory_name<Law, Lateral, Heeds...>;
    static constexpr auto parameters() {
      using P = Memory;
      return parameter_list(parameter("lateral", &P::lateral, "of the lateral part"),
                            parameter("heeds", &P::heeds, "of what it heeds"));
    }

    friend bool operator==(Memory const&, Memory const&) = default;
  };

  static constexpr bool looks_beside = detail::looks_beside<Lateral>() || (detail::looks_beside<Heeds>() || ...);
  static constexpr bool looks_around = detail::looks_around<Lateral>() || (detail::looks_around<Heeds>() || ...);
  static constexpr bool heeds_conflicts = (detail::heeds_conflicts<Heeds>() || ...);

  static constexpr char const* name = driver_text<Law, Lateral, Heeds...>.name;
  static constexpr char const* summary = driver_text<Law, Lateral, Heeds...>.summary;
  static constexpr char const* source = driver_text<Law, Lateral, Heeds...>.source;
  static constexpr auto parameters() {
    using P = Driver;
    return parameter_list(parameter("law", &P::law, "by which it follows"),
                          parameter("lateral", &P::lateral, "where across the road it drives"),
                          parameter("heeds", &P::heeds, "what it heeds besides"),
                          parameter("jerk", &P::jerk, "m/s^3", Range{0.1, 1e6},
                                    "highest change of the acceleration, unless it has to brake hard; 1e6: none"));
  }

  void check(std::string const& where) const { detail::check_law(law, where); }

  /// One of the heeds.
  template <class H>
  [[nodiscard]] constexpr H& heed() {
    return heeds.template get<H>();
  }
  template <class H>
  [[nodiscard]] constexpr H const& heed() const {
    return heeds.template get<H>();
  }
  /// A copy with `heed` instead of its own one of that type.
  template <class H>
  [[nodiscard]] constexpr Driver with(H const& heed) const {
    auto changed = *this;
    changed.template heed<H>() = heed;
    return changed;
  }

  template <class View>
  [[nodiscard]] Plan<View> plan(View const& view, Memory& memory, double dt) const {
    double const speed = std::max(0.0, view.state().speed);
    Limits<Law> limits(law, speed, heeds.desired_speed(law, view, speed), heeds.merging(view, lateral.counted()));
    limits.gives_way = heeds_conflicts;
    limits.jerk_bound = {jerk, view.last_acceleration()};
    auto const seen = lateral.look(view, memory.lateral, limits, dt);
    heeds.heed(view, memory.heeds, limits, dt);
    return lateral.drive(view, memory.lateral, seen, limits, dt);
  }
};

}  // namespace cambium::inline v0_1
