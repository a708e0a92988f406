#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "cambium/benchmark/report.hpp"

namespace cambium::inline v0_1 {

/// Title of an HTML report, and where it finds replays.
struct HtmlReportOptions {
  std::string title = "Benchmark";
  std::filesystem::path replays = "replays";  ///< folder of replays; links to it are relative to the page
  std::filesystem::path page_folder = ".";    ///< where the page will lie
};

/// The folder of the replays of a database: "results_replays" beside "results.db".
[[nodiscard]] inline std::filesystem::path replay_folder(std::filesystem::path const& database) {
  return database.parent_path() / (database.stem().string() + "_replays");
}

/// Name of the file with the replay of a run: "merging_mobil_1f00ba12_17.html"; the digits tell sets and parameters of
/// the same names apart. Letters that are trouble in file names become _.
[[nodiscard]] std::string replay_file_name(std::string const& set, std::string const& behavior, std::uint64_t set_hash,
                                           std::uint64_t parameters_hash, std::int64_t scenario);

/// A page for any browser of 2023 or later, without further files or a network: the tables of a report, distributions
/// of the measures, and a list of all runs that can be sorted and filtered. A row leads to the replay of its run if the
/// file `replays`/`replay_file_name(...)` is there, and otherwise says how to make it. UTF-8; the same report and files
/// give the same bytes. All names are escaped. O(rows).
[[nodiscard]] std::string html_report(Report const& report, HtmlReportOptions const& options = {});

}  // namespace cambium::inline v0_1

#ifndef CAMBIUM_COMPILED
#include "cambium/benchmark/html_report_impl.hpp"
#endif
