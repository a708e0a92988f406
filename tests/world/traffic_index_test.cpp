// The traffic index against a brute-force twin that knows only the map's lanes, links and overlaps.
#include "cambium/world/traffic_index.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cambium/core/distributions.hpp"
#include "cambium/map/corridor/build_corridor.hpp"
#include "cambium/map/corridor/free_corridor.hpp"
#include "cambium/map/road/curve_layout.hpp"
#include "fixtures.hpp"

using namespace fixtures;
using cb::LaneId;
using cb::Slot;
using cb::geometry::Point;

namespace {

double const infinite = std::numeric_limits<double>::infinity();

double between(double low, double high, cb::RandomStream& random) { return low + (high - low) * cb::uniform01(random); }

/// Why somebody is in a lane: it drives there, it reaches over from the neighbouring lane, or it is an object.
enum class Kind { driving, reaching, object };

/// Somebody as the twin sees it: which lane, where on its path. One entry for each lane that it is in.
struct Somebody {
  Kind kind;
  Slot slot;  ///< among the agents or the objects
  LaneId lane;
  double s, front, rear, speed;
};

/// Where `other` counts on a corridor: its position there, and up to where it leaves the road free.
struct Image {
  double s, free_until;
  bool on_corridor;
};

/// The drivable lanes that lead to `lane` within `distance` but by way of `known`, as (lane, distance from the end of
/// that lane to the start of `lane`).
using Upstream = std::vector<std::pair<LaneId, double>>;
void upstream(cb::Map const& map, LaneId lane, LaneId known, double distance, double so_far, Upstream& out) {
  if (so_far >= distance) return;
  for (auto const p : map.lane(lane).predecessors) {
    if (p == known || !map.lane(p).drivable()) continue;
    out.emplace_back(p, so_far);
    upstream(map, p, cb::none<LaneId>, distance, so_far + map.lane(p).length(), out);
  }
}

/// Says where somebody counts on a corridor. By the rules of `build_road_corridor`: who is in one of its lanes, there;
/// and by the first of these rules that gives a place: beside an overlap; on the way to the corridor's begin (who is in
/// one of its lanes too: it may be a ring); on the
/// way into one of its lanes; on the way to an overlap where a lane merges in; within 30 m of its end.
class Twin {
 public:
  Twin(cb::Map const& map, cb::map::LaneCorridor const& corridor) : map_(map), corridor_(corridor) {
    double const view = map.options().merge_view;
    for (auto const& piece : corridor.pieces)
      for (auto const& overlap : map.lane(piece.lane).overlaps)
        if (counts(overlap)) add_beside(position(piece, overlap.begin), position(piece, overlap.end), overlap);
    add_upstream(corridor.pieces.front().lane, cb::none<LaneId>, 100.0, 0.0, 0.0, -infinite, true);
    for (std::size_t i = 0; i < corridor.pieces.size(); ++i) {
      auto const& piece = corridor.pieces[i];
      if (i > 0) add_upstream(piece.lane, corridor.pieces[i - 1].lane, view, 0.0, piece.begin, piece.begin, false);
      for (auto const& overlap : map.lane(piece.lane).overlaps) {
        if (!counts(overlap) || overlap.kind != cb::map::OverlapKind::merge) continue;
        double const begin = position(piece, overlap.begin);
        add_before(overlap.other, overlap.other_begin, view, begin, begin);
        add_upstream(overlap.other, cb::none<LaneId>, view, overlap.other_begin, begin, begin, false);
      }
    }
    add_downstream(corridor.pieces.back().lane, 30.0, corridor.length());
  }

  [[nodiscard]] std::vector<Image> images(LaneId lane, double s) const {
    std::vector<Image> result;
    for (auto const& piece : corridor_.pieces)
      if (piece.lane == lane) result.push_back({position(piece, s), -infinite, true});
    for (auto const& x : stretches_) {
      if (x.lane != lane || s < x.begin || s > x.end) continue;
      double const u = (s - x.begin) / (x.end - x.begin);
      result.push_back({x.image_begin + u * (x.image_end - x.image_begin), x.free_until, false});
      break;
    }
    return result;
  }

 private:
  /// A stretch of a lane and where it lies on the corridor.
  struct Stretch {
    LaneId lane;
    double begin, end, image_begin, image_end, free_until;
  };

  [[nodiscard]] double position(cb::map::CorridorPiece const& piece, double s) const {
    return map_.lane(piece.lane).index_begin + s - piece.index_offset;
  }

  [[nodiscard]] bool holds(LaneId lane) const {
    return std::any_of(corridor_.pieces.begin(), corridor_.pieces.end(),
                       [lane](auto const& piece) { return piece.lane == lane; });
  }

