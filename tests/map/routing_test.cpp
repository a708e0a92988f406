#include "cambium/map/map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include "corpus_maps.hpp"
#include "lanes_by_hand.hpp"
#include "../support/error_of.hpp"

using namespace by_hand;

namespace {

constexpr double lane_change = 10.0;
constexpr double infinity = std::numeric_limits<double>::infinity();

struct Lanes {
  std::vector<Lane> all;

  LaneId add(double length) { return add_straight(all, {0, 10.0 * static_cast<double>(all.size()), 0}, length); }

  /// The finder's answers come through a map.
  [[nodiscard]] std::shared_ptr<Map const> map() const { return make_map(all); }
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

/// What it costs to go from lane `from` on to `to`, by what the lanes themselves say; infinite where it does not lead
/// there.
double step_cost(Map const& map, LaneId from, LaneId to, bool obey_marks = true) {
  auto const& lane = map.lane(from);
  if (lane.drivable() && !map.lane(to).drivable()) return infinity;
  bool const follows = std::count(lane.successors.begin(), lane.successors.end(), to) > 0;
  bool const left = lane.left_neighbor == to && !(obey_marks && lane.left_changes.empty());
  bool const right = lane.right_neighbor == to && !(obey_marks && lane.right_changes.empty());
  return std::min(follows ? lane.length() : infinity, left || right ? lane_change : infinity);
}

/// The lanes that `from` leads to, each once, with what that costs.
std::map<LaneId, double> steps_from(Map const& map, LaneId from, bool obey_marks = true) {
  auto const& lane = map.lane(from);
  auto targets = lane.successors;
  for (auto const side : {lane.left_neighbor, lane.right_neighbor})
    if (is_valid(side)) targets.push_back(side);
  std::map<LaneId, double> steps;
  for (auto const to : targets)
    if (double const cost = step_cost(map, from, to, obey_marks); cost < infinity) steps[to] = cost;
  return steps;
}

/// The route's cost without its last lane, infinite where it jumps.
double cost_of(Map const& map, Route const& route, bool obey_marks = true) {
  double cost = 0.0;
  for (std::size_t i = 0; i + 1 < route.lanes.size(); ++i)
    cost += step_cost(map, route.lanes[i], route.lanes[i + 1], obey_marks);
  return cost;
}

/// Costs from `from` to all lanes, the last one not counted (Bellman, Ford).
std::vector<double> costs_by_relaxation(Map const& map, LaneId from, bool obey_marks = true) {
  std::vector<double> costs(map.lanes().size(), infinity);
  costs[index_of(from)] = 0.0;
  for (bool changed = true; changed;) {
    changed = false;
    for (auto const& lane : map.lanes()) {
      if (costs[index_of(lane.id)] == infinity) continue;
      for (auto const& [to, step] : steps_from(map, lane.id, obey_marks)) {
        double const cost = costs[index_of(lane.id)] + step;
        if (cost >= costs[index_of(to)] - 1e-9) continue;
        costs[index_of(to)] = cost;
        changed = true;
      }
    }
  }
  return costs;
}

/// Costs of all simple paths from lane to lane, the last lane included, by trying every one; sorted.
std::vector<double> all_costs(Map const& map, LaneId from, LaneId to) {
  std::vector<double> costs;
  std::vector<bool> used(map.lanes().size());
  auto const visit = [&](auto const& self, LaneId at, double cost) -> void {
    if (at == to) return costs.push_back(cost + map.lane(to).length());
    used[index_of(at)] = true;
    for (auto const& [next, step] : steps_from(map, at))
      if (!used[index_of(next)]) self(self, next, cost + step);
    used[index_of(at)] = false;
  };
  visit(visit, from, 0.0);
  std::sort(costs.begin(), costs.end());
  return costs;
}

}  // namespace

TEST_CASE("a route is as short as the best of all routes, and is there when any is") {
  int routes = 0, none_there = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    auto const made = random_lanes(seed, 30);
    auto const& lanes = made.all;
    auto const finder = made.map();
    for (auto const& from : lanes) {
      auto const best = costs_by_relaxation(*finder, from.id);
      for (auto const& to : lanes) {
        auto const route = finder->shortest_route(from.id, to.id);
        double const expected = best[index_of(to.id)];
        REQUIRE(route.has_value() == (expected < infinity));
        if (!route) {
          ++none_there;
          continue;
        }
        ++routes;
        CHECK(route->lanes.front() == from.id);
        CHECK(route->lanes.back() == to.id);
        CHECK(cost_of(*finder, *route) == doctest::Approx(expected));
      }
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
  auto const finder = lanes.map();
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
    auto const route = lanes.map()->shortest_route(a, next);
    CHECK(route->lanes[1] == (detour < lane_change ? around : right));
  }
}

TEST_CASE("a route does not lead from a drivable lane onto another kind, but may begin there") {
  Lanes lanes;
  auto const a = lanes.add(10), parking = lanes.add(10), b = lanes.add(10);
  lanes.all[index_of(parking)].type = LaneType::parking;
  link(lanes.all, a, parking);
  link(lanes.all, parking, b);
  auto const finder = lanes.map();
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
  CHECK(lanes.map()->shortest_route(a, b)->lanes == std::vector<LaneId>{a, middle[0], b});
}

TEST_CASE("the k shortest routes are those that listing all simple paths gives") {
  int several = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    auto const made = random_lanes(seed, 9);
    auto const map = made.map();
    for (auto const& from : made.all)
      for (auto const& to : made.all) {
        auto const expected = all_costs(*map, from.id, to.id);
        RouteOptions options;
        options.max_routes = 12;
        auto const found = map->routes(from.id, to.id, options);
        REQUIRE(found.size() == std::min<std::size_t>(12, expected.size()));
        std::set<std::vector<LaneId>> distinct;
        for (std::size_t i = 0; i < found.size(); ++i) {
          CHECK(found[i].cost == doctest::Approx(expected[i]));
          CHECK(cost_of(*map, found[i]) + to.length() == doctest::Approx(found[i].cost));
          CHECK(std::set<LaneId>(found[i].lanes.begin(), found[i].lanes.end()).size() == found[i].lanes.size());
          distinct.insert(found[i].lanes);
        }
        CHECK(distinct.size() == found.size());
        several += found.size() > 3;
      }
  }
  CHECK(several > 500);
}

