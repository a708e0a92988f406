// The long test: mixed traffic that flows into every map without end, saturated or at random demand, among it a third
// of trucks, with steps of 0.05 to 0.5 s. Counts kilometres, collisions and other flaws, and prints for each the
// command that repeats it and writes its replay.

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "cambium/core/text.hpp"
#include "cambium/viewer/html_replay.hpp"

#include "../common/command_line.hpp"
#include "../common/map_file.hpp"
#include "../common/on_threads.hpp"
#include "../common/part_file.hpp"
#include "../common/report.hpp"
#include "capacity.hpp"
#include "drive.hpp"

namespace soak {
namespace {

namespace fs = std::filesystem;

struct Settings {
  std::string map_file, json_file, out = "out/soak";
  double hours = 0.0, minutes = 10.0;
  std::uint64_t seed = 1, threads = std::max(1u, std::thread::hardware_concurrency());
  std::optional<std::uint64_t> replay{}, step{};
  examples::ParameterFile parameters{};

  [[nodiscard]] double duration() const { return hours > 0.0 ? 3600.0 * hours : 60.0 * minutes; }  // [s]
  [[nodiscard]] std::uint64_t runs() const { return static_cast<std::uint64_t>(std::ceil(duration() / run_length)); }
};

constexpr char const* own_maps[] = {"merging",           "highway",           "lane_drop", "highway_exit",
                                    "intersection_3way", "intersection_4way", "roundabout"};
constexpr char const* corpus_maps[] = {"4way_intersection",
                                       "threeway_intersection",
                                       "fabriksgatan",
                                       "simple_3way_intersection_lht",
                                       "DR_CHN_Merging_ZS_partial_v02",
                                       "DR_DEU_Merging_MT_v01_shifted",
                                       "highway_example_with_merge_and_split",
                                       "soderleden",
                                       "Ex_Entry_Exit"};

/// The corpus' maps: in the folder that CAMBIUM_CORPUS names, else in `shared` beside the checkout. Says so where it is
/// not there.
std::vector<std::string> corpus_files() {
  char const* const set = std::getenv("CAMBIUM_CORPUS");
  bool const is_set = set != nullptr && *set != '\0';
  auto const folder = (is_set ? fs::path(set) : fs::path(CAMBIUM_SOURCE_DIR) / ".." / "shared") / "opendrive";
  std::vector<std::string> files;
  for (std::string const name : corpus_maps)
    if (fs::exists(folder / (name + ".xodr"))) files.push_back((folder / (name + ".xodr")).lexically_normal().string());
  if (files.size() < std::size(corpus_maps))
    std::cerr << "soak: " << std::size(corpus_maps) - files.size() << " maps of the corpus are not in "
              << folder.lexically_normal().string() << ", so they are left out; CAMBIUM_CORPUS names its folder\n";
  return files;
}

std::vector<Site> sites_of(Settings const& settings) {
  std::vector<std::string> files;
  if (!settings.map_file.empty()) {
    files.push_back(settings.map_file);
  } else {
    for (std::string const name : own_maps) files.push_back(CAMBIUM_SOURCE_DIR "/maps/" + name + ".xodr");
    for (auto& file : corpus_files()) files.push_back(std::move(file));
  }
  std::vector<Site> sites;
  for (auto const& file : files) {
    sites.push_back(make_site(file, examples::load_map(file)));
    if (sites.back().sources.empty())
      throw cb::MapError(file, "no traffic can enter: no drivable lane begins at the edge of this map",
                         "give a map with an open end, such as maps/merging.xodr");
  }
  return sites;
}

/// The results of a map's runs in one row.
struct Row {
  Site const* site{};
  double kilometres = 0.0, throughput = 0.0;
  std::uint64_t agent_steps = 0, entered = 0, heavy = 0;
  std::array<std::uint64_t, flaw_count> flaws{};

