#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <iterator>
#include <limits>
#include <memory>
#include <set>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include <boost/graph/dijkstra_shortest_paths.hpp>
#include <boost/graph/graph_traits.hpp>
#include <boost/property_map/property_map.hpp>

#include "cambium/core/detail/stable_sort.hpp"
#include "cambium/core/error.hpp"
#include "cambium/core/ids.hpp"
#include "cambium/map/detail/route_graph.hpp"
#include "cambium/map/lane.hpp"
#include "cambium/map/route.hpp"

/// `LaneGraph` as a graph in the sense of Boost.Graph: an edge is a `LaneStep`. (Boost's own compressed graph would do
/// too, but takes longer to compile.)
template <>
struct boost::graph_traits<cambium::map::detail::LaneGraph> {
  using vertex_descriptor = std::uint32_t;
  using edge_descriptor = cambium::map::detail::LaneStep;
  using out_edge_iterator = std::vector<edge_descriptor>::const_iterator;
  using vertex_iterator = std::vector<std::uint32_t>::const_iterator;
  using directed_category = boost::directed_tag;
  using edge_parallel_category = boost::disallow_parallel_edge_tag;
  struct traversal_category : boost::incidence_graph_tag, boost::vertex_list_graph_tag {};
  using vertices_size_type = std::size_t;
  using edges_size_type = std::size_t;
  using degree_size_type = std::size_t;
};

namespace cambium::map::detail {

[[nodiscard]] inline auto out_edges(std::uint32_t place, LaneGraph const& g) {
  auto const at = [&g](std::uint32_t i) { return g.steps.begin() + static_cast<std::ptrdiff_t>(i); };
  return std::pair(at(g.first[place]), at(g.first[place + 1]));
}
[[nodiscard]] inline std::size_t out_degree(std::uint32_t place, LaneGraph const& g) {
  return g.first[place + 1] - g.first[place];
}
[[nodiscard]] inline std::uint32_t source(LaneStep const& step, LaneGraph const&) { return step.from; }
[[nodiscard]] inline std::uint32_t target(LaneStep const& step, LaneGraph const&) { return step.to; }
[[nodiscard]] inline auto vertices(LaneGraph const& g) { return std::pair(g.places.begin(), g.places.end()); }
[[nodiscard]] inline std::size_t num_vertices(LaneGraph const& g) { return g.places.size(); }

/// What a search may not use.
struct Closed {
  std::vector<bool> places;                                 ///< empty: none
  std::set<std::pair<std::uint32_t, std::uint32_t>> steps;  ///< (from, to)
};

/// What a step costs, as a property map; infinite where it is closed.
struct StepCost {
  using key_type = LaneStep;
  using value_type = double;
  using reference = double;
  using category = boost::readable_property_map_tag;

  Closed const* closed;

  friend double get(StepCost const& map, LaneStep const& step) {
    bool const is_closed = (!map.closed->places.empty() && map.closed->places[step.to]) ||
                           (!map.closed->steps.empty() && map.closed->steps.contains({step.from, step.to}));
    return is_closed ? std::numeric_limits<double>::infinity() : step.cost;
  }
};

/// Dijkstra's algorithm (1959) from one place: what it costs to come to the others.
class LaneSearch {
 public:
  /// Ends when `goal` is reached, or all that costs `budget` at most.
  LaneSearch(LaneGraph const& graph, std::uint32_t start, std::uint32_t goal, double budget, Closed const& closed)
      : distance_(graph.places.size(), infinity), previous_(graph.places.size()) {
    std::vector<boost::default_color_type> color(graph.places.size(), boost::white_color);
    distance_[start] = 0.0;
    auto const place = boost::identity_property_map();
    try {
      boost::dijkstra_shortest_paths_no_init(
          graph, start, boost::dummy_property_map(), boost::make_iterator_property_map(distance_.begin(), place),
          StepCost{&closed}, place, std::less<double>(), boost::closed_plus<double>(infinity), 0.0,
          Recorder(*this, goal, budget), boost::make_iterator_property_map(color.begin(), place));
    } catch (Ended const&) {
    }
  }

