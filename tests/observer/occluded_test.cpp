#include "cambium/observer/occluded.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <set>
#include <vector>

#include "cambium/behavior/pedestrian/pedestrian.hpp"
#include "cambium/map/road/curve_layout.hpp"
#include "observed_traffic.hpp"
#include "cambium/core/distributions.hpp"

using namespace fixtures;
using cb::geometry::Point;

namespace {

constexpr double pi = cb::geometry::pi;

/// Vehicles and objects anywhere on a plane.
struct Plane {
  std::vector<cb::State> states;
  std::vector<cb::geometry::Shape> shapes;
  cb::IdVector<cb::StaticObject, cb::Slot> things;

  [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(states.size()); }
  [[nodiscard]] bool in_traffic(cb::Slot) const { return true; }
  [[nodiscard]] cb::State const& state(cb::Slot i) const { return states[index_of(i)]; }
  [[nodiscard]] cb::geometry::Shape const& shape(cb::Slot i) const { return shapes[index_of(i)]; }
  [[nodiscard]] cb::IdVector<cb::StaticObject, cb::Slot> const& objects() const { return things; }
  [[nodiscard]] cb::geometry::OrientedBox box(std::uint32_t i) const {
    return cb::geometry::box_of(shapes[i], states[i]);
  }

  /// Those of vehicle `i`, or of an object behind the last vehicle.
  [[nodiscard]] std::vector<Point> corners(std::size_t i) const {
    if (i >= size()) {
      auto const outline = things[static_cast<cb::Slot>(i - size())].outline.points();
      return {outline.begin(), outline.end()};
    }
    auto const of_box = box(static_cast<std::uint32_t>(i)).corners();
    return {of_box.begin(), of_box.end()};
  }