TEST_CASE("a route from a station costs the rest of the lane, one up to a station the part before it") {
  Lanes lanes;
  auto const a = lanes.add(100), b = lanes.add(50), right = lanes.add(200);
  put_beside(lanes.all, a, right);
  link(lanes.all, a, b);
  link(lanes.all, right, b);
  auto const map = lanes.map();
  auto const route = map->shortest_route(LaneStation{a, 70}, LaneStation{b, 20});
  REQUIRE(route.has_value());
  CHECK(route->lanes == std::vector<LaneId>{a, b});
  CHECK(route->length == doctest::Approx(50));
  CHECK(route->cost == doctest::Approx(50));
  // In the lane beside one is as far as in the own one.
  RouteOptions options;
  auto const all = map->routes(LaneStation{a, 70}, LaneStation{b, 20}, options);
  REQUIRE(all.size() == 2);
  CHECK(all[1].lanes == std::vector<LaneId>{a, right, b});
  CHECK(all[1].cost == doctest::Approx(10 + 0.3 * 200 + 20));
  CHECK(all[1].length == doctest::Approx(0.3 * 200 + 20));
  // Ahead on the own lane, and on the lane beside.
  CHECK(map->shortest_route(LaneStation{a, 70}, LaneStation{a, 90})->length == doctest::Approx(20));
  auto const beside = map->shortest_route(LaneStation{a, 70}, LaneStation{right, 180});
  REQUIRE(beside.has_value());
  CHECK(beside->cost == doctest::Approx(10 + 40));
  CHECK_FALSE(map->shortest_route(LaneStation{a, 70}, LaneStation{a, 60}).has_value());
  CHECK_FALSE(map->shortest_route(LaneStation{a, 70}, LaneStation{right, 60}).has_value());
  // Stations beyond a lane's ends count as its ends.
  CHECK(map->shortest_route(LaneStation{a, -7}, LaneStation{b, 900})->length == doctest::Approx(150));
}

