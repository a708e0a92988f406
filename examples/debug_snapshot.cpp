// The desk: restores a state that `record_snapshots` or the benchmark has kept, says what is in it, runs the cycle
// again and says whether it came out bit-equal. Built to sit in a debugger: --break stops just before the cycle.

#include <array>
#include <cctype>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include <CLI/CLI.hpp>

#include "cambium/core/markup.hpp"
#include "cambium/core/nearest_names.hpp"
#include "cambium/core/text.hpp"
#include "cambium/map/opendrive.hpp"
#include "cambium/snapshot/snapshot.hpp"
#include "cambium/viewer/html_replay.hpp"
#include "cambium/viewer/svg_picture.hpp"

#include "benchmark/traffic.hpp"
#include "common/command_line.hpp"
#include "common/desk.hpp"
#include "common/map_file.hpp"
#include "common/parameter_file.hpp"
#include "common/thawed.hpp"

namespace cb = cambium;
namespace fs = std::filesystem;

namespace {

struct Settings {
  std::string file, map, replay;
  std::vector<std::string> edits;
  std::uint64_t cycles = 1;
  bool breaks = false, goes_on = false, as_test = false;
};

/// The file of the snapshot's map: the one given, where it was, or of that name in maps/; empty if it is embedded.
std::string map_file_of(cb::SnapshotInfo const& info, Settings const& settings) {
  if (!settings.map.empty() || !info.map_text.empty()) return settings.map;
  if (info.map_file.empty())
    throw cb::SnapshotError(settings.file, "does not say where its map is", "give the file by --map");
  auto const own = fs::path(CAMBIUM_SOURCE_DIR) / "maps" / fs::path(info.map_file).filename();
  std::error_code refused;  // of a folder that may not be looked into
  for (auto const& file : {fs::path(info.map_file), own})
    if (fs::exists(file, refused)) return file.string();
  throw cb::SnapshotError(settings.file, "needs the map '" + info.map_file + "', which is not there",
                          "give the file by --map");
}

void print_head(cb::SnapshotInfo const& info, std::string const& file, std::string const& map_file) {
  std::printf("%s\n", file.c_str());
  if (!info.component.empty()) std::printf("  component %s\n", info.component.c_str());
  std::printf("  parts     %s\n  taken by  cambium %s, %s, %s\n", info.parts.c_str(), info.library.c_str(),
              info.build.c_str(), info.platform.c_str());
  if (info.map_hash)
    std::printf("  map       %s (%016llx)\n", map_file.empty() ? "embedded" : map_file.c_str(),
                static_cast<unsigned long long>(*info.map_hash));
  if (!info.note.empty()) std::printf("  because   %s\n", info.note.c_str());
}

void print_world(examples::Thawed const& thawed) {
  std::printf("  time      %.3f s\n\n  agent  model                   x [m]    y [m]   v [m/s]  a [m/s^2]  status\n",
              thawed.time());
  for (auto const& agent : thawed.agents())
    std::printf("  %5s  %-20s %8.2f %8.2f  %8.2f   %8.2f  %s\n", agent.id.c_str(), agent.model.c_str(), agent.x,
                agent.y, agent.speed, agent.acceleration, agent.status.c_str());
}

void print_model(examples::Thawed const& thawed) {
  auto const [usual, behavior, memory] = std::array{std::string("{}\n"), thawed.behavior(), thawed.memory()};
  std::printf("\n  agent %s: %s, %s  remembers: %s", thawed.ego().id.c_str(), thawed.ego().model.c_str(),
              behavior == usual ? "parameters at their defaults\n"
                                : ("with these parameters, else defaults: " + behavior).c_str(),
              memory == usual ? "nothing\n" : memory.c_str());
}

/// Applies "behavior.KEY=VALUE" or "memory.KEY=VALUE" to the ego.
void edit(examples::Thawed& thawed, std::string const& text) {
  auto const sign = text.find('=');
  auto const path = text.substr(0, sign);
  auto const keys = cb::detail::split(path, ".");
  auto const value = sign == text.npos ? "" : text.substr(sign + 1);
  bool const is_memory = keys[0] == "memory";
  if (keys.size() < 2 || value.empty() || !(is_memory || keys[0] == "behavior"))
    throw cb::ParameterError("--edit", "is '" + text + "'",
                             "write behavior.KEY=VALUE, such as behavior.jerk=1, or memory.KEY=VALUE");
  auto const begin = value.find_first_not_of("+-");
  bool const is_word = begin != value.npos && std::isalpha(static_cast<unsigned char>(value[begin])) != 0 &&
                       value != "true" && value != "false";
  auto json = is_word ? cb::detail::json_string(value) : value;
  examples::require_json(json, "--edit '" + text + "'");
  for (std::size_t i = keys.size() - 1; i > 0; --i)
    json = "{" + cb::detail::json_string(std::string(keys[i])) + ": " + json + "}";
  try {
    thawed.edit(json, is_memory);
  } catch (cb::Error const& problem) {
    throw cb::ParameterError("--edit '" + text + "'", problem.what());
  }
}

/// Where the types of a snapshot are: what thaws it, and how that is called in a test.
struct Types {
  examples::Thaw thaw;
  std::string call;
};

Types types_of(cb::SnapshotInfo const& info, std::string const& file) {
  if (info.component == desk::component) return {&desk::thaw, "desk::thaw"};
  examples::ParameterFile usual;
  std::vector<std::string> known{desk::component};
  for (auto const& contender : benchmark::shipped(usual)) {
    if (contender.name == info.component) return {&benchmark::thaw, "benchmark::thaw"};
    known.push_back(contender.name);
  }
  throw cb::SnapshotError(
      file,
      info.component.empty() ? "does not say whose state it is"
                             : "is the state of a component '" + info.component + "', which this program does not know",
      cb::detail::suggestion(info.component, known));
}

void print_test(std::string const& file, std::string const& map_file, std::string const& call, std::uint64_t result) {
  auto const map = map_file.empty() ? "cambium::parse_opendrive(cambium::snapshot_info(bytes).map_text).map"
                                    : "examples::load_map(" + cb::detail::json_string(map_file) + ")";
  std::printf(
      "\n// Needs the examples' sources, with these headers, and the snapshot.\n"
      "#include <cambium/map/opendrive.hpp>\n#include <cambium/snapshot.hpp>\n#include "
      "\"benchmark/traffic.hpp\"\n#include "
      "\"common/desk.hpp\"\n#include \"common/map_file.hpp\"\n\n"
      "TEST_CASE(%s) {\n"
      "  std::string const file = %s, bytes = cambium::read_snapshot_file(file);\n"
      "  auto const thawed = %s(\n      %s, bytes, file);\n"
      "  static_cast<void>(thawed->run());\n"
      "  CHECK(thawed->hash() == 0x%016llxu);\n}\n",
      cb::detail::json_string("the cycle of " + fs::path(file).filename().string() + " comes out as recorded").c_str(),
      cb::detail::json_string(file).c_str(), call.c_str(), map.c_str(), static_cast<unsigned long long>(result));
}

/// How the ego comes out of a cycle. `because`: why it was kept, where it came out as recorded.
void print_ego(std::string const& what, cb::StepResult const& result, std::string const& because,
               examples::ThawedAgent const& ego) {
  std::string const outcome = !result ? to_string(result.problem) : because.empty() ? "the step succeeded" : because;
  std::printf("%s: %s; agent %s at (%.3f, %.3f), %.3f m/s, %.3f m/s^2\n", what.c_str(), outcome.c_str(), ego.id.c_str(),
              ego.x, ego.y, ego.speed, ego.acceleration);
}

/// Says whether the cycle came out as recorded.
void print_verdict(cb::SnapshotInfo const& info, bool is_equal) {
  bool const is_of_other = info.library != cb::library_version;
  std::printf("%s\n", is_equal       ? "It came out bit-equal to what was recorded."
                      : !info.result ? "Its result was not recorded: there is nothing to compare with."
                      : is_of_other  ? "It cannot be compared: another version of cambium recorded it."
                                     : "It came out otherwise than recorded.");
  if (!is_equal && info.result && info.build != cb::detail::build_tag())
    std::printf(
        "It was recorded by a build with %s; this program was built with %s. Fused multiply-adds (-march=native) "
        "change the last bits.\n",
        info.build.c_str(), cb::detail::build_tag().c_str());
}

/// Runs the cycle as it was recorded, beside the edited one.
void print_unedited(examples::Thawed& as_recorded, examples::Thawed const& edited, cb::SnapshotInfo const& info,
                    bool is_equal) {
  try {
    auto const result = as_recorded.run();
    print_ego("without the edit", result, info.note, as_recorded.ego());
  } catch (std::exception const& error) {
    std::printf("without the edit it threw an exception: %s\n", error.what());
    return;
  }
  if (is_equal)
    std::printf("The edit changes nothing: it came out bit-equal to what was recorded.\n");
  else if (as_recorded.agents() == edited.agents())
    std::printf("The edit changes no agent's motion in this cycle.\n");
}

/// Goes on until `settings` say, or the ego has left traffic.
void go_on(examples::Thawed& thawed, Settings const& settings) {
  double const end = settings.goes_on ? thawed.time_limit().value_or(thawed.time() + 60.0) : 0.0;
  std::string last;
  bool collides = false;
  auto const look = [&] {
    auto const trouble = thawed.trouble();
    if (!trouble.empty() && trouble != last)
      std::printf("%.1f s: agent %s %s\n", thawed.time(), thawed.ego().id.c_str(), trouble.c_str());
    collides = collides || trouble.starts_with("collides");
    last = trouble;
  };
  look();
  for (std::uint64_t i = 1; (i < settings.cycles || thawed.time() < end) && thawed.ego_drives(); ++i) {
    try {
      if (auto const next = thawed.run(); !next) {
        std::printf("%.1f s: %s\n", thawed.time(), to_string(next.problem));
        break;
      }
    } catch (std::exception const& error) {
      std::printf("%.1f s: threw an exception: %s\n", thawed.time(), error.what());
      break;
    }
    look();
  }
  if (settings.goes_on || settings.cycles > 1)
    std::printf("until %.1f s: agent %s %s, %s\n", thawed.time(), thawed.ego().id.c_str(), thawed.ego().status.c_str(),
                collides ? "after a collision" : "no collision");
}

int debug(Settings const& settings) {
  std::error_code none;
  if (!settings.replay.empty() && fs::equivalent(settings.replay, settings.file, none))
    throw cb::ParameterError("--replay", "is the snapshot itself", "give the name of another file");
  auto const bytes = cb::read_snapshot_file(settings.file);
  auto const info = cb::snapshot_info(bytes, settings.file);
  auto const types = types_of(info, settings.file);
  auto const map_file = map_file_of(info, settings);
  auto const map = map_file.empty() ? cb::parse_opendrive(info.map_text, {}, "the map in " + settings.file).map
                                    : examples::load_map(map_file);
  auto const thawed = types.thaw(map, bytes, settings.file);
  print_head(info, settings.file, map_file);
  print_world(*thawed);
  print_model(*thawed);
  auto title =
      fs::path(settings.file).filename().string() + ", from " + cb::detail::rounded_text(thawed->time()) + " s";
  for (auto const& text : settings.edits) {
    edit(*thawed, text);
    title += ", " + text;
  }
  if (!settings.edits.empty()) {
    std::printf("\n  edited:");
    print_model(*thawed);
  }
  if (!settings.replay.empty()) thawed->film(title);

  auto const cycle = "the cycle of " + cb::detail::rounded_text(thawed->time_step()) + " s";
  cb::StepResult result;
  std::fflush(stdout);
  if (settings.breaks) std::fprintf(stderr, "debug_snapshot: stops before the cycle, for a debugger\n");
  try {
    if (settings.breaks) std::raise(SIGTRAP);
    result = thawed->run();  // the cycle: step into it
  } catch (std::exception const& error) {
    std::printf("\n%s threw an exception: %s\n", cycle.c_str(), error.what());
    if (settings.as_test || !settings.replay.empty()) std::printf("It has no result: neither a replay nor a test.\n");
    return 1;
  }

  bool const is_equal = info.result && thawed->hash() == *info.result;
  print_ego("\n" + cycle, result, is_equal ? info.note : "", thawed->ego());
  if (settings.edits.empty())
    print_verdict(info, is_equal);
  else
    print_unedited(*types.thaw(map, bytes, settings.file), *thawed, info, is_equal);
  go_on(*thawed, settings);
  if (!settings.replay.empty()) {
    if (!info.note.empty()) thawed->recording().notes.push_back(info.note);
    cb::write_html_replay(settings.replay, thawed->recording());
    auto const figure = fs::path(settings.replay).replace_extension(".svg");
    cb::write_svg_picture(figure, thawed->recording(), {.frame = 0});
    std::printf("replay: %s, figure: %s\n", settings.replay.c_str(), figure.string().c_str());
  }
  if (settings.as_test && !info.result) std::printf("no test: there is no result to compare with\n");
  if (settings.as_test && info.result)
    print_test(fs::absolute(settings.file).string(), map_file.empty() ? "" : fs::absolute(map_file).string(),
               types.call, *info.result);
  return is_equal ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  CLI::App program(
      "Restores a snapshot and runs its cycle again. Exit code: 0 if it came out bit-equal to what was recorded, 1 if "
      "not (as "
      "after --edit, or where it throws), 2 for a bad file or option.",
      "debug_snapshot");
  program.add_option("FILE", settings.file, "a snapshot of record_snapshots, or of a failure in the benchmark")
      ->required();
  program.add_option("--map", settings.map, "its map, if that is not where it was (OpenDRIVE)")
      ->type_name("FILE")
      ->check(examples::not_empty());
  auto* const cycles = program.add_option("--cycles", settings.cycles, "how many to run")
                           ->check(examples::whole_number(1, 100'000))
                           ->capture_default_str();
  program.add_flag("--break", settings.breaks,
                   "stop in the debugger before the cycle (without one, SIGTRAP ends the program)");
  auto* const edits = program
                          .add_option("--edit", settings.edits,
                                      "change the ego first: behavior.jerk=1, memory.planned_at=0; may be repeated")
                          ->type_name("KEY=VALUE")
                          ->allow_extra_args(false)
                          ->check(examples::not_empty());
  program.add_flag("--into-simulation", settings.goes_on, "go on to the end of the benchmark's run, else for a minute")
      ->excludes(cycles);
  program.add_flag("--as-test", settings.as_test, "print a test that repeats the cycle as recorded")->excludes(edits);
  program.add_option("--replay", settings.replay, "write a replay that opens in a browser, and a figure beside it")
      ->type_name("OUT.html")
      ->check(CLI::Validator(
          [](std::string const& file) {
            return file.ends_with(".html") ? "" : "is '" + file + "'; give a name that ends in .html";
          },
          ""));
  return examples::run_program(program, argc, argv, [&] { return debug(settings); });
}
