// Where traffic drives, as one hash for each model and map: two versions drive alike, bit for bit, if they print the
// same. Save the output of the version before a change, and compare: bench/run trajectories --compare FILE.

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "cambium/behavior.hpp"
#include "cambium/core/distributions.hpp"
#include "cambium/core/random.hpp"
#include "cambium/dynamics/single_track.hpp"
#include "cambium/execution/interpolate.hpp"
#include "cambium/map/opendrive.hpp"
#include "cambium/world/world.hpp"

namespace cb = cambium;

namespace {

/// FNV-1a over the bits of numbers.
class Hash {
 public:
  void add(std::uint64_t word) {
    for (int byte = 0; byte < 8; ++byte) value_ = (value_ ^ (word >> (8 * byte) & 0xff)) * 1099511628211ull;
  }
  void add(double x) { add(std::bit_cast<std::uint64_t>(x)); }
  [[nodiscard]] std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 1469598103934665603ull;
};

/// Vehicles anywhere on the lanes of the map, some of them close together, some with a goal, one in five long; two
/// obstacles.
template <class World>
void fill(World& world, std::uint64_t seed) {
  auto const& map = world.map();
  std::vector<cb::LaneId> lanes;
  for (auto const& lane : map.lanes())
    if (lane.drivable() && lane.length() > 12.0) lanes.push_back(lane.id);
  if (lanes.empty()) return;
  cb::RandomStream random(seed, 0, 0);
  auto const any = [&] { return lanes[cb::uniform_index(random, static_cast<std::uint32_t>(lanes.size()))]; };
  auto cluster = any();
  for (int i = 0; i < 72 && world.size() < 24; ++i) {
    if (i % 4 == 0) cluster = any();
    auto const& lane = map.lane(cluster);
    auto const pose = lane.path.pose(5.0 + cb::uniform01(random) * (lane.length() - 10.0));
    typename World::AgentSpec spec{
        .position = pose.position(), .heading = pose.heading, .speed = 16.0 * cb::uniform01(random)};
    if (i % 5 == 4) spec.shape = cb::geometry::truck();
    if (cb::uniform01(random) < 0.4) spec.goal = cb::ReachLane{any()};
    for (bool const again : {false, true}) {
      try {
        world.add(spec);
        break;
      } catch (cb::Error const&) {  // the goal cannot be reached from there
        if (again) continue;
        spec.goal = cb::NoGoal{};
      }
    }
  }
  for (int i = 0; i < 2; ++i) {
    auto const p = map.lane(any()).path.pose(6.0).position();
    world.add_object(
        cb::geometry::Polygon({{p.x() - 0.5, p.y() - 0.5}, {p.x() + 0.5, p.y() - 0.5}, {p.x(), p.y() + 0.5}}));
  }
}

template <class Behavior>
std::string line(std::string const& map_name, std::shared_ptr<cb::Map const> const& map) {
  Hash hash;
  for (double const dt : {0.1, 0.2, 0.5}) {
    cb::World<cb::BehaviorSet<Behavior>, cb::InterpolateExecution, cb::SingleTrack> world(map, {.seed = 7});
    fill(world, static_cast<std::uint64_t>(10.0 * dt));
    for (int step = 0; step < 100; ++step) {
      auto const result = world.step(dt);
      hash.add(static_cast<std::uint64_t>(result.failed));
      for (auto const& agent : world.frame().agents) {
        hash.add(static_cast<std::uint64_t>(agent.status));
        for (double const x : {agent.state.x, agent.state.y, agent.state.heading, agent.state.speed, agent.lane.s,
                               agent.lane.lateral, agent.action.acceleration})
          hash.add(x);
      }
    }
  }
  char text[256];
  std::snprintf(text, sizeof text, "%-24s %-44s %016llx", Behavior::name, map_name.c_str(),
                static_cast<unsigned long long>(hash.value()));
  return text;
}

template <class... Behaviors>
void drive_all(std::string const& name, std::shared_ptr<cb::Map const> const& map, std::vector<std::string>& lines) {
  (lines.push_back(line<Behaviors>(name, map)), ...);
}

std::vector<std::string> drive() {
  std::vector<std::filesystem::path> files;
  auto const look_in = [&](std::filesystem::path const& folder) {
    if (!std::filesystem::exists(folder)) return;
    for (auto const& entry : std::filesystem::directory_iterator(folder))
      if (entry.path().extension() == ".xodr") files.push_back(entry.path());
  };
  look_in(std::filesystem::path(CAMBIUM_SOURCE_DIR) / "maps");
  if (char const* const corpus = std::getenv("CAMBIUM_CORPUS")) look_in(std::filesystem::path(corpus) / "opendrive");
  std::sort(files.begin(), files.end());
  std::vector<std::string> lines;
  for (auto const& file : files)
    drive_all<cb::IdmClassic, cb::IdmLaneTracking, cb::AdaptiveCruiseControl, cb::IdmStochastic, cb::Mobil,
              cb::LaneChangeRuleBased, cb::ZipMerge, cb::Intersection, cb::RssConformant<cb::IdmClassic>,
              cb::RandomMacroActions, cb::Pedestrian>(file.filename().string(), cb::load_opendrive(file.string()).map,
                                                      lines);
  return lines;
}

/// Prints the lines of one list that the other lacks; returns how many.
int print_missing(char const* what, std::vector<std::string> const& lines, std::vector<std::string> const& others) {
  std::set<std::string> const known(others.begin(), others.end());
  int count = 0;
  for (auto const& line : lines)
    if (!known.contains(line)) std::printf("%s %s\n", what, line.c_str()), ++count;
  return count;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App program("Hashes of trajectories, by model and map: equal hashes mean equal bits.", "trajectories");
  std::string before;
  program.add_option("--compare", before, "what an earlier version printed: only differences are shown")
      ->check(CLI::ExistingFile);
  CLI11_PARSE(program, argc, argv);
  auto const lines = drive();
  if (before.empty()) {
    for (auto const& line : lines) std::printf("%s\n", line.c_str());
    return 0;
  }
  std::vector<std::string> earlier;
  std::ifstream file(before);
  for (std::string line; std::getline(file, line);) earlier.push_back(line);
  int const different = print_missing("-", earlier, lines) + print_missing("+", lines, earlier);
  if (different == 0) std::printf("%zu models on maps drive as before, bit for bit\n", lines.size());
  return different == 0 ? 0 : 1;
}
