#pragma once

#include <algorithm>
#include <atomic>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "cambium/behavior/behavior_set.hpp"
#include "cambium/core/error.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/dynamics/dynamic_model.hpp"
#include "cambium/execution/execution_model.hpp"
#include "cambium/map/map.hpp"
#include "cambium/observer/perfect.hpp"
#include "cambium/world/agent_spec.hpp"
#include "cambium/world/detail/entering.hpp"
#include "cambium/world/detail/on_lanes.hpp"
#include "cambium/world/detail/refusals.hpp"
#include "cambium/world/detail/scratch.hpp"
#include "cambium/world/detail/situation.hpp"
#include "cambium/world/detail/world_step.hpp"
#include "cambium/world/frame.hpp"
#include "cambium/world/observed_world.hpp"
#include "cambium/world/prediction.hpp"
#include "cambium/world/roster.hpp"
#include "cambium/world/step_result.hpp"
#include "cambium/world/traffic_index.hpp"

namespace cambium::inline v0_1 {

/// How a world begins.
struct WorldOptions {
  std::uint64_t seed = 0;  ///< for all random numbers in the world
  double time = 0.0;       ///< start time [s]
};

/// Whether `World::set_state` keeps the agent's route or finds a new one from the new position.
enum class Reroute : std::uint8_t { no, yes };

/// Interacting road traffic on a map: a value. Copies are independent; they share the map and the roster, and a copy
/// costs as much as copying the frame. Copying into a world that was used before allocates nothing. Several threads may
/// read one world; `step`, `observe` and all functions that change the world need exclusive access.
template <class Set, class ExecutionType, class DynamicModelType, class ObserverType = PerfectObserver>
class World {
  static_assert(is_behavior_set<Set>, "cambium::World<Set, ...>: Set must be cambium::BehaviorSet<Models...>");
  static_assert(DynamicModel<DynamicModelType>,
                "cambium::World<Set, Execution, Dynamics>: Dynamics must be a vehicle model such as "
                "cambium::SingleTrack (see DynamicModel)");
  static_assert(!DynamicModel<DynamicModelType> || ExecutionModel<ExecutionType, DynamicModelType>,
                "cambium::World<Set, Execution, ...>: Execution must be an execution model such as "
                "cambium::InterpolateExecution (see ExecutionModel)");
  static_assert(ObserverModel<ObserverType>,
                "cambium::World<Set, Execution, Dynamics, Observer>: Observer must be an observer model such as "
                "cambium::PerfectObserver (see ObserverModel)");

 public:
  using Behaviors = Set;
  using Behavior = typename Set::Any;
  using Execution = ExecutionType;
  using Dynamics = DynamicModelType;
  using Observer = ObserverType;
  using State = typename Dynamics::State;
  using FrameType =
      Frame<State, typename Set::Memory, ExecutionMemoryOf<Execution, State>, detail::PastOf<State, Observer>>;
  using Record = typename FrameType::Record;
  using RosterType = Roster<Behavior, Execution, Dynamics, Observer>;
  using View = ObservedWorld<World>;
  using TrueView = ObservedWorld<World, true>;
  /// The type of a prediction: other behaviours, perfect observation.
  template <class OtherSet>
  using WithBehaviors = World<OtherSet, Execution, Dynamics, PerfectObserver>;

  /// Describes an agent for `add`.
  using AgentSpec = AgentSpecOf<Behavior, Execution, Dynamics, Observer>;

  /// An empty world on `map`. Throws `WorldError` without a map.
  explicit World(std::shared_ptr<Map const> map, WorldOptions const& options = {}) : map_(std::move(map)) {
    if (!map_) throw WorldError("World", "there is no map", "pass the map that load_opendrive returned");
    if (!(std::abs(options.time) <= latest_time))
      throw WorldError("World", "its time is not a number of seconds up to 1e9", "set WorldOptions::time");
    auto roster = std::make_shared<RosterType>();
    roster->seed = options.seed;
    roster_ = std::move(roster);
    frame_.time = options.time;
  }

  /// Catches `World(*map)`.
  template <std::same_as<Map> M>
  explicit World(M const&, WorldOptions const& = {}) {
    static_assert(!std::same_as<M, Map>,
                  "cambium::World: a world shares its map with others; pass the std::shared_ptr<Map const> that "
                  "load_opendrive returned, not *map");
  }

