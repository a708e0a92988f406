// Collision evaluators against a twin that compares every pair of boxes.
#include "cambium/evaluation/collision.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "../support/allocations.hpp"
#include "../world/fixtures.hpp"
#include "cambium/core/distributions.hpp"

using namespace fixtures;
using cb::AgentId;
using cb::AgentStatus;

namespace {

cb::geometry::Polygon rectangle(double x, double y, double length, double width) {
  std::vector<cb::geometry::Point> const points{{x, y}, {x + length, y}, {x + length, y + width}, {x, y + width}};
  return cb::geometry::Polygon(points);
}

/// Where agents of a random frame are: in an area of `length` by `width` m, turned by `heading`.
struct Scene {
  std::size_t agents;
  double length, width, heading;
  std::size_t objects = 0;
};

double between(double low, double high, cb::RandomStream& random) { return low + (high - low) * cb::uniform01(random); }

/// A world put together from its parts: agents anywhere, some of them departed. Ids are not slots.
Sim random_world(std::shared_ptr<cb::Map const> const& map, Scene const& scene, std::uint32_t number) {
  cb::RandomStream random(11, number, 0);
  auto roster = std::make_shared<Sim::RosterType>();
  Sim::FrameType frame;
  cb::geometry::Pose const area{between(-1e4, 1e4, random), between(-1e4, 1e4, random), scene.heading};
  cb::geometry::Shape const shapes[] = {
      cb::geometry::car(), cb::geometry::truck(), cb::geometry::pedestrian(), {1.0, 0.2, 2.5, 0.1}};
  for (std::uint32_t i = 0; i < scene.agents; ++i) {
    Sim::RosterType::Agent agent{};
    agent.id = static_cast<AgentId>(3 * i + 1);
    agent.shape = shapes[cb::uniform_index(random, 4)];
    roster->agents.push_back(agent);
    roster->goals.emplace_back();
    auto const at = cb::geometry::to_map(area, {between(0, scene.length, random), between(0, scene.width, random)});
    Sim::Record record{};
    record.state = {0, at.x(), at.y(), scene.heading + between(-4, 4, random), 0};
    if (cb::uniform_index(random, 5) == 0) record.status = static_cast<AgentStatus>(1 + cb::uniform_index(random, 5));
    frame.agents.push_back(record);
  }
  for (std::uint32_t i = 0; i < scene.objects; ++i) {
    auto const at = cb::geometry::to_map(area, {between(0, scene.length, random), between(0, scene.width, random)});
    roster->objects.push_back({static_cast<cb::ObjectId>(i), rectangle(at.x(), at.y(), 1.5, 0.8)});
  }
  return Sim(map, std::move(roster), std::move(frame));
}

cb::geometry::OrientedBox box_of(Sim const& world, cb::Slot slot) {
  return cb::geometry::box_of(world.roster().agents[slot].shape, world.frame().agents[slot].state);
}

bool drives(Sim const& world, cb::Slot slot) { return world.frame().agents[slot].status == AgentStatus::driving; }

bool touch(Sim const& world, cb::Slot i, cb::Slot k) {
  return drives(world, i) && drives(world, k) && cb::geometry::intersects(box_of(world, i), box_of(world, k));
}

bool touches_object(Sim const& world, cb::Slot slot) {
  if (!drives(world, slot)) return false;
  for (auto const& object : world.roster().objects)
    if (cb::geometry::intersects(box_of(world, slot), object.outline)) return true;
  return false;
}

/// First other agent, by id, that this one touches.
std::optional<AgentId> first_touched(Sim const& world, cb::Slot slot) {
  for (cb::Slot k{}; index_of(k) < world.size(); ++k)
    if (k != slot && touch(world, slot, k)) return world.roster().agents[k].id;
  return std::nullopt;
}

bool brute_any(Sim const& world) {
  for (cb::Slot i{}; index_of(i) < world.size(); ++i)
    if (touches_object(world, i) || first_touched(world, i)) return true;
  return false;
}

/// True when the pair that is named does touch.
bool is_true_pair(Sim const& world, cb::AnyCollision::Pair const& found) {
  auto const first = world.slot_of(found.first);
  return cb::is_valid(found.second) ? touch(world, first, world.slot_of(found.second)) : touches_object(world, first);
}

/// Compares both evaluators with the twin on `frames` frames; returns in how many something touches.
int compare(Scene const& scene, std::uint32_t frames) {
  auto const map = straight_road(1, 10);
  int collisions = 0;
  for (std::uint32_t number = 0; number < frames; ++number) {
    auto const world = random_world(map, scene, number);
    auto const any = cb::AnyCollision{}.pair(world);
    bool const expected = brute_any(world);
    REQUIRE(any.has_value() == expected);
    if (any) CHECK(is_true_pair(world, *any));
    collisions += expected;
    for (std::size_t i = 0; i < world.size(); i += 1 + world.size() / 8) {
      auto const slot = static_cast<cb::Slot>(i);
      auto const contact = cb::Collision{}.contact(world, slot);
      auto const other = first_touched(world, slot);
      CHECK(contact.has_value() == (other.has_value() || touches_object(world, slot)));
      CHECK(contact.value_or(cb::Contact{}).agent == other.value_or(cb::none<AgentId>));
    }
  }
  return collisions;
}

}  // namespace