  [[nodiscard]] bool is_free(cb::geometry::OrientedBox const& place) const {
    for (std::uint32_t i = 0; i < size(); ++i)
      if (cb::geometry::intersects(box(i), place)) return false;
    for (auto const& object : things)
      if (cb::geometry::intersects(place, object.outline)) return false;
    return true;
  }
};

double between(double low, double high, cb::RandomStream& random) { return cb::Uniform{low, high}(random); }

Plane sample(std::uint32_t number, std::size_t object_count = 2) {
  cb::RandomStream random(17, number, 0);
  Plane plane;
  std::vector<cb::geometry::Shape> const kinds{cb::geometry::car(), cb::geometry::truck(), cb::geometry::pedestrian()};
  while (plane.size() < 9) {
    cb::State const state{0, between(-30, 30, random), between(-30, 30, random), between(-7, 7, random), 0};
    auto const& shape = kinds[cb::uniform_index(random, 3)];
    if (!plane.is_free(cb::geometry::box_of(shape, state))) continue;
    plane.states.push_back(state);
    plane.shapes.push_back(shape);
  }
  while (plane.things.size() < object_count) {  // an L, not convex
    double const x = between(-30, 30, random), y = between(-30, 30, random);
    cb::geometry::Polygon const outline(
        {{x, y}, {x + 8, y}, {x + 8, y + 1}, {x + 1, y + 1}, {x + 1, y + 6}, {x, y + 6}});
    bool free = true;
    for (std::uint32_t i = 0; i < plane.size(); ++i) free = free && !cb::geometry::intersects(plane.box(i), outline);
    for (auto const& thing : plane.things) free = free && !cb::geometry::intersects(thing.outline, outline);
    if (free) plane.things.push_back({static_cast<cb::ObjectId>(plane.things.size()), outline});
  }
  return plane;
}

/// How far `edge` is along a ray; infinite where it does not meet it.
double hit(Point const& eye, Point const& ray, Point const& a, Point const& b) {
  Point const e = b - a, d = a - eye;
  double const det = e.x() * ray.y() - e.y() * ray.x();
  if (std::abs(det) < 1e-12) return std::numeric_limits<double>::infinity();
  double const t = (e.x() * d.y() - e.y() * d.x()) / det, u = (ray.x() * d.y() - ray.y() * d.x()) / det;
  return t >= 0 && u >= 0 && u <= 1 ? t : std::numeric_limits<double>::infinity();
}

/// By rays all around: how wide the widest clear stretch of each body appears from vehicle 0 [rad].
std::vector<double> widths_by_rays(Plane const& plane, cb::OccludedObserver const& observer, int rays) {
  auto const eye = plane.box(0).center();
  std::size_t const bodies = plane.size() + plane.things.size();
  std::vector<double> widest(bodies, 0.0), run(bodies, 0.0), first(bodies);
  for (int k = 0; k < 2 * rays; ++k) {  // twice around, for stretches across the end
    double const angle = 2 * pi * k / rays, infinite = std::numeric_limits<double>::infinity();
    Point const ray{std::cos(angle), std::sin(angle)};
    double vehicle = infinite, object = infinite;  // the nearest ones
    for (std::size_t i = 1; i < bodies; ++i) {
      auto const corners = plane.corners(i);
      first[i] = infinite;
      for (std::size_t c = 0; c < corners.size(); ++c)
        first[i] = std::min(first[i], hit(eye, ray, corners[c], corners[(c + 1) % corners.size()]));
      auto& nearest = i < plane.size() ? vehicle : object;
      nearest = std::min(nearest, first[i]);
    }
    bool const in_field =
        std::abs(std::remainder(angle - plane.states[0].heading, 2 * pi)) <= 0.5 * observer.field_of_view;
    for (std::size_t i = 1; i < bodies; ++i) {
      bool const clear = in_field && first[i] < infinite && (observer.behind_vehicles || first[i] <= vehicle) &&
                         (observer.behind_objects || first[i] <= object);
      run[i] = clear ? run[i] + 2 * pi / rays : 0.0;
      widest[i] = std::max(widest[i], run[i]);
    }
  }
  return widest;
}

struct Counts {
  int seen = 0, hidden = 0;
};

/// Of vehicles, or of static objects.
Counts compare(cb::OccludedObserver const& observer, bool objects = false) {
  constexpr int rays = 3600;
  constexpr double step = 2 * pi / rays;
  Counts counts;
  for (std::uint32_t number = 0; number < (objects ? 30u : 60u); ++number) {
    auto const plane = sample(number, objects ? 4 : 2);
    auto const widths = widths_by_rays(plane, observer, rays);
    for (std::uint32_t i = objects ? plane.size() : 1; i < (objects ? widths.size() : plane.size()); ++i) {
      CAPTURE(number);
      CAPTURE(i);
      bool const sees = objects ? observer.sees_object(plane, cb::Slot{}, cb::Slot{i - plane.size()})
                                : observer.sees(plane, cb::Slot{}, cb::Slot{i});
      double const distance = cb::geometry::distance(cb::geometry::Polygon(plane.corners(i)), plane.box(0).center());
      if (widths[i] > observer.resolution + 2 * step) CHECK(sees == (distance <= observer.range));
      if (widths[i] < observer.resolution - 2 * step) CHECK_FALSE(sees);
      ++(sees ? counts.seen : counts.hidden);
    }
  }
  return counts;
}

/// Agents of odd numbers are invisible to it.
struct SeesEven {
  static constexpr bool perfect = false;
  template <cb::MotionState S>
  [[nodiscard]] S const& observe(S const& truth, bool, cb::RandomStream const&) const {
    return truth;
  }
  template <class Scene>
  [[nodiscard]] bool sees(Scene const&, cb::Slot, cb::Slot other) const {
    return index_of(other) % 2 == 0;
  }
};

}  // namespace

TEST_CASE("intervals and rays hide the same agents") {
  auto const usual = compare({.resolution = 0.02});
  CHECK(usual.seen > 100);
  CHECK(usual.hidden > 100);
  compare({.resolution = 0.005, .behind_vehicles = true});
  compare({.resolution = 0.005, .behind_objects = true});
  auto const narrow = compare({.field_of_view = 2.0, .resolution = 0.01});
  CHECK(narrow.seen < usual.seen);
  CHECK(narrow.seen > 30);
  auto const wide = compare({.field_of_view = 5.5, .resolution = 0.01});
  CHECK(wide.seen > narrow.seen);
  CHECK(compare({.range = 20.0, .resolution = 0.01}).seen < usual.seen);
}

TEST_CASE("who stands over the eye hides nothing, and the next one does") {
  Plane plane;
  for (double const x : {0.0, 0.0, 30.0, 60.0}) plane.states.push_back({0, x, 0, 0, 0});
  plane.shapes = {cb::geometry::car(), cb::geometry::car(), cb::geometry::truck(), cb::geometry::car()};
  cb::OccludedObserver const observer;
  CHECK(observer.sees(plane, cb::Slot{0}, cb::Slot{2}));
  CHECK_FALSE(observer.sees(plane, cb::Slot{0}, cb::Slot{3}));
}