  /// Builds a world from its parts, as predictions, searches and snapshots do. Throws `WorldError` if the map or the
  /// roster is missing, or if `frame` does not belong to `roster`.
  World(std::shared_ptr<Map const> map, std::shared_ptr<RosterType const> roster, FrameType frame)
      : map_(std::move(map)), roster_(std::move(roster)) {
    if (!map_ || !roster_) throw WorldError("World", "there is no map or no roster", "take them from another world");
    detail::require_same_roster(frame.agents.size(), frame.roster_revision, roster_->agents.size(), roster_->revision);
    frame_ = std::move(frame);
  }

  World(World const&) = default;
  World(World&&) = default;
  World& operator=(World&&) = default;
  ~World() = default;

  World& operator=(World const& other) {
    if (this == &other) return *this;
    frame_ = other.frame_;  // first, because the rest cannot fail
    // Most copies are between worlds that share map and roster: they touch no reference count.
    if (map_ != other.map_) map_ = other.map_;
    if (roster_ != other.roster_) roster_ = other.roster_;
    scratch_ = other.scratch_;
    return *this;
  }

  [[nodiscard]] Map const& map() const { return *map_; }
  [[nodiscard]] std::shared_ptr<Map const> const& shared_map() const { return map_; }
  [[nodiscard]] RosterType const& roster() const { return *roster_; }
  [[nodiscard]] std::shared_ptr<RosterType const> const& shared_roster() const { return roster_; }
  [[nodiscard]] FrameType const& frame() const { return frame_; }
  [[nodiscard]] double time() const { return frame_.time; }
  [[nodiscard]] std::size_t size() const { return frame_.agents.size(); }

  /// Replaces the current frame by a frame of this world, or of a copy with the same roster. A search does this at its
  /// nodes. Throws `WorldError` (the world is unchanged) if an agent has entered, left, got another route or another
  /// model of behaviour since the frame was taken. No allocation once warm.
  void restore(FrameType const& frame) {
    detail::require_same_roster(frame.agents.size(), frame.roster_revision, size(), roster_->revision);
    frame_ = frame;
    scratch_.forget();
  }

  /// Swaps the world's frame with another frame of the same roster: `restore` without a copy. Asserts that the frame
  /// belongs to the roster. O(1).
  void exchange(FrameType& frame) {
    CAMBIUM_ASSERT(frame.agents.size() == size() && frame.roster_revision == roster_->revision,
                   "World::exchange: the frame does not belong to this roster");
    std::swap(frame_, frame);
    scratch_.forget();
  }

  /// Gives the agent another behaviour, with an empty memory. A planner uses this to assume a behaviour of one agent.
  /// Throws `WorldError` or `ParameterError` (the world is unchanged) as `add` does.
  void set_behavior(AgentId id, Behavior const& behavior) {
    auto const slot = slot_of(id);
    auto const where = detail::name_of(id);
    detail::check_if_described(behavior, where);
    auto const& agent = roster_->agents[slot];
    if (detail::is_too_large(*map_, behavior, agent.shape, *agent.road)) detail::refuse_too_large(where);
    bool const is_other_model = behavior.index() != agent.behavior.index();
    (is_other_model ? revised_roster() : writable_roster()).agents[slot].behavior = behavior;
    frame_.agents[slot].memory = Set::initial_memory(behavior);
    if (is_other_model) scratch_.forget();
  }

  /// Reports a behaviour that is not in the set, with a remedy.
  template <class B>
  requires(!std::is_convertible_v<B const&, Behavior>) void set_behavior(AgentId, B const&) {
    static_assert(std::is_void_v<B>,
                  "cambium::World::set_behavior: this type is not one of the Models of the world's "
                  "cambium::BehaviorSet<Models...>; add it there");
  }

  /// Adds an agent; returns its id. Throws `WorldError` or `ParameterError` (the world is unchanged) if its lane, route
  /// or parameters are invalid, if a number is not finite, if the speed is outside 0 to 1000 m/s (measured speeds down
  /// to -0.1 count as 0), if the position is more than 5 m outside the nearest lane (of the route, if the agent brings
  /// one), or if the heading points against the lane's direction. It does not check that the place is free; drivers
  /// that start on top of each other do not move. O(agents), plus routing.
  AgentId add(AgentSpec const& spec) {
    if (!spec.way.empty() && !spec.road) {
      auto on_road = spec;
      on_road.road = detail::free_road_along(*map_, *roster_, spec.way);
      return add(on_road);
    }
    AgentId const id = spec.id.value_or(static_cast<AgentId>(roster_->next_agent_id));
    auto entrant = detail::entrant<World>(*map_, *roster_, spec, id, frame_.time);
    auto& roster = revised_roster();
    if (spec.road) detail::enter_free_road(roster, spec.road, entrant.agent.road);
    auto const slot = roster.insert(std::move(entrant.agent), std::move(entrant.goal));
    frame_.agents.insert(frame_.agents.begin() + static_cast<std::ptrdiff_t>(slot), entrant.record);
    pass_goals(slot, frame_.agents[slot]);
    scratch_.forget();
    return id;
  }