TEST_CASE("collisions are those of a brute-force twin, few agents or many, on roads of any direction") {
  // Sparse enough that both answers are frequent.
  struct Case {
    std::string what;
    Scene scene;
    std::uint32_t frames;
  };
  double const up = cb::geometry::pi / 2;
  Case const cases[] = {{"nobody", {0, 10, 10, 0}, 2},
                        {"two", {2, 15, 6, 0.3}, 2000},
                        {"a few in a square", {8, 60, 60, 1.0}, 1500},
                        {"a few on a vertical road", {14, 600, 8, up}, 1000},
                        {"as many as are compared with each other", {32, 800, 40, 0.3}, 500},
                        {"one more", {33, 800, 40, 0.3}, 500},
                        {"a few who have turned round and round", {20, 500, 40, 4e5}, 500},
                        {"many on a horizontal road", {40, 4000, 8, 0.0}, 500},
                        {"many on a vertical road", {40, 4000, 8, up}, 500},
                        {"many on a slanting road", {40, 4000, 8, 0.8}, 500},
                        {"a hundred", {100, 1200, 500, up}, 200},
                        {"a crowd", {300, 20000, 100, 0.0}, 50},
                        {"more than fit on the stack", {1300, 60000, 600, 0.3}, 30}};
  for (auto const& [what, scene, frames] : cases) {
    int const collisions = compare(scene, frames);
    MESSAGE(what << ": " << collisions << " of " << frames << " frames with a collision");
    if (scene.agents == 0) continue;
    CHECK(collisions > static_cast<int>(frames / 10));
    CHECK(collisions < static_cast<int>(frames - frames / 10));
  }
}

TEST_CASE("up to 1024 agents nothing is allocated, beyond one block") {
  auto const map = straight_road(1, 10);
  for (std::size_t const agents : {10u, 100u, 1024u, 1025u, 3000u}) {
    auto const world = random_world(map, {agents, 1e7, 1e4, 0.2}, 3);
    auto const before = support::allocations();
    auto const found = cb::AnyCollision{}.pair(world);
    CHECK(support::allocations() - before == (CAMBIUM_COUNTS_ALLOCATIONS && agents > 1024 ? 1 : 0));
    CHECK_FALSE(found);
  }
}

TEST_CASE("in the last step, what is touched between its frames counts, and what comes closer than a margin") {
  Sim world(straight_road(1, 900.0));
  auto const a = world.add({.position = {100.0, -1.75}, .speed = 30.0, .behavior = cb::ConstantAcceleration{}});
  world.add({.position = {106.0, -3.0}, .speed = 1.0, .behavior = cb::ConstantAcceleration{}});
  auto const slot = world.slot_of(a);
  CHECK_FALSE(cb::Collision{}.in_last_step(world, slot));
  REQUIRE(world.step(0.5));  // past the other one, whom it touches on the way
  CHECK_FALSE(cb::Collision{}(world, slot));
  CHECK(cb::Collision{}.in_last_step(world, slot));
  REQUIRE(world.step(0.5));
  CHECK_FALSE(cb::Collision{}.in_last_step(world, slot));
  CHECK(cb::Collision{30.0}.in_last_step(world, slot));
}

