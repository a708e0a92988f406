// The traffic index against a brute-force twin that knows only the map's lanes, links and overlaps.
#include "cambium/world/traffic_index.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "cambium/core/distributions.hpp"
#include "fixtures.hpp"

using namespace fixtures;
using cb::LaneId;

namespace {

/// Somebody as the twin sees it: which lane, where on its path.
struct Somebody {
  std::uint32_t slot;
  LaneId lane;
  double s, front, rear;
};

/// Where `other` counts on a corridor: its position there, and up to where it leaves the road free.
struct Image {
  double s, free_until;
};

/// The lanes upstream of `lane` within `distance`, as (lane, distance from the end of that lane to the start of
/// `lane`).
void upstream(cb::Map const& map, LaneId lane, double distance, double so_far,
              std::vector<std::pair<LaneId, double>>& out) {
  if (so_far >= distance) return;
  for (auto const p : map.lane(lane).predecessors) {
    out.emplace_back(p, so_far);
    upstream(map, p, distance, so_far + map.lane(p).length(), out);
  }
}

std::vector<Image> images(cb::Map const& map, cb::map::LaneCorridor const& corridor, Somebody const& other) {
  double const infinite = std::numeric_limits<double>::infinity();
  std::vector<Image> result;
  auto const holds = [&](LaneId lane) {
    for (auto const& piece : corridor.pieces)
      if (piece.lane == lane) return true;
    return false;
  };
  for (auto const& piece : corridor.pieces)
    if (piece.lane == other.lane) result.push_back({piece.begin + other.s, -infinite});
  if (!result.empty()) return result;
  for (auto const& piece : corridor.pieces)
    for (auto const& overlap : map.lane(piece.lane).overlaps) {
      if (overlap.kind == cb::map::OverlapKind::crossing || holds(overlap.other)) continue;
      bool const merge = overlap.kind == cb::map::OverlapKind::merge;
      double const begin = piece.begin + overlap.begin;
      double const free_until = merge ? begin : -infinite;
      if (other.lane == overlap.other && other.s >= overlap.other_begin && other.s <= overlap.other_end) {
        double const u = (other.s - overlap.other_begin) / (overlap.other_end - overlap.other_begin);
        result.push_back({begin + u * (overlap.end - overlap.begin), free_until});
      }
      if (!merge) continue;
      double const view = map.options().merge_view;
      if (other.lane == overlap.other && other.s < overlap.other_begin && overlap.other_begin - other.s <= view)
        result.push_back({begin - (overlap.other_begin - other.s), free_until});
      std::vector<std::pair<LaneId, double>> lanes;
      upstream(map, overlap.other, view, overlap.other_begin, lanes);
      for (auto const& [lane, gap] : lanes)
        if (lane == other.lane && !holds(lane) && gap + map.lane(lane).length() - other.s <= view)
          result.push_back({begin - (gap + map.lane(lane).length() - other.s), free_until});
    }
  std::vector<std::pair<LaneId, double>> behind;
  upstream(map, corridor.pieces.front().lane, 100.0, 0.0, behind);
  for (auto const& [lane, gap] : behind)
    if (lane == other.lane && gap + map.lane(lane).length() - other.s <= 100.0)
      result.push_back({-(gap + map.lane(lane).length() - other.s), -infinite});
  return result;
}

/// Smallest gap over everybody (or `only` one) that is ahead (`sign` 1) or behind (-1) of the asker.
std::optional<double> brute_gap(cb::Map const& map, cb::map::LaneCorridor const& corridor, Somebody const& asker,
                                double s, std::vector<Somebody> const& all, int sign,
                                std::optional<std::uint32_t> only) {
  std::optional<double> best;
  for (auto const& other : all) {
    if (other.slot == asker.slot || (only && other.slot != *only)) continue;
    for (auto const& image : images(map, corridor, other)) {
      double const ahead = sign * (image.s - s);
      if (ahead < 0 || (ahead == 0 && (other.slot > asker.slot) != (sign > 0)) || ahead > cb::TrafficIndex::horizon)
        continue;
      double const gap = sign > 0
                             ? cb::TrafficIndex::gap_between(s + asker.front, image.s - other.rear, image.free_until)
                             : cb::TrafficIndex::gap_between(image.s + other.front, s - asker.rear, image.free_until);
      if (!best || gap < *best) best = gap;
    }
  }
  return best;
}

/// A world with agents thrown at random onto drivable lanes, without regard to each other. Their fronts
/// (`mixed_fronts`) or rears are of any length, the other end is the same for all: then the nearest ahead (behind) by
/// reference point also has the smallest gap.
Sim random_world(std::shared_ptr<cb::Map const> const& map, std::uint64_t seed, std::size_t agents, bool mixed_fronts) {
  Sim world(map, {.seed = seed});
  cb::RandomStream random(seed, 99, 0);
  std::vector<LaneId> lanes;
  for (auto const& lane : map->lanes())
    if (lane.drivable() && lane.length() > 2.0) lanes.push_back(lane.id);
  while (world.size() < agents) {
    auto const& lane =
        map->lane(lanes[static_cast<std::size_t>(cb::uniform01(random) * static_cast<double>(lanes.size()))]);
    auto const pose = lane.path.pose(cb::uniform01(random) * lane.length());
    double const length = 0.5 + 12.0 * cb::uniform01(random);
    world.add({.position = pose.position(),
               .heading = pose.heading,
               .speed = 20 * cb::uniform01(random),
               .shape = {mixed_fronts ? length : 3.0, mixed_fronts ? 1.0 : length, 0.9, 0.9},
               .route = cb::map::straight_route(*map, lane.id)});
  }
  return world;
}

std::vector<Somebody> everybody(Sim const& world) {
  std::vector<Somebody> all;
  for (std::uint32_t i = 0; i < world.size(); ++i) {
    auto const& agent = world.roster().agents[i];
    if (world.frame().agents[i].status != cb::AgentStatus::driving) continue;
    auto const at = world.situation(agent.id);
    all.push_back({i, at.lane, at.lane_position, agent.shape.front, agent.shape.rear});
  }
  return all;
}

/// Compares all agents' neighbours on their own corridors and on those beside; returns the number of neighbours
/// compared.
std::size_t compare(Sim& world, bool mixed_fronts) {
  auto const& map = world.map();
  auto const all = everybody(world);
  std::size_t compared = 0;
  for (auto const& asker : all) {
    auto const& agent = world.roster().agents[asker.slot];
    auto const view = world.observe(agent.id);
    for (std::uint16_t k = 0; k < agent.road->corridors.size(); ++k) {
      auto const& corridor = agent.road->corridors[k];
      auto const& state = world.frame().agents[asker.slot].state;
      double const s = k == view.lane_position().corridor
                           ? view.lane_position().s
                           : cb::map::locate(*agent.road, k, {state.x, state.y, state.heading}).s;
      for (int const sign : {1, -1}) {
        auto const found = sign > 0 ? view.front(k) : view.rear(k);
        auto const any = brute_gap(map, corridor, asker, s, all, sign, std::nullopt);
        CHECK(found.has_value() == any.has_value());
        if (!found || !any) continue;
        if (mixed_fronts == (sign > 0)) CHECK(found->gap == doctest::Approx(*any).epsilon(1e-9));
        auto const same = brute_gap(map, corridor, asker, s, all, sign,
                                    static_cast<std::uint32_t>(*world.roster().slot_of(found->agent)));
        REQUIRE(same.has_value());
        CHECK(found->gap == doctest::Approx(*same).epsilon(1e-9));
        ++compared;
      }
    }
  }
  return compared;
}

}  // namespace