  [[nodiscard]] bool counts(cb::map::Overlap const& overlap) const {
    return overlap.kind != cb::map::OverlapKind::crossing && !holds(overlap.other);
  }

  void add_beside(double begin, double end, cb::map::Overlap const& overlap) {
    bool const merge = overlap.kind == cb::map::OverlapKind::merge;
    stretches_.push_back(
        {overlap.other, overlap.other_begin, overlap.other_end, begin, end, merge ? begin : -infinite});
  }

  /// The `view` m of `lane` before its position `end`.
  void add_before(LaneId lane, double end, double view, double image_end, double free_until) {
    double const length = std::min(view, end);
    if (length > 0) stretches_.push_back({lane, end - length, end, image_end - length, image_end, free_until});
  }

  void add_upstream(LaneId lane, LaneId known, double view, double so_far, double image_end, double free_until,
                    bool with_own) {
    Upstream lanes;
    upstream(map_, lane, known, view, so_far, lanes);
    for (auto const& [before, gap] : lanes)
      if (with_own || !holds(before))
        add_before(before, map_.lane(before).length(), view - gap, image_end - gap, free_until);
  }

  void add_downstream(LaneId lane, double view, double image_begin) {
    for (auto const id : map_.lane(lane).successors) {
      if (!map_.lane(id).drivable()) continue;
      double const length = std::min(view, map_.lane(id).length());
      stretches_.push_back({id, 0.0, length, image_begin, image_begin + length, -infinite});
      if (length < view) add_downstream(id, view - length, image_begin + length);
    }
  }

  cb::Map const& map_;
  cb::map::LaneCorridor const& corridor_;
  std::vector<Stretch> stretches_;
};

/// What the twin says of the neighbours on one side of the asker.
struct Answer {
  double least = infinite;                                ///< gap of whoever has the smallest
  std::pair<double, double> nearest{infinite, infinite};  ///< distance and gap of who is next by reference point
  std::vector<std::pair<Somebody const*, double>> gaps;
};

/// Everybody ahead of the asker (`sign` 1) or behind (-1).
Answer look(Twin const& twin, Somebody const& asker, double s, std::vector<Somebody> const& all, int sign) {
  Answer answer;
  for (auto const& other : all) {
    bool const is_object = other.kind == Kind::object;
    if (!is_object && other.slot == asker.slot) continue;
    for (auto const& image : twin.images(other.lane, other.s)) {
      double const ahead = sign * (image.s - s);
      if (ahead < 0 || (ahead == 0 && (other.slot > asker.slot) != (sign > 0)) || ahead > cb::Look::horizon) continue;
      double const gap = sign > 0 ? cb::gap_before_merge(s + asker.front, image.s - other.rear, image.free_until)
                                  : cb::gap_before_merge(image.s + other.front, s - asker.rear, image.free_until);
      answer.gaps.emplace_back(&other, gap);
      answer.least = std::min(answer.least, gap);
      if (image.on_corridor) answer.nearest = std::min(answer.nearest, {ahead, gap});
    }
  }
  return answer;
}

/// How a world is thrown.
struct Throw {
  std::size_t agents = 0, objects = 0;
  bool aside = false;           ///< agents beside their paths too, of any width
  double longest_object = 6.0;  ///< [m]
};

/// A world with agents and objects thrown at random onto drivable lanes, without regard to each other.
Sim random_world(std::shared_ptr<cb::Map const> const& map, std::uint64_t seed, Throw const& how) {
  Sim world(map, {.seed = seed});
  cb::RandomStream random(seed, 99, 0);
  std::vector<LaneId> lanes;
  for (auto const& lane : map->lanes())
    if (lane.drivable() && lane.length() > 2.0) lanes.push_back(lane.id);
  auto const any_place = [&](LaneId& id) {
    id = lanes[static_cast<std::size_t>(cb::uniform01(random) * static_cast<double>(lanes.size()))];
    auto const& lane = map->lane(id);
    return lane.path.pose(cb::uniform01(random) * lane.length());
  };
  LaneId lane;
  while (world.size() < how.agents) {
    auto const pose = any_place(lane);
    cb::geometry::Shape shape{between(0.5, 12.5, random), between(0.5, 12.5, random), 0.9, 0.9};
    double lateral = 0.0;
    if (how.aside) {
      lateral = world.size() % 4 == 0 ? 0.0 : between(-2.0, 2.0, random);
      shape.left = between(0.3, 1.9, random);
      shape.right = between(0.3, 1.9, random);
    }
    world.add({.position = cb::geometry::to_map(pose, {0.0, lateral}),
               .heading = pose.heading,
               .speed = between(0, 20, random),
               .shape = shape,
               .route = cb::map::straight_route(*map, lane)});
  }
  for (std::size_t i = 0; i < how.objects; ++i) {
    auto pose = any_place(lane);
    auto const center = cb::geometry::to_map(pose, {0.0, between(-3.0, 3.0, random)});
    double const heading = between(0.0, 3.2, random),
                 length = between(0.2, i % 2 == 0 ? how.longest_object : 6.0, random),
                 width = between(0.2, 3.0, random);
    cb::geometry::Pose const at{center.x(), center.y(), heading};
    std::vector<Point> outline;
    for (auto const& [x, y] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}})
      outline.push_back(cb::geometry::to_map(at, {x * length / 2, y * width / 2}));
    world.add_object(cb::geometry::Polygon(outline));
  }
  return world;
}

