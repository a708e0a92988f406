#include "cambium/map/corridor/detail/built_corridors.hpp"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <future>
#include <vector>

#include <doctest/doctest.h>

#include "cambium/map/corridor/build_corridor.hpp"
#include "cambium/map/corridor/detail/make_road_corridor.hpp"
#include "lanes_by_hand.hpp"

using namespace by_hand;

namespace {

using Shared = std::shared_ptr<RoadCorridor const>;

/// A road of 50 lanes, one behind the other.
std::shared_ptr<Map const> long_road() {
  std::vector<Lane> lanes;
  for (int i = 0; i < 50; ++i) add_straight(lanes, {10.0 * i, 0, 0}, 10.0);
  for (std::size_t i = 1; i < lanes.size(); ++i) link(lanes, lanes[i - 1].id, lanes[i].id);
  return make_map(lanes);
}

/// All ways along it of two lanes or more.
std::vector<Route> routes_of(Map const& map) {
  std::vector<Route> routes;
  for (auto const& first : map.lanes()) {
    auto lanes = straight_route(map, first.id).lanes;
    for (; lanes.size() > 1; lanes.pop_back()) routes.push_back({lanes, 10.0 * static_cast<double>(lanes.size())});
  }
  return routes;
}

}  // namespace

TEST_CASE("the same route gives the same road corridor, that built anew too, while the map has not forgotten it") {
  auto const map = long_road();
  auto const routes = routes_of(*map);
  REQUIRE(routes.size() == 1225);
  auto const first = build_road_corridor(*map, routes[0]);
  CHECK(build_road_corridor(*map, routes[0]) == first);
  CHECK(first->route == routes[0].lanes);
  auto const anew = cambium::map::detail::make_road_corridor(*map, routes[0].lanes);
  CHECK(anew != first);
  CHECK(anew->corridors[0].center.samples().size() == first->corridors[0].center.samples().size());
  auto const* const unused = build_road_corridor(*map, routes[1]).get();
  CHECK(build_road_corridor(*map, routes[1]).get() == unused);
  CHECK(build_road_corridor(*long_road(), routes[0]) != first);  // another map has its own
}

TEST_CASE("road corridors in use are kept, and of the others those that were asked for last, as many as fit") {
  using namespace cambium::map::detail;
  auto const map = long_road();
  auto const routes = routes_of(*map);
  std::size_t const room = 20 * bytes_of(*make_road_corridor(*map, routes[0].lanes));  // the longest one
  BuiltCorridors built(room);
  auto const ask = [&](Route const& route) {
    auto const known = built.find(route.lanes);
    return known ? known : built.add(make_road_corridor(*map, route.lanes));
  };
  auto const in_use = ask(routes[0]);
  std::vector<std::weak_ptr<RoadCorridor const>> seen;
  for (auto const& route : routes) {
    seen.push_back(ask(route));
    (void)ask(routes[1]);  // again and again
    std::size_t const count = seen.size(), last = count - std::min<std::size_t>(count, 15);
    for (auto i = last; i < count; ++i) REQUIRE_FALSE(seen[i].expired());
    std::size_t kept = 0;
    for (auto const& road : seen)
      if (auto const still = road.lock(); still && still != in_use) kept += bytes_of(*still);
    REQUIRE(kept <= 2 * room + room / 10);  // those that have just come are in use
  }
  CHECK(seen[2].expired());
  CHECK_FALSE(seen[0].expired());
  CHECK_FALSE(seen[1].expired());
  CHECK(ask(routes[0]) == in_use);
  // However many are in use, none of them is built again; let go, they are forgotten as others come.
  std::vector<Shared> held;
  for (std::size_t i = 0; i < 600; ++i) held.push_back(ask(routes[i]));
  for (std::size_t i = 0; i < held.size(); ++i) REQUIRE(ask(routes[i]) == held[i]);
  seen.assign(held.begin() + 1, held.end());
  held.clear();
  for (std::size_t i = 600; i < routes.size(); ++i) (void)ask(routes[i]);
  for (auto const& road : seen) REQUIRE(road.expired());
}

TEST_CASE("threads that ask for the same roads at once get the same ones") {
  auto const map = long_road();
  auto const routes = routes_of(*map);
  std::vector<std::vector<Shared>> found(4);
  {
    std::vector<std::future<void>> threads;
    for (auto& mine : found)
      threads.push_back(std::async(std::launch::async, [&mine, &map, &routes] {
        for (auto const& route : routes) mine.push_back(build_road_corridor(*map, route));
      }));
  }
  for (auto const& mine : found) REQUIRE(mine == found[0]);
}
