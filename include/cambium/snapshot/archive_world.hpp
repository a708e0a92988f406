#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "cambium/core/described.hpp"
#include "cambium/core/ids.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/geometry/polygon.hpp"
#include "cambium/geometry/shape.hpp"
#include "cambium/goal/goal.hpp"
#include "cambium/map/corridor/build_corridor.hpp"
#include "cambium/map/content_hash.hpp"
#include "cambium/map/corridor/free_corridor.hpp"
#include "cambium/map/lanes/signals.hpp"
#include "cambium/map/map.hpp"
#include "cambium/snapshot/archive_fields.hpp"
#include "cambium/world/world.hpp"

namespace cambium::inline v0_1 {

namespace detail {

struct AnyValue {
  template <class T>
  requires(!std::is_empty_v<T>) operator T() const;  // never called
};
template <class T, std::size_t... i>
[[nodiscard]] constexpr bool takes(std::index_sequence<i...>) {
  return requires { T{(static_cast<void>(i), AnyValue{})...}; };
}
/// Whether aggregate `T` has more than `count` members.
template <class T, std::size_t count>
[[nodiscard]] constexpr bool has_more_members() {
  if constexpr (std::is_aggregate_v<T>)
    return takes<T>(std::make_index_sequence<count + 1>());
  else
    return false;
}

/// Whether a memory's description has all of its fields, in their order: then these fill the struct.
template <class Memory>
[[nodiscard]] constexpr bool describes_all() {
  if constexpr (std::is_empty_v<Memory>) {
    return true;
  } else if constexpr (has_more_members<Memory, field_count<Memory>()>()) {
    return false;
  } else {
    auto const size = [](std::size_t size_of_empty) {
      std::size_t end = 0;
      for_each_parameter<Memory>([&]<class Owner, class Field>(Parameter<Owner, Field> const&) {
        bool const is_empty = std::is_empty_v<Field>;
        end = (end + alignof(Field) - 1) / alignof(Field) * alignof(Field) + (is_empty ? size_of_empty : sizeof(Field));
      });
      return (end + alignof(Memory) - 1) / alignof(Memory) * alignof(Memory);
    };
    return size(0) == sizeof(Memory) || size(1) == sizeof(Memory);  // empty fields may share their place with others
  }
}

template <bool is_memory, class T, class... Around>
[[nodiscard]] constexpr bool check_described();

/// True. Else a compile error says what a snapshot cannot hold of a field. `Around`: the structs that hold it.
template <bool is_memory, class Field, class... Around>
[[nodiscard]] constexpr bool check_field() {
  if constexpr ((std::is_same_v<Field, Around> || ...))
    return true;
  else if constexpr (Described<Field>)
    return check_described<is_memory, Field, Around...>();
  else if constexpr (Variant<Field>)
    return []<class... Models>(std::variant<Models...> const*) {
      return (check_described<is_memory, Models, Around...>() && ...);
    }(static_cast<Field const*>(nullptr));
  else if constexpr (Optional<Field>)
    return check_field<is_memory, typename Field::value_type, Around...>();
  else if constexpr (!std::is_same_v<Field, std::string> && ParameterList<Field>)
    return check_field<is_memory, ElementOf<Field>, Around...>();
  else
    return true;
}

/// The same of a model or memory. The fields of a memory must come in the order of its description, those of a model
/// need not.
template <bool is_memory, class T, class... Around>
[[nodiscard]] constexpr bool check_described() {
  static_assert(Described<T>,
                "cambium: a snapshot holds only models and memories that describe their fields; give this one "
                "`static constexpr char const* name` and `static constexpr auto parameters()`, see Described");
  if constexpr (Described<T>) {
    static_assert(
        is_memory ? describes_all<T>() : !has_more_members<T, field_count<T>()>(),
        "cambium: the parameters() of a model or of its Memory, or of a struct in them, leave out a field, or "
        "name those of a Memory in another order than the struct does; a snapshot would lose it");
    for_each_parameter<T>([]<class Owner, class Field>(Parameter<Owner, Field> const&) {
      static_assert(check_field<is_memory, Field, T, Around...>());
    });
  }
  return true;
}

/// As `check_described` for what is either one struct or a set of them.
template <bool is_memory, class Part>
[[nodiscard]] constexpr bool check_slot() {
  return check_field<is_memory, std::conditional_t<Variant<Part>, Part, std::variant<Part>>>();
}

/// Hash of all that traffic knows of a map, and of the options it was built with. Default options add nothing, so a
/// new option leaves old hashes valid.
[[nodiscard]] inline std::uint64_t hash_of_map(Map const& map) {
  auto const hash = map::content_hash(map);
  return same_bits(map.options(), {}) ? hash : hash ^ hash_parameters(map.options());
}

template <class T>
requires(is_world<T>) inline constexpr bool is_archived_by_fields<T> = true;

/// What the road corridor of an agent is built from.
struct ArchivedRoad {
  std::vector<LaneId> route;
  std::vector<geometry::Point> way;  ///< of a free corridor, as the following
  double width = 0.0, view = 0.0;
  std::uint8_t type = 0;  ///< a `map::LaneType`