  /// Removes an agent. Throws `WorldError` if there is no such agent. O(agents).
  void remove(AgentId id) {
    auto const slot = slot_of(id);
    revised_roster().erase(slot);
    frame_.agents.erase(frame_.agents.begin() + static_cast<std::ptrdiff_t>(slot));
    scratch_.forget();
  }

  /// Removes the agents that no longer take part in traffic; returns their number. Until then they stay readable, with
  /// their last state. O(agents).
  std::size_t remove_departed() {
    std::vector<Slot> staying;
    for (Slot slot{}; index_of(slot) < size(); ++slot)
      if (auto const status = frame_.agents[slot].status;
          status == AgentStatus::driving || status == AgentStatus::not_started)
        staying.push_back(slot);
    auto const departed = size() - staying.size();
    if (departed == 0) return 0;
    revised_roster().keep(staying);
    detail::keep_at(staying, frame_.agents);
    scratch_.forget();
    return departed;
  }

  /// Sets the phases of a traffic light of the map. A light without phases is off. Throws `WorldError` if the map has
  /// no such light or the phases are invalid. O(lights).
  void set_light(LightId id, map::LightPlan const& plan) {
    detail::require_light_plan(*map_, id, plan);
    auto& lights = writable_roster().lights;
    lights.resize(std::max(lights.size(), index_of(id) + 1));
    lights[index_of(id)] = plan;
  }

  /// Puts a static object in the way; returns its id. Throws `WorldError` (the world is unchanged) for one of more than
  /// 10 km around. O(objects + lanes of the map), and the length around the outline.
  ObjectId add_object(geometry::Polygon outline) {
    detail::check_outline(outline);
    return detail::enter_object(*map_, writable_roster(), std::move(outline));
  }

  /// Takes it away. Throws `WorldError` if there is no such object. O(objects).
  void remove_object(ObjectId id) {
    auto const& objects = roster_->objects;
    auto const at = std::find_if(objects.begin(), objects.end(), [id](StaticObject const& o) { return o.id == id; });
    if (at == objects.end())
      throw WorldError("object " + to_string(id), "the world has no such object", "World::roster lists those it has");
    writable_roster().erase_object(static_cast<Slot>(at - objects.begin()));
  }

  /// The agent's place in roster and frame. Throws `WorldError` if there is no such agent. O(log agents).
  [[nodiscard]] Slot slot_of(AgentId id) const {
    if (auto const slot = roster_->slot_of(id)) return *slot;
    detail::refuse(id, "the world has no such agent", "World::roster lists those it has");
  }

  [[nodiscard]] Record const& record(AgentId id) const { return frame_.agents[slot_of(id)]; }
  [[nodiscard]] State const& state(AgentId id) const { return record(id).state; }
  [[nodiscard]] AgentStatus status(AgentId id) const { return record(id).status; }
  /// Catches a number.
  template <std::integral Number>
  State const& state(Number) const {
    static_assert(!std::integral<Number>,
                  "cambium::World::state: a number is no agent; keep the AgentId that World::add returned, or take "
                  "frame().agents[cambium::Slot{i}].state by place");
  }

  /// The agent's situation, as goals see it. Throws as `slot_of`.
  [[nodiscard]] GoalSituation situation(AgentId id) const {
    auto const slot = slot_of(id);
    return detail::situation_of(roster_->agents[slot], frame_.agents[slot]);
  }

  /// The agent's current lane in its lane corridor. Throws as `slot_of`.
  [[nodiscard]] LaneId lane_of(AgentId id) const { return situation(id).lane; }

  /// True when the agent is at its goal. Throws as `slot_of`.
  [[nodiscard]] bool reached_goal(AgentId id) const { return reached_goal(slot_of(id)); }
  [[nodiscard]] bool reached_goal(Slot slot) const {
    return at_goal(roster_->goals[slot], detail::situation_of(roster_->agents[slot], frame_.agents[slot]));
  }

  /// The memory of the agent's behaviour `B`, for setting it from outside. Throws `WorldError` if the agent has another
  /// behaviour.
  template <class B>
  [[nodiscard]] MemoryOf<B>& memory(AgentId id) {
    static_assert(
        Set::template contains<B>,
        "cambium::World::memory<B>: B must be one of the Models of the world's cambium::BehaviorSet<Models...>");
    auto const slot = slot_of(id);
    constexpr auto place = Set::template index<B>;
    if (roster_->agents[slot].behavior.index() != place)
      detail::refuse(id, "its behaviour is not the one whose memory was asked for",
                     "ask for the model in Roster::agents");
    return *std::get_if<place>(&frame_.agents[slot].memory);
  }

