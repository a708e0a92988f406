#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <type_traits>
#include <variant>

#include "cambium/behavior/view.hpp"
#include "cambium/goal/goal.hpp"
#include "cambium/map/map.hpp"
#include "cambium/world/detail/look_around.hpp"
#include "cambium/world/detail/on_lanes.hpp"
#include "cambium/world/detail/seen.hpp"
#include "cambium/world/frame.hpp"
#include "cambium/world/prediction.hpp"
#include "cambium/world/static_object.hpp"
#include "cambium/world/traffic_index.hpp"

namespace cambium {

/// What one agent sees of its world: a view of a few pointers, valid until the world changes. States, and with them
/// gaps, neighbours' speeds and the own lane position, pass through the agent's observer model; who is next to whom is
/// the truth, but for those that the observer does not see. It shows states, shapes, the map, neighbours and the
/// agent's own route; never what the others intend: `predict` asks for a model of that.
template <class World>
class ObservedWorld {
 public:
  using State = typename World::State;
  using Dynamics = typename World::Dynamics;

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
  [[nodiscard]] geometry::Shape const& shape() const { return own_->shape; }
  [[nodiscard]] Dynamics const& dynamics() const { return own_->dynamics; }
  [[nodiscard]] Action const& last_action() const { return record_->action; }
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

  /// Numbers of the agent's own for this step: the same whatever the order of agents, threads or copies. `purpose`
  /// below 2^31 - 1.
  [[nodiscard]] RandomStream random(std::uint32_t purpose) const {
    return {world_->roster().seed, static_cast<std::uint32_t>(id()), static_cast<std::uint32_t>(world_->frame().step),
            purpose};
  }

  /// Where the agent is on lane corridor `number` of its road. O(1) for the own one and those next to it, else O(lanes
  /// of the corridor).
  [[nodiscard]] map::LanePlace place(CorridorId number) const {
    auto const& at = place();
    return number == at.corridor ? at : detail::locate_beside(map(), road(), at, number, pose_of(state()));
  }

  /// Next road user along the own lane corridor, ahead and behind; nothing where there is none within
  /// `Look::distance`. O(1) while the next one is in the same lane.
  [[nodiscard]] std::optional<RoadUser> ahead(Look const& look = {}) const {
    return seen(world_->traffic().front(corridor(), query(record_->lane, look), objects_on_lanes(), in_traffic()), 1);
  }
  [[nodiscard]] std::optional<RoadUser> behind(Look const& look = {}) const {
    return seen(world_->traffic().rear(corridor(), query(record_->lane, look), objects_on_lanes(), in_traffic()), -1);
  }

  /// Next road user ahead of a place on a lane corridor of the own road, or behind it, as if the agent were there.
  /// O(log n).
  [[nodiscard]] std::optional<RoadUser> ahead(map::LanePlace const& from, Look const& look = {}) const {
    auto const& along = road().corridors[from.corridor];
    return seen(world_->traffic().front(along, query(truth(from), look), objects_on_lanes(), false), 1);
  }
  [[nodiscard]] std::optional<RoadUser> behind(map::LanePlace const& from, Look const& look = {}) const {
    auto const& along = road().corridors[from.corridor];
    return seen(world_->traffic().rear(along, query(truth(from), look), objects_on_lanes(), false), -1);
  }

  /// Of the agents in lanes that are still to merge into the own corridor at `merge` (see `Feeder::free_until`), the
  /// foremost that is not beyond corridor position `limit`. O(feeders), plus a search in each.
  [[nodiscard]] std::optional<RoadUser> merging(double merge, double limit) const {
    return seen(world_->traffic().merging(corridor(), merge, limit, query(record_->lane, {})), 1);
  }

