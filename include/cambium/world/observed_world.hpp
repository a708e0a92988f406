#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <type_traits>
#include <variant>

#include "cambium/behavior/view.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/goal/goal.hpp"
#include "cambium/map/map.hpp"
#include "cambium/world/detail/look_around.hpp"
#include "cambium/world/detail/on_lanes.hpp"
#include "cambium/world/detail/seen.hpp"
#include "cambium/world/detail/seen_lanes.hpp"
#include "cambium/world/frame.hpp"
#include "cambium/world/prediction.hpp"
#include "cambium/world/static_object.hpp"
#include "cambium/world/traffic_index.hpp"

namespace cambium::inline v0_1 {

/// What one agent sees of its world: a view of a few pointers, valid until the world changes. It shows states, shapes,
/// neighbours, the map and the agent's own route, never the others' intentions; `predict` takes a model of those.
///
/// The agent's observer model shapes what the view shows. It alters states, and therefore gaps, neighbours' speeds, the
/// agent's own lane position and the lanes in which `ahead`, `behind` and `each_ahead` find others. It may hide agents
/// and objects. It does not alter the order of the visible road users along a lane, nor the agent's own lane corridor,
/// which the view takes from the true positions.
///
/// `World::truth` gives the same view of the true world, for evaluators.
template <class World, bool perfect = World::Observer::perfect>
class ObservedWorld {
 public:
  using State = typename World::State;
  using Dynamics = typename World::Dynamics;

  /// What the agent of `slot` sees. Refers to `world`, which has to live as long. O(1).
  ObservedWorld(World const& world, Slot slot)
      : world_(&world),
        own_(&world.roster().agents[index_of(slot)]),
        record_(&world.frame().agents[index_of(slot)]),
        slot_(slot) {
    if constexpr (!perfect)
      seen_lane_ = map::locate(*own_->road, record_->lane.corridor, pose_of(state()), record_->lane);
  }

  [[nodiscard]] double time() const { return world_->frame().time; }
  [[nodiscard]] AgentId id() const { return own_->id; }
  [[nodiscard]] decltype(auto) state() const { return observed(slot_); }
  [[nodiscard]] double last_acceleration() const { return record(slot_).action.acceleration; }
  [[nodiscard]] geometry::Shape const& shape() const { return own_->shape; }
  [[nodiscard]] Dynamics const& dynamics() const { return own_->dynamics; }
  [[nodiscard]] Goal const& goal() const { return world_->roster().goals[index_of(slot_)]; }
  [[nodiscard]] Map const& map() const { return world_->map(); }
  [[nodiscard]] map::RoadCorridor const& road() const { return *own_->road; }
  [[nodiscard]] map::LanePlace const& place() const {
    if constexpr (perfect)
      return record_->lane;
    else
      return seen_lane_;
  }
  [[nodiscard]] map::LaneCorridor const& corridor() const { return road().corridors[place().corridor]; }

  /// The agent's random numbers for this step, independent of the order of agents, of threads and of copies. `purpose`
  /// distinguishes several streams in one step; it is below 2^31 - 1.
  [[nodiscard]] RandomStream random(std::uint32_t purpose) const {
    return {world_->roster().seed, static_cast<std::uint32_t>(id()), static_cast<std::uint32_t>(world_->frame().step),
            purpose};
  }

  /// The agent's place on lane corridor `number` of its road. O(1) for its own corridor and the adjacent ones, else
  /// O(lanes of the corridor).
  [[nodiscard]] map::LanePlace place(CorridorId number) const {
    auto const& at = place();
    return number == at.corridor ? at : detail::locate_beside(map(), road(), at, number, pose_of(state()));
  }

  /// Next road user ahead (behind) along the agent's own lane corridor; nothing if none is within `Look::distance`.
  /// O(1) if that road user is in the same lane.
  [[nodiscard]] std::optional<RoadUser> ahead(Look const& look = {}) const { return next<1>(look); }
  [[nodiscard]] std::optional<RoadUser> behind(Look const& look = {}) const { return next<-1>(look); }

