// What a planner stack pays in a cycle of 10 Hz: its objects into the tracker's world, and a prediction of 3 s from
// there; beside it, a world filled anew by `add`, and its 30 steps. Traffic on a junction; in the dirty lists a quarter
// is odd: wrong way, off the lanes, on foot, reversing, refused.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "cambium/core/distributions.hpp"
#include "cambium/core/error.hpp"
#include "cambium/map/opendrive.hpp"
#include "cambium/tracking.hpp"

namespace cb = cambium;

namespace {

constexpr std::int64_t cycle = 100'000'000;  // [ns]

/// Traffic that never ends: whoever leaves the map is replaced by somebody else.
class Traffic {
 public:
  Traffic(std::shared_ptr<cb::Map const> map, std::size_t count) : world_(std::move(map), {.seed = 5}), count_(count) {
    for (auto const& lane : world_.map().lanes())
      if (lane.drivable() && lane.length() > 12.0) lanes_.push_back(lane.id);
    refill(400);
  }

  void step() {
    static_cast<void>(world_.step(0.1));
    world_.remove_departed();
    refill(4);
  }

  /// What perception makes of it at `stamp` [ns].
  [[nodiscard]] std::vector<cb::TrackedObject> list(std::int64_t stamp, bool dirty) {
    std::vector<cb::TrackedObject> objects;
    for (cb::Slot slot{}; index_of(slot) < world_.size(); ++slot) {
      auto const& [id, shape, road, behavior, execution, dynamics, observer] = world_.roster().agents[slot];
      auto const& state = world_.frame().agents[slot].state;
      auto const noise = [&](double deviation) { return cb::Normal{0.0, deviation}(random_); };
      auto const at = cb::geometry::to_map({state.x, state.y, state.heading}, {shape.center_offset(), 0.0});
      cb::TrackedObject object{.key = {0, index_of(id)}, .x = at.x() + noise(0.05), .y = at.y() + noise(0.05)};
      object.heading = state.heading + noise(0.01);
      double speed = state.speed + noise(0.1);
      if (dirty) {
        object.stamp = stamp + static_cast<std::int64_t>(noise(1e7));
        spoil(object, speed, index_of(id));
      }
      object.vx = speed * std::cos(object.heading);
      object.vy = speed * std::sin(object.heading);
      object.length = shape.length();
      object.width = shape.width();
      objects.push_back(object);
    }
    return objects;
  }

 private:
  /// A quarter of all ids is odd, each in its way.
  static void spoil(cb::TrackedObject& object, double& speed, std::size_t id) {
    switch (id % 24) {
      case 0:
        object.heading += 3.14;
        break;
      case 4:
        object.heading += 1.4;
        break;
      case 8:
        object.kind = cb::ObjectClass::pedestrian;
        speed = 1.3;
        break;
      case 12:
        speed = -0.5;
        break;
      case 16:
        object.x = std::numeric_limits<double>::quiet_NaN();
        break;
      case 20:
        object.y += 9.0;
        break;
      default:
        break;
    }
  }

  void refill(int tries) {
    for (int i = 0; i < tries && world_.size() < count_; ++i) {
      auto const& lane =
          world_.map().lane(lanes_[cb::uniform_index(random_, static_cast<std::uint32_t>(lanes_.size()))]);
      auto const pose = lane.path.pose(cb::uniform01(random_) * lane.length());
      try {
        world_.add({.position = pose.position(), .heading = pose.heading, .speed = 8.0});
      } catch (cb::Error const&) {
      }
    }
  }

  cb::World<cb::BehaviorSet<cb::UrbanDriver>, cb::InterpolateExecution, cb::SingleTrack> world_;
  std::size_t count_;
  std::vector<cb::LaneId> lanes_;
  cb::RandomStream random_{7, 0, 0};
};

/// The yardstick: a world that is filled anew in each cycle. Refused objects are left out.
void add_all(cb::TrackedWorld& world, std::vector<cb::TrackedObject> const& list) {
  for (auto const& o : list) try {
      world.add({.position = {o.x, o.y}, .heading = o.heading, .speed = std::hypot(o.vx, o.vy)});
    } catch (cb::Error const&) {
    }
}

struct Times {
  std::vector<double> us;
  [[nodiscard]] double median() {
    std::nth_element(us.begin(), us.begin() + static_cast<std::ptrdiff_t>(us.size() / 2), us.end());
    return us[us.size() / 2];
  }
  [[nodiscard]] double worst() const { return *std::max_element(us.begin(), us.end()); }
};

template <class F>
double microseconds(F const& f) {
  auto const begin = std::chrono::steady_clock::now();
  f();
  return std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App program("Times of a planner's cycle: the tracker's update, and a prediction of 3 s in 30 steps.",
                   "embedding");
  std::string json, map_file = std::string(CAMBIUM_SOURCE_DIR) + "/maps/intersection_4way.xodr";
  int cycles = 1000;
  program.add_option("--json", json, "writes the figures into this file");
  program.add_option("--map", map_file, "an OpenDRIVE map")->check(CLI::ExistingFile);
  program.add_option("--cycles", cycles, "how many, each of 0.1 s")->check(CLI::Range(10, 1'000'000));
  CLI11_PARSE(program, argc, argv);
  try {
    auto const map = cb::load_opendrive(map_file).map;
    auto const roads = map->prepare(map->bounds());
    std::map<std::string, Times> results;
    for (std::size_t const count : {std::size_t{20}, std::size_t{100}})
      for (bool const dirty : {false, true}) {
        Traffic traffic(map, count);
        cb::Tracker<> tracker(map);
        auto const name = "/" + std::to_string(count) + (dirty ? "/dirty" : "/clean");
        std::int64_t stamp = 1'764'580'000'000'000'000;
        double objects = 0.0;
        std::vector<cb::PredictedState> states;
        for (int i = 0; i < cycles; ++i, stamp += cycle) {
          auto const list = traffic.list(stamp, dirty);
          results["embedding/update" + name].us.push_back(microseconds([&] { tracker.update(stamp, list); }));
          cb::TrackedWorld anew(map);
          results["embedding/add" + name].us.push_back(microseconds([&] { add_all(anew, list); }));
          results["embedding/step" + name].us.push_back(microseconds([&] {
            for (int step = 0; step < 30; ++step) static_cast<void>(anew.step(0.1));
          }));
          for (std::size_t const modes : {std::size_t{1}, std::size_t{6}}) {
            auto& predicted = results["embedding/predict" + (modes > 1 ? "/6_modes" + name : name)].us;
            states.resize(std::max(states.size(), modes * tracker.world().size() * 30));
            predicted.push_back(microseconds([&] { tracker.predict({.modes = modes}, states); }));
          }
          objects += static_cast<double>(list.size());
          traffic.step();
        }
        std::printf("%.0f objects a list\n", objects / cycles);
      }
    std::string text = "{";
    for (auto& [name, times] : results) {
      double const median = times.median(), worst = times.worst();
      std::printf("%-28s median %8.1f us   worst %8.1f us\n", name.c_str(), median, worst);
      text += (text.size() > 1 ? ",\n " : "\n ") + std::string("\"") + name +
              "\": {\"median_us\": " + std::to_string(median) + ", \"worst_us\": " + std::to_string(worst) + "}";
    }
    if (json.empty()) return 0;
    std::ofstream file(json);
    file << text << "\n}\n";
    if (file.flush()) return 0;
    std::fprintf(stderr, "embedding: %s cannot be written\n", json.c_str());
  } catch (cb::Error const& error) {
    std::fprintf(stderr, "embedding: %s\n", error.what());
  }
  return 1;
}
