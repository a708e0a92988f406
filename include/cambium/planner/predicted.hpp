#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "cambium/behavior/heed/conflicts.hpp"
#include "cambium/behavior/lateral/lane_change.hpp"
#include "cambium/behavior/open_loop/constant_acceleration.hpp"
#include "cambium/core/constants.hpp"
#include "cambium/core/error.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/core/plan.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/evaluation/collision.hpp"
#include "cambium/evaluation/course_end.hpp"
#include "cambium/evaluation/terms.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/world/driven_to.hpp"
#include "cambium/world/prediction.hpp"
#include "cambium/world/world.hpp"

namespace cambium::inline v0_1 {

namespace detail {

/// Whether a view can predict worlds of type `World`; `ViewArchetype` cannot.
template <class View, class World>
concept Predicts = requires(View const view, Prediction<typename World::Behaviors> const prediction) {
  view.predict(prediction);
  typename World::FrameType;
};

/// Whether `World` is a world in which an agent may have that behaviour.
template <class World, class Behavior>
concept HasBehavior = is_world<World> && World::Behaviors::template contains<Behavior>;

/// True. Else a compile error says what a planner's `PredictionWorld` lacks to predict behaviours `Others`.
template <class PredictionWorld, class... Others>
[[nodiscard]] constexpr bool check_planner() {
  static_assert(is_world<PredictionWorld>,
                "cambium: a planner's PredictionWorld must be a cambium::World<BehaviorSet<...>, ...>; take "
                "World::WithBehaviors<BehaviorSet<...>> of the world that it plans in");
  if constexpr (is_world<PredictionWorld>)
    static_assert((HasBehavior<PredictionWorld, Others> && ...),
                  "cambium: the behaviour set of a planner's PredictionWorld must contain its Others, the "
                  "model by which all agents but ego are predicted");
  return true;
}

/// True. Else a compile error says that a planner's own terms are something else.
template <class Own>
[[nodiscard]] constexpr bool check_terms() {
  static_assert(is_terms<Own>, "cambium: a planner's own terms must be cambium::Terms<Evaluators...>");
  return true;
}

/// Throws `ParameterError` if one of a planner's own terms bounds a risk, which only `Mcts` does.
template <class Own>
void refuse_costs(Own const& terms, std::string const& where) {
  if (terms.has_cost())
    throw ParameterError(where, "has a term with a cost, which this planner does not bound", "give it a weight");
}

/// True. Else a compile error says how `PredictionWorld` differs from the world type `Predicted`.
template <class PredictionWorld, class Predicted>
[[nodiscard]] constexpr bool check_prediction_world() {
  if constexpr (!std::is_same_v<PredictionWorld, Predicted>) {
    constexpr bool same_execution = std::is_same_v<typename PredictionWorld::Execution, typename Predicted::Execution>;
    constexpr bool same_dynamics = std::is_same_v<typename PredictionWorld::Dynamics, typename Predicted::Dynamics>;
    constexpr bool same_observer = std::is_same_v<typename PredictionWorld::Observer, typename Predicted::Observer>;
    static_assert(same_execution,
                  "cambium: a planner's PredictionWorld has another execution model than the world that it plans in; "
                  "take World::WithBehaviors<BehaviorSet<...>> of that world");
    static_assert(same_dynamics,
                  "cambium: a planner's PredictionWorld has another vehicle model than the world that it plans in; "
                  "take World::WithBehaviors<BehaviorSet<...>> of that world");
    static_assert(same_observer,
                  "cambium: a planner's PredictionWorld must have cambium::PerfectObserver; "
                  "take World::WithBehaviors<BehaviorSet<...>> of the world that it plans in");
    static_assert(!same_execution || !same_dynamics || !same_observer,
                  "cambium: a planner's PredictionWorld must be a cambium::World itself, not derived from one; "
                  "take World::WithBehaviors<BehaviorSet<...>> of the world that it plans in");
  }
  return true;
}

}  // namespace detail

/// The prediction world for the agent of `view`. That agent behaves as `behavior`, all others as `others`; both models
/// must be in the behaviour set of `PredictionWorld`. Sets `ego` to the agent's slot there, or to none if it is not in
/// traffic.
template <class PredictionWorld, class Ego, class Others, class View>
[[nodiscard]] PredictionWorld predicted_for(View const& view, Ego const& behavior, Others const& others,
                                            std::optional<Slot>& ego) {
  auto world = view.predict(predict_as<typename PredictionWorld::Behaviors>(behavior, others));
  static_assert(detail::check_prediction_world<PredictionWorld, decltype(world)>());
  ego = world.roster().slot_of(view.id());
  return world;
}

namespace detail {
/// To whom the records of a frame of `world` belong.
template <class World>
[[nodiscard]] std::vector<AgentId> ids_of(World const& world) {
  std::vector<AgentId> ids;
  for (auto const& agent : world.roster().agents) ids.push_back(agent.id);
  return ids;
}

/// The desired speed of a driver's law, or of the driver that it wraps; null if it has none.
template <class Driver>
[[nodiscard]] auto* desired_speed_of(Driver& driver) {
  if constexpr (requires { driver.law.desired_speed; })
    return &driver.law.desired_speed;
  else if constexpr (requires { driver.driver; })
    return desired_speed_of(driver.driver);
  else
    return static_cast<double*>(nullptr);
}

/// Whether an agent moves beside or across the lanes on a path of its own, as pedestrians do.
template <class World>
[[nodiscard]] bool is_beside_lanes(World const& world, Slot slot) {
  return !is_valid(world.roster().agents[slot].road->corridors.front().pieces.front().lane);
}

/// Gives an agent a behaviour of the same model, unless it is too large for the conflicts that this model heeds.
template <class World, class Others>
void assume(World& world, Slot slot, Others const& others) {
  auto const& agent = world.roster().agents[slot];
  if (!is_too_large(world.map(), typename World::Behavior(others), agent.shape, *agent.road))
    world.set_behavior(agent.id, others);
}

/// Whether an agent moves at a constant speed.
template <class Record>
[[nodiscard]] bool is_steady(Record const& seen) {
  return seen.state.speed > 3.0 && std::abs(seen.acceleration) < 0.3f;  // [m/s], [m/s^2]
}

/// Whether an agent moves across its lane, as during a lane change.
template <class Record>
[[nodiscard]] bool moves_across(Record const& seen) {
  return std::abs(seen.lane.heading_error) * seen.state.speed > 0.4;  // [m/s]
}

/// Whether an agent drives steadily on a free road, so that its speed must be the one it wants.
template <class World>
[[nodiscard]] bool likes_its_speed(World& world, Slot slot) {
  auto const& seen = world.frame().agents[slot];
  if (!is_steady(seen)) return false;
  auto const ahead = world.observe(slot).ahead();
  return !ahead || ahead->gap > 5.0 + 4.0 * seen.state.speed;  // [m], [s]
}

/// Whether an agent stands in its lane, parked or broken down.
template <class World>
[[nodiscard]] bool is_parked(World& world, Slot slot) {
  auto const& seen = world.frame().agents[slot];
  if (seen.state.speed >= at_rest_below || !in_traffic(world, slot)) return false;
  auto const view = world.observe(slot);
  return is_parked(view, RoadUser{.agent = view.id(), .s = view.place().s, .front = view.shape().front});
}

/// How a driver, or the one that it wraps, gives way; null if it does not.
template <class Driver>
[[nodiscard]] Conflicts* conflicts_of(Driver& driver) {
  if constexpr (requires { driver.heeds.template get<Conflicts>(); })
    return &driver.heeds.template get<Conflicts>();
  else if constexpr (requires { driver.driver; })
    return conflicts_of(driver.driver);
  else
    return nullptr;
}

/// How those who merge into its lane count for a driver, or for the one that it wraps; null if it cannot say.
template <class Driver>
[[nodiscard]] Merging* merging_of(Driver& driver) {
  if constexpr (requires { driver.lateral.keep.merging; })
    return &driver.lateral.keep.merging;
  else if constexpr (requires { driver.lateral.merging; })
    return &driver.lateral.merging;
  else if constexpr (requires { driver.driver; })
    return merging_of(driver.driver);
  else
    return nullptr;
}

/// Makes a driver take its right of way whatever others do; with `opens_no_gap`, those who merge into its lane, too.
template <class Driver>
void let_insist(Driver& driver, bool opens_no_gap) {
  if (auto* const conflicts = conflicts_of(driver)) conflicts->insists = true;
  if (auto* const merging = merging_of(driver); merging != nullptr && opens_no_gap) *merging = Merging::ignored;
}

/// Whether an agent is on a lane that ends by merging into another.
template <class World>
[[nodiscard]] bool gives_up_lane(World const& world, Slot slot) {
  auto const& at = world.frame().agents[slot].lane;
  auto const lane = world.roster().agents[slot].road->corridors[at.corridor].pieces[at.piece].lane;
  return is_valid(lane) && is_valid(world.map().lane(lane).merges_into);
}

/// Whether an agent shows no sign that it lets others go first: it does not brake.
template <class Record>
[[nodiscard]] bool goes_on(Record const& seen) {
  constexpr double noticeable = 1.0;  // [m/s^2]
  return static_cast<double>(seen.acceleration) > -noticeable;
}

/// What is expected of an agent beyond the model of the others.
struct Expectations {
  /// It keeps its speed if it is faster than the others want to drive, drives steadily, is parked, or moves beside the
  /// lanes, as pedestrians do: nobody slows down or speeds up without a reason. On a lane, the speed is rounded to a
  /// whole m/s, so that small changes of speed do not change the prediction.
  bool keeps_speed = true;
  /// It takes its right of way, whatever ego does, unless it brakes already; nor does it open a gap for those who
  /// merge, unless its own lane ends.
  bool insists = true;
  /// The planner learns headways, so an agent counts as steady only if nobody ahead hinders it; a follower's speed
  /// reveals the gap that it keeps.
  bool learns = false;
};

/// Predicts all agents but ego by a driver `others` with these expectations. O(agents).
template <class World, class Others>
void expect(World& world, Slot ego, Others const& others, Expectations const& expected) {
  auto const* const usual_speed = desired_speed_of(others);
  auto const range = usual_speed != nullptr ? range_at(type_info<Others>(), &others, usual_speed) : Range{};
  for (Slot slot{}; index_of(slot) < world.size(); ++slot) {
    auto const& seen = world.frame().agents[slot];
    if (slot == ego) continue;
    bool const is_on_foot = is_beside_lanes(world, slot);
    bool const insists = expected.insists && !is_on_foot && goes_on(seen);
    auto its = others;
    if (insists) let_insist(its, !gives_up_lane(world, slot));
    auto* const desired = desired_speed_of(its);
    bool is_other = insists;
    if (desired != nullptr && expected.keeps_speed) {
      double const usual = *desired;
      bool const stands = !is_on_foot && is_parked(world, slot);
      if (is_on_foot || stands || seen.state.speed > usual ||
          (expected.learns ? likes_its_speed(world, slot) : is_steady(seen))) {
        double const speed = is_on_foot ? seen.state.speed : stands ? 0.0 : std::max(1.0, std::round(seen.state.speed));
        *desired = std::clamp(speed, range.low, range.high);
        is_other = true;
      }
    }
    if (is_other) assume(world, slot, its);
  }
}

/// Predicts that vehicles which brake now and drive in ego's direction keep braking, where `others` would hold their
/// speed. Crossing traffic is left out: it may have right of way and not stop. O(agents).
template <class World, class Others>
void expect_to_brake_on(World& world, Slot ego, Others others) {
  if constexpr (std::is_same_v<Others, ConstantAcceleration>) {
    constexpr double noticeable = 0.5, hardest = 8.0, aligned = 0.5;  // [m/s^2], [rad]
    auto const& agents = world.frame().agents;
    for (Slot slot{}; index_of(slot) < world.size(); ++slot) {
      double const seen = static_cast<double>(agents[slot].acceleration);
      if (slot == ego || seen > others.acceleration - noticeable ||
          std::abs(geometry::angle_difference(agents[slot].state.heading, agents[ego].state.heading)) > aligned)
        continue;
      auto braking = others;
      braking.acceleration = std::max(seen, -hardest);
      assume(world, slot, braking);
    }
  }
}
}  // namespace detail

/// Extends a plan that ends before the time `end` [s], for example at the end of the map, at its last speed and
/// heading.
template <class View>
void go_straight_on(View const& view, double end, Plan<View>& plan) {
  auto state = plan.trajectory.empty() ? view.state() : plan.trajectory.back();
  double const left = end - state.time;
  if (!plan.trajectory.empty() && left <= same_time) return;
  auto const along = portable::sin_cos(state.heading);
  state.x += along.cos * state.speed * left;
  state.y += along.sin * state.speed * left;
  state.time = end;
  plan.trajectory.push_back(state);
}

/// Replaces the motion of the agent at `ego` in a predicted course of `world` by another one: `state_at(k)` is its
/// state in frame k.
template <class World, class F>
void replace_course(World const& world, Slot ego, std::vector<typename World::FrameType>& course, F const& state_at) {
  for (std::size_t k = 1; k < course.size(); ++k) {
    auto state = state_at(k);
    state.time = course[k].time;
    course[k].agents[ego] = driven_to(world, ego, course[k - 1].agents[ego], state);
  }
}

/// Up to `count` agents nearest to the one at `ego`, within `range` [m], nearest first. O(n log n) in the agents.
template <class World>
[[nodiscard]] std::vector<Slot> nearest_agents(World const& world, Slot ego, std::size_t count, double range) {
  auto const& agents = world.frame().agents;
  auto const distance = [&](Slot slot) {
    return portable::hypot(agents[slot].state.x - agents[ego].state.x, agents[slot].state.y - agents[ego].state.y);
  };
  std::vector<Slot> slots;
  for (Slot slot{}; index_of(slot) < world.size(); ++slot)
    if (slot != ego && agents[slot].status == AgentStatus::driving && distance(slot) <= range) slots.push_back(slot);
  std::sort(slots.begin(), slots.end(), [&](Slot a, Slot b) {
    double const to_a = distance(a), to_b = distance(b);
    return to_a < to_b || (to_a == to_b && a < b);
  });
  slots.resize(std::min(slots.size(), count));
  return slots;
}

/// The agents with whom the agent at `ego` has to avoid contact: all but those that are behind it in `frame`, in the
/// strip of road that it covers. Keeping clear of ego is their duty. O(agents).
template <class Roster, class Frame>
void agents_to_avoid(Roster const& roster, Frame const& frame, Slot ego, std::vector<Slot>& slots) {
  slots.clear();
  auto const& state = frame.agents[ego].state;
  double const rear = roster.agents[ego].shape.rear;
  auto const box_of = [&](Slot slot) { return geometry::box_of(roster.agents[slot].shape, frame.agents[slot].state); };
  auto const own = box_of(ego);
  for (Slot i{}; index_of(i) < frame.agents.size(); ++i) {
    auto const box = box_of(i);
    double const aside = own.cos * (box.y - own.y) - own.sin * (box.x - own.x);
    double const ahead = (box.x - state.x) * own.cos + (box.y - state.y) * own.sin;
    bool const beside = std::abs(aside) > own.half_width + box.half_width;
    if (i != ego && (beside || ahead > -rear)) slots.push_back(i);
  }
}

}  // namespace cambium::inline v0_1
