#pragma once

#include <atomic>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "cambium/core/error.hpp"
#include "cambium/core/ids.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/geometry/box.hpp"
#include "cambium/geometry/pose.hpp"
#include "cambium/geometry/shape.hpp"
#include "cambium/map/lanes/detail/find_lane.hpp"
#include "cambium/map/lanes/lane.hpp"
#include "cambium/map/lanes/lane_tree.hpp"
#include "cambium/map/map_queries.hpp"
#include "cambium/map/road/road.hpp"
#include "cambium/map/routing/route.hpp"

namespace cambium::inline v0_1::map {

/// How a map is built.
struct MapOptions {
  double position_tolerance = 0.01;  ///< largest distance of a sampled lane from the exact one [m]
  /// Largest deviation of a sampled lane's heading, which is interpolated between its samples, from the exact one
  /// [rad]; two samples are not more than `turn_per_tolerance` times that apart.
  double heading_tolerance = 0.5 * geometry::pi / 180;
  double overlap_clearance = 2.5;  ///< paths closer than this cannot carry vehicles side by side [m]
  double merge_view = 120.0;   ///< how far before an overlap merging lanes take each other's traffic into account [m]
  double merge_length = 60.0;  ///< longest stretch over which an ending lane swings onto its neighbour [m]
  bool infer_links = false;    ///< join lanes whose ends meet although the file does not link them
  /// The bodies for which conflicts at junctions are found, with some clearance: the first holds cars and vans, the
  /// second trucks and buses, which swing out farther. `World::add` refuses larger ones that heed conflicts.
  geometry::Shape conflict_shape{4.8, 1.4, 1.1, 1.1}, large_conflict_shape{8.8, 3.6, 1.4, 1.4};

  static constexpr double turn_per_tolerance = 6.0;
  static constexpr char const* name = "map_options";
  static constexpr auto parameters() {
    using P = MapOptions;
    return parameter_list(
        parameter("position_tolerance", &P::position_tolerance, "m", Range{1e-5, 10},
                  "largest distance of a sampled lane from the exact one"),
        parameter("heading_tolerance", &P::heading_tolerance, "rad", Range{1e-4, 1},
                  "largest deviation of a sampled lane's heading from the exact one"),
        parameter("overlap_clearance", &P::overlap_clearance, "m", Range{0.1, 20},
                  "paths closer than this cannot carry vehicles side by side"),
        parameter("merge_view", &P::merge_view, "m", Range{0, 1000},
                  "how far before an overlap merging traffic is taken into account"),
        parameter("merge_length", &P::merge_length, "m", Range{30, 1000},
                  "longest stretch over which an ending lane swings onto its neighbour"),
        parameter("infer_links", &P::infer_links, "join lanes whose ends meet although the file does not link them"),
        parameter("conflict_shape", &P::conflict_shape, "the body that conflicts at junctions are found for"),
        parameter("large_conflict_shape", &P::large_conflict_shape, "the same where larger vehicles drive"));
  }
};

/// Of two roads through a junction, traffic on `high` goes before traffic on `low`.
struct RoadPriority {
  RoadId high = none<RoadId>, low = none<RoadId>;
};

/// Which way a road or lane is driven: along its road's reference line or against it.
enum class RoadDirection : std::uint8_t { forward, backward };

/// Where roads meet. Its area and conflicts: `cambium/map/lanes/junction.hpp`.
struct Junction {
  JunctionId id = none<JunctionId>;
  std::string name;                      ///< the file's id
  std::vector<RoadId> roads;             ///< the connecting roads; none in direct and virtual junctions
  std::vector<LaneId> lanes;             ///< of the connecting roads, of any type
  std::vector<RoadPriority> priorities;  ///< as written in the file
};

/// Roads and lanes and the links between them. Immutable, except that it remembers the road corridors that were built
/// (safe on many threads); made by `load_opendrive`, `MapBuilder` or `build_map`, shared by worlds.
class Map {
 public:
  /// What a map is made of, see `build_map`.
  struct Parts {
    std::vector<Road> roads;
    std::vector<Lane> lanes;
    std::vector<Junction> junctions;
    std::vector<TrafficLight> lights;
    MapOptions options;
  };

