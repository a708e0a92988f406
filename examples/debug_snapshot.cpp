// The desk: restores a state that `record_snapshots` has kept, says what is in it, runs the cycle again and says
// whether it came out bit-equal. Built to sit in a debugger: --break stops just before the cycle.

#include <csignal>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include "cambium/core/set_parameter.hpp"
#include "cambium/core/text.hpp"
#include "cambium/evaluation/collision.hpp"
#include "cambium/map/opendrive.hpp"
#include "cambium/snapshot.hpp"
#include "cambium/viewer/html_replay.hpp"
#include "cambium/viewer/record_world.hpp"
#include "cambium/viewer/svg_picture.hpp"

#include "common/command_line.hpp"
#include "common/desk.hpp"
#include "common/map_file.hpp"

namespace cb = cambium;
namespace fs = std::filesystem;

namespace {

struct Settings {
  std::string file, edit, replay;
  std::uint64_t cycles = 1;
  bool breaks = false, goes_on = false, as_test = false;
};

/// The map of the snapshot: embedded, where it was, or of that name in maps/.
std::shared_ptr<cb::Map const> map_of(cb::SnapshotInfo const& info, std::string const& file) {
  if (!info.map_text.empty()) return cb::parse_opendrive(info.map_text).map;
  if (info.map_file.empty())
    throw cb::SnapshotError(file, "does not say where its map is", "record it with a map_file, or embed the map");
  if (fs::exists(info.map_file)) return examples::load_map(info.map_file);
  auto const own = fs::path(CAMBIUM_SOURCE_DIR) / "maps" / fs::path(info.map_file).filename();
  if (fs::exists(own)) return examples::load_map(own.string());
  throw cb::SnapshotError(file, "needs the map '" + info.map_file + "', which is not there", "copy it there");
}

void print_head(cb::SnapshotInfo const& info, std::string const& file) {
  std::printf("%s\n  parts     %s\n  taken by  cambium %s, %s, %s\n", file.c_str(), info.parts.c_str(),
              info.library.c_str(), info.build.c_str(), info.platform.c_str());
  if (info.map_hash)
    std::printf("  map       %s (%016llx)\n", info.map_text.empty() ? info.map_file.c_str() : "embedded",
                static_cast<unsigned long long>(*info.map_hash));
  if (!info.note.empty()) std::printf("  because   %s\n", info.note.c_str());
}

void print_world(desk::World const& world) {
  std::printf("  time      %.3f s\n\n  agent  model              x [m]    y [m]   v [m/s]  a [m/s^2]  status\n",
              world.time());
  for (cb::Slot slot{}; cb::index_of(slot) < world.size(); ++slot) {
    auto const& agent = world.roster().agents[slot];
    auto const& record = world.frame().agents[slot];
    std::string const model = agent.behavior.visit([]<class B>(B const&) { return std::string(B::name); });
    std::printf("  %5s  %-15s %8.2f %8.2f  %8.2f   %8.2f  %s\n", to_string(agent.id).c_str(), model.c_str(),
                record.state.x, record.state.y, record.state.speed, record.action.acceleration,
                to_string(record.status));
  }
  auto const& planner = world.roster().agents[world.slot_of(desk::ego)].behavior;
  std::printf("\n  agent %s: %s\n", to_string(desk::ego).c_str(),
              planner.visit([](auto const& b) { return cb::to_string(b); }).c_str());
  std::visit([]<class M>(M const& memory) { std::printf("  remembers: %s\n", cb::to_string(memory).c_str()); },
             world.record(desk::ego).memory);
}

/// Applies "behavior.KEY=VALUE" to the ego's behaviour.
void edit(desk::World& world, std::string const& text) {
  auto const sign = text.find('=');
  auto const key = text.substr(0, sign);
  auto const value = sign == text.npos ? std::nullopt : cb::detail::parse_number<double>(text.substr(sign + 1));
  constexpr std::string_view place = "behavior.";
  if (!value || !key.starts_with(place))
    throw cb::ParameterError("--edit", "is '" + text + "'", "write behavior.KEY=NUMBER, such as behavior.jerk=1");
  auto const memory = world.record(desk::ego).memory;
  desk::World::Behavior edited = world.roster().agents[world.slot_of(desk::ego)].behavior;
  std::visit([&]<class B>(B& behavior) { cb::set_parameter(behavior, key.substr(place.size()), *value, "--edit"); },
             static_cast<desk::World::Behavior::variant&>(edited));
  world.set_behavior(desk::ego, edited);
  auto frame = world.frame();
  frame.agents[world.slot_of(desk::ego)].memory = memory;  // what it remembers stays
  world.restore(frame);
}

void print_test(Settings const& settings, cb::SnapshotInfo const& info) {
  std::printf(
      "\n// Needs common/desk.hpp of the examples, and the snapshot beside the test.\n"
      "TEST_CASE(\"the cycle of %s comes out as recorded\") {\n"
      "  desk::World world(cambium::load_opendrive(\"%s\").map);\n  desk::Cycle cycle;\n"
      "  cambium::load_snapshot(\"%s\", world, cycle);\n  REQUIRE(desk::run(world, cycle));\n"
      "  CHECK(cambium::snapshot_hash(world) == 0x%016llxu);\n}\n",
      fs::path(settings.file).filename().string().c_str(), info.map_file.c_str(), settings.file.c_str(),
      static_cast<unsigned long long>(info.result.value_or(0)));
}

int debug(Settings const& settings) {
  auto const bytes = cb::read_snapshot_file(settings.file);
  auto const info = cb::snapshot_info(bytes, settings.file);
  print_head(info, settings.file);
  desk::World world(map_of(info, settings.file));
  desk::Cycle cycle;
  cb::from_snapshot(bytes, settings.file, world, cycle);
  print_world(world);
  if (!settings.edit.empty()) edit(world, settings.edit);
  cb::WorldRecorder recorder(world, fs::path(settings.file).filename().string());
  recorder.show_as(desk::ego, cb::RecordedAgentKind::ego);

  if (settings.breaks) std::raise(SIGTRAP);
  auto const result = desk::run(world, cycle);  // the cycle: step into it
  recorder.record(world);

  auto const& ego = world.record(desk::ego);
  std::printf("\nthe cycle of %.3f s: %s; agent %s at (%.3f, %.3f), %.3f m/s, %.3f m/s^2\n", cycle.duration,
              to_string(result.problem), to_string(desk::ego).c_str(), ego.state.x, ego.state.y, ego.state.speed,
              ego.action.acceleration);
  bool const is_equal = info.result && cb::snapshot_hash(world) == *info.result;
  bool const is_of_other = info.library != cb::library_version;
  std::printf("%s\n", is_equal       ? "It came out bit-equal to what was recorded."
                      : !info.result ? "Its result was not recorded: there is nothing to compare with."
                      : is_of_other  ? "It cannot be compared: another version of cambium recorded it."
                                     : "It came out otherwise than recorded.");
  double const end = settings.goes_on ? world.time() + 60.0 : 0.0;
  bool collides = cb::Collision{}(world, world.slot_of(desk::ego));
  for (std::uint64_t i = 1; i < settings.cycles || world.time() < end; ++i) {
    if (world.status(desk::ego) != cb::AgentStatus::driving) break;
    cycle.duration = 0.2;
    if (auto const next = desk::run(world, cycle); !next) {
      std::printf("%.1f s: %s\n", world.time(), to_string(next.problem));
      break;
    }
    recorder.record(world);
    collides = collides || cb::Collision{}(world, world.slot_of(desk::ego));
  }
  if (settings.goes_on || settings.cycles > 1)
    std::printf("until %.1f s: agent %s %s, %s\n", world.time(), to_string(desk::ego).c_str(),
                to_string(world.status(desk::ego)), collides ? "after a collision" : "no collision");
  if (!settings.replay.empty()) {
    auto const recording = recorder.recording();
    cb::write_html_replay(settings.replay, recording);
    auto const figure = fs::path(settings.replay).replace_extension(".svg");
    cb::write_svg_picture(figure, recording, {.frame = 0});
    std::printf("replay: %s, figure: %s\n", settings.replay.c_str(), figure.string().c_str());
  }
  if (settings.as_test && info.result) print_test(settings, info);
  return is_equal ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  CLI::App program("Restores a snapshot and runs its cycle again. Exit code 0: bit-equal, 1: not, 2: a bad file.",
                   "debug_snapshot");
  program.add_option("FILE", settings.file, "a snapshot of record_snapshots")->required();
  program.add_option("--cycles", settings.cycles, "how many to run")
      ->check(examples::whole_number(1, 100'000))
      ->capture_default_str();
  program.add_flag("--break", settings.breaks, "stop in the debugger before the cycle (without one, the program ends)");
  program.add_option("--edit", settings.edit, "change a parameter of the ego first: behavior.jerk=1")
      ->type_name("KEY=VALUE");
  program.add_flag("--into-simulation", settings.goes_on, "go on for a minute");
  program.add_flag("--as-test", settings.as_test, "print a test that repeats the cycle");
  program.add_option("--replay", settings.replay, "write a replay that opens in a browser, and a figure beside it")
      ->type_name("OUT.html")
      ->check(examples::not_empty());
  return examples::run_program(program, argc, argv, [&] { return debug(settings); });
}