  /// Catches the name that others have for it.
  template <class None = void>
  std::optional<RoadUser> leader() const {
    static_assert(!std::is_void_v<None>, "cambium::ObservedWorld::leader: say ahead(), the next road user ahead");
    return std::nullopt;
  }

  /// Calls `f(RoadUser)` for the next road user ahead in the agent's own lane corridor, and for the next one in each
  /// lane that merges into it or has just split off: `ahead` is the one with the smallest gap, but not always the one
  /// that demands the most caution. O(1) if there are no such lanes, else O(feeders), plus a search in each.
  template <class F>
  void each_ahead(Look const& look, F&& f) const {
    index().each_front(corridor(), query(record_->lane, look), objects_on_lanes(), in_traffic(),
                       [&](RoadUser const& found) { f(seen(found, 1)); });
    if (auto const other = nearer<1>(place(), look, std::nullopt)) f(*other);
  }

  /// Next road user ahead of (behind) a place on any lane corridor of the agent's road, as if the agent were there.
  /// O(log n).
  [[nodiscard]] std::optional<RoadUser> ahead(map::LanePlace const& from, Look const& look = {}) const {
    return next<1>(from, look);
  }
  [[nodiscard]] std::optional<RoadUser> behind(map::LanePlace const& from, Look const& look = {}) const {
    return next<-1>(from, look);
  }

  /// The foremost agent, not beyond corridor position `limit`, in the lanes that merge into the agent's own corridor at
  /// `merge` (see `Feeder::free_until`). O(feeders), plus a search in each.
  [[nodiscard]] std::optional<RoadUser> merging(double merge, double limit) const {
    return seen(index().merging(corridor(), merge, limit, query(record_->lane, {})), 1);
  }

  /// Calls `f(RoadUser)` for every agent on the lane corridor of a place, or reaching into it, within `distance` [m] of
  /// the place (at most `Look::horizon`), then for the next static object ahead and the next one behind. Some agents
  /// are reported more than once. O(log n + agents found).
  template <class F>
  void around(map::LanePlace const& from, double distance, F&& f) const {
    auto const& along = road().corridors[from.corridor];
    TrafficQuery const own = plain_query(truth(from), {});
    auto const sees_object = [this](Slot object) { return this->sees_object(object); };
    auto const find = [&]<int sign>(std::integral_constant<int, sign>) -> std::optional<RoadUser> {
      auto const visit = [&](TrafficEntry const& entry, double way) {
        if (!sees(entry.slot)) return false;
        double const gap = sign > 0 ? way - entry.rear - own.front : way - entry.front - own.rear;
        f(seen(TrafficIndex::user_of(entry, false, gap, own.s + sign * way), sign));
        return false;
      };
      SightedQuery<decltype(visit), decltype(sees_object)> const query{own, visit, sees_object, distance};
      auto const next = index().template next<sign>(along, query, objects_on_lanes(), false);
      return next && is_valid(next->object) ? seen(next, sign) : std::nullopt;
    };
    auto const object_ahead = find(std::integral_constant<int, 1>()),
               object_behind = find(std::integral_constant<int, -1>());
    if (object_ahead) f(*object_ahead);
    if (object_behind) f(*object_behind);
  }

  /// Calls `f(RoadUser)` for every other agent in traffic near the agent, regardless of lanes: its bounding circle
  /// (about the reference point) comes within `distance` [m] of the agent's own. If a behaviour of the world's set
  /// looks around, O(agents found), in an order that does not depend on lanes; else O(agents), in the order of ids.
  template <class F>
  void around(double distance, F&& f) const {
    detail::for_each_around(*world_, slot_, distance, [&](Slot slot) {
      if (sees(slot)) f(user(slot));
    });
  }

