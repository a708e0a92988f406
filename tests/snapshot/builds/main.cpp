// Whether states that one build has recorded thaw bit-equal in another: see builds.cmake.
//
//   builds record FOLDER        drives, and keeps each cycle as a snapshot
//   builds thaw FOLDER          runs each cycle again; exit code 1 if one comes out otherwise
//   builds mutate FOLDER COUNT  restores damaged snapshots, which must be refused or be worlds
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iterator>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "cambium/behavior/wrap/human_driver.hpp"
#include "cambium/behavior/wrap/idm_stochastic.hpp"
#include "cambium/behavior/drivers.hpp"
#include "cambium/behavior/pedestrian/pedestrian.hpp"
#include "cambium/core/distributions.hpp"
#include "cambium/dynamics/dynamic_set.hpp"
#include "cambium/dynamics/kinematic_point.hpp"
#include "cambium/execution/lqr.hpp"
#include "cambium/execution/stanley.hpp"
#include "cambium/map/opendrive.hpp"
#include "cambium/observer/delayed.hpp"
#include "cambium/observer/observer_chain.hpp"
#include "cambium/observer/parametric.hpp"
#include "cambium/snapshot.hpp"

#include "../../../examples/common/desk.hpp"
#include "../../support/sealed.hpp"
#include "../../support/spoil.hpp"

// As in examples/common/desk.cpp, with the flags of this build.
CAMBIUM_INSTANTIATE_WORLD(desk::World);
CAMBIUM_INSTANTIATE_PLANNING(desk::World, desk::Planner);

namespace cb = cambium;
namespace fs = std::filesystem;