TEST_CASE("collisions with static objects are those of the twin") {
  int const collisions = compare({4, 60, 60, 0.5, 6}, 1000);
  CHECK(collisions > 100);
  CHECK(collisions < 900);
}

TEST_CASE("a contact says whether it is with an object, or with which agent") {
  Sim world(straight_road(2));
  auto const a = world.add({.position = {20, -1.75}});
  auto const b = world.add({.position = {60, -1.75}});
  CHECK_FALSE(cb::AnyCollision{}(world));
  auto const object = world.add_object(rectangle(23.5, -2, 1, 1));
  CHECK(cb::Collision{}(world, world.slot_of(a)));
  CHECK(cb::Collision{}.contact(world, world.slot_of(a))->object == object);
  CHECK_FALSE(cb::Collision{}(world, world.slot_of(b)));
  CHECK(cb::AnyCollision{}.pair(world)->first == a);
  CHECK(cb::AnyCollision{}.pair(world)->second == cb::none<AgentId>);
  world.remove_object(object);
  CHECK_FALSE(cb::AnyCollision{}(world));
  world.set_state(b, {.x = 22, .y = -3.4});
  CHECK(cb::Collision{}.contact(world, world.slot_of(a))->agent == b);
  CHECK(cb::Collision{}.contact(world, world.slot_of(b))->agent == a);
  CHECK(cb::AnyCollision{}.pair(world)->first == a);
  CHECK(cb::AnyCollision{}.pair(world)->second == b);
}

TEST_CASE("agents that have left traffic are not hit any more") {
  Sim world(straight_road(1, 100));
  auto const gone = world.add({.position = {95, -1.75}, .speed = 20, .behavior = cb::ConstantAcceleration{}});
  auto const next = world.add({.position = {60, -1.75}, .speed = 0, .behavior = cb::ConstantAcceleration{}});
  REQUIRE(world.step(0.5));
  REQUIRE(world.status(gone) == AgentStatus::left_map);
  world.set_state(next, {.x = world.state(gone).x, .y = -1.75});
  CHECK_FALSE(cb::AnyCollision{}(world));
  CHECK_FALSE(cb::Collision{}(world, world.slot_of(next)));
  CHECK_FALSE(cb::Collision{}(world, world.slot_of(gone)));
}

TEST_CASE("a distance below the margin counts as contact, ahead of agents and objects") {
  Sim world(straight_road(2));
  auto const a = world.slot_of(world.add({.position = {20, -1.75}, .shape = box(2, 2)}));
  world.add({.position = {25, -1.75}, .shape = box(2, 2)});  // 1 m ahead
  CHECK_FALSE(cb::Collision{0.9}(world, a));
  CHECK(cb::Collision{1.1}(world, a));
  Sim other(straight_road(2));
  auto const b = other.slot_of(other.add({.position = {20, -1.75}, .shape = box(2, 2)}));
  other.add_object(rectangle(23, -2, 1, 1));
  CHECK_FALSE(cb::Collision{0.9}(other, b));
  CHECK(cb::Collision{1.1}(other, b));
}

TEST_CASE(
    "the agent that drives into a road user or an object is at fault, not one that stands or is hit from behind") {
  Sim world(straight_road(1, 300));
  auto const rear = world.add({.position = {20, -1.75}, .speed = 10}), front = world.add({.position = {24, -1.75}});
  cb::AtFaultCollision const at_fault;
  REQUIRE(cb::Collision{}(world, world.slot_of(rear)));
  CHECK(at_fault(world, world.slot_of(rear)));
  CHECK_FALSE(at_fault(world, world.slot_of(front)));
  world.set_state(front, {.x = 24, .y = -1.75, .speed = 5});
  CHECK_FALSE(at_fault(world, world.slot_of(front)));
  world.set_state(rear, {.x = 20, .y = -1.75, .speed = 0});
  CHECK_FALSE(at_fault(world, world.slot_of(rear)));
  world.add_object(rectangle(20, -2, 1, 1));
  CHECK_FALSE(at_fault(world, world.slot_of(rear)));
  world.set_state(rear, {.x = 20, .y = -1.75, .speed = 0.1});
  CHECK(at_fault(world, world.slot_of(rear)));
}

