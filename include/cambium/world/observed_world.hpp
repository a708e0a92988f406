#pragma once

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

  ObservedWorld(World const& world, std::uint32_t slot)
      : world_(&world), own_(&world.roster().agents[slot]), record_(&world.frame().agents[slot]), slot_(slot) {
    if constexpr (!perfect)
      seen_lane_ = map::locate(*own_->road, record_->lane.corridor, pose_of(state()), record_->lane);
  }

  [[nodiscard]] double time() const { return world_->frame().time; }
  [[nodiscard]] AgentId id() const { return own_->id; }
  [[nodiscard]] decltype(auto) state() const { return observed(slot_); }
  [[nodiscard]] geometry::Shape const& shape() const { return own_->shape; }
  [[nodiscard]] Dynamics const& dynamics() const { return own_->dynamics; }
  [[nodiscard]] Action const& last_action() const { return record_->action; }
  [[nodiscard]] Goal const& goal() const { return world_->roster().goals[slot_]; }
  [[nodiscard]] Map const& map() const { return world_->map(); }
  [[nodiscard]] map::RoadCorridor const& road() const { return *own_->road; }
  [[nodiscard]] map::LanePosition const& lane_position() const {
    if constexpr (perfect)
      return record_->lane;
    else
      return seen_lane_;
  }
  [[nodiscard]] map::LaneCorridor const& corridor() const { return road().corridors[lane_position().corridor]; }

  /// Numbers of the agent's own for this step: the same whatever the order of agents, threads or copies. `purpose`
  /// below 2^31 - 1.
  [[nodiscard]] RandomStream random(std::uint32_t purpose) const {
    return {world_->roster().seed, static_cast<std::uint32_t>(id()), static_cast<std::uint32_t>(world_->frame().step),
            purpose};
  }

  /// Next road user ahead along the own lane corridor; nothing if there is none within `TrafficIndex::horizon`. O(1)
  /// while the next one is in the same lane.
  [[nodiscard]] std::optional<Neighbor> front() const {
    return neighbor(world_->traffic().front(corridor(), query(record_->lane), objects_on_lanes(), in_traffic()), 1);
  }
  [[nodiscard]] std::optional<Neighbor> rear() const {
    return neighbor(world_->traffic().rear(corridor(), query(record_->lane), objects_on_lanes(), in_traffic()), -1);
  }

  /// As `front`, but for those who are still to merge in a junction: there the right of way says who goes first, see
  /// `LaneCorridor::conflicts`.
  [[nodiscard]] std::optional<Neighbor> front_by_rule() const {
    auto asker = query(record_->lane);
    asker.by_rule = true;
    return neighbor(world_->traffic().front(corridor(), asker, objects_on_lanes(), in_traffic()), 1);
  }

  /// Where the agent is on lane corridor `number` of its road. O(lanes of the corridor).
  [[nodiscard]] map::LanePosition lane_position(std::uint16_t number) const {
    auto const& at = lane_position();
    return number == at.corridor ? at : detail::locate_beside(map(), road(), at, number, pose_of(state()));
  }

  /// Next road users ahead and behind along lane corridor `number` of the own road, from the place beside the agent.
  /// O(log n).
  [[nodiscard]] Neighbors neighbors(std::uint16_t number) const {
    if (number == record_->lane.corridor) return {front(), rear(), lane_position()};
    auto const place = beside(number);
    return {front(place), rear(place), lane_position(number)};
  }

  /// Calls `f(ObservedAgent)` for every agent that is on lane corridor `number` of the own road, or reaches into it,
  /// within `distance` [m], at most `TrafficIndex::horizon`, ahead of or behind the place beside the agent; for some of
  /// them more than once. Returns the next objects there. O(log n + agents found).
  template <class F>
  Neighbors for_each_near(std::uint16_t number, double distance, F&& f) const {
    auto const at = number == record_->lane.corridor
                        ? record_->lane
                        : detail::locate_beside(map(), road(), record_->lane, number, pose_of(record_->state));
    auto const visit = [&](std::uint32_t slot) {
      if (detail::is_seen(*world_, slot_, slot)) f(observed_agent(slot));
      return false;
    };
    TrafficQuery const own{slot_, at.s, shape().front, shape().rear, at.piece};
    auto const sees_object = [this](std::uint32_t object) { return detail::is_object_seen(*world_, slot_, object); };
    SightedQuery<decltype(visit), decltype(sees_object)> const query{own, visit, sees_object, distance};
    auto const& along = road().corridors[number];
    auto const entry = world_->traffic().find(along, own);
    auto const object = [](std::optional<TrafficHit> hit) { return hit && hit->is_object ? hit : std::nullopt; };
    return {neighbor(object(world_->traffic().front_from(entry, along, query, objects_on_lanes())), 1),
            neighbor(object(world_->traffic().rear_from(entry, along, query, objects_on_lanes())), -1),
            perfect ? at : lane_position(number)};
  }

  /// The place beside the agent on lane corridor `number` of the own road, another than the own. O(1) where that is
  /// next to the own one, else O(lanes of the corridor); plus a search, O(log n).
  [[nodiscard]] BesidePlace beside(std::uint16_t number) const {
    auto place = detail::place_beside(map(), road(), record_->lane, number, pose_of(record_->state));
    place.entry = world_->traffic().find(road().corridors[number], query(place));
    if constexpr (!perfect) place.s += shift(slot_);
    return place;
  }

  /// Next road users ahead of and behind such a place. O(1) while the next one is in the same lane.
  [[nodiscard]] std::optional<Neighbor> front(BesidePlace const& place) const {
    return neighbor(world_->traffic().front_from(place.entry, road().corridors[place.corridor], query(truth(place)),
                                                 objects_on_lanes()),
                    1);
  }
  [[nodiscard]] std::optional<Neighbor> rear(BesidePlace const& place) const {
    return neighbor(world_->traffic().rear_from(place.entry, road().corridors[place.corridor], query(truth(place)),
                                                objects_on_lanes()),
                    -1);
  }

  /// As `front`, but without those who are in lanes that are still to merge into the own one.
  [[nodiscard]] std::optional<Neighbor> front_in_lane() const {
    auto asked = query(record_->lane);
    asked.with_merging = false;
    return neighbor(world_->traffic().front(corridor(), asked, objects_on_lanes(), in_traffic()), 1);
  }

  /// Of the agents in lanes that are still to merge into the own corridor at `merge` (see `Feeder::free_until`), the
  /// foremost that is behind corridor position `behind`. O(feeders), plus a search in each.
  [[nodiscard]] std::optional<MergingNeighbor> merging(double merge, double behind) const {
    auto const entry = world_->traffic().merging(corridor(), merge, behind, query(record_->lane));
    if (!entry) return std::nullopt;
    MergingNeighbor other{static_cast<AgentId>(entry->id), entry->position, entry->front, entry->rear, entry->speed};
    if constexpr (!perfect) {
      other.s += shift(entry->slot);
      other.speed += observed(entry->slot).speed - record(entry->slot).state.speed;
    }
    return other;
  }

  /// Whether it matters in which lane the route ends.
  [[nodiscard]] bool has_goal() const { return !std::holds_alternative<NoGoal>(goal()); }

  /// Calls `f(LaneUser)` for those who reach into lane coordinates `index_begin` to `index_end` of one lane (see
  /// `Lane::index_begin`), the agent itself left out. O(log n) and those near.
  template <class F>
  void for_each_on_lane(double index_begin, double index_end, F&& f) const {
    world_->traffic().for_each_in(index_begin, index_end, objects_on_lanes(), [&](auto const& entry, bool is_object) {
      if (is_object) {
        if (!detail::is_object_seen(*world_, slot_, entry.slot)) return;
        f(LaneUser{.object = static_cast<ObjectId>(entry.id),
                   .position = entry.position,
                   .front = entry.front,
                   .rear = entry.rear,
                   .slot = entry.slot});
      } else if (entry.slot != slot_ && detail::is_seen(*world_, slot_, entry.slot)) {
        LaneUser user{static_cast<AgentId>(entry.id),
                      none<ObjectId>,
                      entry.position,
                      entry.front,
                      entry.rear,
                      entry.speed,
                      entry.slot,
                      world_->roster().agents[entry.slot].shape};
        if constexpr (!perfect) {
          user.position += shift(entry.slot);
          user.speed += observed(entry.slot).speed - record(entry.slot).state.speed;
        }
        f(user);
      }
    });
  }

  /// What a traffic light shows now; `off` where it has no plan (see `World::set_light`). O(1).
  [[nodiscard]] map::LightColor light(LightId id) const {
    auto const& lights = world_->roster().lights;
    return index_of(id) < lights.size() ? lights[index_of(id)].at(time()) : map::LightColor::off;
  }

  /// Whether an agent's turn signals say that it will come by `lane`, or it is there: the way ahead is all that they
  /// tell. Objects go nowhere. O(lanes of its road).
  [[nodiscard]] bool signals_way(LaneUser const& user, LaneId lane) const {
    if (!is_valid(user.agent)) return false;
    return world_->roster().agents[user.slot].road->corridor_of(lane) != map::no_corridor;
  }

  /// The agent that a neighbour is. O(1). Not for neighbours that are objects.
  [[nodiscard]] ObservedAgent<State> agent(Neighbor const& neighbor) const {
    CAMBIUM_ASSERT(is_valid(neighbor.agent), "ObservedWorld::agent: the neighbour is an object");
    return observed_agent(neighbor.slot);
  }

  /// Calls `f(ObservedAgent)` for every other agent in traffic, in the order of their ids.
  template <class F>
  void for_each_other(F&& f) const {
    detail::for_each_other(*world_, slot_, [&](std::uint32_t slot) { f(observed_agent(slot)); });
  }

  /// Calls `f(ObservedAgent)` for every other agent in traffic of which a circle about its reference point that holds
  /// it comes within `distance` [m] of the own one, whatever lane it is on. In worlds of which a behaviour says that it
  /// looks around O(agents found), in an order that does not depend on the lanes; else O(agents).
  template <class F>
  void for_each_around(double distance, F&& f) const {
    detail::for_each_around(*world_, slot_, distance, [&](std::uint32_t slot) { f(observed_agent(slot)); });
  }

  /// Calls `f(id, outline)`, an `ObjectId` and a `geometry::Polygon`, for the static objects that are seen, in the
  /// order of their ids.
  template <class F>
  void for_each_object(F&& f) const {
    detail::for_each_object(*world_, slot_, f);
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
  [[nodiscard]] auto const& record(std::uint32_t slot) const { return world_->frame().agents[slot]; }
  [[nodiscard]] std::span<TrafficEntry const> objects_on_lanes() const { return world_->roster().object_entries; }

  [[nodiscard]] decltype(auto) observed(std::uint32_t slot) const { return detail::seen_state(*world_, slot_, slot); }

  /// The place as it is, not as the observer shows it.
  [[nodiscard]] BesidePlace truth(BesidePlace place) const {
    if constexpr (!perfect) place.s -= shift(slot_);
    return place;
  }

  template <class Place>
  [[nodiscard]] auto query(Place const& at) const {
    TrafficQuery const query{slot_, at.s, shape().front, shape().rear, at.piece};
    if constexpr (detail::hides<World> || detail::hides_objects<World>) {
      auto const sees = [world = world_, own = slot_](std::uint32_t slot) {
        return detail::is_seen(*world, own, slot);
      };
      auto const sees_object = [world = world_, own = slot_](std::uint32_t object) {
        return detail::is_object_seen(*world, own, object);
      };
      return SightedQuery<decltype(sees), decltype(sees_object)>{query, sees, sees_object};
    } else {
      return query;
    }
  }

  [[nodiscard]] ObservedAgent<State> observed_agent(std::uint32_t slot) const {
    auto const& agent = world_->roster().agents[slot];
    return {agent.id, observed(slot), agent.shape, detail::seen_acceleration(*world_, slot_, slot)};
  }

  /// The neighbour ahead (`sign` 1) or behind (-1), as observed.
  [[nodiscard]] std::optional<Neighbor> neighbor(std::optional<TrafficHit> const& hit, int sign) const {
    if (!hit) return std::nullopt;
    auto const agent = hit->is_object ? none<AgentId> : static_cast<AgentId>(hit->id);
    auto const object = hit->is_object ? static_cast<ObjectId>(hit->id) : none<ObjectId>;
    if constexpr (perfect) return Neighbor{agent, object, hit->gap, hit->speed, hit->length, hit->slot};
    double gap = hit->gap - sign * shift(slot_);
    if (hit->is_object) return Neighbor{agent, object, gap, 0.0, hit->length, hit->slot};
    gap += sign * shift(hit->slot);
    double const speed = observed(hit->slot).speed * std::cos(record(hit->slot).lane.heading_error);
    return Neighbor{agent, object, gap, speed, hit->length, hit->slot};
  }

  /// How far the observer moves an agent along its lane [m].
  [[nodiscard]] double shift(std::uint32_t slot) const {
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
  std::uint32_t slot_;
  [[no_unique_address]] std::conditional_t<perfect, NoMemory, map::LanePosition> seen_lane_{};
};

}  // namespace cambium
