// Drives in traffic as a car would, and keeps the state from just before each cycle that went wrong: a collision, hard
// braking, a jerk, no plan, an exception. `examples/run debug_snapshot FILE` takes it apart.

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>

#include <CLI/CLI.hpp>

#include "cambium/core/distributions.hpp"
#include "cambium/core/read_file.hpp"
#include "cambium/evaluation/collision.hpp"
#include "cambium/map/opendrive.hpp"
#include "cambium/snapshot.hpp"

#include "common/command_line.hpp"
#include "common/desk.hpp"
#include "common/map_file.hpp"

namespace cb = cambium;

namespace {

struct Settings {
  std::string out, map = CAMBIUM_SOURCE_DIR "/maps/merging.xodr", planner = "follower", format = "binary";
  std::uint64_t seed = 5, iterations = 200;
  double seconds = 12.0, late = 0.2;
  bool each_cycle = false, embeds_map = false;
};

desk::World traffic(Settings const& settings, std::string const& map_text) {
  auto const map =
      map_text.empty() ? examples::load_map(settings.map) : cb::parse_opendrive(map_text, {}, settings.map).map;
  desk::World world(map, {.seed = settings.seed});
  cb::RandomStream random(settings.seed, 0, 0);
  desk::World::Behavior ego = desk::SmoothFollower{};
  if (settings.planner == "search") {
    desk::Planner planner;
    planner.options.budget.iterations = settings.iterations;
    ego = planner;
  }
  world.add({.position = {20, -5.25}, .speed = 12, .behavior = ego, .id = desk::ego});
  for (int i = 0; i < 8; ++i) {
    double const speed = cb::Uniform{5.0, 14.0}(random);
    desk::World::Behavior driver = cb::IdmClassic{.law = {.desired_speed = speed}};
    if (i % 3 == 1) driver = cb::Mobil{};
    if (i % 3 == 2) driver = cb::UrbanDriver{};
    world.add({.position = {50.0 + 25.0 * i, i % 2 == 0 ? -5.25 : -1.75}, .speed = speed, .behavior = driver});
  }
  return world;
}

void drive(Settings const& settings) {
  std::string const map_text = settings.embeds_map ? cb::read_file<cb::MapError>(settings.map, {}) : "";
  auto world = traffic(settings, map_text);
  desk::Cycle cycle;
  double last = 0.0, last_duration = 0.2;  // acceleration [m/s^2] and duration [s] of the last cycle
  bool is_first = true;
  cb::SnapshotRecorderOptions options{.folder = settings.out, .each_cycle = settings.each_cycle};
  options.snapshot.format = settings.format == "xml"    ? cb::SnapshotFormat::xml
                            : settings.format == "text" ? cb::SnapshotFormat::text
                                                        : cb::SnapshotFormat::binary;
  options.snapshot.map_file = std::filesystem::absolute(settings.map).string();
  options.snapshot.component = desk::component;
  options.snapshot.map_text = map_text;
  options.watches.push_back([&] { return cb::Collision{}(world, world.slot_of(desk::ego)) ? "ego collides" : ""; });
  options.watches.push_back(
      [&] { return world.record(desk::ego).acceleration < -6.0f ? "ego brakes harder than 6 m/s^2" : ""; });
  options.watches.push_back([&]() -> std::string {  // passengers feel more jerk than the planner allows itself
    double const now = world.record(desk::ego).action.acceleration;
    double const duration = cycle.time_step + cycle.late;
    double const rate = std::abs(now - last) / (0.5 * (duration + last_duration));
    last = now;
    last_duration = duration;
    constexpr double felt = 0.9;  // [m/s^3]
    return settings.planner == "follower" && rate > felt && !is_first
               ? "a jerk of " + cb::detail::rounded_text(rate) + " m/s^3"
               : "";
  });
  cb::SnapshotRecorder recorder(options);
  cb::RandomStream random(settings.seed, 1, 0);
  int cycles = 0;
  while (world.time() < settings.seconds && world.status(desk::ego) == cb::AgentStatus::driving) {
    cycle.late = cb::uniform01(random) < settings.late ? 0.5 : 0.0;  // now and then the machine is busy
    recorder.begin(world, cycle);
    try {
      auto const result = world.step(cycle.time_step + cycle.late);
      if (!result) recorder.trigger(to_string(result.problem));
    } catch (std::exception const& error) {
      recorder.trigger(std::string("exception: ") + error.what());
      recorder.end();
      throw;
    }
    recorder.end(world);
    is_first = false;
    ++cycles;
  }
  recorder.flush();
  std::printf("%d cycles, %.1f s; %zu snapshots in %s\n", cycles, world.time(), recorder.written(),
              settings.out.c_str());
  if (recorder.written() > 0)
    std::printf("next: examples/run debug_snapshot %s\n", recorder.last_file().string().c_str());
  if (recorder.failed() > 0)
    throw cb::SnapshotError(std::to_string(recorder.failed()) + " snapshots",
                            "could not be written, the last one because: " + recorder.problem());
}

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  CLI::App program("Drives in traffic and keeps the state before each cycle that went wrong.", "record_snapshots");
  program.add_option("--out", settings.out, "folder of the snapshots")->required()->check(examples::not_empty());
  program.add_option("--map", settings.map, "OpenDRIVE map")->type_name("FILE");
  program.add_option("--planner", settings.planner, "who drives: follower (has a defect, for practice) or search")
      ->check(CLI::IsMember({"follower", "search"}))
      ->capture_default_str();
  program.add_option("--format", settings.format, "binary, text or xml")
      ->check(CLI::IsMember({"binary", "text", "xml"}))
      ->capture_default_str();
  program.add_option("--seed", settings.seed, "of the traffic")
      ->check(examples::whole_number(0, ~std::uint64_t{0}))
      ->capture_default_str();
  program.add_option("--iterations", settings.iterations, "of the search")
      ->check(examples::whole_number(1, 1'000'000))
      ->capture_default_str();
  program.add_option("--seconds", settings.seconds, "duration [s]")
      ->check(examples::number(0.1, 3600.0))
      ->capture_default_str();
  program.add_option("--late", settings.late, "share of the cycles that come 0.5 s late")
      ->check(examples::number(0.0, 1.0))
      ->capture_default_str();
  program.add_flag("--each-cycle", settings.each_cycle, "keep all cycles");
  program.add_flag("--embed-map", settings.embeds_map, "put the map into each file (OpenDRIVE only)");
  return examples::run_program(program, argc, argv, [&] { drive(settings); });
}