  static constexpr char const* name = "road";
  static constexpr auto parameters() {
    using P = ArchivedRoad;
    return parameter_list(
        parameter("route", &P::route, "lanes in order; of a free corridor none"),
        parameter("way", &P::way, "m", any_finite, "points of a free corridor"),
        parameter("width", &P::width, "m", non_negative, "of a free corridor"),
        parameter("view", &P::view, "m", non_negative, "likewise"),
        parameter("type", &P::type, "-", Range{0, static_cast<double>(map::LaneType::other)}, "likewise"));
  }
};

/// An agent of a roster; `road` numbers the roads of the archive.
template <class World>
struct ArchivedAgent {
  AgentId id = none<AgentId>;
  std::uint32_t road = 0;
  geometry::Shape shape{};
  typename World::Behavior behavior{};
  typename World::Execution execution{};
  typename World::Dynamics dynamics{};
  typename World::Observer observer{};
  Goal goal{};

  static constexpr char const* name = "agent";
  static constexpr auto parameters() {
    using P = ArchivedAgent;
    return parameter_list(parameter("id", &P::id, "its name"),
                          parameter("road", &P::road, "-", Range{0, 4294967295.0}, "number of its road"),
                          parameter("shape", &P::shape, "its outline"),
                          parameter("behavior", &P::behavior, "one of the world's behaviours"),
                          parameter("execution", &P::execution, "how it tracks its plans"),
                          parameter("dynamics", &P::dynamics, "the vehicle model"),
                          parameter("observer", &P::observer, "how it sees the others"),
                          parameter("goal", &P::goal, "where it wants to go"));
  }
};

struct ArchivedObject {
  ObjectId id = none<ObjectId>;
  geometry::Polygon outline{};

  static constexpr char const* name = "object";
  static constexpr auto parameters() {
    using P = ArchivedObject;
    return parameter_list(parameter("id", &P::id, "its name"),
                          parameter("outline", &P::outline, "m", any_finite, "corners"));
  }
};

/// All that a world consists of, but for its map.
template <class World>
struct ArchivedWorld : RosterFacts {
  std::uint64_t map_hash = 0;
  std::uint32_t free_roads = 0;
  std::vector<ArchivedRoad> roads;
  std::vector<ArchivedAgent<World>> agents;
  std::vector<ArchivedObject> objects;
  typename World::FrameType frame{};