  /// Calls `f(RoadUser)` for every other agent within `distance` [m], measured as in `around`, that is on no drivable
  /// lane of its own, such as a pedestrian on a free corridor, in the order of ids. O(such agents in the world).
  template <class F>
  void off_lanes(double distance, F&& f) const {
    for (Slot const slot : index().off_lanes())
      if (detail::is_near(*world_, slot_, slot, distance) && sees(slot)) f(user(slot));
  }
  /// Whether it sees such an agent anywhere. O(1); with an observer that may miss some, O(such agents).
  [[nodiscard]] bool anybody_off_lanes() const { return sees_any(index().off_lanes()); }
  /// Whether it sees an agent that drives aside from the middle of its lane and leaves `TrafficIndex::room_to_pass`
  /// beside itself. O(1); with an observer that may miss some, O(such agents).
  [[nodiscard]] bool anybody_leaves_room() const { return sees_any(index().aside()); }

  /// Calls `f(RoadUser)` for every other road user that reaches into lane coordinates `index_begin` to `index_end` of
  /// one lane (see `Lane::index_begin`); `s` is then the lane coordinate. O(log n + road users near).
  template <class F>
  void on_lane(double index_begin, double index_end, F&& f) const {
    index().for_each_in(index_begin, index_end, objects_on_lanes(), [&](auto const& entry, bool is_object) {
      bool const counts = is_object ? sees_object(entry.slot) : entry.slot != slot_ && sees(entry.slot);
      if (counts) f(seen(TrafficIndex::user_of(entry, is_object, 0.0, entry.position), 0));
    });
  }

  /// Calls `f(id, outline)`, with an `ObjectId` and a `geometry::Polygon`, for each visible static object, in the order
  /// of ids.
  template <class F>
  void for_each_object(F&& f) const {
    auto const& objects = world_->roster().objects;
    for (Slot i{}; index_of(i) < objects.size(); ++i)
      if (sees_object(i)) f(objects[i].id, objects[i].outline);
  }

  /// Another agent's state, as observed. O(1). Asserts that the road user is an agent.
  [[nodiscard]] decltype(auto) state(RoadUser const& agent) const { return observed(slot_of(agent)); }
  [[nodiscard]] geometry::Shape const& shape(RoadUser const& agent) const {
    return world_->roster().agents[index_of(slot_of(agent))].shape;
  }
  /// Holds the shapes of the own agent and of all that it sees. O(1); with an observer that may miss some, O(agents).
  [[nodiscard]] geometry::Shape largest_shape() const {
    auto const& roster = world_->roster();
    if constexpr (perfect) return roster.largest_shape;
    auto largest = shape();
    for (Slot slot{}; index_of(slot) < roster.agents.size(); ++slot)
      if (slot != slot_ && record(slot).status == AgentStatus::driving && sees(slot))
        largest = geometry::joined(largest, roster.agents[slot].shape);
    return largest;
  }
  /// Another agent's acceleration over the last step, along its heading [m/s^2], as brake lights would show it.
  [[nodiscard]] double acceleration(RoadUser const& agent) const {
    auto const slot = slot_of(agent);
    if constexpr (perfect)
      return static_cast<double>(record(slot).acceleration);
    else
      return detail::seen_acceleration(*world_, slot_, slot);
  }
  [[nodiscard]] geometry::Polygon const& outline(RoadUser const& object) const {
    CAMBIUM_ASSERT(is_valid(object.object), "ObservedWorld::outline: the road user is an agent");
    return world_->roster().objects[index_of(object.slot)].outline;
  }

  /// Whether the agent has a goal, so that the lane in which its route ends matters.
  [[nodiscard]] bool has_goal() const { return !std::holds_alternative<NoGoal>(goal()); }