namespace {

using Models =
    cb::World<cb::BehaviorSet<cb::IdmClassic, cb::IdmStochastic, cb::HumanDriver<cb::IdmClassic>, cb::Mobil>,
              cb::StanleyExecution, cb::SingleTrack, cb::ObserverChain<cb::ParametricObserver, cb::DelayedObserver<2>>>;

std::shared_ptr<cb::Map const> merging() {
  static auto const map = cb::load_opendrive(CAMBIUM_SOURCE_DIR "/maps/merging.xodr").map;
  return map;
}
std::shared_ptr<cb::Map const> crossing() {
  static auto const map = cb::load_opendrive(CAMBIUM_SOURCE_DIR "/maps/intersection_4way.xodr").map;
  return map;
}

Models models() {
  Models world(merging(), {.seed = 11});
  cb::RandomStream random(11, 0, 0);
  for (std::size_t i = 0; i < 16; ++i) {
    Models::Behavior const all[] = {cb::IdmClassic{}, cb::IdmStochastic{}, cb::HumanDriver<cb::IdmClassic>{},
                                    cb::Mobil{}};
    world.add({.position = {20.0 + 20.0 * static_cast<double>(i / 2), i % 2 == 0 ? -1.75 : -5.25},
               .speed = cb::Uniform{2.0, 14.0}(random),
               .behavior = all[i % std::size(all)],
               .observer = {cb::ParametricObserver{.others = {.along = 0.3, .speed = 0.2}}, {}}});
  }
  return world;
}

using Street = cb::World<cb::BehaviorSet<cb::Intersection, cb::Pedestrian, cb::LaneChangeRuleBased>, cb::LqrExecution,
                         cb::DynamicSet<cb::SingleTrack, cb::KinematicPoint>>;

/// People on foot, traffic lights, goals and things that stand in the way.
Street junction() {
  Street world(crossing(), {.seed = 5});
  for (auto const& light : crossing()->lights())
    world.set_light(light.id, {.cycle = 20.0, .green_begin = 2.0, .green_end = 9.0});
  for (int i = 0; i < 6; ++i) {
    Street::Behavior driver = cb::Intersection{};
    if (i % 2 == 1) driver = cb::LaneChangeRuleBased{};
    world.add({.position = {-30.0 - 12.0 * i, -1.75},
               .speed = 6.0,
               .behavior = driver,
               .goal = cb::GoalSequence{{cb::StateLimits{}, cb::AllGoals{{cb::StateLimits{}, cb::NoGoal{}}}}}});
  }
  for (double const x : {-20.0, -20.0, 22.0})
    world.add({.position = {x, -8},
               .speed = 1.0,
               .shape = cb::geometry::pedestrian(),
               .behavior = cb::Pedestrian{},
               .way = {{x, -8}, {x, 8}},
               .dynamics = cb::KinematicPoint{}});
  world.add_object(cb::geometry::Polygon({{-30, -9}, {-28, -9}, {-28, -4}}));
  return world;
}

/// A planner among other drivers.
desk::World planner(desk::World::Behavior const& ego) {
  desk::World world(merging(), {.seed = 7});
  world.add({.position = {20, -5.25}, .speed = 12, .behavior = ego, .id = desk::ego});
  for (int i = 0; i < 8; ++i) {
    desk::World::Behavior driver = cb::UrbanDriver{};
    if (i % 3 == 1) driver = cb::Mobil{};
    if (i % 3 == 2) driver = cb::IdmClassic{.law = {.desired_speed = 9.0}};
    world.add({.position = {50.0 + 25.0 * i, i % 2 == 0 ? -5.25 : -1.75}, .speed = 6.0 + i, .behavior = driver});
  }
  return world;
}

/// Calls `f(name, world)` for each situation.
template <class F>
void with_situations(F const& f) {
  f("models", models());
  f("junction", junction());
  f("follower", planner(desk::SmoothFollower{}));
  desk::Planner search;
  search.options.budget.iterations = 60;
  f("search", planner(search));
}

constexpr double time_step = 0.2;
constexpr cb::SnapshotFormat formats[] = {cb::SnapshotFormat::binary, cb::SnapshotFormat::text,
                                          cb::SnapshotFormat::xml};

std::vector<std::string> files_in(fs::path const& folder) {
  std::vector<std::string> files;
  for (auto const& entry : fs::directory_iterator(folder)) files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  return files;
}

int record(fs::path const& folder) {
  fs::remove_all(folder);
  with_situations([&]<class World>(char const* name, World world) {
    for (int cycle = 0; cycle < 60; ++cycle) {
      auto const before = world;
      if (auto const step = world.step(time_step); !step)
        throw cb::WorldError(name, to_string(step.problem), "mend the situation");
      auto const number = std::to_string(100 + cycle);
      fs::create_directories(folder / name);
      cb::save_snapshot(folder / name / number,
                        {.format = formats[cycle % 3], .note = number, .result = cb::snapshot_hash(world)}, before);
    }
  });
  return 0;
}

/// The largest difference between two worlds in the position [m] and speed [m/s] of an agent.
template <class World>
double difference(World const& a, World const& b) {
  double most = 0.0;
  for (cb::Slot slot{}; cb::index_of(slot) < std::min(a.size(), b.size()); ++slot) {
    auto const &one = a.frame().agents[slot].state, &other = b.frame().agents[slot].state;
    most = std::max({most, std::hypot(one.x - other.x, one.y - other.y), std::abs(one.speed - other.speed)});
  }
  return most;
}

int thaw(fs::path const& folder) {
  int equal = 0, all = 0;
  with_situations([&]<class World>(char const* name, World const& first) {
    auto const files = files_in(folder / name);
    double most = 0.0;
    int others = 0;
    for (std::size_t i = 0; i < files.size(); ++i) {
      World world(first.shared_map()), recorded(first.shared_map());
      cb::load_snapshot(files[i], world);
      if (!world.step(time_step)) throw cb::WorldError(files[i], "its cycle has no result", "record it again");
      bool const is_equal = cb::snapshot_hash(world) == cb::snapshot_info(cb::read_snapshot_file(files[i])).result;
      ++all;
      equal += is_equal;
      others += !is_equal;
      if (is_equal || i + 1 == files.size()) continue;
      cb::load_snapshot(files[i + 1], recorded);
      most = std::max(most, difference(world, recorded));
    }
    if (others > 0)
      std::printf("%s: %d of %zu cycles differ, by up to %.2g m or m/s\n", name, others, files.size(), most);
  });
  std::printf("%d of %d cycles came out bit-equal\n", equal, all);
  return all > 0 && equal == all ? 0 : 1;
}

/// Damages `bytes` behind `from`.
void damage(std::string& bytes, std::size_t from, cb::RandomStream& random, std::string const& other) {
  auto const at = from + random() % (bytes.size() - from);
  switch (random() % 6) {
    case 0:
      bytes[at] = static_cast<char>(bytes[at] ^ static_cast<char>(1u << random() % 8));
      break;
    case 1:
      bytes[at] = static_cast<char>('0' + random() % 10);
      break;
    case 2:
      bytes.resize(at + 1);
      break;
    case 3:
      bytes.erase(at, 1 + random() % 8);
      break;
    case 4:
      bytes.insert(at, 1 + random() % 4, static_cast<char>(random()));
      break;
    default:  // goes on as another file does
      bytes = bytes.substr(0, at) + other.substr(std::min(at, other.size()));
      break;
  }
  if (bytes.size() <= from) bytes.resize(from + 1);
}

int mutate(fs::path const& folder, int count) {
  int refused = 0, worlds = 0, wrong = 0;
  with_situations([&]<class World>(char const* name, World first) {
    bool const is_search = std::string_view(name) == "search";  // its budget may become endless
    std::vector<std::string> all;
    for (auto const& file : files_in(folder / name)) all.push_back(cb::read_snapshot_file(file));
    cb::RandomStream random(3, 0, 0);
    for (int i = 0; i < count / 4; ++i) {
      bool const is_sealed = i % 4 == 0;
      auto bytes = all[random() % all.size()];
      auto const from = is_sealed ? bytes.find("\n\n") + 2 : 0;
      for (auto k = 1 + random() % 3; k > 0; --k) damage(bytes, from, random, all[random() % all.size()]);
      World world(first.shared_map());
      try {
        cb::from_snapshot(is_sealed ? support::sealed_again(bytes) : bytes, "mutant", world);
        if (!is_search) static_cast<void>(world.step(time_step));
        ++worlds;
      } catch (cb::Error const&) {
        ++refused;
      }
    }
    if (is_search) return;
    for (int i = 0; i < 5; ++i) static_cast<void>(first.step(time_step));
    auto const spoilt = support::spoil_numbers(first, count / 40, 2, [&](std::string const& what) {
      std::printf("%s: %s\n", name, what.c_str());
      ++wrong;
    });
    refused += spoilt.refused;
    worlds += spoilt.worlds;
  });
  std::printf("%d mutants: %d refused, %d are worlds\n", refused + worlds, refused, worlds);
  return refused > worlds && wrong == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> const words(argv + 1, argv + argc);
  try {
    if (words.size() == 2 && words[0] == "record") return record(words[1]);
    if (words.size() == 2 && words[0] == "thaw") return thaw(words[1]);
    if (words.size() == 3 && words[0] == "mutate") return mutate(words[1], std::stoi(words[2]));
  } catch (std::exception const& error) {
    std::printf("%s\n", error.what());
    return 2;
  }
  std::printf("builds record FOLDER | thaw FOLDER | mutate FOLDER COUNT\n");
  return 2;
}