TEST_CASE("with a look-ahead, a driver is at fault for the collisions that constant velocities lead to") {
  Sim world(straight_road(2, 300));
  auto const rear = world.slot_of(world.add({.position = {20, -1.75}, .speed = 10}));
  auto const front = world.slot_of(world.add({.position = {40, -1.75}, .speed = 2}));
  auto const beside = world.slot_of(world.add({.position = {20, -5.25}, .speed = 10}));
  double const gap = 20.0 - cb::geometry::car().length();
  CHECK_FALSE(cb::AtFaultCollision{}(world, rear));
  CHECK_FALSE(cb::AtFaultCollision{.look_ahead = gap / 8.0 - 0.05}(world, rear));
  cb::AtFaultCollision const soon{.look_ahead = gap / 8.0 + 0.05};
  CHECK(soon(world, rear));
  CHECK_FALSE(soon(world, front));  // hit from behind
  CHECK_FALSE(soon(world, beside));
  cb::Slot const others[] = {beside};
  CHECK_FALSE(soon.among(world, rear, others));
  cb::Slot const all[] = {beside, front};
  CHECK(soon.among(world, rear, all));
  CHECK_FALSE(cb::AtFaultCollision{.blameless_speed = 10.5, .look_ahead = 5.0}(world, rear));
  world.add_object(rectangle(60, -2, 1, 1));
  CHECK(cb::AtFaultCollision{.look_ahead = 4.0}.among(world, rear, {}));
}

namespace {

/// A straight road, x from 0 to 400 m, and ways of their own beside and across it.
struct Stage {
  Sim world;

  explicit Stage(int lanes = 1) : world(straight_road(lanes, 400)) {}

  AgentId on_road(double x, double speed, double y = -1.75) {
    return world.add({.position = {x, y}, .speed = speed, .behavior = cb::ConstantAcceleration{}});
  }

  /// Drives along the straight way from `from` to `to`, the reference point `s` [m] after `from`.
  AgentId on_way(cb::geometry::Point from, cb::geometry::Point to, double s, double speed) {
    auto const along = (to - from).normalized();
    return world.add({.position = from + s * along,
                      .heading = std::atan2(along.y(), along.x()),
                      .speed = speed,
                      .behavior = cb::ConstantAcceleration{},
                      .way = {from, to}});
  }

  struct Seen {
    bool at_frames, in_steps;
  };

  /// Steps for `duration` [s]: whether boxes touch at a frame, and whether `AnyCollision` says so after a step.
  Seen run(double dt, double duration) {
    Seen seen{};
    for (double time = 0.0; time < duration; time += dt) {
      REQUIRE(world.step(dt));
      seen.at_frames = seen.at_frames || brute_any(world);
      seen.in_steps = seen.in_steps || cb::AnyCollision{}(world);
    }
    return seen;
  }
};

/// Two cars at right angles, the second one across the road. Its front is at the middle of the lane `lead` [s] before
/// that of the first one is at the middle of its way; both get there after `time` [s].
Stage crossing(double time, double lead, std::size_t bystanders = 0) {
  Stage stage;
  double const front = cb::geometry::car().front, speed = 15.0, across = 12.0;
  stage.on_road(200.0 - front - speed * time, speed);
  stage.on_way({200, -100}, {200, 100}, 98.25 - front - across * (time - lead), across);
  for (std::size_t i = 0; i < bystanders; ++i) stage.on_way({-900, -900}, {900, -900}, 10.0 * double(i), 0.0);
  return stage;
}

/// Distance of the two cars of `crossing` over the whole run [m]. Exact to millimetres; they drive at constant speeds.
double least_distance(double time, double lead) {
  auto stage = crossing(time, lead);
  double least = 1e9;
  for (double t = 0.0; t < time + 2.0; t += 1e-3) {
    auto const after = [&](cb::Slot slot) { return cb::detail::box_after(stage.world, slot, t); };
    least = std::min(least, cb::geometry::separation(after(cb::Slot{0}), after(cb::Slot{1})));
  }
  return least;
}

}  // namespace

