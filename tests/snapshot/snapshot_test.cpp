// Snapshot files: what they say, what they refuse, and a user's own components in them.
#include "cambium/snapshot.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <locale>
#include <memory>
#include <string>
#include <vector>

#include <boost/container/static_vector.hpp>
#include <boost/serialization/vector.hpp>

#include "../support/error_of.hpp"

#include "cambium/cambium.hpp"
#include "cambium/map/content_hash.hpp"
#include "cambium/map/opendrive.hpp"
#include "cambium/planner.hpp"
#include "snapshot/fixtures.hpp"
#include "support/described.hpp"
#include "support/maps.hpp"
#include "support/sealed.hpp"
#include "support/versions.hpp"

using namespace cambium;
using namespace fixtures;
using support::hex, support::One, support::sealed_again;

namespace {

using Sim = World<BehaviorSet<IdmClassic, Mobil>, InterpolateExecution, SingleTrack>;

Sim traffic(std::shared_ptr<Map const> const& map, int agents = 6) {
  Sim world(map, {.seed = 4});
  for (int i = 0; i < agents; ++i) {
    Sim::Behavior driver = IdmClassic{.law = {.desired_speed = 10.0 + i}};
    if (i % 2 == 1) driver = Mobil{};
    world.add({.position = {20.0 + 30.0 * i, -1.75}, .speed = 8.0 + i, .behavior = driver});
  }
  for (int i = 0; i < 3; ++i) REQUIRE(world.step(0.2));
  return world;
}

/// A planner of one's own: a part of the library in it, and a log that belongs to where it runs.
class OwnPlanner {
 public:
  std::vector<double> inputs{};
  IdmClassic driver{};
  std::vector<std::string>* log = nullptr;

 private:
  friend class boost::serialization::access;
  template <class Archive>
  void serialize(Archive& archive, unsigned) {
    archive& boost::serialization::make_nvp("inputs", inputs);
    archive& boost::serialization::make_nvp("driver", driver);
  }
};

struct Spaced {
  int count = 0;
  static constexpr char const* name = "my stack";
  template <class Archive>
  void serialize(Archive& archive, unsigned) {
    archive& boost::serialization::make_nvp("count", count);
  }
};
struct Nameless {
  int count = 0;
  std::vector<double> numbers{};
  template <class Archive>
  void serialize(Archive& archive, unsigned) {
    archive& count& numbers;
  }
};
struct NamelessBefore {
  int count = 0;
  template <class Archive>
  void serialize(Archive& archive, unsigned) {
    archive& count;
  }
};
}  // namespace

TEST_CASE("the head of a snapshot tells what is in it, and where its map is") {
  auto const map = support::straight_road(2, 500.0);
  auto const world = traffic(map);
  auto const bytes = to_snapshot({.format = SnapshotFormat::text,
                                  .map_file = "maps/a road.xodr",
                                  .map_text = "<OpenDRIVE/>\n",
                                  .note = "a driver\nasked",
                                  .result = 0xabcu},
                                 world, IdmClassic{});
  auto const info = snapshot_info(bytes);
  CHECK(info.format == SnapshotFormat::text);
  CHECK(info.library == library_version);
  CHECK(info.build.find(".") != std::string::npos);
  CHECK(info.platform.find("endian") != std::string::npos);
  CHECK(info.parts == "world, idm_classic");
  CHECK(info.time == world.time());
  CHECK(info.map_hash == detail::hash_of_map(*map));
  CHECK(info.map_file == "maps/a road.xodr");
  CHECK(info.map_text == "<OpenDRIVE/>\n");
  CHECK(info.note == "a driver\\x0aasked");
  CHECK(info.result == 0xabcu);
  Sim other(map);
  IdmClassic driver;
  from_snapshot(bytes, "x", other, driver);
  CHECK(other.frame() == world.frame());
}