/// How far a box's corners reach from its reference point, seen along `direction`.
struct Reach {
  double front = -infinite, rear = -infinite, left = -infinite, right = -infinite;

  Reach(cb::geometry::Shape const& shape, double heading, double direction) {
    double const c = std::cos(heading - direction), s = std::sin(heading - direction);
    for (double const x : {shape.front, -shape.rear})
      for (double const y : {shape.left, -shape.right}) {
        front = std::max(front, c * x - s * y);
        rear = std::max(rear, s * y - c * x);
        left = std::max(left, s * x + c * y);
        right = std::max(right, -s * x - c * y);
      }
  }
};

/// The lanes beside `somebody`'s that an agent reaches into: where its corners are beyond its lane's border. Nearer
/// than 0.3 m to its path it follows that, unless it reaches more than 1.4 m aside. False where it has left its lane.
bool add_reached(cb::Map const& map, cb::State const& state, cb::geometry::Shape const& shape, Somebody somebody,
                 std::vector<Somebody>& all) {
  cb::geometry::Pose const at{state.x, state.y, state.heading};
  auto const& lane = map.lane(somebody.lane);
  auto const foot = lane.path.project(at.position());
  double const along = lane.path.pose(foot.s).heading;
  double const aslant = std::abs(std::remainder(at.heading - along, 2 * cb::geometry::pi));
  double const aside =
      std::abs(foot.lateral) + std::max(shape.left, shape.right) + aslant * std::max(shape.front, shape.rear);
  if (std::abs(foot.lateral) <= 0.3 && aside <= 1.4) return true;
  Reach const across(shape, at.heading, along);
  auto const room = lane.widths_at(somebody.s);
  if (foot.lateral + across.left <= -room.right || foot.lateral - across.right >= room.left) return false;
  somebody.kind = Kind::reaching;
  for (auto const& [beside, reaches] : {std::pair{lane.left_neighbor, foot.lateral + across.left > room.left},
                                        {lane.right_neighbor, across.right - foot.lateral > room.right}}) {
    if (!cb::is_valid(beside) || !reaches) continue;
    auto const& path = map.lane(beside).path;
    double const s = path.project(at.position()).s, along_there = path.pose(s).heading;
    Reach const there(shape, at.heading, along_there);
    somebody.speed = state.speed * std::cos(at.heading - along_there);
    somebody.lane = beside;
    somebody.s = std::clamp(s, 0.0, path.length());
    somebody.front = there.front;
    somebody.rear = there.rear;
    all.push_back(somebody);
  }
  return true;
}

/// From where to where an outline's points, `spacing` m apart at most, lie in a lane, or the lane's ends in it; nothing
/// where none does.
std::optional<std::pair<double, double>> reach(cb::map::Lane const& lane, cb::geometry::Polygon const& outline,
                                               double spacing) {
  std::pair<double, double> range{infinite, -infinite};
  for (std::size_t i = 0; i < outline.size(); ++i) {
    auto const [a, b] = outline.edge(i);
    auto const parts = std::max(1.0, std::ceil((b - a).norm() / spacing));
    for (double k = 0; k < parts; ++k) {
      auto const foot = lane.path.project(a + (b - a) * (k / parts));
      if (foot.s < 0 || foot.s > lane.length()) continue;
      auto const room = lane.widths_at(foot.s);
      if (foot.lateral > room.left || foot.lateral < -room.right) continue;
      range = {std::min(range.first, foot.s), std::max(range.second, foot.s)};
    }
  }
  for (double const s : {0.0, lane.length()})
    if (outline.contains(lane.path.pose(s).position())) range = {std::min(range.first, s), std::max(range.second, s)};
  if (range.first > range.second) return std::nullopt;
  return range;
}