  [[nodiscard]] std::string map() const { return fs::path(site->file).filename().string(); }
  [[nodiscard]] Facility facility() const {
    return facility_of(*site, static_cast<double>(heavy) / static_cast<double>(std::max<std::uint64_t>(1, entered)));
  }
  [[nodiscard]] std::uint64_t count(Flaw flaw) const { return flaws[static_cast<std::size_t>(flaw)]; }
  [[nodiscard]] std::uint64_t collisions() const {
    return count(Flaw::rear_end) + count(Flaw::side) + count(Flaw::crossing) + count(Flaw::head_on) +
           count(Flaw::pedestrian);
  }
  [[nodiscard]] std::uint64_t all() const {
    std::uint64_t sum = 0;
    for (auto const flaw : flaws) sum += flaw;
    return sum;
  }
  [[nodiscard]] std::uint64_t others() const { return all() - collisions() - count(Flaw::stand); }
};

/// Throughput is that of the saturated runs; where the map has lights, of those with lights.
Row row_of(Site const& site, std::vector<Result> const& runs) {
  Row row{.site = &site};
  double minutes = 0.0, passed = 0.0;
  for (auto const& run : runs) {
    row.kilometres += run.kilometres;
    row.agent_steps += run.agent_steps;
    row.entered += run.entered;
    row.heavy += run.heavy;
    for (auto const& finding : run.findings) ++row.flaws[static_cast<std::size_t>(finding.flaw)];
    if (!run.mix.is_saturated || (site.has_conflicts && run.mix.lights != site.has_lights())) continue;
    minutes += run.counted_minutes;
    passed += static_cast<double>(run.passed);
  }
  row.throughput = minutes > 0.0 ? passed / minutes : 0.0;
  return row;
}

std::string repeat_command(Settings const& settings, std::string const& file, std::uint64_t run,
                           Finding const& finding) {
  return "examples/run soak --map " + cb::shell_word(file) + " --seed " + std::to_string(settings.seed) + " --replay " +
         std::to_string(run) + " --step " + std::to_string(finding.step) +
         (settings.parameters.path().empty() ? "" : " --parameters " + cb::shell_word(settings.parameters.path()));
}

/// Prints the findings, of each map the first `most` of each kind, which suffices to see what is wrong.
void print_findings(Settings const& settings, std::vector<Site> const& sites,
                    std::vector<std::vector<Result>> const& results) {
  constexpr std::uint64_t most = 5;
  for (std::size_t i = 0; i < sites.size(); ++i) {
    std::array<std::uint64_t, flaw_count> shown{};
    for (std::size_t run = 0; run < results[i].size(); ++run)
      for (auto const& finding : results[i][run].findings) {
        if (shown[static_cast<std::size_t>(finding.flaw)]++ >= most) continue;
        auto const& mix = results[i][run].mix;
        std::printf("  %s: %s, run %zu (%s%s, dt %.2f s), seed %llu, step %llu, %.1f s\n    %s\n    %s\n",
                    fs::path(sites[i].file).filename().c_str(), to_string(finding.flaw), run, mix.name.c_str(),
                    mix.is_saturated ? ", saturated" : "", mix.dt, static_cast<unsigned long long>(settings.seed),
                    static_cast<unsigned long long>(finding.step), finding.time, finding.who.c_str(),
                    repeat_command(settings, sites[i].file, run, finding).c_str());
      }
    for (std::size_t flaw = 0; flaw < flaw_count; ++flaw)
      if (shown[flaw] > most)
        std::printf("  %s: %llu more of '%s'; --json lists them\n", fs::path(sites[i].file).filename().c_str(),
                    static_cast<unsigned long long>(shown[flaw] - most), flaw_names[flaw]);
  }
}

void print_table(std::vector<Row> const& rows) {
  std::printf("\n  %-42s %10s %10s %6s %6s %10s %10s %7s  %s\n", "map", "vehicle-km", "collisions", "stands", "other",
              "passed", "capacity", "trucks", "facility");
  std::printf("  %-42s %10s %10s %6s %6s %10s %10s %7s\n", "", "", "", "", "", "1/min", "1/min", "1/min");
  double kilometres = 0.0;
  std::uint64_t collisions = 0, stands = 0, others = 0;
  for (auto const& row : rows) {
    auto const facility = row.facility();
    std::printf("  %-42s %10.0f %10llu %6llu %6llu %10.1f %10.1f %7.1f  %s\n", row.map().c_str(), row.kilometres,
                static_cast<unsigned long long>(row.collisions()),
                static_cast<unsigned long long>(row.count(Flaw::stand)), static_cast<unsigned long long>(row.others()),
                row.throughput, facility.per_minute, facility.heavy_per_minute, facility.kind.c_str());
    kilometres += row.kilometres;
    collisions += row.collisions();
    stands += row.count(Flaw::stand);
    others += row.others();
  }
  std::printf("  %-42s %10.0f %10llu %6llu %6llu\n\n", "all", kilometres, static_cast<unsigned long long>(collisions),
              static_cast<unsigned long long>(stands), static_cast<unsigned long long>(others));
}

nlohmann::ordered_json json_of(Settings const& settings, std::vector<Row> const& rows,
                               std::vector<std::vector<Result>> const& results) {
  nlohmann::ordered_json json;
  json["cambium_version"] = examples::version();
  json["seed"] = settings.seed;
  json["simulated_minutes_per_map"] = settings.duration() / 60.0;
  json["rows"] = nlohmann::ordered_json::array();
  json["findings"] = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    auto const& row = rows[i];
    auto const facility = row.facility();
    nlohmann::ordered_json one{{"map", row.map()},
                               {"vehicle_km", row.kilometres},
                               {"collisions", row.collisions()},
                               {"stands", row.count(Flaw::stand)},
                               {"throughput_per_min", row.throughput},
                               {"capacity_per_min", facility.per_minute},
                               {"capacity_with_trucks_per_min", facility.heavy_per_minute},
                               {"facility", facility.kind},
                               {"vehicles", row.entered},
                               {"heavy_vehicles", row.heavy},
                               {"agent_steps", row.agent_steps}};
    for (std::size_t flaw = 0; flaw < flaw_count; ++flaw) one["flaws"][flaw_names[flaw]] = row.flaws[flaw];
    json["rows"].push_back(std::move(one));
    for (std::size_t run = 0; run < results[i].size(); ++run)
      for (auto const& finding : results[i][run].findings)
        json["findings"].push_back({{"map", row.map()},
                                    {"flaw", to_string(finding.flaw)},
                                    {"scenario", results[i][run].mix.name},
                                    {"run", run},
                                    {"step", finding.step},
                                    {"time", finding.time},
                                    {"dt", results[i][run].mix.dt},
                                    {"who", finding.who},
                                    {"repeat", repeat_command(settings, row.site->file, run, finding)}});
  }
  return json;
}

/// Drops the frames in which no agent of a finding is there yet. Without findings it keeps all.
void skip_to_findings(cb::Recording& recording) {
  auto const begin = std::ranges::find_if(recording.frames, [&](cb::RecordedFrame const& frame) {
    for (std::size_t i = 0; i < frame.poses.size(); ++i)
      if (frame.poses[i].present && recording.agents[i].kind != cb::RecordedAgentKind::other) return true;
    return false;
  });
  if (begin != recording.frames.end()) recording.frames.erase(recording.frames.begin(), begin);
}

/// Repeats a run up to a step, and writes the replay of what led there.
void replay(Settings const& settings) {
  if (settings.map_file.empty())
    throw cb::Error("--replay", "it is not clear on which map", "give --map, as the finding's command does");
  auto const site = sites_of(settings).front();
  fs::path const folder(settings.out);
  examples::prepare_folder(folder);
  Shot shot{.step = settings.step.value_or(100)};
  auto const run = static_cast<std::uint32_t>(*settings.replay);
  auto const result = drive(site, settings.seed, run, run_length, settings.parameters, &shot);
  if (shot.step > result.steps)
    throw cb::Error("--step " + std::to_string(shot.step),
                    "run " + std::to_string(run) + " has " + std::to_string(result.steps) + " steps of " +
                        std::to_string(result.mix.dt).substr(0, 4) + " s",
                    "give one of these, as the finding's command does");
  shot.recording.title = "Soak on " + fs::path(site.file).filename().string() + ", run " + std::to_string(run);
  std::string text = result.mix.name + ", dt " + std::to_string(result.mix.dt).substr(0, 4) + " s, seed " +
                     std::to_string(settings.seed) + ", step " + std::to_string(shot.step);
  shot.recording.notes = {text};
  for (auto const& finding : result.findings)
    if (finding.step == shot.step) {
      shot.recording.notes.push_back(std::string(to_string(finding.flaw)) + ": " + finding.who);
      text += "\n  " + shot.recording.notes.back();
    }
  skip_to_findings(shot.recording);
  cb::write_html_replay(folder / "replay.html", shot.recording);
  std::cout << "  " << text << "\n  " << (folder / "replay.html").string() << "  plays it in a browser\n";
}

/// Returns the exit status.
int run(Settings& settings) {
  if (take_parameters(settings.parameters)) return 0;
  if (settings.replay) return replay(settings), 0;
  std::optional<examples::PartFile> json;
  auto const sites = sites_of(settings);
  std::vector<std::string> inputs{settings.parameters.path()};
  for (auto const& site : sites) inputs.push_back(site.file);
  for (auto const& input : inputs)
    if (std::error_code none; fs::equivalent(settings.json_file, input, none))
      throw cb::Error("--json " + settings.json_file, "is a file that this run reads", "give the name of another file");
  if (!settings.json_file.empty()) json.emplace(settings.json_file);
  auto const runs = settings.runs();
  std::vector<std::vector<Result>> results(sites.size(), std::vector<Result>(runs));
  auto const begin = std::chrono::steady_clock::now();
  examples::run_on_threads(sites.size() * runs, settings.threads, [&](std::uint64_t job) {
    auto const i = job / runs, number = job % runs;
    double const left = settings.duration() - run_length * static_cast<double>(number);
    results[i][number] = drive(sites[i], settings.seed, static_cast<std::uint32_t>(number), std::min(run_length, left),
                               settings.parameters);
  });
  double const seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  std::vector<Row> rows;
  for (std::size_t i = 0; i < sites.size(); ++i) rows.push_back(row_of(sites[i], results[i]));
  print_findings(settings, sites, results);
  print_table(rows);
  double kilometres = 0.0;
  for (auto const& row : rows) kilometres += row.kilometres;
  std::printf("  %.0f km in %.1f s on %s: %.0f a minute\n", kilometres, seconds,
              examples::counted(settings.threads, "thread").c_str(), 60.0 * kilometres / seconds);
  if (json) {
    json->append(json_of(settings, rows, results).dump(1) + "\n");
    json->finish();
  }
  return std::any_of(rows.begin(), rows.end(), [](Row const& row) { return row.all() > 0; }) ? 1 : 0;
}

}  // namespace
}  // namespace soak