TEST_CASE("every kind of field keeps its bits in every format") {
  double const inf = std::numeric_limits<double>::infinity();
  for (auto const format : formats) {
    std::vector<double> const numbers{0.1, -0.0, inf, -inf, 5e-324, 1.7976931348623157e308, 1.0 / 3.0};
    for (double const number : numbers) {
      auto kinds = support::unusual();
      kinds.number = number;
      kinds.single = static_cast<float>(number);
      kinds.text = "a <b> & \"c\"\n\tend ";
      kinds.shared = std::make_shared<std::vector<double> const>(300, 0.25);
      support::Everything back;
      from_snapshot(to_snapshot({.format = format}, kinds), "x", back);
      CHECK(detail::same_bits(kinds, back));
      CHECK(back.text == kinds.text);
      CHECK(back.shared->size() == 300);
    }
  }
}

TEST_CASE("structs of older versions are read in every format") {
  for (auto const format : formats)
    versions::check([&](auto const& object) { return to_snapshot({.format = format}, object); },
                    [](std::string const& bytes, auto& object) { from_snapshot(bytes, "x", object); });
}

TEST_CASE("a class without names for its members is no part of an XML file; what is left over is noticed") {
  Nameless const nameless{3, {1.0, 2.0}};
  says("a member of a class has no name, which XML needs; write",
       [&] { static_cast<void>(to_snapshot({.format = SnapshotFormat::xml}, nameless)); });
  for (auto const format : {SnapshotFormat::binary, SnapshotFormat::text}) {
    Nameless back;
    from_snapshot(to_snapshot({.format = format}, nameless), "x", back);
    CHECK(back.numbers == nameless.numbers);
    NamelessBefore before;
    says("holds more than was read", [&] { from_snapshot(to_snapshot({.format = format}, nameless), "x", before); });
  }
}

TEST_CASE("a world that contradicts itself is refused") {
  auto const map = support::straight_road(2, 500.0);
  auto world = traffic(map);
  geometry::Polygon const cone{{300, -3}, {301, -3}, {301, -2}, {300, -2}};
  static_cast<void>(world.add_object(cone));
  static_cast<void>(world.add_object(cone));
  auto const says_after = [&](std::string const& sentence, auto const& change) {
    auto parts = detail::archived(world);
    change(parts);
    says(sentence, [&] { static_cast<void>(detail::restored<Sim>(map, std::move(parts))); });
  };
  says_after("no error", [](auto&) {});
  says_after("the next id is taken", [](auto& parts) { parts.next_agent_id = 0; });
  says_after("the next id is taken", [](auto& parts) { parts.next_object_id = 1; });
  says_after("its objects are not sorted", [](auto& parts) { parts.objects[1].id = parts.objects[0].id; });
  says_after("an agent drives at another time", [](auto& parts) { parts.frame.agents[Slot{1}].state.time += 1e6; });
  says_after("^snapshot: agent 0: idm_classic.law.desired_speed",
             [](auto& parts) { parts.agents[0].behavior = IdmClassic{.law = {.desired_speed = -1.0}}; });
  says_after("^snapshot: agent 1: shape.left", [](auto& parts) { parts.agents[1].shape.left = std::nan(""); });
  says_after("^snapshot: largest_shape: shape.rear", [](auto& parts) { parts.largest_shape.rear = -1.0; });
  says_after("there is no such id", [](auto& parts) { parts.agents.back().id = none<AgentId>; });
  says_after("an object has no id", [](auto& parts) { parts.objects.back().id = none<ObjectId>; });
  says_after("its outline has no corners", [](auto& parts) { parts.objects[0].outline = geometry::Polygon(); });
  says_after("its outline is longer than 10 km", [](auto& parts) {
    parts.objects[0].outline = geometry::Polygon({{0, 0}, {9000, 0}, {9000, 9000}});
  });
  says_after("its agents are not sorted", [](auto& parts) { std::swap(parts.agents[0].id, parts.agents[1].id); });
  says_after("single_track.wheel_base", [](auto& parts) { parts.agents[0].dynamics.wheel_base = 0.0; });
  says_after("its goal has no parts", [](auto& parts) { parts.agents[0].goal = GoalSequence{}; });
  says_after("light", [](auto& parts) { parts.lights.push_back({}); });
  says_after("its time is not finite", [](auto& parts) { parts.frame.time = std::nan(""); });
  says_after("an agent has no road", [](auto& parts) { parts.agents[0].road = 99; });
  says_after("a road has no lanes", [](auto& parts) { parts.roads[0].route.clear(); });
  says_after("a route has a lane that the map lacks", [](auto& parts) { parts.roads[0].route[0] = LaneId{99}; });
  says_after("its free corridors do not come first", [](auto& parts) { parts.roads.back().way = {{0, 0}, {9, 9}}; });
  says_after("it has more agents than places, or fewer", [](auto& parts) { parts.frame.agents.pop_back(); });
  for (double const strange : {std::nan(""), HUGE_VAL}) {
    auto const says_of_record = [&](auto const& change) {
      says_after("an agent has a state, place or action that is not finite",
                 [&](auto& parts) { change(parts.frame.agents[Slot{1}]); });
    };
    says_of_record([&](auto& record) { record.state.y = strange; });
    says_of_record([&](auto& record) { record.lane.lateral = strange; });
    says_of_record([&](auto& record) { record.action.acceleration = strange; });
    says_after("no error", [&](auto& parts) {
      auto& record = parts.frame.agents[Slot{1}];
      record.status = AgentStatus::left_map;
      record.state.y = strange;
    });
  }
  Sim thawed(map);
  from_snapshot(to_snapshot({}, world), "x", thawed);
  CHECK(thawed.roster().largest_shape == world.roster().largest_shape);
  CHECK(thawed.add_object(cone) == world.add_object(cone));
}