  static constexpr char const* name = "world";
  static constexpr auto parameters() {
    using P = ArchivedWorld;
    constexpr Range whole{0, 4294967295.0};
    return parameter_list(parameter("map_hash", &P::map_hash, "-", Range{0, 1.9e19}, "of the map, see hash_of_map"),
                          parameter("seed", &P::seed, "-", Range{0, 1.9e19}, "of its random numbers"),
                          parameter("revision", &P::revision, "-", whole, "of its roster"),
                          parameter("next_agent_id", &P::next_agent_id, "-", whole, "of the next agent without one"),
                          parameter("next_object_id", &P::next_object_id, "-", whole, "of the next object"),
                          parameter("largest_shape", &P::largest_shape, "holds those of all agents so far"),
                          parameter("free_roads", &P::free_roads, "-", whole, "how many roads are free corridors"),
                          parameter("roads", &P::roads, "of the agents; free corridors first"),
                          parameter("agents", &P::agents, "who they are"),
                          parameter("lights", &P::lights, "plans of the map's traffic lights"),
                          parameter("objects", &P::objects, "that stand in the way"),
                          parameter("frame", &P::frame, "time, and where the agents are"));
  }
};

/// Why `World` would not let an agent drive on from this record at `time` [s]; null if it would. What drivers remember
/// may be anything: a planner may have gone wrong.
template <class Record>
[[nodiscard]] char const* flaw_of(Record const& record, double time) {
  if (record.status != AgentStatus::driving && record.status != AgentStatus::not_started) return nullptr;
  auto const& lane = record.lane;
  bool is_sound = is_finite(record.state) && std::isfinite(lane.s + lane.lateral + lane.heading_error) &&
                  std::isfinite(record.action.acceleration + record.action.steering) &&
                  std::isfinite(record.acceleration);
  if constexpr (requires { record.past.states; }) {
    for (auto const& state : record.past.states) is_sound = is_sound && is_finite(state);
    for (double const acceleration : record.past.accelerations) is_sound = is_sound && std::isfinite(acceleration);
  }
  if (!is_sound) return "has a state, place or action that is not finite";
  // Execution models set the time of a state.
  if (record.status == AgentStatus::driving && !(std::abs(record.state.time - time) <= 1.0))
    return "drives at another time than its world";
  return nullptr;
}

/// What the archive holds of a world. Throws `SnapshotError` if a road was not built by this library.
template <class World>
[[nodiscard]] ArchivedWorld<World> archived(World const& world) {
  using Record = typename World::Record;
  static_assert(check_slot<true, typename World::Behaviors::Memory>() &&
                check_described<true, typename World::State>() && check_slot<true, decltype(Record::execution)>() &&
                check_described<true, decltype(Record::past)>());
  static_assert(check_slot<false, typename World::Behavior>() && check_slot<false, typename World::Execution>() &&
                check_slot<false, typename World::Dynamics>() && check_slot<false, typename World::Observer>());
  auto const& roster = world.roster();
  ArchivedWorld<World> parts;
  static_cast<RosterFacts&>(parts) = roster;
  parts.map_hash = hash_of_map(world.map());
  parts.free_roads = static_cast<std::uint32_t>(roster.free_roads.size());
  parts.frame = world.frame();
  std::vector<map::RoadCorridor const*> roads;
  for (auto const& road : roster.free_roads) {
    if (road.given->way.empty())
      throw SnapshotError("snapshot", "a free corridor of the world was not built by build_free_corridor",
                          "build it so: only then can it be built again");
    auto const options = map::free_corridor_options(*road.given);
    parts.roads.push_back({{}, road.given->way, options.width, options.view, static_cast<std::uint8_t>(options.type)});
    roads.push_back(road.numbered.get());
  }
  parts.agents.reserve(roster.agents.size());
  for (Slot slot{}; index_of(slot) < roster.agents.size(); ++slot) {
    auto const& agent = roster.agents[slot];
    if (auto const* const flaw = flaw_of(parts.frame.agents[slot], parts.frame.time))
      throw SnapshotError("snapshot", "agent " + to_string(agent.id) + " " + flaw,
                          "let its execution model return finite states of the end of the step");
    auto const place = std::find(roads.begin(), roads.end(), agent.road.get());
    auto const number = static_cast<std::uint32_t>(place - roads.begin());
    if (place == roads.end()) {
      roads.push_back(agent.road.get());
      parts.roads.push_back({agent.road->route, {}, 0.0, 0.0, 0});
    }
    parts.agents.push_back({agent.id, number, agent.shape, agent.behavior, agent.execution, agent.dynamics,
                            agent.observer, roster.goals[slot]});
  }
  for (auto const& object : roster.objects) parts.objects.push_back({object.id, object.outline});
  return parts;
}

/// Throws `SnapshotError` unless `condition` holds.
inline void require_consistent(bool condition, char const* what) {
  if (!condition)
    throw SnapshotError("snapshot", what, "it does not belong to this map, or is damaged: take another copy");
}

[[nodiscard]] inline bool is_on(map::RoadCorridor const& road, map::LanePlace const& at) {
  if (index_of(at.corridor) >= road.corridors.size()) return false;
  auto const& corridor = road.corridors[at.corridor];
  return index_of(at.piece) < corridor.pieces.size() && at.segment < corridor.center.segments().size();
}

/// Whether every lane corridor that an object names is one of the `count` of its road.
[[nodiscard]] inline bool names_corridors_below(TypeInfo const& type, void const* object, std::size_t count) {
  struct Corridors final : ValueVisitor {
    std::size_t count = 0;
    bool are_there = true;

    void value(ParameterPath const&, ParameterInfo const&, PlainValue const& value) override {
      auto const corridor = static_cast<CorridorId>(value.bits);
      if (value.kind == TypeInfo::Kind::corridor && is_valid(corridor))
        are_there = are_there && index_of(corridor) < count;
    }
  } visitor;
  visitor.count = count;
  visit_values({nullptr, ""}, {}, type, object, ListElements::each, visitor);
  return visitor.are_there;
}

/// Checks the record of an agent that behaves as `behavior` on `road` in a world at `time` [s], and numbers its place.
template <class Record, class Behavior>
void place_on(map::RoadCorridor const& road, Behavior const& behavior, Record& record, double time) {
  if (auto const* const flaw = flaw_of(record, time))
    throw SnapshotError("snapshot", std::string("an agent ") + flaw, "it is damaged: take another copy");
  require_consistent(is_on(road, record.lane), "an agent is on no lane of its road");
  auto const& pieces = road.corridors[record.lane.corridor].pieces;
  record.lane.index = map::lane_coordinate(pieces[record.lane.piece], record.lane.s);
  require_consistent(record.memory.index() == behavior.index(), "an agent has another model's memory");
  require_consistent(names_corridors_below(type_info<decltype(record.memory)>(), &record.memory, road.corridors.size()),
                     "an agent remembers a lane that its road lacks");
}

/// The maps and free corridors of the worlds that an archive has had so far. What is restored after them shares both.
struct ArchivedScenes {
  struct Scene {
    std::shared_ptr<Map const> map;
    std::vector<FreeRoad> free_roads;
  };
  std::vector<Scene> scenes;