std::vector<Somebody> everybody(Sim const& world) {
  std::vector<Somebody> all;
  auto const& map = world.map();
  for (Slot i{}; index_of(i) < world.size(); ++i) {
    auto const& agent = world.roster().agents[i];
    auto const& record = world.frame().agents[i];
    if (record.status != cb::AgentStatus::driving) continue;
    auto const at = world.situation(agent.id);
    Somebody const somebody{Kind::driving,
                            i,
                            at.lane,
                            at.lane_position,
                            agent.shape.front,
                            agent.shape.rear,
                            record.state.speed * std::cos(record.lane.heading_error)};
    cb::geometry::Pose const pose{record.state.x, record.state.y, record.state.heading};
    if (add_reached(map, record.state, agent.shape, somebody, all)) {
      all.push_back(somebody);
    } else if (auto const hit = map.nearest_lane(pose, 0.0)) {  // whoever has left its lane counts where it is
      auto const& path = map.lane(hit->lane).path;
      double const along = path.pose(hit->s).heading;
      Reach const there(agent.shape, pose.heading, along);
      all.push_back({Kind::reaching, i, hit->lane, std::clamp(hit->s, 0.0, path.length()), there.front, there.rear,
                     record.state.speed * std::cos(pose.heading - along)});
    }
  }
  auto const& objects = world.roster().objects;
  for (Slot i{}; index_of(i) < objects.size(); ++i)
    for (auto const& lane : map.lanes()) {
      if (!lane.drivable()) continue;
      if (auto const range = reach(lane, objects[i].outline, 0.1)) {
        double const length = range->second - range->first;
        int const parts = std::max(1, static_cast<int>(std::ceil(length / 10.0)));  // each counts by its own middle
        double const half = length / (2 * parts);
        for (int k = 0; k < parts; ++k)
          all.push_back({Kind::object, i, lane.id, range->first + (2 * k + 1) * half, half, half, 0.0});
      }
    }
  return all;
}

struct Count {
  std::size_t compared = 0;                      ///< neighbours
  std::size_t reaching = 0;                      ///< of them in another lane than their own
  std::size_t objects = 0;                       ///< of them
  std::size_t hidden = 0;                        ///< of them not the nearest by reference point on the corridor
  std::size_t lane_by_lane = 0, on_feeders = 0;  ///< see `compare_each_ahead`
};

/// Compares whom an agent finds ahead lane by lane with all road users on its corridor's feeders, asked one by one.
template <class View>
void compare_each_ahead(View const& view, Count& count) {
  std::vector<cb::RoadUser> each;
  view.each_ahead({}, [&](cb::RoadUser const& user) { each.push_back(user); });
  auto const next = view.ahead();
  REQUIRE(each.empty() == !next.has_value());
  if (!next) return;
  auto const nearest =
      std::min_element(each.begin(), each.end(), [](auto const& a, auto const& b) { return a.gap < b.gap; });
  CHECK(nearest->gap == next->gap);
  count.lane_by_lane += each.size();
  double const s = view.place().s, front = s + view.shape().front;
  for (auto const& feeder : view.corridor().feeders)
    view.on_lane(feeder.index_begin, feeder.index_end, [&](cb::RoadUser const& user) {
      double const image = feeder.image(user.s);
      if (user.s < feeder.index_begin || user.s > feeder.index_end || image <= s || image > s + cb::Look::horizon)
        return;
      double const gap = cb::gap_before_merge(front, image - user.rear, feeder.free_until);
      bool const is_covered = std::ranges::any_of(each, [&](cb::RoadUser const& found) {
        return found.gap <= gap + 1e-6 && found.s >= feeder.begin - 1e-6 && found.s <= feeder.end + 1e-6;
      });
      CHECK(is_covered);
      ++count.on_feeders;
    });
}