  /// Sets the agent's state, for example to a perceived one, and puts the agent (back) into traffic. The agent stays on
  /// its route: in its lane corridor if the position fits, else in the nearest one. With `Reroute::yes` it gets the
  /// route that `add` would find there, to the rest of its goal (straight on without one), and its behaviour's memory
  /// is reset, because it refers to the old route. `acceleration` [m/s^2], as measured along the heading, is what
  /// planners see of it, as if it had been driven. Throws `WorldError` (the world is unchanged) if the agent is
  /// unknown, if a number is not finite, if the speed is outside 0 to 1000 m/s (measured speeds down to -0.1 count as
  /// 0: speeds along the heading are never negative), if the position is more than 5 m outside the lanes of the route,
  /// or if the heading points against their direction; with `Reroute::yes` also if no route leads to the goal, or if
  /// the agent is on a free corridor. O(lanes of the route); with `Reroute::yes` O(agents), plus routing.
  void set_state(AgentId id, State state, Reroute reroute = Reroute::no, double acceleration = 0.0) {
    auto const slot = slot_of(id);
    auto const where = detail::name_of(id);
    state.time = frame_.time;
    if (!is_finite(state))
      throw WorldError(where, "its position, heading or speed is not a finite number", "give metres, radians, m/s");
    state.speed = detail::checked_speed(state.speed, where);
    detail::check_acceleration(acceleration, where);
    auto const& agent = roster_->agents[slot];
    auto& record = frame_.agents[slot];
    if (reroute == Reroute::yes) {
      auto const again = detail::entrance_again(
          *map_, *roster_, {{state.x, state.y}, state.heading, agent.shape, roster_->goals[slot], {}, agent.road},
          record.goals_passed, where);
      if (detail::is_too_large(*map_, agent.behavior, agent.shape, *again.road)) detail::refuse_too_large(where);
      revised_roster().agents[slot].road = again.road;
      record.lane = again.place;
      record.memory = Set::initial_memory(roster_->agents[slot].behavior);  // lane corridors have other numbers now
      scratch_.forget();
    } else {
      auto const place = detail::relocate(*agent.road, record.lane, {state.x, state.y, state.heading});
      detail::check_set_place(*map_, *agent.road, place, where);
      record.lane = place;
      Set::was_set(record.memory);
    }
    record.state = state;
    record.action = {acceleration, 0.0};
    record.acceleration = static_cast<float>(acceleration);
    record.execution = {};
    if (record.status != AgentStatus::driving) detail::forget_past(record);
    record.status = AgentStatus::driving;
    if (scratch_.stepped) scratch_.next[slot].status = AgentStatus::not_started;  // it did not drive here
    pass_goals(slot, record);
    scratch_.fresh = false;
  }

  /// What the agent sees now: a view, valid until the world changes. Throws as `slot_of`. Brings the traffic index up
  /// to date.
  [[nodiscard]] View observe(AgentId id) & { return observe(slot_of(id)); }
  [[nodiscard]] View observe(Slot slot) & { return fresh_view<View>(slot); }

  /// What the agent would see with a perfect observer: the view by which others judge it. As `observe`, but without
  /// `predict` if the agents' observers are imperfect.
  [[nodiscard]] TrueView truth(AgentId id) & { return truth(slot_of(id)); }
  [[nodiscard]] TrueView truth(Slot slot) & { return fresh_view<TrueView>(slot); }

  /// Reports a call on a const world or a temporary, with a remedy.
  template <class Id, bool may_change = false>
  View observe(Id) const& {
    static_assert(may_change,
                  "cambium::World::observe brings the traffic index up to date: call it on a world that is neither "
                  "const nor a temporary, or on a copy");
  }
  template <class Id, bool may_change = false>
  TrueView truth(Id) const& {
    static_assert(may_change,
                  "cambium::World::truth brings the traffic index up to date: call it on a world that is neither "
                  "const nor a temporary, or on a copy; an evaluator that looks at neighbours takes a World&");
  }

  /// The traffic index; views use it. Up to date after `observe` and within a step.
  [[nodiscard]] TrafficIndex const& traffic() const { return scratch_.traffic; }

  /// The plane index, also up to date after `observe` and within a step. Empty unless a behaviour looks around.
  [[nodiscard]] PlaneIndex const& plane() const { return scratch_.plane; }

