// Reports the results of a benchmark: tables, comparisons of behaviours and with older results, a page for browsers.
// Exits 1 if --against finds that something became significantly worse, or is missing.

#include <cstdio>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include <CLI/CLI.hpp>

#include "cambium/benchmark/html_report.hpp"
#include "cambium/benchmark/read_results.hpp"
#include "cambium/benchmark/report.hpp"
#include "cambium/core/error.hpp"
#include "cambium/core/write_file.hpp"

#include "../common/command_line.hpp"

namespace {

namespace cb = cambium;
namespace fs = std::filesystem;

struct Settings {
  std::string db, against, baseline, html, csv, latex;
  std::vector<std::string> merged;
  double level = 5.0;
};

/// The results, after those of other databases were added.
std::vector<cb::ResultGroup> read(Settings const& settings) {
  if (settings.merged.empty()) {
    auto store = cb::ResultStore::existing(settings.db);
    return cb::read_results(store);
  }
  std::vector<cb::ResultStore> others;  // all are opened before anything is written
  for (auto const& file : settings.merged) {
    others.push_back(cb::ResultStore::existing(file));
    std::error_code none;
    if (fs::equivalent(file, settings.db, none))
      throw cb::Error("--merge " + file, "is the database itself", "name the others");
  }
  cb::ResultStore store(settings.db);
  for (auto& other : others) store.merge(other);
  return cb::read_results(store);
}

int report(Settings const& settings) {
  double const level = settings.level / 100.0;
  auto report = cb::make_report(read(settings), level);
  if (report.groups.empty()) throw cb::Error(settings.db, "holds no results", "run a benchmark with this --db first");
  if (!settings.baseline.empty())
    report.comparisons.push_back(cb::compare_with_baseline(report.groups, settings.baseline, level));
  bool has_loss = false;
  if (!settings.against.empty()) {
    auto old = cb::ResultStore::existing(settings.against);
    report.comparisons.push_back(
        cb::compare_against(cb::read_results(old), report.groups, settings.against, settings.db, level));
    has_loss = report.comparisons.back().has_loss();
  }
  auto const tables = cb::tables_of(report);
  for (auto const& table : tables) std::printf("%s\n", cb::text_of(table).c_str());
  for (auto const& words : cb::errors_of(report.groups)) std::printf("  %s\n", words.c_str());
  for (auto const& comparisons : report.comparisons) {
    for (auto const& words : comparisons.left_out) std::printf("  not compared: %s\n", words.c_str());
    for (auto const& words : comparisons.missing) std::printf("  missing: %s\n", words.c_str());
    std::printf("  %s\n", cb::verdict_of(comparisons).c_str());
  }
  if (!settings.csv.empty()) cb::write_file(settings.csv, cb::csv_of(report));
  if (!settings.latex.empty()) {
    std::string text = "% needs \\usepackage{booktabs}\n";
    for (auto const& table : tables) text += cb::latex_of(table) + "\n";
    cb::write_file(settings.latex, text);
  }
  if (!settings.html.empty()) {
    auto const folder = fs::absolute(settings.html).parent_path();
    std::error_code none;
    auto const replays = cb::replay_folder(fs::absolute(settings.db));
    fs::create_directories(folder, none);
    fs::create_directories(replays, none);  // where the page's commands put them
    cb::write_file(settings.html,
                   cb::html_report(report, {.title = "Benchmark " + fs::path(settings.db).stem().string(),
                                            .replays = fs::relative(replays, folder),
                                            .page_folder = folder}));
    std::printf("  %s opens in a browser\n", settings.html.c_str());
  }
  return has_loss ? 1 : 0;
}

void add_options(CLI::App& program, Settings& settings) {
  auto const file = [&](char const* name, std::string& target, char const* sentence) {
    return program.add_option(name, target, sentence)->type_name("FILE")->check(examples::not_empty());
  };
  file("--db", settings.db, "database of results that examples/run benchmark has written")->required();
  program
      .add_option("--merge", settings.merged,
                  "adds the results of another database, as of another --shard, to --db; may be repeated")
      ->type_name("FILE")
      ->check(examples::not_empty())
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->expected(1);
  file(
      "--against", settings.against,
      "compares with the results of an older database; exits 1 if something became significantly worse, or is missing");
  program.add_option("--baseline", settings.baseline, "compares all behaviours with this one on equal scenarios")
      ->type_name("NAME")
      ->check(examples::not_empty());
  program.add_option("--level", settings.level, "level of significance in percent, for all tests together")
      ->type_name("PERCENT")
      ->check(examples::number(0.01, 50.0))
      ->capture_default_str();
  file("--html", settings.html, "writes a page for browsers; its rows open the replays beside the database");
  file("--csv", settings.csv, "writes all figures, one row a measure");
  file("--latex", settings.latex, "writes the tables for LaTeX (booktabs)");
}

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  CLI::App program("Reports the results of a benchmark.", "report");
  add_options(program, settings);
  return examples::run_program(program, argc, argv, [&] { return report(settings); });
}