/// Compares all agents' neighbours on their own corridors and on those beside.
void compare(Sim& world, Count& count) {
  auto const& map = world.map();
  auto const all = everybody(world);
  std::map<cb::map::LaneCorridor const*, Twin> twins;
  for (auto const& asker : all) {
    if (asker.kind != Kind::driving) continue;
    auto const& agent = world.roster().agents[asker.slot];
    auto const view = world.observe(agent.id);
    compare_each_ahead(view, count);
    for (cb::CorridorId k{}; index_of(k) < agent.road->corridors.size(); ++k) {
      auto const& corridor = agent.road->corridors[k];
      auto const& twin = twins.try_emplace(&corridor, map, corridor).first->second;
      auto const& state = world.frame().agents[asker.slot].state;
      double const s = k == view.place().corridor
                           ? view.place().s
                           : cb::map::locate(*agent.road, k, {state.x, state.y, state.heading}).s;
      for (int const sign : {1, -1}) {
        auto const found = sign > 0 ? view.ahead(view.place(k)) : view.behind(view.place(k));
        auto const answer = look(twin, asker, s, all, sign);
        CAPTURE(map.describe(asker.lane));
        CAPTURE(state.x);
        CAPTURE(state.y);
        CAPTURE(k);
        CAPTURE(sign);
        CHECK(found.has_value() == !answer.gaps.empty());
        if (!found || answer.gaps.empty()) continue;
        CHECK(std::abs(found->gap - answer.least) < 1e-6);
        bool const is_object = !cb::is_valid(found->agent);
        Kind kind = Kind::driving;
        bool is_known = false;
        for (auto const& [other, gap] : answer.gaps) {
          bool const same = is_object
                                ? other->kind == Kind::object && world.roster().objects[other->slot].id == found->object
                                : other->kind != Kind::object && world.roster().agents[other->slot].id == found->agent;
          if (!same || std::abs(gap - found->gap) > 1e-6) continue;
          is_known = true;
          kind = other->kind;
          CHECK(found->speed == doctest::Approx(other->speed).epsilon(1e-9));
        }
        CHECK(is_known);
        ++count.compared;
        count.reaching += kind == Kind::reaching;
        count.objects += kind == Kind::object;
        count.hidden += answer.nearest.first < infinite && answer.nearest.second > answer.least + 1e-6;
      }
    }
  }
}

/// `worlds` random worlds on the map of that name, some of them stepped: then the index is repaired, not built.
Count compare_many(std::string const& name, std::shared_ptr<cb::Map const> const& map, std::uint64_t worlds,
                   std::size_t most_agents, bool aside = true) {
  CAPTURE(name);
  Count count;
  for (std::uint64_t seed = 0; seed < worlds; ++seed) {
    Throw const how{2 + seed % most_agents, seed % 3 == 0 ? 0 : seed % 5, aside && seed % 4 != 0, 40.0};
    auto world = random_world(map, seed, how);
    compare(world, count);
    if (seed % 7 != 0) continue;
    for (int k = 0; k < 10; ++k) REQUIRE(world.step(0.2));
    compare(world, count);
  }
  MESSAGE(name << ": " << count.compared << " neighbours compared, " << count.reaching << " of them reaching over, "
               << count.objects << " objects; " << count.hidden << " not next by reference point");
  return count;
}

}  // namespace

TEST_CASE("an index prepared for many searches gives the same answers") {
  for (std::uint32_t seed = 0; seed < 200; ++seed) {
    CAPTURE(seed);
    cb::RandomStream random(seed, 31, 0);
    auto const count = cb::uniform_index(random, 60);
    double const spread = std::pow(10.0, between(-1.0, 4.0, random)), outlier = between(0.0, 1.0, random);
    cb::TrafficIndex plain;
    plain.refresh(
        count,
        [&](Slot slot, cb::ReachingEntries&) {
          double position = 1000.0 + std::floor(between(0.0, spread, random));  // some are in the same place
          if (cb::uniform01(random) < 0.1) position = outlier < 0.5 ? infinite : 1e6;
          return cb::TrafficEntry{position, between(0.3, 9.0, random),       between(0.3, 9.0, random), 5.0,
                                  slot,     static_cast<std::uint32_t>(slot)};
        },
        [](Slot) {
          return cb::LaneStretch{0.0, 1e6};
        });
    auto prepared = plain;
    prepared.expect_searches();
    auto const found = [](cb::TrafficIndex const& index, double begin, double end) {
      std::vector<Slot> slots;
      index.for_each_in(begin, end, {}, [&](cb::TrafficEntry const& entry, bool) { slots.push_back(entry.slot); });
      return slots;
    };
    for (int i = 0; i < 50; ++i) {
      double const begin = std::floor(between(950.0, 1100.0 + 1.1 * spread, random)),
                   end = begin + between(0.0, 40.0, random);
      CHECK(found(plain, begin, end) == found(prepared, begin, end));
    }
    CHECK(found(plain, 0.0, 2e6) == found(prepared, 0.0, 2e6));
  }
}

TEST_CASE("front and rear neighbours equal those of a brute-force twin on thousands of random worlds") {
  for (std::string const name : {"merging.xodr", "lane_drop.xodr", "highway.xodr"}) {
    auto const count = compare_many(name, own_map(name), 700, 23);
    CHECK(count.compared > 10000);
    CHECK(count.reaching > 500);
    CHECK(count.objects > 500);
    CHECK(count.hidden > 200);
    CHECK(count.lane_by_lane > 5000);
    if (name != "highway.xodr") CHECK(count.on_feeders > 500);
  }
}

