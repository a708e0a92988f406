// Measures the drivers of `presets` as observers measure people, and prints both side by side: capacity, speed and
// headway on motorways, lane changes, waves; gaps, capacity, lights and stop signs in town.

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <nlohmann/json.hpp>

#include "../common/command_line.hpp"
#include "../common/on_threads.hpp"
#include "../common/part_file.hpp"
#include "row.hpp"

namespace field {
namespace {

namespace cb = cambium;

struct Settings {
  std::uint64_t seed = 1, threads = std::max(1u, std::thread::hardware_concurrency());
  std::string json_file, only;
};

std::string in_words(Row const& row) {
  char text[64];
  if (row.low == row.high)
    std::snprintf(text, sizeof text, "%g", row.low);
  else
    std::snprintf(text, sizeof text, "%.4g to %.4g", row.low, row.high);
  return text;
}

void print(std::vector<Row> const& rows) {
  std::printf("\n  %-62s %-16s %-8s %-6s  source\n", "quantity", "people", "cambium", "unit");
  for (auto const& row : rows)
    std::printf("%c %-62s %-16s %-8.4g %-6s  %s\n",
                row.is_within()        ? ' '
                : row.is_only_reported ? '.'
                                       : '!',
                row.quantity.c_str(), in_words(row).c_str(), row.cambium, row.unit.c_str(), row.source.c_str());
  std::printf("\n  !: outside the band; .: outside, but only reported\n\n");
}

nlohmann::ordered_json json_of(Settings const& settings, std::vector<Row> const& rows) {
  nlohmann::ordered_json json;
  json["cambium_version"] = examples::version();
  json["seed"] = settings.seed;
  json["rows"] = nlohmann::ordered_json::array();
  for (auto const& row : rows) {
    nlohmann::ordered_json people = row.low;
    if (row.low != row.high) people = {row.low, row.high};
    json["rows"].push_back({{"quantity", row.quantity},
                            {"people", people},
                            {"cambium", row.cambium},
                            {"sumo", nullptr},
                            {"unit", row.unit},
                            {"source", row.source}});
  }
  return json;
}

std::vector<Row> measure(Settings const& settings) {
  auto experiments = motorway_experiments();
  for (auto const& more : {town_experiments(), junction_experiments()})
    experiments.insert(experiments.end(), more.begin(), more.end());
  std::string known;
  for (auto const& one : experiments) known += (known.empty() ? "'" : ", '") + one.name + "'";
  if (!settings.only.empty()) std::erase_if(experiments, [&](auto const& one) { return one.name != settings.only; });
  if (experiments.empty())
    throw cb::Error("--only " + settings.only, "there is no such experiment", "choose one of " + known);
  std::vector<std::vector<Row>> results(experiments.size());
  examples::run_on_threads(
      experiments.size(), settings.threads, [&](std::size_t i) { results[i] = experiments[i].run(settings.seed); },
      "experiments");
  std::vector<Row> rows;
  for (auto const& result : results) rows.insert(rows.end(), result.begin(), result.end());
  return rows;
}

/// Returns the exit status.
int run(Settings const& settings) {
  std::optional<examples::PartFile> json;
  if (!settings.json_file.empty()) json.emplace(settings.json_file);
  auto const rows = measure(settings);
  print(rows);
  if (json) {
    json->append(json_of(settings, rows).dump(1) + "\n");
    json->finish();
  }
  auto const is_outside = [](Row const& row) { return !row.is_within() && !row.is_only_reported; };
  return std::any_of(rows.begin(), rows.end(), is_outside) ? 1 : 0;
}

}  // namespace
}  // namespace field

int main(int argc, char** argv) {
  field::Settings settings;
  CLI::App program(
      "Measures traffic as observers measure people's, and prints both. Exit status 1: a quantity is out "
      "of people's band.",
      "field");
  program.add_option("--seed", settings.seed, "of the drivers and the traffic")
      ->type_name("N")
      ->check(examples::whole_number(0, 1'000'000'000))
      ->capture_default_str();
  program.add_option("--threads", settings.threads, "number of threads; the results do not depend on it")
      ->type_name("N")
      ->check(examples::whole_number(1, 1024))
      ->capture_default_str();
  program.add_option("--only", settings.only, "run only this experiment, such as 'queue'")
      ->type_name("NAME")
      ->check(examples::not_empty());
  program.add_option("--json", settings.json_file, "also write the rows to this file")
      ->type_name("FILE")
      ->check(examples::not_empty());
  return examples::run_program(program, argc, argv, [&] { return field::run(settings); });
}