  /// Defined in `map_impl.hpp`. O(n log n) for n path segments.
  explicit Map(Parts parts);
  Map(Map const&) = delete;
  Map& operator=(Map const&) = delete;

  [[nodiscard]] std::span<Road const> roads() const { return parts_.roads; }
  [[nodiscard]] std::span<Lane const> lanes() const { return parts_.lanes; }
  [[nodiscard]] std::span<Junction const> junctions() const { return parts_.junctions; }
  [[nodiscard]] std::span<TrafficLight const> lights() const { return parts_.lights; }
  [[nodiscard]] MapOptions const& options() const { return parts_.options; }

  /// The smallest box around all lanes of any type, borders and paths; the empty box (`min_x > max_x`) where the map
  /// has no lane.
  [[nodiscard]] geometry::Box const& bounds() const { return bounds_; }

  /// Precondition: the map has it.
  [[nodiscard]] Road const& road(RoadId id) const {
    CAMBIUM_ASSERT(index_of(id) < parts_.roads.size(), "Map::road: the map has no road of that id");
    return parts_.roads[index_of(id)];
  }
  /// As `road`.
  [[nodiscard]] Lane const& lane(LaneId id) const {
    CAMBIUM_ASSERT(index_of(id) < parts_.lanes.size(), "Map::lane: the map has no lane of that id");
    return parts_.lanes[index_of(id)];
  }

  /// Whether the lane's road leads through a junction. Precondition: the map has the lane. O(1).
  [[nodiscard]] bool in_junction(LaneId id) const { return is_valid(road(lane(id).road).junction); }

  /// As `road`.
  [[nodiscard]] Junction const& junction(JunctionId id) const {
    CAMBIUM_ASSERT(index_of(id) < parts_.junctions.size(), "Map::junction: the map has no junction of that id");
    return parts_.junctions[index_of(id)];
  }

  /// The road with the file's id `name`. Throws `MapError` if there is none. O(roads).
  [[nodiscard]] Road const& find_road(std::string_view name) const {
    for (auto const& road : parts_.roads)
      if (road.name == name) return road;
    throw MapError("road " + std::string(name), "the map has no such road", "see Map::roads for those it has");
  }

  /// The traffic light of that name (see `TrafficLight`). Throws `MapError` if there is none. O(lights).
  [[nodiscard]] LightId find_light(std::string_view name) const {
    for (auto const& light : parts_.lights)
      if (light.name == name) return light.id;
    throw MapError("light " + std::string(name), "the map has no such traffic light",
                   "see Map::lights for those it has");
  }

  /// Lane `number` of road `name` at road position `s` [m], the road's end included; of a lane for both directions the
  /// one that is driven as its side of the road is. Throws `MapError` if there is none. O(roads).
  [[nodiscard]] LaneId find_lane(std::string_view name, double s, int number) const {
    return detail::lane_at(find_road(name), s, number).id;
  }
  /// As above, but returns the lane driven in `direction`.
  [[nodiscard]] LaneId find_lane(std::string_view name, double s, int number, RoadDirection direction) const {
    auto const& found = detail::lane_at(find_road(name), s, number);
    for (auto const id : {found.id, found.opposite})
      if (is_valid(id) && lane(id).along_road == (direction == RoadDirection::forward)) return id;
    throw MapError(describe(found.id), "it is driven the other way only", "give the other direction, or none");
  }

  /// Name of a lane for messages: "road 12, section 0, lane -1"; with ", backward" (or forward) where traffic runs in
  /// both directions.
  [[nodiscard]] std::string describe(LaneId id) const {
    auto const& l = lane(id);
    std::string const direction = !is_valid(l.opposite) ? "" : l.along_road ? ", forward" : ", backward";
    return "road " + road(l.road).name + ", section " + std::to_string(l.section) + ", lane " +
           std::to_string(l.number) + direction;
  }