TEST_CASE("so they do on maps of real merges and of a town") {
  for (std::string const name : {"DR_CHN_Merging_ZS_partial_v02.xodr", "DR_DEU_Merging_MT_v01_shifted.xodr",
                                 "fabriksgatan.xodr", "multi_intersections.xodr"}) {
    auto const map = corpus_map(name);
    if (!map) continue;
    auto const count = compare_many(name, map, 100, 40, name.starts_with("DR_"));  // the twin knows no oncoming lanes
    CHECK(count.compared > 1000);
    CHECK(count.objects > 50);
  }
}

TEST_CASE("objects are in the lanes that their outlines reach into, to half a metre") {
  std::size_t compared = 0;
  for (auto const* name : {"merging.xodr", "lane_drop.xodr", "highway.xodr"}) {
    auto const map = own_map(name);
    for (std::uint64_t seed = 0; seed < 30; ++seed) {
      auto const world = random_world(map, seed, {.objects = 5});
      for (Slot i{}; index_of(i) < 5; ++i)
        for (auto const& lane : map->lanes()) {
          if (!lane.drivable()) continue;
          auto const range = reach(lane, world.roster().objects[i].outline, 0.01);
          cb::TrafficEntry const* entry = nullptr;
          for (auto const& e : world.roster().object_entries)
            if (e.slot == i && e.position >= lane.index_begin && e.position <= lane.index_begin + lane.length())
              entry = &e;
          CAPTURE(name);
          CAPTURE(map->describe(lane.id));
          if (!entry) {
            if (!range) continue;
            auto const room = lane.widths_at(range->second);
            CHECK(std::min(range->second - range->first, room.left + room.right) < 0.1);  // it hardly reaches in
            continue;
          }
          REQUIRE(range.has_value());
          double const at = entry->position - lane.index_begin;
          CHECK(at - entry->rear >= range->first - 0.02);
          CHECK(at - entry->rear <= range->first + 0.1);
          CHECK(at + entry->front <= range->second + 0.02);
          CHECK(at + entry->front >= range->second - 0.1);
          ++compared;
        }
    }
  }
  CHECK(compared > 400);
}

TEST_CASE("an agent off the road is not a leader, and one in another lane is seen there") {
  auto const map = support::map_of({.line = cb::map::lay_from({}, {{500.0}}),
                                    .sections = {{.left = cb::map::equal_lanes(1), .right = cb::map::equal_lanes(1)}}});
  Sim world(map);
  auto const follower = world.add({.position = {50, -1.75}, .speed = 10});
  auto const other = world.add({.position = {100, -1.75}, .speed = 5});
  auto const oncoming = world.add({.position = {200, 1.75}, .heading = cb::geometry::pi, .speed = 10});
  CHECK(world.observe(follower).ahead()->agent == other);
  CHECK_FALSE(world.observe(oncoming).ahead().has_value());

  world.set_state(other, {.x = 100, .y = -8, .speed = 5});
  CHECK_FALSE(world.observe(follower).ahead().has_value());
  CHECK_FALSE(world.observe(other).ahead().has_value());

  world.set_state(other, {.x = 100, .y = 1.75, .speed = 5});  // in the oncoming lane, the wrong way round
  CHECK_FALSE(world.observe(follower).ahead().has_value());
  auto const front = world.observe(oncoming).ahead();
  REQUIRE(front.has_value());
  CHECK(front->agent == other);
  CHECK(front->gap == doctest::Approx(100 - 3.6 - 3.6));
  CHECK(front->speed == doctest::Approx(-5.0));

  world.set_state(other, {.x = 100, .y = -0.5, .speed = 5});  // half of it over the middle
  CHECK(world.observe(follower).ahead()->agent == other);
  CHECK(world.observe(oncoming).ahead()->agent == other);
}

TEST_CASE("a long vehicle that stands aslant is seen in the lane that its front reaches into") {
  Sim world(straight_road(2, 500));
  auto const truck = world.add({.position = {100, -5.25}, .shape = cb::geometry::truck()});
  auto const follower = world.add({.position = {50, -1.75}, .speed = 10});
  CHECK_FALSE(world.observe(follower).ahead().has_value());
  world.set_state(truck, {.x = 100, .y = -5.25, .heading = 0.25, .speed = 0});
  REQUIRE(world.observe(follower).ahead().has_value());
  CHECK(world.observe(follower).ahead()->agent == truck);
}

