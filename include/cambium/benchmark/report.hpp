#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "cambium/benchmark/comparison.hpp"
#include "cambium/benchmark/measure.hpp"
#include "cambium/benchmark/result_group.hpp"
#include "cambium/benchmark/statistics.hpp"
#include "cambium/benchmark/table.hpp"

namespace cambium::inline v0_1 {

/// A measure of one group: a share with its Wilson interval, or a mean with its bootstrap interval (both 95 %).
struct Estimate {
  std::size_t count = 0;  ///< scenarios with a finite value; only these count
  double value = std::numeric_limits<double>::quiet_NaN();
  Interval interval{};
  double most = -std::numeric_limits<double>::infinity();  ///< the largest value
};

/// A report on a benchmark.
struct Report {
  std::vector<ResultGroup> groups{};
  std::vector<std::vector<Estimate>> estimates{};  ///< by group and measure, as in `measures()`
  Comparisons each{};                              ///< each two behaviours of a set, by success and closed-loop score
  std::vector<Comparisons> comparisons{};          ///< added by the user: with a baseline, against older results
};

/// Estimates all measures of all groups, and compares each two behaviours of a set. The same on any number of threads.
/// O(rows × measures × resamples of a bootstrap).
[[nodiscard]] Report make_report(std::vector<ResultGroup> groups, double level = 0.05);

/// The tables of a report: an overview; for each set the outcomes, violations, means and planning times of each
/// behaviour, and the differences between each two; then the comparisons. Tables of means have at most `columns`
/// measures, but at least one.
[[nodiscard]] std::vector<Table> tables_of(Report const& report, std::size_t columns = 7);

/// One table a set of what matters most, without intervals: outcomes, violations that there are, duration, closed-loop
/// score and planning time of each behaviour; then an overview, if there are several sets. Groups of a set are
/// neighbours.
[[nodiscard]] std::vector<Table> summary_of(std::vector<ResultGroup> const& groups);

/// A sentence for each group with errors: how many, and the first: "merging, mine: 2 of 16 runs ended with an error,
/// scenario 3 with: ...".
[[nodiscard]] std::vector<std::string> errors_of(std::vector<ResultGroup> const& groups);

/// A comparison in one line: "significant loss: merging, mobil: success".
[[nodiscard]] std::string verdict_of(Comparisons const& comparisons);

/// All estimates and comparisons as comma-separated values (RFC 4180), one row a measure. In rows of comparisons,
/// `against` names the other behaviour, and `value` is the difference from it. Shares are numbers from 0 to 1.
[[nodiscard]] std::string csv_of(Report const& report);

}  // namespace cambium::inline v0_1

#ifndef CAMBIUM_COMPILED
#include "cambium/benchmark/report_impl.hpp"
#endif
