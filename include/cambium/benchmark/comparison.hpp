#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "cambium/benchmark/measure.hpp"
#include "cambium/benchmark/result_group.hpp"
#include "cambium/benchmark/statistics.hpp"

namespace cambium::inline v0_1 {

/// Which way a significant difference goes.
enum class Finding { none, better, worse };

/// One measure of two behaviours, on the scenarios in which both have a finite value.
struct Change {
  Measure const* measure = nullptr;
  std::size_t pairs = 0;
  double before = 0.0, after = 0.0;  ///< shares or means over the pairs
  bool differs = false;              ///< some pair does
  Interval difference{};             ///< 95 % bootstrap interval of after - before
  double p = 1.0;                    ///< McNemar's exact test of a share, paired bootstrap of a mean
  double p_adjusted = 1.0;           ///< for all measures and comparisons made together
  Finding verdict = Finding::none;
};

/// Two behaviours on the scenarios that both have run (congruent scenarios).
struct Comparison {
  std::string set{}, before{}, after{};  ///< labels
  std::size_t scenarios = 0;
  std::vector<Change> changes{};
  std::vector<std::int64_t> lost{}, won{};  ///< scenarios in which only the first, only the second succeeds
  std::vector<std::string> why_lost{};      ///< of each of `lost`: "red_light at 3.4 s", "time-out"
};

/// Comparisons made together.
struct Comparisons {
  std::string title{};
  double level = 0.05;
  std::vector<Comparison> list{};
  std::vector<std::string> left_out{};  ///< what had no counterpart: "merging: mobil is only in new.db"
  std::vector<std::string> missing{};   ///< older results without a counterpart, as of a behaviour that crashes now

  /// Whether some measure became significantly worse, or results are missing.
  [[nodiscard]] bool has_loss() const {
    if (!missing.empty()) return true;
    for (auto const& comparison : list)
      for (auto const& change : comparison.changes)
        if (change.verdict == Finding::worse) return true;
    return false;
  }
};

/// Compares results with older ones: each behaviour with that of the same name on the same set, with equal parameters
/// if there is one, else of the latest version. Sets are the same by their hashes; or by title and seeds of scenarios,
/// as other versions of cambium hash otherwise, and then the comparison says so. p values are adjusted by Holm's method
/// for all measures that are better or worse and differ in some scenario; one below `level` gives a verdict. So a
/// report on equally good behaviours finds a significant difference with a probability of at most about `level`. A
/// scenario counts in the mean of a measure where both values are finite. Throws `Error` if the two have no scenario in
/// common; `old_name` and `new_name` are for messages. The same on any number of threads. O(measures × scenarios ×
/// resamples).
[[nodiscard]] Comparisons compare_against(std::vector<ResultGroup> const& old_groups,
                                          std::vector<ResultGroup> const& new_groups, std::string const& old_name,
                                          std::string const& new_name, double level = 0.05);

/// Compares each behaviour with the one named `baseline` (its label, or its name) on the same set. As above otherwise.
/// Throws `Error` if there is no such behaviour, or no other to compare it with.
[[nodiscard]] Comparisons compare_with_baseline(std::vector<ResultGroup> const& groups, std::string const& baseline,
                                                double level = 0.05);

/// Compares each two behaviours of a set by success and closed-loop score. As above otherwise; may be empty.
[[nodiscard]] Comparisons compare_each(std::vector<ResultGroup> const& groups, double level = 0.05);

}  // namespace cambium::inline v0_1

#ifndef CAMBIUM_COMPILED
#include "cambium/benchmark/comparison_impl.hpp"
#endif