  /// Lanes of any type that hold `p`, or come within `radius` [m] of it, nearest first. O(log n).
  [[nodiscard]] std::vector<LaneHit> lanes_near(geometry::Point const& p, double radius) const {
    return tree_.near(p, LaneQuery{radius});
  }
  /// As above, but those that match `query`.
  [[nodiscard]] std::vector<LaneHit> lanes_near(geometry::Point const& p, LaneQuery const& query) const {
    return tree_.near(p, query);
  }

  /// Lanes of any type of which a part lies in `box`, in the order of their ids. O(log n) and those found.
  [[nodiscard]] std::vector<LaneId> lanes_in(geometry::Box const& box) const { return tree_.in(box); }

  /// The drivable lane that a vehicle at `pose` is in: of the lanes that hold the position the one whose direction fits
  /// best; where none does, the nearest within `radius` [m] that does not run the other way. Nothing if there is none.
  /// O(log n).
  [[nodiscard]] std::optional<LaneHit> nearest_lane(geometry::Pose const& pose, double radius = 5.0) const {
    return tree_.nearest_drivable(pose, radius);
  }

  /// As above for something that moves: the lane of `previous` while that holds `pose` and runs that way, else a
  /// successor, predecessor or neighbour that does, else as above. The result does not jump to lanes that cross or
  /// branch off before the own one ends. O(segments moved since), no allocation.
  [[nodiscard]] std::optional<LaneHit> nearest_lane(geometry::Pose const& pose, LaneHit const& previous,
                                                    double radius = 5.0) const {
    CAMBIUM_ASSERT(index_of(previous.lane) < parts_.lanes.size(), "Map::nearest_lane: the map has no lane of that id");
    if (auto const hit = detail::follow_lane(parts_.lanes, pose, previous)) return hit;
    return nearest_lane(pose, radius);
  }

  /// Catches `nearest_lane({x, y})`, which would pass for a pose of heading 0.
  template <class None = void>
  std::optional<LaneHit> nearest_lane(double const (&)[2], double = 5.0) const {
    static_assert(!std::is_void_v<None>,
                  "cambium::Map::nearest_lane({x, y}): two numbers are no pose; give the heading too, {x, y, heading}, "
                  "or ask for the point, lanes_near({x, y}, {.radius = 5, .count = 1, .only_drivable = true})");
    return {};
  }
  template <class None = void>
  std::optional<LaneHit> nearest_lane(double const (&xy)[2], LaneHit const&, double radius = 5.0) const {
    return nearest_lane<None>(xy, radius);
  }

  /// Calls `f(LaneHit)` for each foot point of `p` in a drivable lane that comes within `radius` [m] of it. O(log n)
  /// and those found, no allocation.
  template <class F>
  void for_each_drivable_near(geometry::Point const& p, double radius, F&& f) const {
    tree_.for_each_drivable(p, radius, f);
  }

  /// True when a drivable lane holds the point. O(log n), no allocation.
  [[nodiscard]] bool on_drivable_lane(geometry::Point const& p) const { return tree_.any_drivable_at(p); }

  /// The cheapest way from `from` to `to`; nothing if there is none. Where the start lies past the destination on the
  /// same lane, the route leads round to it, if there is a way. Throws `MapError` for a lane that the map does not
  /// have, a station that is not a number, and options out of range. O((V + E) log V) for V lanes and E links.
  [[nodiscard]] std::optional<Route> shortest_route(LaneStation from, LaneStation to, RouteOptions options = {}) const {
    options.max_routes = 1;
    auto found = routes(from, to, options);
    if (found.empty()) return std::nullopt;
    return std::move(found.front());
  }
  /// As above, from the begin of `from` to the end of `to`.
  [[nodiscard]] std::optional<Route> shortest_route(LaneId from, LaneId to, RouteOptions options = {}) const {
    return shortest_route(LaneStation{from}, end_of(to), std::move(options));
  }