  /// Latest start time of a world [s]. Up to it, time resolves well below a microsecond.
  static constexpr double latest_time = 1e9;

  /// Longest step [s].
  static constexpr double longest_step = 3600.0;

  /// Advances the world by `dt` [s]: every agent plans on the current frame, then the next frame replaces it. Does not
  /// allocate once warm and throws nothing itself; the result reports problems. O(agents).
  StepResult step(double dt);

  /// The records before the last step, in the order of the frame's, or null: after `add`, `remove` and `restore`, and
  /// in copies, the current frame has nothing before it. `set_state` takes its agent out of the traffic before.
  /// Evaluators read from it how agents came to where they are. Valid until the world changes.
  [[nodiscard]] IdVector<Record, Slot> const* before_step() const {
    return scratch_.stepped ? &scratch_.next : nullptr;
  }

  /// Keeps the last `frames` frames from now on (0, the default: none). Copies and predictions start without history.
  /// The history is cleared when an agent enters, leaves, or gets another route or another model of behaviour. Throws
  /// `WorldError` for more than a million frames.
  void keep_history(std::size_t frames) {
    if (frames > 1'000'000)
      throw WorldError("history", "a world keeps at most a million frames", "ask for fewer, or record what you need");
    scratch_.keep(frames);
  }

  /// Number of frames kept before the current one.
  [[nodiscard]] std::size_t history_size() const { return scratch_.kept; }

  /// The frame `steps_back` steps ago, from 1 (the previous frame) to `history_size()`. Its records include the
  /// actions. Throws `WorldError` outside this range.
  [[nodiscard]] FrameType const& history(std::size_t steps_back) const {
    detail::require_kept(steps_back, scratch_.kept);
    return scratch_.back(steps_back);
  }

 private:
  void pass_goals(Slot slot, Record& record) const {
    detail::pass_goals(roster_->agents[slot], roster_->goals[slot], record);
  }

  [[nodiscard]] RosterType& writable_roster() {
    // A roster without other owners may change in place. The cast is sound because every roster is created non-const.
    if (roster_.use_count() != 1) roster_ = std::make_shared<RosterType>(*roster_);
    std::atomic_thread_fence(std::memory_order_acquire);  // orders the reads of former owners before our writes
    return const_cast<RosterType&>(*roster_);
  }

  /// The roster, for changes that make earlier frames invalid.
  [[nodiscard]] RosterType& revised_roster() {
    auto& roster = writable_roster();
    frame_.roster_revision = ++roster.revision;
    return roster;
  }

  void refresh_traffic() {
    if (scratch_.fresh) return;
    detail::refresh_traffic(scratch_.traffic, *map_, *roster_, frame_);
    if constexpr (Set::heeds_conflicts) scratch_.traffic.expect_searches();
    if constexpr (Set::looks_around) detail::refresh_plane(scratch_.plane, *roster_, frame_);
    scratch_.fresh = true;
  }

  template <class AnyView>
  [[nodiscard]] AnyView fresh_view(Slot slot) {
    if (index_of(slot) >= size()) [[unlikely]]
      detail::refuse_slot(slot);
    refresh_traffic();
    return AnyView(*this, slot);
  }

  std::shared_ptr<Map const> map_;
  std::shared_ptr<RosterType const> roster_;
  FrameType frame_;
  detail::Scratch<FrameType, typename Set::Workspaces> scratch_;
};

// Not in the class, and so not inline: sources that declare the world extern do not compile it.
template <class Set, class ExecutionType, class DynamicModelType, class ObserverType>
StepResult World<Set, ExecutionType, DynamicModelType, ObserverType>::step(double dt) {
  StepResult result;
  if (!(dt > 0 && dt <= longest_step)) {
    result.problem = StepProblem::bad_duration;
    return result;
  }
  refresh_traffic();
  auto& next = scratch_.next;
  scratch_.stepped = false;
  next.resize(frame_.agents.size());
  result = detail::WorldStep<World>(*this, dt, next, scratch_.workspaces).run();
  scratch_.remember(frame_);
  frame_.agents.swap(next);
  frame_.time += dt;
  ++frame_.step;
  scratch_.fresh = false;
  scratch_.stepped = true;
  return result;
}

namespace detail {
/// Whether `W` is a `cambium::World` or derived from one.
template <class W>
inline constexpr bool is_world = requires {
  typename W::Behaviors;
  typename W::Execution;
  typename W::FrameType;
  typename W::View;
};
}  // namespace detail

}  // namespace cambium::inline v0_1
