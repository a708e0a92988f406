#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <type_traits>
#include <vector>

#include "cambium/behavior/following/constant_acceleration.hpp"
#include "cambium/behavior/law/follow_lane.hpp"
#include "cambium/core/plan.hpp"
#include "cambium/evaluation/collision.hpp"
#include "cambium/evaluation/course_end.hpp"
#include "cambium/world/prediction.hpp"

namespace cambium {

namespace detail {

/// Whether a view can be asked for predictions: `ViewArchetype` cannot.
template <class View, class Set, class Other>
concept Predicts = requires(View const view, Prediction<Set> const prediction) {
  view.predict(prediction);
  typename Other::FrameType;
};

/// Whether `W` is a `cambium::World`, or derived from one.
template <class W>
inline constexpr bool is_world = requires {
  typename W::Behaviors;
  typename W::Execution;
  typename W::FrameType;
  typename W::View;
};

/// True; says in a sentence what the `PredictionWorld` of a planner lacks to predict with behaviours `Others`.
template <class PredictionWorld, class... Others>
[[nodiscard]] constexpr bool check_planner() {
  static_assert(is_world<PredictionWorld>,
                "cambium: a planner's PredictionWorld must be a cambium::World<BehaviorSet<...>, ...>; take "
                "World::WithBehaviors<BehaviorSet<...>> of the world that it plans in");
  if constexpr (is_world<PredictionWorld>)
    static_assert((PredictionWorld::Behaviors::template contains<Others> && ...),
                  "cambium: the behaviour set of a planner's PredictionWorld must contain its Others, as which the "
                  "others are predicted");
  return true;
}

/// True; says in a sentence where `PredictionWorld` differs from the world that is `Predicted`.
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
                  "cambium: a planner's PredictionWorld must be a cambium::World itself, no class derived from one; "
                  "take World::WithBehaviors<BehaviorSet<...>> of the world that it plans in");
  }
  return true;
}

}  // namespace detail

/// The world that a planner predicts for the agent of `view`: that agent behaves as `behavior`, all others as `others`,
/// both of the behaviour set of `PredictionWorld`. `ego`: the agent's slot there; none where it is not in traffic.
template <class PredictionWorld, class Ego, class Others, class View>
[[nodiscard]] PredictionWorld predicted_for(View const& view, Ego const& behavior, Others const& others,
                                            std::optional<Slot>& ego) {
  auto world = view.predict(predict_as<typename PredictionWorld::Behaviors>(behavior, others));
  static_assert(detail::check_prediction_world<PredictionWorld, decltype(world)>());
  ego = world.roster().slot_of(view.id());
  return world;
}

/// Lets a plan that ends before the time `end` [s], such as one that leaves the map, go on at its last speed and
/// heading.
template <class View>
void go_straight_on(View const& view, double end, Plan<View>& plan) {
  auto state = plan.trajectory.empty() ? view.state() : plan.trajectory.back();
  double const left = end - state.time;
  if (!plan.trajectory.empty() && left <= 1e-9) return;
  auto const along = geometry::sin_cos(state.heading);
  state.x += along.cos * state.speed * left;
  state.y += along.sin * state.speed * left;
  state.time = end;
  plan.trajectory.push_back(state);
}

/// Steps `world` by `dt` [s], in equal steps of at most `step` [s]; what the agent at `slot` does becomes its plan.
template <class World, class S>
void drive_predicted(World& world, Slot slot, double dt, double step, BasicPlan<S>& plan) {
  auto const steps = std::max(1, static_cast<int>(std::ceil(dt / step - 1e-9)));
  double const begin = world.time();
  for (int i = 0; i < steps; ++i) {
    (void)world.step(dt / steps);
    auto const& record = world.frame().agents[slot];
    if (i == 0) plan.action = record.action;
    plan.trajectory.push_back(record.state);
    plan.trajectory.back().time = i + 1 == steps ? begin + dt : world.time();
  }
  plan.status = PlanStatus::valid;
}

/// Where the agent is after `time` [s] of braking with `deceleration` [m/s^2], along its lane and as far beside its
/// middle as it is now.
template <class View>
[[nodiscard]] typename View::State braking_state(View const& view, double deceleration, double time) {
  double const speed = std::max(0.0, view.state().speed);
  if (!(time > 0.0)) return view.state();
  return follow_lane(view, ConstantAcceleration{-deceleration}.motion(speed, time), time);
}

/// The agents nearest to the one at `ego`, at most `count` of them and within `range` [m], nearest first. O(n log n).
template <class World>
[[nodiscard]] std::vector<Slot> nearest_agents(World const& world, Slot ego, std::size_t count, double range) {
  auto const& agents = world.frame().agents;
  auto const distance = [&](Slot slot) {
    return std::hypot(agents[slot].state.x - agents[ego].state.x, agents[slot].state.y - agents[ego].state.y);
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

namespace detail {

/// The others that the agent at `ego` has to look out for: not those who follow behind in the strip that it drives in,
/// who have to keep clear themselves. O(agents).
template <class World>
void choose_counting(World const& world, Slot ego, std::vector<Slot>& counting) {
  counting.clear();
  double const rear = world.roster().agents[ego].shape.rear;
  auto const own = box_at(world, ego);
  for (Slot i{}; index_of(i) < world.size(); ++i) {
    auto const box = box_at(world, i);
    double const aside = own.cos * (box.y - own.y) - own.sin * (box.x - own.x);
    bool const beside = std::abs(aside) > own.half_width + box.half_width;
    if (i != ego && (beside || distance_ahead(world, ego, box) > -rear)) counting.push_back(i);
  }
}

/// How many lane changes it takes from `piece` of lane corridor `number` to one that the route ends in; 0 where none
/// is beside. O(lanes).
[[nodiscard]] inline int lanes_to_destination(map::RoadCorridor const& road, CorridorId number, PieceId piece) {
  constexpr int most = 16;
  if (road.corridors[number].reaches_destination) return 0;
  for (bool const left : {true, false}) {
    auto corridor = number;
    auto at = piece;
    for (int lanes = 1; lanes <= most; ++lanes) {
      auto const& here = road.corridors[corridor].pieces[at];
      corridor = here.beside(left);
      at = here.piece_beside(left);
      if (corridor == none<CorridorId>) break;
      if (road.corridors[corridor].reaches_destination) return lanes;
    }
  }
  return 0;
}

}  // namespace detail

}  // namespace cambium