TEST_CASE("no drive-through at a crossing is missed, however long the steps are and wherever they begin") {
  for (double const dt : {0.2, 0.5, 1.0, 2.0}) {
    int hidden = 0;
    for (std::uint32_t i = 0; i < 80; ++i) {
      cb::RandomStream random(5, i, 0);
      double const time = 3.0 + dt * cb::uniform01(random), lead = between(-0.05, 0.05, random);
      auto const seen = crossing(time, lead, i % 2 ? 40 : 0).run(dt, 6.0);
      CHECK(seen.in_steps);
      hidden += !seen.at_frames;
    }
    MESSAGE("steps of " << dt << " s: " << hidden << " of 80 drive-throughs lie between two frames");
    CHECK((hidden > 0) == (dt >= 0.5));
  }
}

TEST_CASE("vehicles that cross the same place one after the other do not collide between frames") {
  int clear = 0, hits = 0;
  for (std::uint32_t i = 0; i < 300; ++i) {
    cb::RandomStream random(6, i, 0);
    double const dt = between(0.3, 1.5, random), time = 3.0 + cb::uniform01(random), lead = between(-1.0, 1.0, random);
    double const distance = least_distance(time, lead);
    if (std::abs(distance) < 0.02) continue;
    CHECK(crossing(time, lead, i % 2 ? 40 : 0).run(dt, 6.0).in_steps == (distance < 0.0));
    ++(distance < 0.0 ? hits : clear);
  }
  CHECK(clear > 50);
  CHECK(hits > 50);
}

TEST_CASE("vehicles that pass each other at 10 cm do not collide, whatever the step; at -10 cm they do") {
  double const width = cb::geometry::car().width();
  for (double const dt : {0.1, 0.5, 1.0, 2.0})
    for (double const gap : {0.1, -0.1})
      for (bool const oncoming : {false, true}) {
        Stage stage;
        stage.on_road(20.0, 25.0);
        double const y = -1.75 + width + gap;
        if (oncoming)
          stage.on_way({390, y}, {10, y}, 100.0, 20.0);
        else
          stage.on_way({10, y}, {390, y}, 60.0, 10.0);
        CHECK(stage.run(dt, 8.0).in_steps == (gap < 0.0));
      }
}

TEST_CASE(
    "vehicles that swap places in a step collide; so does one that drives through one that stands, or an object") {
  Stage swap, standing, object;
  swap.on_road(100.0, 20.0);
  swap.on_way({390, -1.75}, {10, -1.75}, 270.0, 20.0);
  standing.on_road(100.0, 20.0);
  standing.on_road(110.0, 0.0);
  object.on_road(100.0, 20.0);
  object.world.add_object(rectangle(112, -2, 0.5, 0.5));
  for (auto* const stage : {&swap, &standing, &object}) {
    auto const seen = stage->run(1.0, 0.5);
    CHECK_FALSE(seen.at_frames);
    CHECK(seen.in_steps);
    CHECK_FALSE(stage->run(1.0, 0.5).in_steps);  // only the last step counts
  }
}

TEST_CASE("only agents that were driven from one frame to the next sweep what is between") {
  Stage stage;
  auto const a = stage.on_road(100.0, 20.0);
  stage.on_road(110.0, 0.0);
  REQUIRE(stage.world.step(1.0));
  REQUIRE(stage.world.before_step());
  REQUIRE(cb::AnyCollision{}(stage.world));

  SUBCASE("not copies and restored worlds") {
    Sim const copy = stage.world;
    CHECK_FALSE(copy.before_step());
    CHECK_FALSE(cb::AnyCollision{}(copy));
    stage.world.restore(copy.frame());
    CHECK_FALSE(cb::AnyCollision{}(stage.world));
  }
  SUBCASE("not worlds that agents entered or left") {
    stage.on_road(300.0, 0.0);
    CHECK_FALSE(cb::AnyCollision{}(stage.world));
  }
  SUBCASE("not an agent that was set") {
    stage.world.set_state(a, {.x = 130.0, .y = -1.75, .speed = 20.0});
    CHECK_FALSE(cb::AnyCollision{}(stage.world));
    stage.world.set_state(a, {.x = 100.0, .y = -1.75, .speed = 20.0});
    REQUIRE(stage.world.step(1.0));
    CHECK(cb::AnyCollision{}(stage.world));
  }
  SUBCASE("an invalid step is none") {
    CHECK_FALSE(stage.world.step(-1.0));
    CHECK(cb::AnyCollision{}(stage.world));
  }
}