  /// The present colour of a traffic light; `off` if it has no phases (see `World::set_light`). O(1).
  [[nodiscard]] map::LightColor light(LightId id) const {
    auto const& lights = world_->roster().lights;
    return index_of(id) < lights.size() ? lights[index_of(id)].at(time()) : map::LightColor::off;
  }

  /// How long the light has shown its present colour [s]. Precondition: the light is on. O(1).
  [[nodiscard]] double shown_for(LightId id) const {
    auto const& lights = world_->roster().lights;
    return index_of(id) < lights.size() ? lights[index_of(id)].shown_for(time()) : 0.0;
  }

  /// Time [s] since the light turned red; negative: time until it will, which drivers know because yellow always lasts
  /// the same. Precondition: the light is on. O(1).
  [[nodiscard]] double red_for(LightId id) const {
    auto const& lights = world_->roster().lights;
    return index_of(id) < lights.size() ? lights[index_of(id)].red_for(time()) : 0.0;
  }

  /// Whether an agent's route passes `lane`, as its turn signals show it: the only knowledge about another agent's
  /// route that the view gives. False for objects. O(lanes of its road).
  [[nodiscard]] bool signals_way(RoadUser const& user, LaneId lane) const {
    if (!is_valid(user.agent)) return false;
    return world_->roster().agents[index_of(user.slot)].road->corridor_of(lane) != none<CorridorId>;
  }

  /// The section that an agent is in at a conflict of this agent's corridor, with positions on the way by which it
  /// comes; the sizes are its own, that of this agent, and the largest (see `map::LaneCorridor::section_of`). Nothing
  /// for objects, and where its turn signals show another way. O(lanes and conflicts of its road).
  [[nodiscard]] std::optional<map::ConflictSection> section(RoadUser const& user, map::Conflict const& conflict,
                                                            bool is_large, bool own_large, bool any_large) const {
    if (!is_valid(user.agent)) return std::nullopt;
    auto const& road = *world_->roster().agents[index_of(user.slot)].road;
    auto const corridor = road.corridor_of(conflict.other);
    if (corridor == none<CorridorId>) return std::nullopt;
    return road.corridors[corridor].section_of(conflict, is_large, own_large, any_large);
  }

  /// Returns a separate world, as this agent sees it, in which all agents behave as `prediction` says. Step, copy and
  /// judge it. It contains no history, no observer models and no true behaviours. O(agents); allocates, so predict
  /// once, then copy.
  template <class Set>
  [[nodiscard]] typename World::template WithBehaviors<Set> predict(Prediction<Set> const& prediction) const {
    static_assert(perfect == World::Observer::perfect,
                  "cambium::World::truth shows what no agent knows: predict from World::observe");
    return predicted_world<Set>(*world_, slot_, prediction);
  }

  /// Reports a call with a behaviour in place of a `Prediction`, with a remedy.
  template <class Behavior>
  void predict(Behavior const&) const {
    static_assert(std::is_void_v<Behavior>,
                  "cambium::ObservedWorld::predict needs a Prediction: "
                  "predict(cambium::predict_all_as<cambium::BehaviorSet<Models...>>(behavior))");
  }

 private:
  [[nodiscard]] TrafficIndex const& index() const { return world_->traffic(); }
  /// Whether the index has an entry for the agent; without one, a query searches for its place.
  [[nodiscard]] bool in_traffic() const { return index().has(slot_); }
  [[nodiscard]] auto const& record(Slot slot) const { return world_->frame().agents[index_of(slot)]; }
  [[nodiscard]] std::span<TrafficEntry const> objects_on_lanes() const { return world_->roster().object_entries; }

