#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include "cambium/core/described.hpp"
#include "cambium/core/ids.hpp"
#include "cambium/core/one_of.hpp"
#include "cambium/geometry/pose.hpp"
#include "cambium/geometry/shape.hpp"
#include "cambium/goal/goal.hpp"
#include "cambium/map/corridor/corridor.hpp"
#include "cambium/map/routing/route.hpp"

namespace cambium::inline v0_1 {

namespace detail {
enum class SpecPart { behavior, goal, id };

/// A part of an `AgentSpecOf`, of type `Value`. It accepts any type, so that a wrong type yields our message, which
/// names the part, and not the compiler's, which does not.
template <class Value, SpecPart part>
struct Given : Value {
  Given() = default;
  Given(Value const& value) : Value(value) {}
  Given(Value&& value) : Value(std::move(value)) {}
  template <class T>
  requires(!std::is_base_of_v<Value, std::remove_cvref_t<T>>) Given(T&& value)
      : Value(converted(std::forward<T>(value))) {}

  [[nodiscard]] Value const& given() const { return *this; }

 private:
  template <class T>
  [[nodiscard]] static Value converted(T&& value) {
    constexpr bool fits = std::is_convertible_v<T, Value>;
    static_assert(fits || part != SpecPart::behavior,
                  "cambium::World::AgentSpec::behavior: this type is not one of the Models of the world's "
                  "cambium::BehaviorSet<Models...>; add it there");
    static_assert(fits || part != SpecPart::goal,
                  "cambium::World::AgentSpec::goal: this type is no goal; give one of cambium/goal.hpp, or a copyable "
                  "struct of your own with `bool at_goal(cambium::GoalSituation const&) const`");
    static_assert(
        fits || part != SpecPart::id,
        "cambium::World::AgentSpec::id: this is no id; write cambium::AgentId{7}, or leave it out to get a free one");
    if constexpr (fits)
      return std::forward<T>(value);
    else
      return Value{};
  }
};

/// The field, unless it is a struct without a description, which files cannot hold.
template <class Owner, class Field>
[[nodiscard]] constexpr auto if_described(Parameter<Owner, Field> field) {
  if constexpr (DescribedModel<Field>)
    return parameter_list(field);
  else
    return parameter_list();
}
}  // namespace detail

/// Describes an agent for `World::add`: see `World::AgentSpec`.
template <class Behavior, class Execution, class Dynamics, class Observer>
struct AgentSpecOf {
  geometry::Point position{std::numeric_limits<double>::quiet_NaN(),
                           std::numeric_limits<double>::quiet_NaN()};  ///< of the reference point [m]
  std::optional<double> heading{};                                     ///< [rad]; default: along the lane
  double speed = 0.0;                                                  ///< [m/s]
  double acceleration = 0.0;  ///< as measured [m/s^2]; planners see it as if driven
  geometry::Shape shape{};    ///< default: a car
  detail::Given<Behavior, detail::SpecPart::behavior> behavior{};
  detail::Given<Goal, detail::SpecPart::goal> goal{};
  std::optional<map::Route> route{};                ///< default: the shortest to the goal; straight on without a goal
  std::shared_ptr<map::RoadCorridor const> road{};  ///< instead of a route: see `map::build_free_corridor`
  std::vector<geometry::Point> way{};               ///< instead of a road: its points; agents on equal ways share one
  Execution execution{};
  Dynamics dynamics{};
  Observer observer{};
  detail::Given<std::optional<AgentId>, detail::SpecPart::id> id{};  ///< default: the next free id

  static constexpr char const* name = "agent";
  /// What a file holds of it: all but `road`.
  static constexpr auto parameters() {
    using P = AgentSpecOf;
    auto const own = parameter_list(
        parameter("id", &P::id, "a number; absent: the next free one"),
        parameter("position", &P::position, "m", any_finite, "of the reference point"),
        parameter("heading", &P::heading, "rad", any_finite, "counter-clockwise from +x; absent: along the lane"),
        parameter("speed", &P::speed, "m/s", Range{-0.1, 1000}, "along the heading"),
        parameter("acceleration", &P::acceleration, "m/s^2", any_finite, "as measured"),
        parameter("shape", &P::shape, "default: a car"),
        parameter("behavior", &P::behavior, "one of the world's behaviours"),
        parameter("goal", &P::goal, "absent: none"),
        parameter("route", &P::route, "absent: the shortest to the goal, straight on without one"),
        parameter("way", &P::way, "m", any_finite, "instead of a route: points of a way that is no lane, as on foot"));
    auto const models =
        join_parameters(detail::if_described(parameter("execution", &P::execution, "how it tracks its plans")),
                        detail::if_described(parameter("dynamics", &P::dynamics, "the vehicle model")));
    auto const observer = detail::if_described(parameter("observer", &P::observer, "how it sees the others"));
    return join_parameters(own, join_parameters(models, observer));
  }
};

}  // namespace cambium::inline v0_1