TEST_CASE("a controller that would act without end, an observer and a past that cannot be are refused") {
  using Driven = World<BehaviorSet<IdmClassic>, StanleyExecution, SingleTrack,
                       ObserverChain<ParametricObserver, DelayedObserver<2>>>;
  auto const map = support::straight_road(2, 500.0);
  Driven world(map);
  world.add({.position = {20, -1.75}, .speed = 3, .behavior = IdmClassic{}});
  auto const says_after = [&](std::string const& sentence, auto const& change) {
    auto parts = detail::archived(world);
    change(parts);
    says(sentence, [&] { static_cast<void>(detail::restored<Driven>(map, std::move(parts))); });
  };
  says_after("^snapshot: agent 0: stanley.actuation.period",
             [](auto& parts) { parts.agents[0].execution.actuation.period = 1e-30; });
  says_after("others.along", [](auto& parts) { parts.agents[0].observer.template stage<0>().others.along = -1.0; });
  says_after("not finite", [](auto& parts) { parts.frame.agents[Slot{0}].past.states[1].x = std::nan(""); });
}

TEST_CASE("a state may have fields that are infinite: they are its model's own") {
  using Loose = World<BehaviorSet<IdmClassic>, InterpolateExecution, TripleIntegrator>;
  Loose world(support::straight_road(1, 300.0));
  auto const id = world.add({.position = {20, -1.75}, .speed = 3, .behavior = IdmClassic{}});
  auto state = world.state(id);
  state.lateral_acceleration = std::nan("");
  world.set_state(id, state);
  Loose thawed(world.shared_map());
  from_snapshot(to_snapshot({}, world), "x", thawed);
  CHECK(snapshot_hash(thawed) == snapshot_hash(world));
}