TEST_CASE("a start behind its destination on the same lane leads round, where there is a way round") {
  Lanes lanes;
  auto const a = lanes.add(100), b = lanes.add(50), c = lanes.add(30);
  link(lanes.all, a, b);
  link(lanes.all, b, c);
  CHECK_FALSE(lanes.map()->shortest_route(LaneStation{a, 60}, LaneStation{a, 40}).has_value());
  link(lanes.all, c, a);
  auto const map = lanes.map();
  auto const route = map->shortest_route(LaneStation{a, 60}, LaneStation{a, 40});
  REQUIRE(route.has_value());
  CHECK(route->lanes == std::vector<LaneId>{a, b, c, a});
  CHECK(route->length == doctest::Approx(40 + 50 + 30 + 40));
  CHECK(map->shortest_route(LaneStation{a, 40}, LaneStation{a, 60})->lanes == std::vector<LaneId>{a});
  // A lane that leads into itself is a ring, too.
  Lanes ring;
  auto const only = ring.add(100);
  link(ring.all, only, only);
  CHECK(ring.map()->shortest_route(LaneStation{only, 60}, LaneStation{only, 40})->length == doctest::Approx(80));
}

TEST_CASE("a route passes its start's lane and its destination's again where only their other parts lead on") {
  Lanes lanes;
  auto const left = lanes.add(100), right = lanes.add(100), off = lanes.add(30);
  put_beside(lanes.all, left, right);
  link(lanes.all, left, left);
  link(lanes.all, right, right);
  link(lanes.all, left, off);
  lanes.all[index_of(right)].left_changes = {{0.0, 20.0}};
  lanes.all[index_of(left)].right_changes = {};
  auto const check = [&](LaneStation from, LaneStation to, std::vector<LaneId> const& way, double cost, double length) {
    auto const route = lanes.map()->shortest_route(from, to);
    REQUIRE(route.has_value());
    CHECK(route->lanes == way);
    CHECK(route->cost == doctest::Approx(cost));
    CHECK(route->length == doctest::Approx(length));
  };
  check({right, 50}, {left, 80}, {right, right, left}, 50 + lane_change + 80, 50 + 80);
  check({right, 50}, {off, 10}, {right, right, left, off}, 50 + lane_change + 100 + 10, 50 + 100 + 10);
  check({right, 10}, {left, 80}, {right, left}, lane_change + 70, 70);
  auto const reached = lanes.map()->reachable(LaneStation{right, 50}, infinity);
  REQUIRE(reached.size() == 3);
  CHECK(reached[0].cost == 0.0);
  CHECK(reached[1].lane == left);
  CHECK(reached[1].cost == doctest::Approx(50 + lane_change));
  CHECK(lanes.map()->reachable(LaneStation{right, 50}, 59.0).size() == 1);
  // The change comes behind the destination.
  lanes.all[index_of(right)].left_changes = {{40.0, 60.0}};
  check({right, 0}, {left, 20}, {right, left, left}, lane_change + 100 + 20, 100 + 20);
  // Other routes do not go round for nothing.
  RouteOptions lawless;
  lawless.obey_lane_marks = false;
  for (auto const& route : lanes.map()->routes(LaneStation{left, 50}, LaneStation{off, 10}, lawless))
    CHECK(std::count(route.lanes.begin(), route.lanes.end(), left) <= 2);
}