TEST_CASE("of two objects beside each other in a lane, the one that reaches nearer counts, also of a long one") {
  struct Pair {
    double begin, end;  ///< of the one on the left [m]
    double post;        ///< begin of the one on the right, 0.4 m long
  };
  for (auto const& [begin, end, post] : {Pair{200, 210, 204}, {100, 140, 104}, {100, 140, 134}}) {
    Sim world(straight_road(1, 600));
    auto const block = [&world](double from, double to, double right, double left) {
      return world.add_object(cb::geometry::Polygon({{from, right}, {to, right}, {to, left}, {from, left}}));
    };
    auto const wall = block(begin, end, -1.0, -0.5);
    block(post, post + 0.4, -3.0, -2.5);
    auto const front = world.observe(world.add({.position = {50, -1.75}})).ahead();
    REQUIRE(front);
    CHECK(front->object == wall);
    CHECK(front->gap == doctest::Approx(begin - 50 - cb::geometry::car().front).epsilon(1e-3));
    auto const rear = world.observe(world.add({.position = {300, -1.75}})).behind();
    REQUIRE(rear);
    CHECK(rear->object == wall);
    CHECK(rear->gap == doctest::Approx(300 - cb::geometry::car().rear - end).epsilon(1e-3));
  }
}

TEST_CASE("of two vehicles side by side within a lane, the one that reaches nearer counts, also over a lane's end") {
  auto const truck = cb::geometry::articulated_truck();
  auto const motorcycle = cb::geometry::motorcycle();
  auto const map = support::map_of(
      {.line = cb::map::lay_from({}, {{400.0}}),
       .sections = {{.right = cb::map::equal_lanes(1)}, {.s = 200.0, .right = cb::map::equal_lanes(1)}}});
  for (double const x : {100.0, 195.0, 199.8, 200.3, 203.0}) {
    Sim world(map);
    auto const large = world.add({.position = {x, -1.3}, .shape = truck});
    auto const behind = world.add({.position = {20, -1.75}}), ahead = world.add({.position = {300, -1.75}});
    auto const small = world.add({.position = {x - 0.5, -3.07}, .shape = motorcycle});
    REQUIRE(world.observe(behind).ahead());
    CHECK(world.observe(behind).ahead()->agent == large);
    CHECK(world.observe(behind).ahead()->gap == doctest::Approx(x - truck.rear - 20 - cb::geometry::car().front));
    world.set_state(small, {.x = x + 0.5, .y = -3.07});
    REQUIRE(world.observe(ahead).behind());
    CHECK(world.observe(ahead).behind()->agent == large);
    CHECK(world.observe(ahead).behind()->gap == doctest::Approx(300 - cb::geometry::car().rear - x - truck.front));
  }
}

/// Puts the agent into a state that `set_state` refuses: against the direction of its route.
void turn_round(Sim& world, cb::AgentId id, cb::State const& state) {
  auto const slot = world.slot_of(id);
  auto frame = world.frame();
  auto& record = frame.agents[slot];
  record.state = state;
  record.lane = cb::map::locate(*world.roster().agents[slot].road, record.lane.corridor,
                                {state.x, state.y, state.heading}, record.lane);
  world.restore(frame);
}

TEST_CASE("the same holds where the larger vehicle has changed lanes and reaches over the end of its new lane") {
  auto const truck = cb::geometry::articulated_truck();
  auto const motorcycle = cb::geometry::motorcycle();
  auto const one_each_way = [](double s) {
    return cb::map::SectionPlan{.s = s, .left = cb::map::equal_lanes(1), .right = cb::map::equal_lanes(1)};
  };
  auto const map =
      support::map_of({.line = cb::map::lay_from({}, {{400.0}}), .sections = {one_each_way(0.0), one_each_way(200.0)}});
  Count count;
  for (double x = 180.0; x <= 206.0; x += 0.5)
    for (double const ahead : {-2.5, -0.5, 0.5, 3.5}) {
      Sim world(map);
      auto const large = world.add({.position = {x, 1.75}, .heading = cb::geometry::pi, .shape = truck});
      turn_round(world, large, {.x = x, .y = -1.3});
      world.add({.position = {x + ahead, -3.07}, .shape = motorcycle});
      auto const behind = world.add({.position = {20, -1.75}}), before = world.add({.position = {30, -1.75}});
      world.set_state(before, {.x = 300, .y = -1.75});  // on a corridor that both lanes are pieces of
      CAPTURE(x);
      CAPTURE(ahead);
      compare(world, count);
      REQUIRE(world.observe(behind).ahead());
      CHECK(world.observe(behind).ahead()->agent == large);
      REQUIRE(world.observe(before).behind());
      CHECK(world.observe(before).behind()->agent == large);
    }
  CHECK(count.reaching > 200);
  CHECK(count.hidden > 50);
}