int main(int argc, char** argv) {
  using namespace examples;
  soak::Settings settings;
  CLI::App program(
      "Lets mixed traffic flow into every map without end, and counts what must not happen. Exit status 1: some of it "
      "did.",
      "soak");
  auto* const hours =
      program.add_option("--hours", settings.hours, "simulated time of traffic on each map; instead of --minutes");
  hours->type_name("H")->check(number(0.001, 10'000.0));
  auto* const minutes =
      program.add_option("--minutes", settings.minutes, "simulated time of traffic on each map, in runs of 10 minutes");
  minutes->type_name("M")->check(number(0.1, 600'000.0))->capture_default_str()->excludes(hours);
  program.add_option("--seed", settings.seed, "seed of all random numbers")
      ->type_name("N")
      ->check(whole_number(0, ~std::uint64_t{0}))
      ->capture_default_str();
  program.add_option("--threads", settings.threads, "number of threads; the results do not depend on it")
      ->type_name("N")
      ->check(whole_number(1, 1024))
      ->capture_default_str();
  program
      .add_option("--map", settings.map_file,
                  "a map (.xodr, .osm, .xml); default: all own ones, and nine of the corpus in the folder "
                  "CAMBIUM_CORPUS, or in ../shared")
      ->type_name("FILE")
      ->check(not_empty());
  auto* const json = program.add_option("--json", settings.json_file, "file for the table and all findings");
  json->type_name("FILE")->check(not_empty());
  auto* const replay =
      program.add_option("--replay", settings.replay, "repeat this run instead, on --map, and write its replay");
  replay->type_name("RUN")->check(whole_number(0, 9'999'999))->excludes(json)->excludes(hours)->excludes(minutes);
  program.add_option("--step", settings.step, "the step that the replay leads to; default: 100")
      ->type_name("N")
      ->check(whole_number(1, 100'000'000))
      ->needs(replay);
  program.add_option("--out", settings.out, "folder for replay.html")
      ->type_name("DIR")
      ->check(not_empty())
      ->capture_default_str()
      ->needs(replay);
  settings.parameters.add_options(program);
  program.footer(
      "What it prints:\n"
      "  the findings, with what repeats each; then a row for each map:\n"
      "  collisions: of any two road users; both are then taken away, and traffic goes on\n"
      "  stands: vehicles that stand for more than 120 s\n"
      "  other: negative speeds, steps back, jumps, vehicles off their route, failed steps\n"
      "  passed: vehicles that leave the map in a minute where all entrances are saturated (two of three runs)\n"
      "  capacity: what the Highway Capacity Manual gives for such a road or junction, for passenger cars and for\n"
      "    the share of trucks that there is; else the capacity of the lanes that enter");
  return run_program(program, argc, argv, [&] { return soak::run(settings); });
}