  [[nodiscard]] decltype(auto) observed(Slot slot) const {
    if constexpr (perfect)
      return (record(slot).state);
    else
      return detail::seen_state(*world_, slot_, slot);
  }
  [[nodiscard]] bool sees(Slot slot) const {
    if constexpr (perfect)
      return true;
    else
      return detail::is_seen(*world_, slot_, slot);
  }
  [[nodiscard]] bool sees_any(std::span<Slot const> agents) const {
    if constexpr (perfect)
      return !agents.empty();
    else
      return std::any_of(agents.begin(), agents.end(), [this](Slot slot) { return slot != slot_ && sees(slot); });
  }
  [[nodiscard]] bool sees_object(Slot object) const {
    if constexpr (perfect)
      return true;
    else
      return detail::is_object_seen(*world_, slot_, object);
  }

  /// The true place for an observed one.
  [[nodiscard]] decltype(auto) truth(map::LanePlace const& at) const {
    if constexpr (perfect) {
      return (at);
    } else {
      auto place = at;
      place.s -= shift(slot_);
      return place;
    }
  }

  [[nodiscard]] TrafficQuery plain_query(map::LanePlace const& at, Look const& look) const {
    return {slot_, at.s, shape().front, shape().rear, at.piece, look.merging, std::min(look.distance, Look::horizon)};
  }

  [[nodiscard]] auto query(map::LanePlace const& at, Look const& look) const {
    auto const query = plain_query(at, look);
    if constexpr (!perfect && (detail::hides<World> || detail::hides_objects<World> || misplaces)) {
      auto const sees = [world = world_, own = slot_](TrafficEntry const& entry, double) {
        if constexpr (misplaces)
          if (!detail::is_seen_in_lane(*world, own, entry)) return false;
        return detail::is_seen(*world, own, entry.slot);
      };
      auto const sees_object = [world = world_, own = slot_](Slot object) {
        return detail::is_object_seen(*world, own, object);
      };
      return SightedQuery<decltype(sees), decltype(sees_object)>{query, sees, sees_object};
    } else {
      return query;
    }
  }

  /// Next road user ahead (`sign` 1) or behind (-1), of the agent or of a place. The search's result gets no name here:
  /// copied right after its members are written, it stalls, and a step takes 1.7 times as long.
  template <int sign>
  [[nodiscard]] std::optional<RoadUser> next(Look const& look) const {
    return nearer<sign>(
        place(), look,
        seen(index().template next<sign>(corridor(), query(record_->lane, look), objects_on_lanes(), in_traffic()),
             sign));
  }
  template <int sign>
  [[nodiscard]] std::optional<RoadUser> next(map::LanePlace const& from, Look const& look) const {
    auto const& along = road().corridors[from.corridor];
    return nearer<sign>(
        from, look,
        seen(index().template next<sign>(along, query(truth(from), look), objects_on_lanes(), false), sign));
  }

  /// `found`, or a nearer agent ahead (`sign` 1) or behind (-1) that is seen in the lane of `from` but drives in one
  /// beside. O(agents in those lanes as far as `found`).
  template <int sign>
  [[nodiscard]] std::optional<RoadUser> nearer(map::LanePlace const& from, Look const& look,
                                               std::optional<RoadUser> const& found) const {
    if constexpr (misplaces)
      return nearer_from_beside<sign>(from, look, found);
    else
      return found;
  }

