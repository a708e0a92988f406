#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <iterator>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <boost/graph/dijkstra_shortest_paths.hpp>
#include <boost/graph/graph_traits.hpp>
#include <boost/property_map/property_map.hpp>

#include "cambium/core/error.hpp"
#include "cambium/core/ids.hpp"
#include "cambium/map/lane.hpp"
#include "cambium/map/map.hpp"

namespace cambium::map::detail {

/// A way from lane to lane: ahead over the lane's end, or to the side.
struct LaneStep {
  std::uint32_t from{}, to{};
  double cost{};  ///< [m]
  bool ahead{};

  friend bool operator==(LaneStep const&, LaneStep const&) = default;
};

/// Steps sorted by `from`, as a graph in the sense of Boost.Graph: an edge is a `LaneStep`. (Boost's own compressed
/// graph would do too, but takes longer to compile.)
struct LaneGraph {
  std::vector<LaneStep> steps;
  std::vector<std::uint32_t> first;  ///< of each lane's steps, and one more
  std::vector<std::uint32_t> lanes;  ///< 0, 1, 2, ...
};

/// What a step costs, as a property map.
struct StepCost {
  using key_type = LaneStep;
  using value_type = double;
  using reference = double;
  using category = boost::readable_property_map_tag;

  friend double get(StepCost, LaneStep const& step) { return step.cost; }
};

}  // namespace cambium::map::detail

template <>
struct boost::graph_traits<cambium::map::detail::LaneGraph> {
  using vertex_descriptor = std::uint32_t;
  using edge_descriptor = cambium::map::detail::LaneStep;
  using out_edge_iterator = std::vector<edge_descriptor>::const_iterator;
  using vertex_iterator = std::vector<std::uint32_t>::const_iterator;
  using directed_category = boost::directed_tag;
  using edge_parallel_category = boost::allow_parallel_edge_tag;
  struct traversal_category : boost::incidence_graph_tag, boost::vertex_list_graph_tag {};
  using vertices_size_type = std::size_t;
  using edges_size_type = std::size_t;
  using degree_size_type = std::size_t;
};

namespace cambium::map {

namespace detail {

[[nodiscard]] inline auto out_edges(std::uint32_t lane, LaneGraph const& g) {
  auto const at = [&g](std::uint32_t i) { return g.steps.begin() + static_cast<std::ptrdiff_t>(i); };
  return std::pair(at(g.first[lane]), at(g.first[lane + 1]));
}
[[nodiscard]] inline std::size_t out_degree(std::uint32_t lane, LaneGraph const& g) {
  return g.first[lane + 1] - g.first[lane];
}
[[nodiscard]] inline std::uint32_t source(LaneStep const& step, LaneGraph const&) { return step.from; }
[[nodiscard]] inline std::uint32_t target(LaneStep const& step, LaneGraph const&) { return step.to; }
[[nodiscard]] inline auto vertices(LaneGraph const& g) { return std::pair(g.lanes.begin(), g.lanes.end()); }
[[nodiscard]] inline std::size_t num_vertices(LaneGraph const& g) { return g.lanes.size(); }

/// Dijkstra's algorithm over the lanes, see `make_route_finder`.
class GraphRouteFinder final : public RouteFinder {
 public:
  explicit GraphRouteFinder(std::vector<Lane> const& lanes) {
    for (auto const& lane : lanes) {
      lengths_.push_back(lane.length());
      graph_.first.push_back(static_cast<std::uint32_t>(graph_.steps.size()));
      graph_.lanes.push_back(static_cast<std::uint32_t>(lane.id));
      auto const add = [&](LaneId to, double cost, bool ahead) {
        if (!is_valid(to) || (lane.drivable() && !lanes[index_of(to)].drivable())) return;
        graph_.steps.push_back({static_cast<std::uint32_t>(lane.id), static_cast<std::uint32_t>(to), cost, ahead});
      };
      for (auto const next : lane.successors) add(next, lane.length(), true);
      add(lane.left_neighbor, lane_change_cost, false);
      add(lane.right_neighbor, lane_change_cost, false);
    }
    graph_.first.push_back(static_cast<std::uint32_t>(graph_.steps.size()));
  }

  [[nodiscard]] std::optional<Route> shortest_route(LaneId from, LaneId to) const override {
    check(from, "start");
    check(to, "destination");
    constexpr double infinity = std::numeric_limits<double>::infinity();
    auto const start = static_cast<std::uint32_t>(from);
    auto const count = lengths_.size();
    std::vector<double> distance(count, infinity);
    std::vector<LaneStep> last_step(count);
    std::vector<boost::default_color_type> color(count, boost::white_color);
    distance[start] = 0.0;
    auto const place = boost::identity_property_map();
    try {
      boost::dijkstra_shortest_paths_no_init(
          graph_, start, boost::dummy_property_map(), boost::make_iterator_property_map(distance.begin(), place),
          StepCost(), place, std::less<double>(), boost::closed_plus<double>(infinity), 0.0,
          Recorder(static_cast<std::uint32_t>(to), last_step), boost::make_iterator_property_map(color.begin(), place));
    } catch (Arrived const&) {
      return route(from, to, last_step);
    }
    return std::nullopt;
  }

 private:
  /// Boost.Graph's way to end a search is to throw.
  struct Arrived {};
  /// Notes by which step each lane is reached best, and stops at the destination.
  class Recorder : public boost::default_dijkstra_visitor {
   public:
    Recorder(std::uint32_t destination, std::vector<LaneStep>& last_step)
        : destination_(destination), last_step_(&last_step) {}
    void examine_vertex(std::uint32_t lane, LaneGraph const&) const {
      if (lane == destination_) throw Arrived{};
    }
    void edge_relaxed(LaneStep const& step, LaneGraph const&) const { (*last_step_)[step.to] = step; }

   private:
    std::uint32_t destination_;
    std::vector<LaneStep>* last_step_;
  };

  void check(LaneId lane, char const* what) const {
    if (index_of(lane) >= lengths_.size())
      throw MapError("route", std::string("its ") + what + ", lane " + to_string(lane) + ", is not in the map",
                     "see Map::lanes for those it has");
  }

  [[nodiscard]] Route route(LaneId from, LaneId to, std::vector<LaneStep> const& last_step) const {
    Route result;
    result.lanes.push_back(to);
    result.length = lengths_[index_of(to)];
    for (auto lane = to; lane != from;) {
      auto const& step = last_step[index_of(lane)];
      if (step.ahead) result.length += step.cost;
      lane = static_cast<LaneId>(step.from);
      result.lanes.push_back(lane);
    }
    std::reverse(result.lanes.begin(), result.lanes.end());
    return result;
  }

  static constexpr double lane_change_cost = 10.0;  // [m]

  LaneGraph graph_;
  std::vector<double> lengths_;
};

}  // namespace detail

/// A finder of shortest routes over `lanes` (Dijkstra 1959, by Boost.Graph; O((V + E) log V) a query). Keeps no
/// reference to them. The number of a lane must be its place in `lanes`.
///
/// A route costs its length, and 10 m for each change to a neighbouring lane; the first and the last lane count whole.
/// Of routes with equal costs always the same one is found. No route leads from a drivable lane onto one that is not.
/// `shortest_route` throws `MapError` for a lane that the map does not have.
[[nodiscard]] inline std::unique_ptr<RouteFinder const> make_route_finder(std::vector<Lane> const& lanes) {
  return std::make_unique<detail::GraphRouteFinder const>(lanes);
}

}  // namespace cambium::map