TEST_CASE("front and rear neighbours equal those of a brute-force twin on thousands of random worlds") {
  std::size_t compared = 0;
  for (auto const* name : {"merging.xodr", "lane_drop.xodr", "highway.xodr"}) {
    auto const map = own_map(name);
    for (std::uint64_t seed = 0; seed < 700; ++seed) {
      bool const mixed_fronts = seed % 2 == 0;
      auto world = random_world(map, seed, 2 + seed % 23, mixed_fronts);
      compared += compare(world, mixed_fronts);
      if (seed % 7 != 0) continue;
      for (int k = 0; k < 10; ++k) world.step(0.2);  // the index repaired, not built
      compared += compare(world, mixed_fronts);
    }
  }
  MESSAGE(compared << " neighbours compared");
  CHECK(compared > 40000);
}

TEST_CASE("the nearest neighbour is the one with the smallest gap when nobody stands inside another") {
  // A follower 30 m behind a truck, which is 20 m behind a car: the truck is the leader, and the car's follower is the
  // truck.
  Sim world(straight_road(1, 500));
  auto const follower = world.add({.position = {50, -1.75}, .speed = 10});
  auto const truck = world.add({.position = {100, -1.75}, .speed = 10, .shape = cb::geometry::truck()});
  auto const car = world.add({.position = {130, -1.75}, .speed = 10});
  CHECK(world.observe(follower).front()->agent == truck);
  CHECK(world.observe(follower).front()->gap == doctest::Approx(50 - 3.6 - cb::geometry::truck().rear));
  CHECK(world.observe(car).rear()->agent == truck);
  CHECK(world.observe(car).rear()->gap == doctest::Approx(30 - 0.9 - cb::geometry::truck().front));
  CHECK_FALSE(world.observe(car).front().has_value());
  CHECK_FALSE(world.observe(follower).rear().has_value());
}