TEST_CASE("a number out of its range, a name that is no tag, and a file that would fill the memory are refused") {
  versions::Ordered<0> ordered{1.0, 2.0, 12};
  says("^x: c: is 12", [&] { from_snapshot(to_snapshot({}, ordered), "x", ordered); });
  Spaced spaced;
  says("no archive can hold its parts",
       [&] { static_cast<void>(to_snapshot({.format = SnapshotFormat::xml}, spaced)); });
  One<std::vector<One<std::string>>> texts{{9000, {std::string(10'000, 'x')}}};
  auto const small = to_snapshot({}, texts);
  CHECK(small.size() < 40'000);
  says("^x: expands to far more memory", [&] { from_snapshot(small, "x", texts); });
}

TEST_CASE("a switch that is neither off nor on, and a list that is too long, are refused") {
  One<bool> truth;
  says("^x: its content contradicts itself", [&] { from_snapshot(to_snapshot({}, One<std::uint8_t>{7}), "x", truth); });
  CHECK_FALSE(truth.value);
  One<std::array<int, 2>> pair;
  says("^x: its content contradicts itself", [&] {
    from_snapshot(to_snapshot({}, One<std::array<int, 3>>{{7, 8, 9}}), "x", pair);
  });
  One<boost::container::static_vector<int, 2>> few;
  says("^x: its content contradicts itself", [&] {
    from_snapshot(to_snapshot({}, One<std::vector<int>>{{7, 8, 9}}), "x", few);
  });
}

TEST_CASE("a map built with the defaults is known by its content alone") {
  auto const map = support::straight_road(2, 500.0);
  CHECK(detail::hash_of_map(*map) == map::content_hash(*map));
}

TEST_CASE("the host's locale is not in the files") {
  struct Grouping : std::numpunct<char> {
    char do_thousands_sep() const override { return '.'; }
    char do_decimal_point() const override { return ','; }
    std::string do_grouping() const override { return "\3"; }
  };
  versions::After const now{1234567.5, {{1e9}}, 123456789.0};
  for (auto const format : {SnapshotFormat::text, SnapshotFormat::xml}) {
    auto const usual = to_snapshot({.format = format}, now, RandomStream(123456789, 1, 2));
    auto const before = std::locale::global(std::locale(std::locale::classic(), new Grouping));
    auto const german = to_snapshot({.format = format}, now, RandomStream(123456789, 1, 2));
    versions::After back;
    RandomStream random(0, 0, 0);
    from_snapshot(usual, "x", back, random);
    std::locale::global(before);
    CHECK(german == usual);
    CHECK(back.added == now.added);
  }
}

TEST_CASE("a component of one's own is saved beside a world, and keeps its environment") {
  auto const map = support::straight_road(2, 500.0);
  auto const world = traffic(map);
  std::vector<std::string> in_car, on_desk;
  OwnPlanner const planner{{3.0}, {.law = {.desired_speed = 5.3}}, &in_car};
  for (auto const format : formats) {
    auto const bytes = to_snapshot({.format = format}, world, planner);
    CHECK(snapshot_info(bytes).parts == "world, component");
    Sim other(map);
    OwnPlanner thawed{.log = &on_desk};
    from_snapshot(bytes, "x", other, thawed);
    CHECK(thawed.inputs == planner.inputs);
    CHECK(thawed.driver.law.desired_speed == 5.3);
    CHECK(thawed.log == &on_desk);
    CHECK(other.frame() == world.frame());
    CHECK(snapshot_hash(thawed) == snapshot_hash(planner));
    thawed.inputs.push_back(1.0);
    CHECK(snapshot_hash(thawed) != snapshot_hash(planner));
  }
}

TEST_CASE("a wrong map, wrong parts and unknown models are refused, and nothing changes") {
  auto const map = support::straight_road(2, 500.0), longer = support::straight_road(2, 501.0);
  auto const world = traffic(map);
  auto const bytes = to_snapshot({.map_file = "maps/a.xodr"}, world);
  auto other = traffic(longer, 3);
  auto const before = snapshot_hash(other);
  auto const read = [&] { from_snapshot(bytes, "car.snapshot", other); };
  says("^car.snapshot: was taken on another map: its hash is " + hex(detail::hash_of_map(*map)), read);
  says("maps/a.xodr", read);
  CHECK(snapshot_hash(other) == before);
  IdmClassic driver;
  says("holds the parts 'world', not 'idm_classic'", [&] { from_snapshot(bytes, "x", driver); });
  World<BehaviorSet<IdmClassic>, InterpolateExecution, SingleTrack> poorer(map);
  says("holds the model 'mobil', which is not among those of this program (idm_classic)",
       [&] { from_snapshot(bytes, "x", poorer); });
  CHECK(poorer.size() == 0);
  // More models, and in another order, do no harm.
  World<BehaviorSet<Intersection, Mobil, IdmClassic>, InterpolateExecution, SingleTrack> richer(map);
  from_snapshot(bytes, "x", richer);
  auto twin = world;
  for (int i = 0; i < 5; ++i) {
    REQUIRE(richer.step(0.2));
    REQUIRE(twin.step(0.2));
  }
  for (Slot slot{}; index_of(slot) < twin.size(); ++slot)
    CHECK(richer.frame().agents[slot].state == twin.frame().agents[slot].state);
}

TEST_CASE("what is no snapshot, newer, foreign, cut short or longer is refused by a sentence") {
  auto const map = support::straight_road(2, 500.0);
  auto const world = traffic(map);
  auto const bytes = to_snapshot({}, world);
  Sim other(map);
  auto const refused = [&](std::string const& part, std::string const& damaged) {
    says(part, [&] { from_snapshot(damaged, "f", other); });
  };
  refused("^f: is no snapshot of cambium; give a file that", "");
  refused("is no snapshot", "{\"a\": 1}");
  refused("is cut short: ", bytes.substr(0, bytes.size() - 1));
  refused("is too long: ", bytes + "x");
  refused("it is damaged", bytes.substr(0, 25));
  auto newer = bytes;
  newer.replace(newer.find(" 1\n"), 3, " 2\n");
  refused("is of version 2 of the format, newer than this program", newer);
  auto flipped = bytes;
  flipped[flipped.size() / 2] = static_cast<char>(flipped[flipped.size() / 2] ^ 4);
  refused("has a wrong checksum", flipped);
  auto foreign = bytes;
  foreign.replace(foreign.find("little-endian"), 13, "bigger-endian");
  refused("is binary and of another platform (bigger-endian", sealed_again(foreign));
  auto unknown = bytes;
  unknown.replace(unknown.find("archive binary"), 14, "archive zipped");
  refused("kind of archive that is unknown", sealed_again(unknown));
  CHECK(other.size() == 0);
  says("^/nowhere/x.snapshot: the file cannot be opened", [&] { load_snapshot("/nowhere/x.snapshot", other); });
}

// Not within the test: g++ 14 crashes there.
struct Anywhere {
  [[nodiscard]] bool at_goal(GoalSituation const&) const { return false; }
};

TEST_CASE("a struct without a description is refused when it is saved") {
  Sim world(support::straight_road(1, 300.0));
  world.add({.position = {20, -1.75}, .speed = 3, .behavior = IdmClassic{}, .goal = Anywhere{}});
  says("a struct is not described", [&] { static_cast<void>(to_snapshot({}, world)); });
}

TEST_CASE("goals in goals are saved as deep as they can be read") {
  auto const thaw = [](int depth) {
    Goal goal = NoGoal{};
    for (int i = 0; i < depth; ++i) goal = AllGoals{{goal}};
    Sim world(support::straight_road(1, 300.0));
    world.add({.position = {20, -1.75}, .speed = 3, .behavior = IdmClassic{}, .goal = goal});
    Sim thawed(world.shared_map());
    from_snapshot(to_snapshot({}, world), "x", thawed);
    return snapshot_hash(thawed) == snapshot_hash(world);
  };
  CHECK(thaw(190));
  says("lies within more than 200 others", [&] { thaw(200); });
}

TEST_CASE("a memory that holds NaN thaws as it is") {
  using Driven = World<BehaviorSet<ExternalInput>, InterpolateExecution, SingleTrack>;
  Driven world(support::straight_road(1, 300.0));
  auto const id = world.add({.position = {20, -1.75}, .speed = 3, .behavior = ExternalInput{}});
  world.memory<ExternalInput>(id).acceleration = std::nan("");
  for (auto const format : formats) {
    Driven thawed(world.shared_map());
    from_snapshot(to_snapshot({.format = format}, world), "x", thawed);
    CHECK(snapshot_hash(thawed) == snapshot_hash(world));
    auto twin = world;
    CHECK(twin.step(0.2).problem == thawed.step(0.2).problem);
    CHECK(snapshot_hash(thawed) == snapshot_hash(twin));
  }
}

TEST_CASE("what a map was built with counts, and the map of each world") {
  auto const file = std::string(CAMBIUM_SOURCE_DIR "/maps/merging.xodr");
  auto const map = load_opendrive(file).map, other = load_opendrive(file, {.merge_view = 60.0}).map;
  CHECK(content_hash(*map) == content_hash(*other));
  Sim const world(map), on_other(other);
  Sim one(other), two(map);
  says("^f: was taken on another map", [&] { from_snapshot(to_snapshot({}, world), "f", one); });
  Sim fits(map);
  says("another map", [&] { from_snapshot(to_snapshot({}, world, on_other), "f", fits, two); });
  says("no error", [&] { from_snapshot(to_snapshot({}, world, on_other), "f", fits, one); });
}

TEST_CASE("no mutation of a snapshot gets through to the archive") {
  auto const map = support::straight_road(2, 500.0);
  auto const world = traffic(map);
  Sim other(map);
  for (auto const format : formats) {
    auto const bytes = to_snapshot({.format = format}, world);
    RandomStream random(static_cast<std::uint64_t>(format), 0, 0);
    int refused = 0;
    int const runs = 35'000;
    for (int i = 0; i < runs; ++i) {
      auto damaged = bytes;
      auto const at = static_cast<std::size_t>(random() % damaged.size());
      switch (random() % 4) {
        case 0:
          damaged[at] = static_cast<char>(damaged[at] ^ static_cast<char>(1u << random() % 8));
          break;
        case 1:
          damaged.resize(at);
          break;
        case 2:
          damaged.insert(at, 1, static_cast<char>(random()));
          break;
        default:
          damaged.erase(at, 1 + random() % 8);
          break;
      }
      auto const message = support::error_of<cambium::SnapshotError>([&] { from_snapshot(damaged, "f", other); });
      bool const by_its_head = message.find("is no snapshot") != message.npos ||
                               message.find("newer than this program") != message.npos ||
                               message.find("it is damaged") != message.npos;
      refused += by_its_head;
    }
    CHECK(refused == runs);
    CHECK(other.size() == 0);
  }
}

TEST_CASE("an archive that was changed and sealed again is an error or a world, never a crash") {
  auto const map = support::straight_road(2, 500.0);
  auto const world = traffic(map);
  int refused = 0;
  for (auto const format : formats) {
    auto const bytes = to_snapshot({.format = format}, world);
    auto const begin = bytes.find("\n\n") + 2;
    RandomStream random(static_cast<std::uint64_t>(format), 1, 0);
    for (int i = 0; i < 1500; ++i) {
      Sim other(map);
      bool const is_refused = support::error_of<cambium::SnapshotError>([&] {
                                from_snapshot(changed_archive(bytes, begin, random), "f", other);
                              }) != "no error";
      refused += is_refused;
      if (!is_refused) static_cast<void>(other.step(0.2));
    }
  }
  CHECK(refused > 1000);
}

namespace {

using GoldenPrediction = World<BehaviorSet<DriverActions<Intersection>, Intersection>, StanleyExecution, SingleTrack>;
using GoldenSet = BehaviorSet<Mcts<GoldenPrediction>, HumanDriver<IdmClassic>, Intersection, Mobil, IdmClassic>;
using GoldenWorld = World<GoldenSet, StanleyExecution, SingleTrack, DelayedObserver<2>>;

constexpr double golden_human_decision = 1.11345;  // [m/s^2]

GoldenWorld golden() {
  GoldenWorld world(support::straight_road(2, 500.0), {.seed = 12345678901234567u, .time = -3.25});
  world.add({.position = {20, -1.75}, .speed = 8, .behavior = HumanDriver<IdmClassic>{}, .goal = StateLimits{}});
  world.add({.position = {60, -1.75}, .speed = 9, .behavior = Mobil{}, .id = AgentId{300}});
  world.add({.position = {90, -5.25}, .speed = 10, .behavior = Intersection{.law = {.desired_speed = 17.5}}});
  world.add({.position = {130, -5.25}, .speed = 0.1, .behavior = Mcts<GoldenPrediction>{}});
  world.add_object(geometry::Polygon({{200, -9}, {203, -9}, {203, -6}}));
  for (int i = 0; i < 4; ++i) REQUIRE(world.step(0.2));
  return world;
}

}  // namespace

// Files of each version of the format stay here for good: whoever changes what a snapshot holds sees whether they load,
// or that a sentence refuses them: drivers of the first files had no parts.
TEST_CASE("snapshots of earlier versions load, or are refused with the fields of today") {
  using Parts = detail::ArchivedWorld<GoldenWorld>;
  auto const map = support::straight_road(2, 500.0);
  write_golden("world_5", 3, [] { return detail::archived(golden()); });
  auto const loads = [&](std::string const& path) {
    Parts parts;
    load_snapshot(path, parts);
    CHECK(parts.seed == 12345678901234567u);
    CHECK(parts.frame.time == doctest::Approx(-2.45));
    CHECK(parts.frame.step == 4);
    REQUIRE(parts.agents.size() == 4);
    CHECK(parts.next_agent_id == 303);
    CHECK(parts.objects.size() == 1);
    CHECK(parts.agents[2].id == AgentId{301});
    CHECK(std::get<Intersection>(parts.agents[2].behavior).law.desired_speed == 17.5);
    auto const& human = std::get<HumanDriver<IdmClassic>::Memory>(parts.frame.agents[0].memory);
    CHECK(human.has_begun);
    CHECK(human.decided[1] == doctest::Approx(golden_human_decision).epsilon(1e-5));
    CHECK(parts.frame.agents[1].execution.begun);
    CHECK(parts.frame.agents[3].past.states[1].time == doctest::Approx(-2.85));
    // On the map as it is built now; other versions may build it otherwise.
    parts.map_hash = detail::hash_of_map(*map);
    auto world = detail::restored<GoldenWorld>(map, std::move(parts));
    for (auto const& record : world.frame().agents)
      CHECK(double{record.acceleration} == doctest::Approx(record.action.acceleration).epsilon(0.02));
    for (int i = 0; i < 5; ++i) CHECK(world.step(0.2));
  };
  for (auto const name : {"world_4", "world_5"}) CHECK(for_each_golden(name, loads) == 3);
  CHECK(for_each_golden("world_1", [&](std::string const& path) {
          Parts parts;
          says("(law, lateral, heeds, jerk); read it with the program that wrote it",
               [&] { load_snapshot(path, parts); });
        }) == 3);
  for (auto const name : {"world_2", "world_3"})
    CHECK(for_each_golden(name, [&](std::string const& path) {
            Parts parts;
            says("its struct 'human_driver_memory'", [&] { load_snapshot(path, parts); });
          }) == 3);
}
