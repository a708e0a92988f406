#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <queue>
#include <set>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "cambium/core/error.hpp"
#include "cambium/core/ids.hpp"
#include "cambium/core/stable_sort.hpp"
#include "cambium/map/lanes/lane.hpp"
#include "cambium/map/routing/detail/route_graph.hpp"
#include "cambium/map/routing/route.hpp"

namespace cambium::inline v0_1::map::detail {

/// Places and steps closed to a search.
struct Closed {
  std::vector<bool> places;                                    ///< empty: none
  std::vector<std::pair<std::uint32_t, std::uint32_t>> steps;  ///< (from, to), each once: a few, all from one place

  [[nodiscard]] bool holds(std::uint32_t from, std::uint32_t to) const {
    return (!places.empty() && places[to]) || std::find(steps.begin(), steps.end(), std::pair(from, to)) != steps.end();
  }

  void close(std::uint32_t from, std::uint32_t to) {
    if (!holds(from, to)) steps.emplace_back(from, to);
  }
};

/// Dijkstra's algorithm (1959) from one place: what it costs to come to the others. (Boost.Graph's takes longer to
/// include than the whole of this room, and ends early by an exception only.)
class LaneSearch {
 public:
  /// Ends when `goal` is reached, or all that costs `budget` at most.
  LaneSearch(LaneGraph const& graph, std::uint32_t start, std::uint32_t goal, double budget, Closed const& closed)
      : distance_(graph.size(), infinity), previous_(graph.size()) {
    using Candidate = std::pair<double, std::uint32_t>;  // cost, place
    std::priority_queue<Candidate, std::vector<Candidate>, std::greater<>> open;
    distance_[start] = 0.0;
    open.emplace(0.0, start);
    while (!open.empty()) {
      auto const [cost, place] = open.top();
      open.pop();
      if (place == goal || cost > budget) return;
      if (cost > distance_[place]) continue;  // reached at less since
      for (auto const& step : graph.from(place)) {
        double const there = cost + step.cost;
        if (!(there < distance_[step.to]) || closed.holds(step.from, step.to)) continue;
        distance_[step.to] = there;
        previous_[step.to] = place;
        open.emplace(there, step.to);
      }
    }
  }

  /// Cost of reaching `place`: exact if it is within the budget and not beyond the goal; infinite if it is unreachable.
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
    closed.places.assign(graph_.size(), false);
    for (std::size_t i = 0; i + 1 < last.size(); ++i) {
      auto const here = last.begin() + static_cast<std::ptrdiff_t>(i);
      closed.steps.clear();
      for (auto const& [cost, path] : found)
        if (path.size() > i + 1 && std::equal(last.begin(), here + 1, path.begin())) closed.close(path[i], path[i + 1]);
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
  cambium::detail::stable_sort(reached, [](ReachedLane const& r) { return std::tuple(r.cost, r.lane); });
  return reached;
}

}  // namespace cambium::inline v0_1::map::detail
