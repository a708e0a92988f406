// Traffic on a ring road: measures flow against density and compares it with theory, and shows stop-and-go waves at
// densities where theory predicts them. Writes a table, a summary, a picture and a replay of the waves.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <string>
#include <system_error>
#include <vector>

#include <nlohmann/json.hpp>

#include "cambium/behavior/presets.hpp"
#include "cambium/core/error.hpp"
#include "cambium/core/write_file.hpp"
#include "cambium/viewer/html_replay.hpp"
#include "cambium/viewer/record_world.hpp"

#include "../common/command_line.hpp"
#include "../common/parameter_file.hpp"
#include "picture.hpp"
#include "ring_traffic.hpp"

namespace ring {
namespace {

constexpr double dt = 0.25;

struct Settings {
  std::string driver = "treiber_2000";
  std::uint64_t length = 2000, density = 40, minutes = 30;
  std::string out = "out/ring";
  examples::ParameterFile parameters{};
};

cb::Idm driver_of(std::string const& name) {
  std::string known;
  for (auto const& preset : cb::presets::all) {
    if (preset.name == name) return preset.parameters;
    known += std::string(known.empty() ? "" : ", ") + preset.name;
  }
  throw cb::Error("--driver " + name, "there is no such driver", "choose one of " + known);
}

/// Results at one density: theory and measurement.
struct Row {
  int vehicles{};
  Equilibrium expected;
  Measured measured;
};

/// Measures at densities from light traffic to 95 % of what fits on the ring.
std::vector<Row> sweep(cb::RingRoad const& road, cb::Idm const& driver, double duration) {
  double const closest = driver.minimum_gap + cb::geometry::car().length();
  std::vector<Row> rows;
  for (double density = 0.005; density < 0.95 / closest; density += 0.005) {
    Row row;
    row.vehicles = static_cast<int>(std::lround(density * road.length));
    row.expected = equilibrium(driver, road.length, row.vehicles);
    auto world = start_disturbed(road, driver, row.vehicles);
    measure(world, road.length, 2.0 / 3.0 * duration, dt);
    row.measured = measure(world, road.length, duration / 3.0, dt);
    rows.push_back(row);
  }
  return rows;
}

DensityPoint point_of(double length, Row const& row) {
  return {1000.0 * row.vehicles / length, 3600 * row.measured.flow, 3600 * row.expected.flow, row.expected.is_stable};
}

/// The theoretical curve, with finer steps than the measurements.
std::vector<DensityPoint> theory(cb::Idm const& driver) {
  std::vector<DensityPoint> curve;
  double const length = 2000.0;
  for (int vehicles = 1;; ++vehicles) {
    auto const e = equilibrium(driver, length, vehicles);
    if (!(e.gap > driver.minimum_gap)) return curve;
    curve.push_back({1000.0 * vehicles / length, 0.0, 3600 * e.flow, e.is_stable});
  }
}

/// Simulates the traffic at one density and records at most its first 15 minutes.
void record_waves(cb::RingRoad const& road, cb::Idm const& driver, Settings const& settings, Shown& shown,
                  cb::Recording& recording) {
  int const vehicles = static_cast<int>(std::lround(static_cast<double>(settings.density) * road.length / 1000.0));
  auto world = start_disturbed(road, driver, vehicles);
  shown.end = 60.0 * static_cast<double>(std::min<std::uint64_t>(15, settings.minutes));
  shown.density = 1000.0 * vehicles / road.length;
  shown.traces.resize((world.size() + 1) / 2);
  cb::WorldRecorder recorder(world, "Traffic on a ring: " + settings.driver);
  std::uint64_t step = 0;
  auto const trace = [&](Sim const& now) {
    if (step % 20 == 0)
      for (std::size_t i = 0; i < now.size(); i += 2) {
        auto const& agent = now.frame().agents[i];
        shown.traces[i / 2].push_back({now.time(), std::fmod(agent.lane.s, road.length), agent.state.speed});
      }
    if (++step % 8 == 0) recorder.record(now);
  };
  trace(world);
  measure(world, road.length, shown.end, dt, trace);
  recording = recorder.recording();
}

nlohmann::ordered_json summary(Settings const& settings, cb::RingRoad const& road, std::vector<Row> const& rows) {
  nlohmann::ordered_json json;
  json["driver"] = settings.driver;
  json["length"] = road.length;
  json["dt"] = dt;
  for (auto const& row : rows)
    json["densities"].push_back({{"vehicles", row.vehicles},
                                 {"density", row.vehicles / road.length},
                                 {"flow", row.measured.flow},
                                 {"equilibrium_flow", row.expected.flow},
                                 {"string_stable", row.expected.is_stable},
                                 {"growth_rate", row.expected.growth},
                                 {"slowest", row.measured.slowest},
                                 {"fastest", row.measured.fastest},
                                 {"drove", row.measured.drove}});
  return json;
}

void print_table(Settings const& settings, cb::RingRoad const& road, std::vector<Row> const& rows) {
  std::printf("\n  %s on a ring of %.0f m, one vehicle disturbed by 1 m/s; the last third of %llu minutes\n\n",
              settings.driver.c_str(), road.length, static_cast<unsigned long long>(settings.minutes));
  std::printf("  density    flow   of theory   string     wave grows    speeds at the end\n");
  std::printf("     1/km     1/h         1/h   stable   1/min by theory               m/s\n");
  for (auto const& row : rows)
    std::printf("  %7.0f  %6.0f      %6.0f   %6s   %15.3f   %6.2f to %6.2f%s\n", 1000.0 * row.vehicles / road.length,
                3600 * row.measured.flow, 3600 * row.expected.flow, row.expected.is_stable ? "yes" : "no",
                60 * row.expected.growth, row.measured.slowest, row.measured.fastest,
                row.measured.drove ? "" : "  failed");
  std::printf("\n");
}

void run(Settings& settings) {
  auto driver = driver_of(settings.driver);
  settings.parameters.take(driver);
  if (settings.parameters.finish()) return;
  std::filesystem::path const folder(settings.out);
  examples::prepare_folder(folder);
  double const duration = 60.0 * static_cast<double>(settings.minutes), length = static_cast<double>(settings.length);
  auto const road = cb::make_ring_road(length, 2 + static_cast<int>(driver.desired_speed * duration / length));
  auto const rows = sweep(road, driver, duration);
  Shown shown{settings.driver, theory(driver), {}, {}, road.length};
  for (auto const& row : rows) shown.points.push_back(point_of(road.length, row));
  cb::Recording recording;
  record_waves(road, driver, settings, shown, recording);
  cb::write_file(folder / "summary.json", summary(settings, road, rows).dump(1) + "\n");
  cb::write_file(folder / "ring.svg", picture(shown));
  cb::write_html_replay(folder / "replay.html", recording);
  print_table(settings, road, rows);
  std::cout << "  " << (folder / "ring.svg").string() << "      flow over density, and the waves at "
            << settings.density << " vehicles/km\n  " << (folder / "replay.html").string()
            << "   plays the waves in a browser\n  " << (folder / "summary.json").string() << "  these figures\n";
}

}  // namespace
}  // namespace ring

int main(int argc, char** argv) {
  ring::Settings settings;
  CLI::App program("Simulates traffic on a ring road and compares it with the theory of traffic flow.", "ring");
  auto const number = [&](char const* name, std::uint64_t& target, std::uint64_t low, std::uint64_t high,
                          char const* sentence) {
    program.add_option(name, target, sentence)
        ->type_name("N")
        ->check(examples::whole_number(low, high))
        ->capture_default_str();
  };
  program.add_option("--driver", settings.driver, "one of the presets, such as treiber_2000 or kesting_2010_car")
      ->type_name("NAME")
      ->capture_default_str();
  number("--length", settings.length, 500, 20'000, "length of the ring [m]");
  number("--density", settings.density, 2, 120, "density at which the waves are drawn [vehicles/km]");
  number("--minutes", settings.minutes, 1, 120, "simulated time at each density");
  program.add_option("--out", settings.out, "folder for summary.json, ring.svg and replay.html")
      ->type_name("DIR")
      ->capture_default_str();
  settings.parameters.add_options(program);
  return examples::run_program(program, argc, argv, [&] { ring::run(settings); });
}