  /// Calls `f(RoadUser)` for every agent that is on the lane corridor of a place, or reaches into it, within `distance`
  /// [m] of it, at most `Look::horizon`; for some of them more than once; and then for the next objects ahead and
  /// behind. O(log n + agents found).
  template <class F>
  void around(map::LanePlace const& from, double distance, F&& f) const {
    auto const& along = road().corridors[from.corridor];
    TrafficQuery const own = plain_query(truth(from), {});
    auto const sees_object = [this](Slot object) { return detail::is_object_seen(*world_, slot_, object); };
    auto const visit = [&](int sign) {
      return [&f, &own, this, sign](TrafficEntry const& entry, double way) {
        if (!detail::is_seen(*world_, slot_, entry.slot)) return false;
        double const gap = sign > 0 ? way - entry.rear - own.front : way - entry.front - own.rear;
        f(seen(TrafficIndex::user_of(entry, false, gap, own.s + sign * way), sign));
        return false;
      };
    };
    auto const find = [&](int sign) -> std::optional<RoadUser> {
      auto const all = visit(sign);
      SightedQuery<decltype(all), decltype(sees_object)> const query{own, all, sees_object, distance};
      auto const& index = world_->traffic();
      auto const next = sign > 0 ? index.front(along, query, objects_on_lanes(), false)
                                 : index.rear(along, query, objects_on_lanes(), false);
      return next && is_valid(next->object) ? seen(next, sign) : std::nullopt;
    };
    auto const object_ahead = find(1), object_behind = find(-1);
    if (object_ahead) f(*object_ahead);
    if (object_behind) f(*object_behind);
  }

  /// Calls `f(RoadUser)` for every other agent in traffic of which a circle about its reference point that holds it
  /// comes within `distance` [m] of the own one, whatever lane it is on. In worlds of which a behaviour says that it
  /// looks around O(agents found), in an order that does not depend on the lanes; else O(agents), in that of their ids.
  template <class F>
  void around(double distance, F&& f) const {
    detail::for_each_around(*world_, slot_, distance, [&](Slot slot) { f(user(slot)); });
  }

  /// Calls `f(RoadUser)` for those who reach into lane coordinates `index_begin` to `index_end` of one lane (see
  /// `Lane::index_begin`), the agent itself left out; their `s` is the lane coordinate. O(log n) and those near.
  template <class F>
  void on_lane(double index_begin, double index_end, F&& f) const {
    world_->traffic().for_each_in(index_begin, index_end, objects_on_lanes(), [&](auto const& entry, bool is_object) {
      bool const counts = is_object ? detail::is_object_seen(*world_, slot_, entry.slot)
                                    : entry.slot != slot_ && detail::is_seen(*world_, slot_, entry.slot);
      if (counts) f(seen(TrafficIndex::user_of(entry, is_object, 0.0, entry.position), 0));
    });
  }

  /// Calls `f(id, outline)`, an `ObjectId` and a `geometry::Polygon`, for the static objects that are seen, in the
  /// order of their ids.
  template <class F>
  void for_each_object(F&& f) const {
    detail::for_each_object(*world_, slot_, f);
  }

  /// Of another agent, as observed. O(1). Not of objects.
  [[nodiscard]] decltype(auto) state(RoadUser const& agent) const { return observed(slot_of(agent)); }
  [[nodiscard]] geometry::Shape const& shape(RoadUser const& agent) const {
    return world_->roster().agents[index_of(slot_of(agent))].shape;
  }
  /// Over the last step, along its heading [m/s^2]: what brake lights tell.
  [[nodiscard]] double acceleration(RoadUser const& agent) const {
    return detail::seen_acceleration(*world_, slot_, slot_of(agent));
  }
  [[nodiscard]] geometry::Polygon const& outline(RoadUser const& object) const {
    CAMBIUM_ASSERT(is_valid(object.object), "ObservedWorld::outline: the road user is an agent");
    return world_->roster().objects[index_of(object.slot)].outline;
  }

  /// Whether it matters in which lane the route ends.
  [[nodiscard]] bool has_goal() const { return !std::holds_alternative<NoGoal>(goal()); }

  /// What a traffic light shows now; `off` where it has no plan (see `World::set_light`). O(1).
  [[nodiscard]] map::LightColor light(LightId id) const {
    auto const& lights = world_->roster().lights;
    return index_of(id) < lights.size() ? lights[index_of(id)].at(time()) : map::LightColor::off;
  }

