// cambium inside an existing planner stack: lists of objects from its perception in, verdicts and predictions out. The
// code between the two marks is all that the stack needs; the rest imitates the stack, and prints. predictor.hpp costs
// less than <Eigen/Dense> to compile: what it declares is in cambium::compiled_predictor.

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "cambium/predictor.hpp"

#include "../common/command_line.hpp"
#include "perception.hpp"

namespace {

// [embed
namespace cb = cambium;

struct Traffic {
  cb::Predictor predictor;  ///< once per map
  std::vector<cb::TrackedObject> objects{};
  std::vector<cb::PredictedState> states{};  ///< [mode, object, step]

  /// Once per cycle: a verdict for each object of the list, and 3 s of what each tracked one may do.
  auto cycle(std::int64_t stamp, std::vector<stack::Object> const& seen) {
    constexpr cb::ObjectClass kinds[] = {cb::ObjectClass::car, cb::ObjectClass::truck, cb::ObjectClass::bicycle,
                                         cb::ObjectClass::pedestrian};
    objects.clear();
    for (auto const& o : seen)
      objects.push_back({.key = cb::key_of(o.uuid),
                         .stamp = o.stamp,
                         .x = o.x,
                         .y = o.y,
                         .heading = o.yaw,
                         .vx = o.speed * std::cos(o.yaw),
                         .vy = o.speed * std::sin(o.yaw),
                         .length = o.length,
                         .width = o.width,
                         .kind = kinds[static_cast<int>(o.label)]});
    auto const verdicts = predictor.update(stamp, objects);
    states.resize(3 * predictor.objects().size() * 30);
    return std::pair(verdicts, predictor.predict({.steps = 30, .step = 0.1, .modes = 3}, states));
  }
};
// embed]

void print(std::vector<stack::Object> const& list, std::span<cb::Verdict const> verdicts,
           cb::PredictedModes const& prediction, std::vector<cb::PredictedState> const& states) {
  for (std::size_t i = 0; i < list.size(); ++i) {
    auto const& verdict = verdicts[i];
    if (verdict.refusal != cb::Refusal::none) {
      std::printf("%-10s  refused: %s\n", list[i].uuid.c_str(), to_string(verdict.refusal));
      continue;
    }
    std::printf("%-10s  %s%s\n", list[i].uuid.c_str(), to_string(verdict.motion),
                verdict.assumed_size ? ", of a usual size" : "");
    for (std::size_t o = 0; o < prediction.objects.size(); ++o)
      for (std::size_t m = 0; m < 3 && prediction.objects[o] == verdict.key; ++m)
        if (auto const& mode = prediction.mode(m, o); mode.probability > 0.0) {
          auto const& end = states[prediction.at(m, o, prediction.steps - 1)];
          std::printf("            %3.0f %%  %-14s after 3 s at (%7.1f, %7.1f), %5.1f m/s\n", 100.0 * mode.probability,
                      to_string(mode.maneuver), end.x, end.y, end.speed);
        }
  }
}

struct Settings {
  std::string map;
  int cycles = 20;
};

void run(Settings const& settings) {
  constexpr double latitude = 49.0, longitude = 8.4;  // of the Lanelet2 map that is tried first
  bool const is_lanelet2 = std::filesystem::path(settings.map).extension() == ".osm";
  Traffic traffic{cb::Predictor(
      settings.map, {}, is_lanelet2 ? std::optional(cb::map::Lanelet2Origin{latitude, longitude}) : std::nullopt)};
  stack::Perception const perception(*traffic.predictor.map());
  std::printf("%s, %d lists of 0.1 s; the last one:\n\n", settings.map.c_str(), settings.cycles);
  for (int i = 0; i < settings.cycles; ++i) {
    std::int64_t const stamp = 1'764'580'000'000'000'000 + i * 100'000'000ll;  // [ns]
    auto const list = perception.list(0.1 * i, stamp);
    auto const [verdicts, prediction] = traffic.cycle(stamp, list);
    if (i + 1 == settings.cycles) print(list, verdicts, prediction, traffic.states);
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App program("Tracks and predicts the objects of a planner stack, odd ones among them.", "embed_in_planner");
  std::string const root = CAMBIUM_SOURCE_DIR, shared = root + "/../shared/lanelet2/mapping_example.osm";
  Settings settings{std::filesystem::exists(shared) ? shared : root + "/maps/intersection_4way.xodr"};
  program.add_option("--map", settings.map, "OpenDRIVE (.xodr), Lanelet2 (.osm) or CommonRoad (.xml)")
      ->check(CLI::ExistingFile);
  program.add_option("--cycles", settings.cycles, "number of lists")->check(examples::whole_number(1, 10'000));
  return examples::run_program(program, argc, argv, [&] { run(settings); });
}