TEST_CASE("vehicles behind a truck are hidden, and the next visible one is the neighbour") {
  Observed<cb::OccludedObserver> world(straight_road(2, 1000.0));
  auto const ego = world.add({.position = {100, -1.75}, .speed = 10});
  auto const truck = world.add({.position = {120, -1.75}, .speed = 10, .shape = cb::geometry::truck()});
  auto const hidden = world.add({.position = {140, -1.75}, .speed = 10});
  auto const beside = world.add({.position = {135, -5.25}, .speed = 10});
  auto const seen = [&](cb::AgentId id) {
    std::set<cb::AgentId> others;
    for (auto const& [other, state] : seen_by(world, id)) others.insert(other);
    return others;
  };
  CHECK(seen(ego) == std::set{truck, beside});
  CHECK(seen(hidden) == std::set{truck, beside});
  CHECK(world.observe(ego).ahead()->agent == truck);
  CHECK(world.observe(truck).ahead()->agent == hidden);
  auto const prediction = world.observe(ego).predict(cb::predict_all_as<decltype(world)::Behaviors>(cb::IdmClassic{}));
  CHECK(prediction.size() == 3);
  CHECK_FALSE(prediction.roster().slot_of(hidden));

  // A wall between the lanes ahead hides the one beside, so that there is no neighbour there.
  auto const side = static_cast<cb::CorridorId>(1 - index_of(world.observe(ego).place().corridor));
  auto const next_beside = [&] {
    auto const view = world.observe(ego);
    return view.ahead(view.place(side));
  };
  CHECK(next_beside()->agent == beside);
  world.add_object(cb::geometry::Polygon({{105, -3.6}, {160, -3.6}, {160, -3.4}, {105, -3.4}}));
  CHECK(seen(ego) == std::set{truck});
  auto const front = next_beside();
  CHECK((!front || !cb::is_valid(front->agent)));
}

TEST_CASE(
    "beyond its range an agent drives as if nobody were there; the next one in range is found behind a hidden one") {
  Observed<cb::OccludedObserver> world(straight_road(1, 1000.0));
  auto const ego = world.add({.position = {100, -1.75}, .observer = {.range = 30.0, .field_of_view = 3.0}});
  world.add({.position = {140, -1.75}});
  CHECK_FALSE(world.observe(ego).ahead());
  world.add({.position = {90, -1.75}});
  CHECK_FALSE(world.observe(ego).behind());  // out of its field of view
}

TEST_CASE("a neighbour behind one that is not seen is found") {
  Observed<SeesEven> world(straight_road(2, 1000.0));
  for (int i = 0; i < 8; ++i) world.add({.position = {100 + 20.0 * i, -1.75}});
  auto const straddling = world.add({.position = {205, -3.3}});  // id 8
  auto const at = [&](std::uint32_t id) { return world.observe(static_cast<cb::AgentId>(id)); };
  CHECK(at(0).ahead()->agent == static_cast<cb::AgentId>(2));
  CHECK(at(0).ahead()->gap == doctest::Approx(40 - 4.5));
  CHECK(at(5).behind()->agent == static_cast<cb::AgentId>(4));
  CHECK(at(4).behind()->agent == static_cast<cb::AgentId>(2));
  CHECK(at(4).ahead()->agent == straddling);
  CHECK_FALSE(at(0).behind());
  auto const side = static_cast<cb::CorridorId>(1 - index_of(at(3).place().corridor));
  CHECK(at(3).ahead(at(3).place(side))->agent == straddling);
}

TEST_CASE("intervals and rays hide the same static objects") {
  auto const usual = compare({.resolution = 0.02}, true);
  CHECK(usual.seen > 50);
  CHECK(usual.hidden > 10);
  CHECK(compare({.resolution = 0.1}, true).hidden > usual.hidden);
  CHECK(compare({.resolution = 0.02, .behind_vehicles = true}, true).seen > usual.seen);
  compare({.resolution = 0.005, .behind_objects = true}, true);
  CHECK(compare({.field_of_view = 2.0, .resolution = 0.02}, true).seen < usual.seen);
  CHECK(compare({.range = 15.0, .resolution = 0.02}, true).seen < usual.seen);
  cb::OccludedObserver const knows{.range = 1.0, .objects_known = true};
  CHECK(knows.sees_object(sample(0), cb::Slot{0}, cb::Slot{1}));
}