  /// Whether an agent's turn signals say that it will come by `lane`, or it is there: the way ahead is all that they
  /// tell. Objects go nowhere. O(lanes of its road).
  [[nodiscard]] bool signals_way(RoadUser const& user, LaneId lane) const {
    if (!is_valid(user.agent)) return false;
    return world_->roster().agents[index_of(user.slot)].road->corridor_of(lane) != none<CorridorId>;
  }

  /// A world of its own, as this agent sees it, in which everybody behaves as `prediction` says: to be stepped, copied
  /// and judged. History, observers and true behaviours stay behind. O(agents), allocates: do it once, then copy.
  template <class Set>
  [[nodiscard]] typename World::template WithBehaviors<Set> predict(Prediction<Set> const& prediction) const {
    return predicted_world<Set>(*world_, slot_, prediction);
  }

  /// Says what is missing where a bare behaviour is given.
  template <class Behavior>
  void predict(Behavior const&) const {
    static_assert(std::is_void_v<Behavior>,
                  "cambium::ObservedWorld::predict needs a Prediction: "
                  "predict(cambium::predict_all_as<cambium::BehaviorSet<Models...>>(behavior))");
  }

 private:
  /// An agent that is not on its lane has no place in the index: it is searched for.
  [[nodiscard]] bool in_traffic() const { return world_->traffic().has(slot_); }
  [[nodiscard]] auto const& record(Slot slot) const { return world_->frame().agents[index_of(slot)]; }
  [[nodiscard]] std::span<TrafficEntry const> objects_on_lanes() const { return world_->roster().object_entries; }

  [[nodiscard]] decltype(auto) observed(Slot slot) const { return detail::seen_state(*world_, slot_, slot); }

  /// The place as it is, not as the observer shows it.
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
    if constexpr (detail::hides<World> || detail::hides_objects<World>) {
      auto const sees = [world = world_, own = slot_](TrafficEntry const& entry, double) {
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

  [[nodiscard]] static Slot slot_of(RoadUser const& agent) {
    CAMBIUM_ASSERT(is_valid(agent.agent), "ObservedWorld: an object has no state");
    return agent.slot;
  }

  /// An agent that is asked for by itself, not along a lane corridor.
  [[nodiscard]] RoadUser user(Slot slot) const {
    auto const& agent = world_->roster().agents[index_of(slot)];
    return {.agent = agent.id,
            .slot = slot,
            .s = record(slot).lane.index,
            .front = agent.shape.front,
            .rear = agent.shape.rear,
            .speed = observed(slot).speed};
  }

  /// One found ahead (`sign` 1), behind (-1) or on a lane (0), as observed.
  [[nodiscard]] RoadUser seen(RoadUser found, int sign) const {
    if constexpr (!perfect) {
      found.gap -= sign * shift(slot_);
      if (is_valid(found.object)) return found;
      double const moved = shift(found.slot);
      found.gap += sign * moved;
      found.s += moved;
      found.speed += observed(found.slot).speed - record(found.slot).state.speed;
    }
    return found;
  }
  [[nodiscard]] std::optional<RoadUser> seen(std::optional<RoadUser> const& found, int sign) const {
    if constexpr (perfect) return found;
    return found ? std::optional(seen(*found, sign)) : std::nullopt;
  }

  /// How far the observer moves an agent along its lane [m].
  [[nodiscard]] double shift(Slot slot) const {
    auto const& truth = record(slot).state;
    auto const& seen = observed(slot);
    double const along = truth.heading - record(slot).lane.heading_error;
    return (seen.x - truth.x) * std::cos(along) + (seen.y - truth.y) * std::sin(along);
  }

  [[nodiscard]] static geometry::Pose pose_of(State const& s) { return {s.x, s.y, s.heading}; }

  static constexpr bool perfect = World::Observer::perfect;

  World const* world_;
  typename World::RosterType::Agent const* own_;
  typename World::Record const* record_;
  Slot slot_;
  [[no_unique_address]] std::conditional_t<perfect, NoMemory, map::LanePlace> seen_lane_{};
};

}  // namespace cambium