  /// The latest on a map of this hash; null if there is none.
  [[nodiscard]] Scene const* on_map(std::uint64_t hash) const {
    auto const found = std::find_if(scenes.rbegin(), scenes.rend(),
                                    [&](auto const& scene) { return hash_of_map(*scene.map) == hash; });
    return found != scenes.rend() ? &*found : nullptr;
  }
};

/// Those of `archive`, which has them until its end.
template <class Archive>
requires requires(Archive& archive, void* id) { archive.template get_helper<ArchivedScenes>(id); }
[[nodiscard]] ArchivedScenes& scenes_of(Archive& archive) {
  static constexpr char key{};  // its address is the helper's id
  return archive.template get_helper<ArchivedScenes>(const_cast<char*>(&key));
}

/// `known`: free corridors to be shared.
[[nodiscard]] inline std::shared_ptr<map::RoadCorridor const> restored_road(Map const& map, RosterBase& roster,
                                                                            ArchivedRoad const& road,
                                                                            std::span<FreeRoad const> known) {
  if (road.way.empty()) {
    require_consistent(!road.route.empty(), "a road has no lanes");
    for (auto const lane : road.route)
      require_consistent(index_of(lane) < map.lanes().size(), "a route has a lane that the map lacks");
    return map.queries().road_corridor(map, road.route);
  }
  map::FreeCorridorOptions const options{road.width, static_cast<map::LaneType>(road.type), road.view};
  FreeRoad free;
  if (auto const* const same = find_free_road(known, road.way, options)) {
    free = *same;
  } else {
    free.given = map::build_free_corridor(map, road.way, options);
    free.numbered = numbered_road(map, roster.free_roads, free.given, "snapshot");
  }
  enter_free_road(roster, free.given, free.numbered);
  return free.numbered;
}

/// Puts the static objects of `parts` into the roster.
template <class World>
void restore_objects(Map const& map, ArchivedWorld<World>& parts, RosterBase& roster) {
  for (auto& object : parts.objects) {
    check_outline(object.outline);
    require_consistent(is_valid(object.id), "an object has no id");
    require_consistent(static_cast<std::uint32_t>(object.id) >= roster.next_object_id, "its objects are not sorted");
    roster.next_object_id = static_cast<std::uint32_t>(object.id);
    static_cast<void>(enter_object(map, roster, std::move(object.outline)));
  }
}

/// The world of `parts` on `map`, with the `known` free corridors. Throws `SnapshotError` if they contradict each other
/// or the map, and `ParameterError` for a model that could not enter.
template <class World>
[[nodiscard]] World restored(std::shared_ptr<Map const> const& map, ArchivedWorld<World>&& parts,
                             std::span<FreeRoad const> known = {}) {
  require_consistent(parts.map_hash == hash_of_map(*map), "a world in it was taken on another map");
  check_parameters(parts.largest_shape, "snapshot: largest_shape");
  auto roster = std::make_shared<typename World::RosterType>();
  std::vector<std::shared_ptr<map::RoadCorridor const>> roads;
  for (auto const& road : parts.roads) {
    require_consistent((roads.size() < parts.free_roads) == !road.way.empty(), "its free corridors do not come first");
    roads.push_back(restored_road(*map, *roster, road, known));
  }
  restore_objects(*map, parts, *roster);
  require_consistent(std::isfinite(parts.frame.time), "its time is not finite");
  require_consistent(parts.agents.size() == parts.frame.agents.size(), "it has more agents than places, or fewer");
  for (std::size_t i = 0; i < parts.agents.size(); ++i) {
    auto& agent = parts.agents[i];
    auto& record = parts.frame.agents[i];
    require_consistent(agent.road < roads.size(), "an agent has no road");
    require_consistent(i == 0 || parts.agents[i - 1].id < agent.id, "its agents are not sorted");
    auto const& road = roads[agent.road];
    auto const where = "snapshot: agent " + to_string(agent.id);
    check_id(agent.id, false, where);
    check_parameters(agent.shape, where);
    check_models(agent, where);
    place_on(*road, agent.behavior, record, parts.frame.time);
    auto const lane = road->corridors[record.lane.corridor].pieces[record.lane.piece].lane;
    static_cast<void>(entering_goal(*map, agent.goal, lane, "snapshot"));
    static_cast<void>(roster->insert({agent.id, agent.shape, road, std::move(agent.behavior),
                                      std::move(agent.execution), std::move(agent.dynamics), std::move(agent.observer)},
                                     std::move(agent.goal)));
  }
  require_consistent(parts.next_agent_id >= roster->next_agent_id && parts.next_object_id >= roster->next_object_id,
                     "the next id is taken");
  for (std::size_t i = 0; i < parts.lights.size(); ++i)
    require_light_plan(*map, static_cast<LightId>(i), parts.lights[i]);
  static_cast<RosterFacts&>(*roster) = std::move(parts);
  return World(map, std::move(roster), std::move(parts.frame));
}

}  // namespace detail

}  // namespace cambium::inline v0_1

namespace boost::serialization {

/// A world, also as a member of your own class. When it is loaded, it must have the map already.
template <class Archive, class T>
requires(cambium::detail::is_world<T>) void serialize(Archive& archive, T& world, unsigned) {
  using namespace cambium::detail;
  if constexpr (Archive::is_saving::value) {
    auto const parts = archived(world);
    archive_fields(archive, "world", parts);
  } else {
    ArchivedWorld<T> parts;
    archive_fields(archive, "world", parts);
    world = restored<T>(world.shared_map(), std::move(parts));
    if constexpr (requires { scenes_of(archive); })
      scenes_of(archive).scenes.push_back({world.shared_map(), world.roster().free_roads});
  }
}

}  // namespace boost::serialization