TEST_CASE("an outline of many short edges is seen as one") {
  Plane plane;
  plane.states.push_back({});
  plane.shapes = {cb::geometry::car()};
  std::vector<Point> round;  // a bollard 3 m wide, whose edges are seen at 0.6 mrad or less
  for (int i = 0; i < 500; ++i)
    round.push_back({30.0 + 1.5 * std::cos(i * cb::geometry::pi / 250), 1.5 * std::sin(i * cb::geometry::pi / 250)});
  plane.things.push_back({.outline = cb::geometry::Polygon(round)});
  CHECK(cb::OccludedObserver{.resolution = 0.05}.sees_object(plane, cb::Slot{0}, cb::Slot{0}));
  CHECK_FALSE(cb::OccludedObserver{.resolution = 0.15}.sees_object(plane, cb::Slot{0}, cb::Slot{0}));
}

TEST_CASE("an object behind a truck is no neighbour, and in no prediction, until it is seen") {
  Observed<cb::OccludedObserver> world(straight_road(1, 1000.0));
  auto const ego = world.add({.position = {100, -1.75}, .speed = 10});
  auto const truck = world.add({.position = {120, -1.75}, .speed = 10, .shape = cb::geometry::truck()});
  auto const hidden = world.add_object(cb::geometry::Polygon({{150, -2.5}, {152, -2.5}, {152, -1.0}, {150, -1.0}}));
  auto const farther = world.add_object(cb::geometry::Polygon({{170, -9.5}, {172, -9.5}, {172, 9.0}, {170, 9.0}}));
  auto const seen = [&](auto view) {
    std::vector<cb::ObjectId> ids;
    view.for_each_object([&](cb::ObjectId id, cb::geometry::Polygon const&) { ids.push_back(id); });
    return ids;
  };
  CHECK(seen(world.observe(ego)) == std::vector{farther});
  CHECK(seen(world.observe(truck)) == std::vector{hidden, farther});
  CHECK(world.observe(truck).ahead()->object == hidden);
  std::vector<cb::ObjectId> near;
  auto const view = world.observe(ego);
  view.around(view.place(), 200.0, [&](auto const& other) {
    if (is_valid(other.object)) near.push_back(other.object);
  });
  CHECK(near == std::vector{farther});
  auto prediction = world.observe(ego).predict(cb::predict_all_as<decltype(world)::Behaviors>(cb::IdmClassic{}));
  REQUIRE(prediction.roster().objects.size() == 1);
  CHECK(prediction.roster().objects[0].id == farther);
  CHECK(prediction.observe(truck).ahead()->object == farther);
  world.remove(truck);
  CHECK(world.observe(ego).ahead()->object == hidden);
}

TEST_CASE("a ray meets the nearest side of a hull, or misses it") {
  std::vector<Point> const square{{4.5, -0.4}, {5.5, -0.4}, {5.5, 0.6}, {4.5, 0.6}};
  CHECK(cb::detail::distance_along(square, {0, 0}, {1, 0}) == doctest::Approx(4.5));
  CHECK(cb::detail::distance_along(square, {5, 0}, {1, 0}) == doctest::Approx(0.5));
  for (Point const& ray : {Point(-1, 0), Point(0, 1)})
    CHECK(cb::detail::distance_along(square, {0, 0}, ray) == std::numeric_limits<double>::infinity());
}

TEST_CASE("a view tells nothing of those that its observer does not see") {
  using Set = cb::BehaviorSet<cb::IdmClassic, cb::Pedestrian>;
  cb::World<Set, cb::InterpolateExecution, cb::SingleTrack, cb::OccludedObserver> world(support::map_of(
      {.id = "1", .line = cb::map::lay_from({}, {{400.0}}), .sections = {{.right = cb::map::equal_lanes(1, 7.0)}}}));
  auto const add_observer = [&](double x, double range) {
    return world.add({.position = {x, -3.5}, .observer = cb::OccludedObserver{.range = range}});
  };
  auto const near = add_observer(10.0, 30.0), far = add_observer(20.0, 400.0);
  world.add({.position = {150, -5.5}, .shape = cb::geometry::bicycle()});
  world.add({.position = {200, -3.5}, .shape = cb::geometry::truck()});
  world.add({.position = {250, 3.0},
             .shape = cb::geometry::pedestrian(),
             .behavior = cb::Pedestrian{},
             .way = {{250.0, 3.0}, {250.0, -12.0}}});
  REQUIRE(world.step(0.1));
  CHECK(world.observe(far).anybody_leaves_room());
  CHECK(world.observe(far).anybody_off_lanes());
  CHECK(world.observe(far).largest_shape().holds(cb::geometry::truck()));
  CHECK_FALSE(world.observe(near).anybody_leaves_room());
  CHECK_FALSE(world.observe(near).anybody_off_lanes());
  CHECK(world.observe(near).largest_shape() == cb::geometry::car());
}