TEST_CASE("a vehicle that reaches over the border does not hide a nearer one") {
  auto const car = cb::geometry::car();
  auto const bus = cb::geometry::bus();
  REQUIRE(bus.rear > car.rear + 0.5);
  // The middle lane's centre is at y = -5.25; the bus stands there, a car beside it reaches 5 cm into that lane.
  double const beside = -3.5 + car.right - 0.05;
  Sim world(straight_road(3, 400));
  auto const ahead = world.add({.position = {100, -5.25}});
  auto const large = world.add({.position = {203, -5.25}, .shape = bus});
  world.add({.position = {202.9, beside}});
  auto const behind = world.add({.position = {300, -5.25}});
  auto const front = world.observe(ahead).ahead();
  REQUIRE(front);
  CHECK(front->agent == large);
  CHECK(front->gap == doctest::Approx(203 - bus.rear - 100 - car.front));
  world.set_state(world.roster().agents[2].id, {.x = 203.1, .y = beside});
  auto const rear = world.observe(behind).behind();
  REQUIRE(rear);
  CHECK(rear->agent == large);
  CHECK(rear->gap == doctest::Approx(300 - car.rear - 203 - bus.front));
}

TEST_CASE("a vehicle that only reaches over into a merging lane does not count as merging") {
  auto const map = own_map("lane_drop.xodr");
  auto const place = [&map](int lane, double s, double right) {
    auto const p = map->lane(map->find_lane("1", s, lane)).path.pose(s);
    return cb::geometry::Pose{p.x + right * std::sin(p.heading), p.y - right * std::cos(p.heading), p.heading};
  };
  Sim world(map);
  auto const enter = [&](cb::geometry::Pose const& pose) {
    return world.add({.position = pose.position(), .heading = pose.heading});
  };
  auto const ego = enter(place(-2, 330, 0.0));
  auto const view = world.observe(ego);
  auto const& feeders = view.corridor().feeders;
  REQUIRE_FALSE(feeders.empty());
  double const merge = feeders.front().free_until;
  auto const beside = enter(place(-2, 380, 1.2));  // its own lane's, 23 cm over the border
  CHECK_FALSE(world.observe(ego).merging(merge, infinite));
  auto const from_ramp = enter(place(-3, 350, 0.0));
  auto const next = world.observe(ego).merging(merge, infinite);
  REQUIRE(next);
  CHECK(next->agent == from_ramp);
  auto const ramp_view = world.observe(from_ramp);
  REQUIRE(ramp_view.ahead());
  CHECK(ramp_view.ahead()->agent == beside);  // whom those behind it in the ramp's lane follow
}

TEST_CASE("who crosses a merging lane on foot is ahead of those in that lane, but not of those in the lane beside") {
  auto const map = own_map("lane_drop.xodr");
  auto const place = [&map](int lane, double s) { return map->lane(map->find_lane("1", s, lane)).path.pose(s); };
  Sim world(map);
  auto const enter = [&](cb::geometry::Pose const& pose) {
    return world.add({.position = pose.position(), .heading = pose.heading});
  };
  auto const beside = enter(place(-2, 330)), in_lane = enter(place(-3, 330));
  auto const at = place(-3, 350);
  std::vector<cb::geometry::Point> const way{at.position(), at.position() + cb::geometry::Point(0.0, 5.0)};
  auto const walker = world.add(
      {.position = way.front(), .shape = cb::geometry::pedestrian(), .road = cb::map::build_free_corridor(*map, way)});
  CHECK_FALSE(world.observe(beside).ahead());
  REQUIRE(world.observe(in_lane).ahead());
  CHECK(world.observe(in_lane).ahead()->agent == walker);
}

TEST_CASE("the agents around a place are in its lane corridor, not in lanes whose coordinates follow") {
  auto const map = own_map("intersection_4way.xodr");
  cb::World<cb::BehaviorSet<cb::IdmClassic>, cb::InterpolateExecution, cb::SingleTrack> world(map);
  for (auto const& lane : map->lanes())
    for (double s = 8.0; lane.drivable() && s < lane.length(); s += 30.0) {
      auto const pose = lane.path.pose(s);
      world.add({.position = pose.position(), .heading = pose.heading, .speed = 5.0});
    }
  int found = 0;
  for (auto const& agent : world.roster().agents) {
    auto const view = world.observe(agent.id);
    for (auto const& [left, number] : {std::pair{false, view.place().corridor},
                                       std::pair{true, view.corridor().pieces[view.place().piece].beside(true)}}) {
      if (number == cb::none<cb::CorridorId>) continue;
      auto const& corridor = view.road().corridors[number];
      view.around(view.place(number), 80.0, [&](cb::RoadUser const& other) {
        double const index = world.record(other.agent).lane.index;
        for (auto const& feeder : corridor.feeders)
          if (index >= feeder.index_begin && index <= feeder.index_end) return;
        auto const there = corridor.center.pose(other.s).position();
        CHECK(std::hypot(view.state(other).x - there.x(), view.state(other).y - there.y()) < 4.0);
        ++found;
      });
    }
  }
  CHECK(found > 200);
}