  /// The `RouteOptions::max_routes` cheapest ways, cheapest first; fewer where there are no more. None passes a lane
  /// twice, but for the one that leads round to its start's lane. Throws as above. O(k n (V + E) log V) for k routes of
  /// n lanes.
  [[nodiscard]] std::vector<Route> routes(LaneStation from, LaneStation to, RouteOptions const& options) const {
    return queries_->routes(parts_.lanes, from, to, options);
  }
  /// As above, from the begin of `from` to the end of `to`.
  [[nodiscard]] std::vector<Route> routes(LaneId from, LaneId to, RouteOptions const& options) const {
    return routes(LaneStation{from}, end_of(to), options);
  }

  /// The lanes reachable from `from` at a cost of at most `budget`, its own first, then the cheapest; ties go to the
  /// smaller id. Throws as above, and for a budget that is negative or not a number. O((V + E) log V).
  [[nodiscard]] std::vector<ReachedLane> reachable(LaneStation from, double budget,
                                                   RouteOptions const& options = {}) const {
    return queries_->reachable(parts_.lanes, from, budget, options);
  }
  [[nodiscard]] std::vector<ReachedLane> reachable(LaneId from, double budget, RouteOptions const& options = {}) const {
    return reachable(LaneStation{from}, budget, options);
  }

  /// Builds the roads that worlds and trackers ask for in `area`: from each drivable lane there straight on, as
  /// `World::add` does without a route, and by all `roads_ahead`. Hold the result: as long as it lives, the map has
  /// them at once, and no cycle of a planner pays the milliseconds that building them takes. Safe on many threads.
  [[nodiscard]] std::vector<std::shared_ptr<RoadCorridor const>> prepare(geometry::Box const& area) const {
    std::vector<std::shared_ptr<RoadCorridor const>> roads;
    for (auto const id : lanes_in(area)) {
      if (!lane(id).drivable()) continue;
      roads.push_back(queries_->road_corridor(*this, queries_->straight_route(*this, id, straight_on).lanes));
      for (auto& road : queries_->roads_ahead(*this, id)) roads.push_back(std::move(road));
    }
    return roads;
  }

  /// How far `straight_route` leads by default [m].
  static constexpr double straight_on = 2000.0;

  /// The cached `content_hash`; 0 until it is computed.
  [[nodiscard]] std::atomic<std::uint64_t>& known_content_hash() const { return content_hash_; }

  /// The queries that take long to compile; call them by the functions named there.
  [[nodiscard]] MapQueries const& queries() const { return *queries_; }

 private:
  [[nodiscard]] static LaneStation end_of(LaneId lane) { return {lane, std::numeric_limits<double>::infinity()}; }

  Parts parts_;
  LaneTree tree_;
  geometry::Box bounds_;
  std::unique_ptr<MapQueries const> queries_;
  mutable std::atomic<std::uint64_t> content_hash_{0};
};

}  // namespace cambium::inline v0_1::map

namespace cambium::inline v0_1 {
using map::Map;
using map::MapOptions;

namespace detail {
struct NotIncluded {
  std::shared_ptr<Map const> map;
  int diagnostics;
};
}  // namespace detail

/// Catch forgotten includes: any other function of the name is a better match.
template <class None = void>
detail::NotIncluded load_opendrive(...) {
  static_assert(!std::is_void_v<None>, "cambium::load_opendrive: include <cambium/map/opendrive.hpp> (needs pugixml)");
  return {};
}
template <class None = void>
detail::NotIncluded load_lanelet2(...) {
  static_assert(!std::is_void_v<None>,
                "cambium::load_lanelet2: include <cambium/map/lanelet/lanelet2.hpp> (needs pugixml)");
  return {};
}
}  // namespace cambium::inline v0_1