  template <int sign>
  CAMBIUM_NOINLINE [[nodiscard]] std::optional<RoadUser> nearer_from_beside(map::LanePlace const& from,
                                                                            Look const& look,
                                                                            std::optional<RoadUser> best) const {
    constexpr double longest = 40.0;  // [m]: of two vehicles
    auto const start = truth(from);
    auto const& corridor = road().corridors[from.corridor];
    auto const pose = corridor.center.pose(start.s);
    auto const seen_at = [&](Slot slot, double s) {
      map::LanePlace hint;
      hint.segment = corridor.center.find(std::clamp(s, 0.0, corridor.length()));
      hint.piece = from.piece;
      return map::locate(road(), from.corridor, pose_of(observed(slot)), hint);
    };
    for (bool const left : {true, false})
      for (auto at = start;;) {
        auto const beside = road().corridors[at.corridor].pieces[at.piece].beside(left);
        if (beside == none<CorridorId>) break;
        at = detail::locate_beside(map(), road(), at, beside, pose);
        auto const sees = [&](TrafficEntry const& entry, double way) {
          if (!detail::is_misplaced(*world_, slot_, entry.slot) || !detail::is_seen(*world_, slot_, entry.slot))
            return false;
          auto const place = seen_at(entry.slot, start.s + sign * way);
          return detail::reaches_into(world_->roster().agents[entry.slot].shape, place.lateral, place.heading_error,
                                      corridor.widths_at(place.s, place.segment));
        };
        auto const sees_no_object = [](Slot) { return false; };
        auto query = plain_query(at, look);
        if (best) query.distance = std::min(query.distance, std::max(0.0, best->gap) + longest);
        SightedQuery<decltype(sees), decltype(sees_no_object)> const sighted{query, sees, sees_no_object,
                                                                             query.distance};
        auto const& along = road().corridors[beside];
        auto user = index().template next<sign>(along, sighted, {}, false);
        if (!user) continue;
        double const s = seen_at(user->slot, start.s + (user->s - at.s)).s;
        user->gap = sign > 0 ? s - user->rear - from.s - shape().front : from.s - shape().rear - s - user->front;
        user->s = s;
        user->speed += observed(user->slot).speed - record(user->slot).state.speed;
        if (!best || (user->gap < best->gap && user->agent != best->agent)) best = user;
      }
    return best;
  }

  [[nodiscard]] static Slot slot_of(RoadUser const& agent) {
    CAMBIUM_ASSERT(is_valid(agent.agent), "ObservedWorld: an object has no state");
    return agent.slot;
  }

  /// An agent found without a lane corridor.
  [[nodiscard]] RoadUser user(Slot slot) const {
    auto const& agent = world_->roster().agents[index_of(slot)];
    return {.agent = agent.id,
            .slot = slot,
            .s = record(slot).lane.index,
            .front = agent.shape.front,
            .rear = agent.shape.rear,
            .speed = observed(slot).speed};
  }

  /// A road user found ahead (`sign` 1), behind (-1) or on a lane (0), as observed. Without errors it is `found`
  /// itself: copied right after its members are written, it stalls.
  [[nodiscard]] decltype(auto) seen(RoadUser const& found, int sign) const {
    if constexpr (perfect)
      return (found);
    else
      return shifted(found, sign);
  }
  [[nodiscard]] RoadUser shifted(RoadUser found, int sign) const {
    found.gap -= sign * shift(slot_);
    if (is_valid(found.object)) return found;
    double const moved = shift(found.slot);
    found.gap += sign * moved;
    found.s += moved;
    found.speed += observed(found.slot).speed - record(found.slot).state.speed;
    return found;
  }
  [[nodiscard]] std::optional<RoadUser> seen(std::optional<RoadUser> const& found, int sign) const {
    if constexpr (perfect) return found;
    return found ? std::optional(seen(*found, sign)) : std::nullopt;
  }

  /// The observer's position error of an agent, along the agent's lane [m].
  [[nodiscard]] double shift(Slot slot) const {
    auto const& truth = record(slot).state;
    auto const& seen = observed(slot);
    double const along = truth.heading - record(slot).lane.heading_error;
    auto const [sin, cos] = portable::sin_cos(along);
    return (seen.x - truth.x) * cos + (seen.y - truth.y) * sin;
  }

  [[nodiscard]] static geometry::Pose pose_of(State const& s) { return {s.x, s.y, s.heading}; }

  static constexpr bool misplaces = !perfect && detail::misplaces<World>;

  World const* world_;
  typename World::RosterType::Agent const* own_;
  typename World::Record const* record_;
  Slot slot_;
  [[no_unique_address]] std::conditional_t<perfect, NoMemory, map::LanePlace> seen_lane_{};
};

}  // namespace cambium::inline v0_1