  /// Cost of coming to `place`: true where it is within the budget and not beyond the goal. Infinite where there is no
  /// way.
  [[nodiscard]] double cost(std::uint32_t place) const { return distance_[place]; }

  /// The places on the way from `start` to `place`, both included. There must be one.
  [[nodiscard]] std::vector<std::uint32_t> path(std::uint32_t start, std::uint32_t place) const {
    std::vector<std::uint32_t> path{place};
    while (path.back() != start) path.push_back(previous_[path.back()]);
    std::reverse(path.begin(), path.end());
    return path;
  }

 private:
  static constexpr double infinity = std::numeric_limits<double>::infinity();

  /// Boost.Graph's way to end a search is to throw.
  struct Ended {};
  /// Notes from where each place is reached best, and ends the search.
  class Recorder : public boost::default_dijkstra_visitor {
   public:
    Recorder(LaneSearch& search, std::uint32_t goal, double budget) : search_(&search), goal_(goal), budget_(budget) {}
    void examine_vertex(std::uint32_t place, LaneGraph const&) const {
      double const cost = search_->distance_[place];
      if (place == goal_ || cost > budget_ || cost == infinity) throw Ended{};
    }
    void edge_relaxed(LaneStep const& step, LaneGraph const&) const { search_->previous_[step.to] = step.from; }

   private:
    LaneSearch* search_;
    std::uint32_t goal_;
    double budget_;
  };

  std::vector<double> distance_;
  std::vector<std::uint32_t> previous_;
};

/// The k cheapest ways without a loop (Yen 1971).
class YenSearch {
 public:
  using Path = std::vector<std::uint32_t>;

  YenSearch(LaneGraph const& graph, std::uint32_t start, std::uint32_t goal)
      : graph_(graph), start_(start), goal_(goal) {}

  /// At most `count` paths, sorted by cost, then by places.
  [[nodiscard]] std::vector<std::pair<double, Path>> find(std::size_t count) {
    std::vector<std::pair<double, Path>> found;
    if (count == 0) return found;
    offer({}, start_, {});
    while (found.size() < count && !candidates_.empty()) {
      found.push_back(*candidates_.begin());
      candidates_.erase(candidates_.begin());
      if (found.size() < count) branch(found);
    }
    return found;
  }

 private:
  /// Looks for the best way from `spur` on; `root` leads there.
  void offer(Path root, std::uint32_t spur, Closed const& closed) {
    LaneSearch const search(graph_, spur, goal_, std::numeric_limits<double>::infinity(), closed);
    if (search.cost(goal_) == std::numeric_limits<double>::infinity()) return;
    auto const rest = search.path(spur, goal_);
    root.insert(root.end(), rest.begin(), rest.end());
    candidates_.emplace(cost(root), std::move(root));
  }

  /// Looks for ways that leave the last one found at each of its places, where no other found one does.
  void branch(std::vector<std::pair<double, Path>> const& found) {
    Path const last = found.back().second;
    Closed closed;
    closed.places.assign(graph_.places.size(), false);
    for (std::size_t i = 0; i + 1 < last.size(); ++i) {
      auto const here = last.begin() + static_cast<std::ptrdiff_t>(i);
      closed.steps.clear();
      for (auto const& [cost, path] : found)
        if (path.size() > i + 1 && std::equal(last.begin(), here + 1, path.begin()))
          closed.steps.emplace(path[i], path[i + 1]);
      offer(Path(last.begin(), here), *here, closed);
      closed.places[*here] = true;
    }
  }

  [[nodiscard]] double cost(Path const& path) const {
    double sum = 0.0;
    for (std::size_t i = 0; i + 1 < path.size(); ++i)
      for (auto const& step : graph_.from(path[i]))
        if (step.to == path[i + 1]) sum += step.cost;
    return sum;
  }

