#include "cambium/map/routing.hpp"

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "lanes_by_hand.hpp"

using namespace by_hand;

namespace {

constexpr double lane_change = 10.0;
constexpr double infinity = std::numeric_limits<double>::infinity();

struct Lanes {
  std::vector<Lane> all;

  LaneId add(double length) { return add_straight(all, {0, 10.0 * static_cast<double>(all.size()), 0}, length); }
};

/// Lanes of whole lengths (so that sums are exact) with random links and neighbours.
Lanes random_lanes(std::uint64_t seed, int count) {
  Numbers random{seed};
  Lanes lanes;
  for (int i = 0; i < count; ++i) lanes.add(std::floor(random(1, 60)));
  auto const any = [&] { return static_cast<LaneId>(random(0, count - 1e-9)); };
  for (int i = 0; i < 2 * count; ++i) link(lanes.all, any(), any());
  for (int i = 0; i + 1 < count; i += 3) put_beside(lanes.all, static_cast<LaneId>(i), static_cast<LaneId>(i + 1));
  return lanes;
}

/// Costs from lane to lane without the last lane's length (Floyd, Warshall 1962).
std::vector<std::vector<double>> costs_by_floyd_warshall(std::vector<Lane> const& lanes) {
  auto const n = lanes.size();
  std::vector<std::vector<double>> cost(n, std::vector<double>(n, infinity));
  for (auto const& lane : lanes) {
    auto& row = cost[index_of(lane.id)];
    row[index_of(lane.id)] = 0.0;
    for (auto const next : lane.successors) row[index_of(next)] = std::min(row[index_of(next)], lane.length());
    for (auto const side : {lane.left_neighbor, lane.right_neighbor})
      if (is_valid(side)) row[index_of(side)] = std::min(row[index_of(side)], lane_change);
  }
  for (std::size_t k = 0; k < n; ++k)
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) cost[i][j] = std::min(cost[i][j], cost[i][k] + cost[k][j]);
  return cost;
}

/// The route's cost by the lanes' links, infinite where it jumps.
double cost_of(std::vector<Lane> const& lanes, Route const& route) {
  double cost = 0.0;
  for (std::size_t i = 0; i + 1 < route.lanes.size(); ++i) {
    auto const& lane = lanes[index_of(route.lanes[i])];
    auto const next = route.lanes[i + 1];
    double step = infinity;
    if (std::count(lane.successors.begin(), lane.successors.end(), next) > 0) step = lane.length();
    if (lane.left_neighbor == next || lane.right_neighbor == next) step = std::min(step, lane_change);
    cost += step;
  }
  return cost;
}

}  // namespace

TEST_CASE("a route is as short as the best of all routes, and is there when any is") {
  int routes = 0, none_there = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    auto const lanes = random_lanes(seed, 30).all;
    auto const finder = make_route_finder(lanes);
    auto const best = costs_by_floyd_warshall(lanes);
    for (auto const& from : lanes)
      for (auto const& to : lanes) {
        auto const route = finder->shortest_route(from.id, to.id);
        double const expected = best[index_of(from.id)][index_of(to.id)];
        REQUIRE(route.has_value() == (expected < infinity));
        if (!route) {
          ++none_there;
          continue;
        }
        ++routes;
        CHECK(route->lanes.front() == from.id);
        CHECK(route->lanes.back() == to.id);
        CHECK(cost_of(lanes, *route) == doctest::Approx(expected));
      }
  }
  CHECK(routes > 1000);
  CHECK(none_there > 100);
}

TEST_CASE("a route's length counts the lanes driven to their end and the last one, not the changes between lanes") {
  Lanes lanes;
  auto const a = lanes.add(100), a_right = lanes.add(102), b_right = lanes.add(50);
  put_beside(lanes.all, a, a_right);
  link(lanes.all, a_right, b_right);
  auto const finder = make_route_finder(lanes.all);
  auto const route = finder->shortest_route(a, b_right);
  REQUIRE(route.has_value());
  CHECK(route->lanes == std::vector<LaneId>{a, a_right, b_right});
  CHECK(route->length == doctest::Approx(152));
  CHECK(finder->shortest_route(a, a)->lanes == std::vector<LaneId>{a});
  CHECK(finder->shortest_route(a, a)->length == doctest::Approx(100));
}

TEST_CASE("a short detour is taken rather than two lane changes, a long one is not") {
  for (double const detour : {15.0, 25.0}) {
    Lanes lanes;
    auto const a = lanes.add(10), right = lanes.add(10), next = lanes.add(10), around = lanes.add(detour);
    put_beside(lanes.all, a, right);
    link(lanes.all, right, next);
    link(lanes.all, a, around);
    link(lanes.all, around, next);
    auto const route = make_route_finder(lanes.all)->shortest_route(a, next);
    CHECK(route->lanes[1] == (detour < lane_change ? around : right));
  }
}

TEST_CASE("a route does not lead from a drivable lane onto another kind, but may begin there") {
  Lanes lanes;
  auto const a = lanes.add(10), parking = lanes.add(10), b = lanes.add(10);
  lanes.all[index_of(parking)].type = LaneType::parking;
  link(lanes.all, a, parking);
  link(lanes.all, parking, b);
  auto const finder = make_route_finder(lanes.all);
  CHECK_FALSE(finder->shortest_route(a, b).has_value());
  CHECK(finder->shortest_route(parking, b).has_value());
}

TEST_CASE("of equally short routes always the same is found") {
  Lanes lanes;
  auto const a = lanes.add(10);
  std::vector<LaneId> const middle{lanes.add(20), lanes.add(20), lanes.add(20)};
  auto const b = lanes.add(10);
  for (auto const m : middle) {
    link(lanes.all, a, m);
    link(lanes.all, m, b);
  }
  auto const first = make_route_finder(lanes.all)->shortest_route(a, b)->lanes;
  for (int i = 0; i < 5; ++i) CHECK(make_route_finder(lanes.all)->shortest_route(a, b)->lanes == first);
}

TEST_CASE("a lane that the map does not have is named in the error") {
  Lanes lanes;
  auto const a = lanes.add(10);
  auto const finder = make_route_finder(lanes.all);
  try {
    (void)finder->shortest_route(a, static_cast<LaneId>(17));
    FAIL("no error");
  } catch (MapError const& e) {
    CHECK(std::string(e.what()).find("destination, lane 17") != std::string::npos);
  }
  CHECK_THROWS_AS((void)finder->shortest_route(none<LaneId>, a), MapError);
}
