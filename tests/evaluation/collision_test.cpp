// Collision evaluators against a twin that compares every pair of boxes.
#include "cambium/evaluation/collision.hpp"

#include <doctest/doctest.h>

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