TEST_CASE("lanes are changed where marks permit it, unless they are not obeyed") {
  Lanes lanes;
  auto const a = lanes.add(100), right = lanes.add(100), next = lanes.add(50);
  put_beside(lanes.all, a, right);
  link(lanes.all, right, next);
  auto& changes = lanes.all[index_of(a)].right_changes;
  RouteOptions lawless;
  lawless.obey_lane_marks = false;
  auto const way = [&](double from, RouteOptions const& options = {}) {
    return lanes.map()->shortest_route(LaneStation{a, from}, LaneStation{next, 10}, options).has_value();
  };
  auto const to_beside = [&](double from, double to) {
    return lanes.map()->shortest_route(LaneStation{a, from}, LaneStation{right, to}).has_value();
  };
  CHECK(way(0));
  changes = {{20.0, 60.0}};
  CHECK(way(0));
  CHECK(way(50));
  CHECK_FALSE(way(70));
  CHECK(way(70, lawless));
  CHECK(to_beside(0, 30));
  CHECK_FALSE(to_beside(0, 10));
  CHECK_FALSE(to_beside(65, 90));
  changes = {};
  CHECK_FALSE(way(0));
  CHECK(way(0, lawless));
  RouteOptions none_at_all = lawless;
  none_at_all.lane_change_cost = infinity;
  CHECK_FALSE(way(0, none_at_all));
}

TEST_CASE("by time a longer way with a higher limit is taken, by an own cost whatever that says") {
  Lanes lanes;
  auto const a = lanes.add(10), slow = lanes.add(100), fast = lanes.add(200), b = lanes.add(20);
  for (auto const middle : {slow, fast}) {
    link(lanes.all, a, middle);
    link(lanes.all, middle, b);
  }
  lanes.all[index_of(slow)].speed_limits = {{0.0, 30.0}, {50.0, 5.0}};
  lanes.all[index_of(fast)].speed_limits = {{0.0, 40.0}};
  auto const map = lanes.map();
  RouteOptions options;
  CHECK(map->shortest_route(a, b, options)->lanes[1] == slow);
  options.cost = RouteCost::time;
  options.default_speed = 10.0;
  auto const by_time = map->shortest_route(a, b, options);
  CHECK(by_time->lanes[1] == fast);
  CHECK(by_time->cost == doctest::Approx(1.0 + 5.0 + 2.0));
  CHECK(by_time->length == doctest::Approx(230));
  CHECK(map->routes(a, b, options)[1].cost == doctest::Approx(1.0 + 50.0 / 30 + 10.0 + 2.0));
  options.own_cost = [slow](Lane const& lane) { return lane.id == slow ? 0.5 : 1.0; };
  CHECK(map->shortest_route(a, b, options)->cost == doctest::Approx(2.5));
  options.own_cost = [=](Lane const& lane) { return lane.id == slow || lane.id == fast ? infinity : 1.0; };
  CHECK_FALSE(map->shortest_route(a, b, options).has_value());
}

TEST_CASE("reachable lanes are those within the budget, with what it costs to come there") {
  int many = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    auto const made = random_lanes(seed, 30);
    auto const map = made.map();
    for (auto const& from : made.all) {
      auto const best = costs_by_relaxation(*map, from.id);
      for (double const budget : {0.0, 100.0, infinity}) {
        std::vector<std::pair<double, LaneId>> expected;
        for (auto const& lane : made.all) {
          double const cost = best[index_of(lane.id)];
          if (cost <= budget && cost < infinity) expected.emplace_back(cost, lane.id);
        }
        std::sort(expected.begin(), expected.end());
        auto const reached = map->reachable(from.id, budget);
        REQUIRE(reached.size() == expected.size());
        for (std::size_t i = 0; i < reached.size(); ++i) {
          CHECK(reached[i].lane == expected[i].second);
          CHECK(reached[i].cost == doctest::Approx(expected[i].first));
        }
        many += reached.size() > 10;
      }
    }
  }
  CHECK(many > 100);
}