  LaneGraph const& graph_;
  std::uint32_t start_, goal_;
  std::set<std::pair<double, Path>> candidates_;
};

[[nodiscard]] inline bool is_ahead(LaneGraph const& graph, std::uint32_t from, std::uint32_t to) {
  auto const steps = graph.from(from);
  return std::any_of(steps.begin(), steps.end(), [to](LaneStep const& step) { return step.to == to && step.ahead; });
}

[[nodiscard]] inline Route make_route(std::span<Lane const> lanes, RouteGraphBuilder const& builder,
                                      LaneGraph const& graph, std::vector<std::uint32_t> const& path, double cost) {
  Route route{{}, 0.0, cost};
  double begin = builder.from_share();  // where the current lane is entered
  for (std::size_t i = 0; i < path.size(); ++i) {
    auto const lane = builder.lane_of(path[i]);
    route.lanes.push_back(static_cast<LaneId>(lane));
    bool const is_last = i + 1 == path.size();
    bool const ahead = !is_last && is_ahead(graph, path[i], path[i + 1]);
    if (is_last || ahead) route.length += ((is_last ? builder.to_share() : 1.0) - begin) * lanes[lane].length();
    if (ahead) begin = 0.0;
  }
  return route;
}

/// See `Map::routes`. A route costs what is driven of its lanes, and each change to a neighbouring lane; of lanes
/// beside each other that it changes between only the last one counts. Of routes with equal costs always the same one
/// is found. No route leads from a drivable lane onto one that is not. The number of a lane must be its place in
/// `lanes`.
[[nodiscard]] inline std::vector<Route> find_routes(std::span<Lane const> lanes, LaneStation from, LaneStation to,
                                                    RouteOptions const& options) {
  if (!is_valid(to.lane))
    throw MapError("route", "its destination names no lane", "see Map::lanes for those there are");
  RouteGraphBuilder builder(lanes, from, to, options);
  std::vector<Route> routes;
  if (builder.is_ahead()) {
    double const share = builder.to_share() - builder.from_share();
    double const cost = share > 0.0 ? share * builder.cost(builder.lane_of(builder.start())) : 0.0;
    if (options.max_routes > 0 && std::isfinite(cost))
      routes.push_back({{from.lane}, share * lanes[index_of(from.lane)].length(), cost});
    return routes;
  }
  auto const graph = builder.build();
  for (auto const& [cost, path] : YenSearch(graph, builder.start(), builder.goal()).find(options.max_routes))
    routes.push_back(make_route(lanes, builder, graph, path, cost));
  return routes;
}

/// See `Map::reachable`. The number of a lane must be its place in `lanes`.
[[nodiscard]] inline std::vector<ReachedLane> find_reachable(std::span<Lane const> lanes, LaneStation from,
                                                             double budget, RouteOptions const& options) {
  if (!(budget >= 0.0)) throw MapError("reachable lanes", "the budget is negative or not a number", "give 0 or more");
  RouteGraphBuilder builder(lanes, from, {}, options);
  auto const graph = builder.build();
  LaneSearch const search(graph, builder.start(), builder.goal(), budget, {});
  std::vector<ReachedLane> reached;
  for (std::uint32_t i = 0; i < lanes.size(); ++i) {
    auto const own = builder.start_place(i);
    double const cost = own == builder.no_place ? search.cost(i) : std::min(search.cost(i), search.cost(own));
    if (cost <= budget && std::isfinite(cost)) reached.push_back({static_cast<LaneId>(i), cost});
  }
  cambium::detail::stable_sort_by(reached, [](ReachedLane const& a, ReachedLane const& b) {
    return std::tie(a.cost, a.lane) < std::tie(b.cost, b.lane);
  });
  return reached;
}

}  // namespace cambium::map::detail