TEST_CASE("reachable lanes from a station cost the rest of its lane") {
  Lanes lanes;
  auto const a = lanes.add(100), b = lanes.add(50);
  link(lanes.all, a, b);
  auto const reached = lanes.map()->reachable(LaneStation{a, 75}, 25.0);
  REQUIRE(reached.size() == 2);
  CHECK(reached[1].lane == b);
  CHECK(reached[1].cost == doctest::Approx(25));
  CHECK(lanes.map()->reachable(LaneStation{a, 75}, 24.0).size() == 1);
}

TEST_CASE("options out of range and costs that are none are said to be so") {
  Lanes lanes;
  auto const a = lanes.add(10), b = lanes.add(10);
  link(lanes.all, a, b);
  auto const map = lanes.map();
  double const nan = std::numeric_limits<double>::quiet_NaN();
  for (double const bad : {-1.0, nan}) {
    RouteOptions options;
    options.lane_change_cost = bad;
    CHECK_THROWS_AS((void)map->shortest_route(a, b, options), MapError);
    options = {};
    options.default_speed = bad;
    CHECK_THROWS_AS((void)map->shortest_route(a, b, options), MapError);
    options = {};
    options.own_cost = [bad](Lane const&) { return bad; };
    CHECK_THROWS_AS((void)map->shortest_route(a, b, options), MapError);
    CHECK_THROWS_AS((void)map->reachable(a, 1.0, options), MapError);
    CHECK_THROWS_AS((void)map->reachable(a, bad), MapError);
  }
  CHECK_THROWS_AS((void)map->shortest_route(LaneStation{a, nan}, LaneStation{b, 0}), MapError);
  CHECK_THROWS_AS((void)map->reachable(static_cast<LaneId>(2), 1.0), MapError);
  RouteOptions no_routes;
  no_routes.max_routes = 0;
  CHECK(map->routes(a, b, no_routes).empty());
  auto const said = support::error_of([&] { (void)map->shortest_route(a, static_cast<LaneId>(17)); });
  CHECK_MESSAGE(said.find("destination, lane 17") != std::string::npos, said);
  CHECK_THROWS_AS((void)map->shortest_route(none<LaneId>, a), MapError);
}

TEST_CASE("on real maps routes cost what a plain relaxation says, go with the traffic, and obey the marks or not") {
  int routes = 0;
  std::size_t maps = 0;
  bool const is_there = for_each_corpus_map([&](auto const&, Map const& map) {
    ++maps;
    Numbers random{maps};
    auto const any = [&] { return static_cast<LaneId>(random(0, static_cast<double>(map.lanes().size()) - 1e-9)); };
    for (int i = 0; i < 8; ++i) {
      RouteOptions const options{.obey_lane_marks = i < 4};
      auto const from = any();
      auto const expected = costs_by_relaxation(map, from, options.obey_lane_marks);
      auto const reached = map.reachable(from, infinity, options);
      std::size_t wrong = 0;
      for (auto const& r : reached) wrong += !(std::abs(r.cost - expected[index_of(r.lane)]) < 1e-6);
      CHECK(wrong == 0);
      CHECK(reached.size() == static_cast<std::size_t>(std::count_if(expected.begin(), expected.end(),
                                                                     [](double cost) { return cost < infinity; })));
      for (int j = 0; j < 5; ++j) {
        auto const to = j < 3 ? reached[static_cast<std::size_t>(any()) % reached.size()].lane : any();
        for (auto const& route : map.routes(from, to, options)) {
          ++routes;
          CHECK(cost_of(map, route, options.obey_lane_marks) < infinity);
          CHECK(route.cost >= doctest::Approx(expected[index_of(to)] + map.lane(to).length()));
        }
        auto const best = map.shortest_route(from, to, options);
        REQUIRE(best.has_value() == (expected[index_of(to)] < infinity));
        if (best) CHECK(best->cost == doctest::Approx(expected[index_of(to)] + map.lane(to).length()));
      }
    }
  });
  if (!is_there) return;
  CHECK(maps >= 28);
  CHECK(routes > 300);
}
