#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "cambium/benchmark/detail/report_text.hpp"
#include "cambium/benchmark/report.hpp"
#include "cambium/benchmark/run_on_threads.hpp"
#include "cambium/core/error.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/core/text.hpp"

namespace cambium::inline v0_1 {

namespace detail {

/// "93.1 (90.2-95.4)": a value and its interval, with enough digits to tell the ends apart.
[[nodiscard]] inline std::string with_interval(double value, Interval const& interval, bool is_share, bool with_sign) {
  if (!std::isfinite(value)) return "-";
  double const scale = is_share ? 100.0 : 1.0, width = scale * (interval.high - interval.low);
  bool const is_known = std::isfinite(width);
  double const digits = is_share                  ? (width > 1.0   ? 1
                                                     : width > 0.1 ? 2
                                                                   : 3)
                        : is_known && width > 0.0 ? 1 - std::floor(std::log10(width))
                        : std::abs(value) > 0.0   ? 2 - std::floor(std::log10(std::abs(value)))
                                                  : 0;
  auto const decimals = static_cast<int>(std::clamp(digits, 0.0, is_share ? 3.0 : 6.0));
  auto const number = [&](double x) {
    auto const text = fixed_text(scale * x, decimals);
    return with_sign && x > 0.0 ? "+" + text : text;
  };
  if (!is_known || width == 0.0) return number(value);
  auto const low = number(interval.low), high = number(interval.high);
  bool const has_sign = with_sign || low.front() == '-';
  return number(value) + " (" + low + (has_sign ? " to " : "-") + high + ")";
}

/// A few of many as a count: "3/100 (1.0-8.5)".
[[nodiscard]] inline std::string cell_of(Measure const& measure, Estimate const& estimate, std::size_t scenarios) {
  auto text = with_interval(estimate.value, estimate.interval, measure.is_share, false);
  double const hits = estimate.value * static_cast<double>(estimate.count);
  if (measure.is_share && hits > 0.5 && hits < 4.5)
    text.replace(0, text.find(' '), fixed_text(hits, 0) + "/" + std::to_string(estimate.count));
  return estimate.count == scenarios || estimate.count == 0 ? text : text + " n=" + std::to_string(estimate.count);
}

[[nodiscard]] inline std::string p_text(double p) { return p < 1e-4 ? "<0.0001" : fixed_text(p, p < 0.001 ? 4 : 3); }

/// A table of some measures of the groups of a set.
[[nodiscard]] inline Table measure_table(Report const& report, std::vector<std::size_t> const& set,
                                         std::vector<std::size_t> const& chosen, std::string const& title) {
  Table table{.title = title, .head = {"behaviour"}};
  bool const with_scenarios = title == "outcomes";
  if (with_scenarios) table.head.emplace_back("scenarios");
  for (auto const m : chosen) table.head.push_back(titled(measures()[m]));
  for (auto const g : set) {
    auto const& group = report.groups[g];
    table.rows.push_back({group.label});
    if (with_scenarios) table.rows.back().push_back(std::to_string(group.rows.size()));
    for (auto const m : chosen)
      table.rows.back().push_back(cell_of(measures()[m], report.estimates[g][m], group.rows.size()));
  }
  return table;
}

/// The planning times of the behaviours of a set.
[[nodiscard]] inline Table time_table(Report const& report, std::vector<std::size_t> const& set) {
  Table table{.title = "planning times",
              .head = {"behaviour", "plans", "mean time of a plan [ms]", "longest [ms]", "plans longer than a step"}};
  for (auto const g : set) {
    auto const& group = report.groups[g];
    auto const& estimates = report.estimates[g];
    std::int64_t plans = 0, overruns = 0;
    for (auto const& row : group.rows) {
      plans += row.times.decisions;
      overruns += row.times.overruns;
    }
    auto const mean = measure_index("mean_ms");
    table.rows.push_back({group.label, std::to_string(plans),
                          cell_of(measures()[mean], estimates[mean], group.rows.size()),
                          with_interval(estimates[measure_index("longest_ms")].most, {0.0, 0.0}, false, false),
                          std::to_string(overruns)});
  }
  table.note = "On the machine and threads of the run; interval of the mean over scenarios.";
  return table;
}

/// Differences of a measure between each two behaviours of a set.
[[nodiscard]] inline Table difference_table(Report const& report, std::vector<std::size_t> const& set,
                                            std::string const& key) {
  Table table{.head = {"row minus column"}};
  for (auto const g : set) table.head.push_back(report.groups[g].label);
  table.rows.resize(set.size());
  bool is_share = false;
  for (std::size_t i = 0; i < set.size(); ++i) {
    auto const& row = report.groups[set[i]];
    table.rows[i] = {row.label};
    for (auto const g : set) {
      std::string cell;
      for (auto const& pair : report.each.list)
        for (auto const& change : pair.changes) {
          bool const forward = pair.before == row.label && pair.after == report.groups[g].label;
          bool const backward = pair.after == row.label && pair.before == report.groups[g].label;
          if (pair.set != row.set_label || change.measure->key != key || !(forward || backward)) continue;
          is_share = change.measure->is_share;
          double const difference = (is_share ? 100.0 : 1.0) * (change.after - change.before) * (forward ? -1.0 : 1.0);
          cell = (difference > 0 ? "+" : "") + fixed_text(difference, is_share ? 1 : 3);
          if (change.verdict != Finding::none) cell += "*";
        }
      table.rows[i].push_back(cell);
    }
  }
  std::string name = key;
  std::replace(name.begin(), name.end(), '_', ' ');
  table.title = name + (is_share ? ", differences [percentage points]" : ", differences");
  table.note = std::string("On the scenarios that both have run. *: significant at ") +
               rounded_text(100 * report.each.level) + " % (" +
               (is_share ? "McNemar's exact test" : "paired bootstrap") + ", Holm's correction for all pairs).";
  return table;
}

/// How runs ended, and how long their plans took.
struct OutcomeCount {
  std::size_t runs = 0, successes = 0, collisions = 0;
  double decisions = 0.0, ms = 0.0;

  void add(ResultGroup::Row const& row) {
    ++runs;
    successes += row.result.success;
    collisions += row.result.collision;
    decisions += static_cast<double>(row.times.decisions);
    ms += static_cast<double>(row.times.decisions) * row.times.mean_ms;
  }
  /// "28/30 (1)".
  [[nodiscard]] std::string text() const {
    return std::to_string(successes) + "/" + std::to_string(runs) +
           (collisions > 0 ? " (" + std::to_string(collisions) + ")" : "");
  }
};

/// Successes and collisions of each behaviour on each set, and its planning time.
[[nodiscard]] inline Table overview_of(std::vector<ResultGroup> const& groups) {
  Table table{.title = "successes (collisions)", .head = {"behaviour"}};
  std::vector<std::string> sets, labels;
  for (auto const& group : groups) {
    if (std::find(sets.begin(), sets.end(), group.set_label) == sets.end()) sets.push_back(group.set_label);
    if (std::find(labels.begin(), labels.end(), group.label) == labels.end()) labels.push_back(group.label);
  }
  table.head.insert(table.head.end(), sets.begin(), sets.end());
  table.head.insert(table.head.end(), {"all", "mean time of a plan [ms]"});
  for (auto const& label : labels) {
    OutcomeCount all;
    std::vector<std::string> row{label};
    for (auto const& set : sets) {
      OutcomeCount sum;
      for (auto const& group : groups)
        if (group.label == label && group.set_label == set)
          for (auto const& run : group.rows)
            for (auto* const one : {&sum, &all}) one->add(run);
      row.push_back(sum.runs > 0 ? sum.text() : "-");
    }
    row.push_back(all.text());
    row.push_back(all.decisions > 0.0 ? short_text(all.ms / all.decisions) : "-");
    table.rows.push_back(std::move(row));
  }
  return table;
}

/// How many runs failed by which criteria: "infeasible 5, red_light 2"; empty if none did.
[[nodiscard]] inline std::string failed_by(ResultGroup const& group) {
  std::map<std::string, std::size_t, std::less<>> counts;
  for (auto const& row : group.rows)
    for (auto const criterion : split(row.result.failed_by, " "))
      if (!criterion.empty()) ++counts[std::string(criterion)];
  std::string text;
  for (auto const& [criterion, count] : counts)
    text += (text.empty() ? "" : ", ") + criterion + " " + std::to_string(count);
  return text;
}

/// Successes and collisions of each behaviour among each population of a set; no rows where there are fewer than two.
[[nodiscard]] inline Table population_table(Report const& report, std::vector<std::size_t> const& set) {
  Table table{.title = "successes (collisions) by population", .head = {"behaviour"}};
  std::vector<std::string> populations;
  for (auto const g : set)
    for (auto const& row : report.groups[g].rows)
      if (!row.population.empty() && std::ranges::find(populations, row.population) == populations.end())
        populations.push_back(row.population);
  if (populations.size() < 2) return table;
  table.head.insert(table.head.end(), populations.begin(), populations.end());
  for (auto const g : set) {
    auto& cells = table.rows.emplace_back(std::vector{report.groups[g].label});
    for (auto const& population : populations) {
      OutcomeCount count;
      for (auto const& row : report.groups[g].rows)
        if (row.population == population) count.add(row);
      cells.push_back(count.runs > 0 ? count.text() : "-");
    }
  }
  return table;
}

inline constexpr char const* finding_words[] = {"", "better", "worse"};

/// "3 (time-out), 7": at most twelve. `why`: of each, or empty.
[[nodiscard]] inline std::string numbers_text(std::vector<std::int64_t> const& numbers,
                                              std::vector<std::string> const& why = {}) {
  constexpr std::size_t most = 12;
  std::string text;
  for (std::size_t i = 0; i < std::min(most, numbers.size()); ++i)
    text += (i == 0 ? "" : ", ") + std::to_string(numbers[i]) + (why.empty() ? "" : " (" + why[i] + ")");
  return numbers.size() > most ? text + " and " + std::to_string(numbers.size() - most) + " more" : text;
}

[[nodiscard]] inline Table comparison_table(Comparison const& comparison) {
  Table table{.title = comparison.set + ": " + comparison.after +
                       (comparison.after == comparison.before ? "" : " compared with " + comparison.before) + ", " +
                       std::to_string(comparison.scenarios) + " equal scenarios",
              .head = {"measure", "pairs", "before", "after", "difference", "p", "p (Holm)", "verdict"}};
  std::string equal;
  for (auto const& change : comparison.changes) {
    auto const& measure = *change.measure;
    if (!change.differs) {
      if (change.pairs > 0) equal += (equal.empty() ? "" : ", ") + measure.name;
      continue;
    }
    bool const is_judged = measure.better != Better::neither;
    auto const value = [&](double x) {
      auto const text = with_interval(x, change.difference, measure.is_share, false);
      return text.substr(0, text.find(' '));
    };
    table.rows.push_back(
        {titled(measure), std::to_string(change.pairs), value(change.before), value(change.after),
         with_interval(change.after - change.before, change.difference, measure.is_share, true), p_text(change.p),
         is_judged ? p_text(change.p_adjusted) : "",
         change.verdict == Finding::worse ? "WORSE" : finding_words[static_cast<std::size_t>(change.verdict)]});
  }
  if (!comparison.lost.empty())
    table.note = "Success lost in scenarios " + numbers_text(comparison.lost, comparison.why_lost) + ". ";
  if (!comparison.won.empty()) table.note += "Success won in scenarios " + numbers_text(comparison.won) + ". ";
  if (table.rows.empty())
    table.note += "No difference.";
  else if (!equal.empty())
    table.note += "Equal in each scenario: " + equal + ".";
  return table;
}

[[nodiscard]] inline std::string csv_line(std::vector<std::string> const& cells) {
  std::string line;
  for (auto const& cell : cells) {
    if (&cell != &cells.front()) line += ',';
    if (cell.find_first_of(",\"\r\n") == cell.npos) {
      line += cell;
      continue;
    }
    line += '"';
    for (char const c : cell) line += c == '"' ? "\"\"" : std::string(1, c);
    line += '"';
  }
  return line + "\n";
}

[[nodiscard]] inline std::string csv_number(double value) { return std::isfinite(value) ? number_text(value) : ""; }

[[nodiscard]] inline Estimate estimate_of(ResultGroup const& group, Measure const& measure) {
  Estimate estimate;
  std::vector<double> values;
  for (auto const& row : group.rows)
    if (double const value = measure.value(row); std::isfinite(value)) values.push_back(value);
  estimate.count = values.size();
  if (values.empty()) return estimate;
  estimate.value = mean_of(values);
  estimate.most = *std::max_element(values.begin(), values.end());
  estimate.interval =
      measure.is_share
          ? wilson_interval(static_cast<std::uint64_t>(std::count(values.begin(), values.end(), 1.0)), values.size())
          : bootstrap_interval(values);
  return estimate;
}

}  // namespace detail

CAMBIUM_COLD Report make_report(std::vector<ResultGroup> groups, double level) {
  Report report{.groups = std::move(groups)};
  auto const count = measures().size();
  report.estimates.assign(report.groups.size(), std::vector<Estimate>(count));
  run_on_threads(report.groups.size() * count, std::thread::hardware_concurrency(), [&](std::size_t i) {
    report.estimates[i / count][i % count] = detail::estimate_of(report.groups[i / count], measures()[i % count]);
  });
  report.each = compare_each(report.groups, level);
  return report;
}

CAMBIUM_COLD std::vector<Table> tables_of(Report const& report, std::size_t columns) {
  std::vector<Table> tables;
  std::vector<std::size_t> shares, rules, means;
  for (std::size_t m = 0; m < measures().size(); ++m) {
    if (measures()[m].is_share)
      (m <= measure_index("error") ? shares : rules).push_back(m);
    else if (!measures()[m].is_time && measures()[m].key != "steps")  // the duration says that
      means.push_back(m);
  }
  columns = std::max(columns, std::size_t{1});
  auto const parts = (means.size() + columns - 1) / columns;
  columns = (means.size() + parts - 1) / parts;  // tables of equal widths
  tables.push_back(detail::overview_of(report.groups));
  for (auto const& set : detail::groups_by_set(report.groups)) {
    auto const& name = report.groups[set.front()].set_label;
    auto const add = [&](Table table) {
      table.set = name;
      tables.push_back(std::move(table));
    };
    add(detail::measure_table(report, set, shares, "outcomes"));
    if (auto table = detail::population_table(report, set); !table.rows.empty()) add(std::move(table));
    add(detail::measure_table(report, set, rules, "violations"));
    tables.back().note = "Shares of the scenarios, the smallest as counts; in brackets: 95 % intervals [%] (Wilson).";
    for (auto const g : set)
      if (auto const why = detail::failed_by(report.groups[g]); !why.empty())
        tables.back().note += " " + report.groups[g].label + " failed by " + why + ".";
    for (std::size_t begin = 0; begin < means.size(); begin += columns) {
      auto const first = means.begin() + static_cast<std::ptrdiff_t>(begin);
      auto const last = means.begin() + static_cast<std::ptrdiff_t>(std::min(means.size(), begin + columns));
      bool const is_first = first == means.begin();
      add(detail::measure_table(report, set, {first, last}, is_first ? "means" : "means, continued"));
      if (is_first)
        tables.back().note =
            "Over scenarios; in brackets: 95 % intervals (bootstrap, BCa); n: scenarios that have the value, where not "
            "all.";
    }
    add(detail::time_table(report, set));
    if (set.size() < 2) continue;
    for (char const* key : {"success", "closed_loop_score"}) add(detail::difference_table(report, set, key));
  }
  for (auto const& comparisons : report.comparisons)
    for (auto const& comparison : comparisons.list) tables.push_back(detail::comparison_table(comparison));
  return tables;
}

CAMBIUM_COLD std::vector<Table> summary_of(std::vector<ResultGroup> const& groups) {
  std::vector<Measure const*> chosen;
  auto const occurs = [&](Measure const& measure) {
    return std::ranges::any_of(groups,
                               [&](auto const& group) { return detail::mean_of_measure(group, measure) > 0.0; });
  };
  auto const is_text = [](Measure const& measure) { return measure.key == "violations" || measure.key == "failed_by"; };
  for (std::size_t m = 0; m < measures().size(); ++m) {
    auto const& measure = measures()[m];
    bool const is_outcome = measure.is_share && m <= measure_index("error");
    if (is_outcome || (measure.is_share && !is_text(measure) && occurs(measure)) || measure.key == "duration_s" ||
        measure.key == "closed_loop_score" || measure.key == "mean_ms")
      chosen.push_back(&measure);
  }
  std::vector<Table> tables;
  auto const sets = detail::groups_by_set(groups);
  for (auto const& set : sets) {
    Table table{.title = groups[set.front()].set_label, .head = {"behaviour", "scenarios"}};
    for (auto const* const measure : chosen) table.head.push_back(detail::titled(*measure));
    for (auto const g : set) {
      table.rows.push_back({groups[g].label, std::to_string(groups[g].rows.size())});
      for (auto const* const measure : chosen) {
        double const value = detail::mean_of_measure(groups[g], *measure);
        bool const is_rounded = measure->is_share || measure->key == "duration_s";
        table.rows.back().push_back(!std::isfinite(value) ? "-"
                                    : is_rounded ? detail::fixed_text(measure->is_share ? 100.0 * value : value, 1)
                                                 : detail::short_text(value));
      }
    }
    for (auto const g : set)
      if (auto const why = detail::failed_by(groups[g]); !why.empty())
        table.note += (table.note.empty() ? "" : " ") + groups[g].label + " failed by " + why + ".";
    tables.push_back(std::move(table));
  }
  if (sets.size() > 1) tables.push_back(detail::overview_of(groups));
  return tables;
}

CAMBIUM_COLD std::vector<std::string> errors_of(std::vector<ResultGroup> const& groups) {
  std::vector<std::string> lines;
  for (auto const& group : groups) {
    ResultGroup::Row const* first = nullptr;
    std::size_t errors = 0;
    for (auto const& row : group.rows) {
      if (row.result.error.empty()) continue;
      ++errors;
      if (first == nullptr) first = &row;
    }
    if (first == nullptr) continue;
    lines.push_back(detail::printable(group.set_label + ", " + group.label + ": " + std::to_string(errors) + " of " +
                                      std::to_string(group.rows.size()) + " runs ended with an error, scenario " +
                                      std::to_string(first->scenario) + " with: " + first->result.error));
  }
  return lines;
}

CAMBIUM_COLD std::string verdict_of(Comparisons const& comparisons) {
  std::string worse, better;
  for (auto const& comparison : comparisons.list)
    for (auto const& change : comparison.changes) {
      if (change.verdict == Finding::none) continue;
      auto& text = change.verdict == Finding::worse ? worse : better;
      text += (text.empty() ? "" : "; ") + comparison.set + ", " + comparison.after + ": " + change.measure->name;
    }
  auto text = (worse.empty() ? "no significant loss" : "significant loss: " + worse) +
              (better.empty() ? "" : "; significant gain: " + better);
  if (!comparisons.missing.empty()) text = "results are missing; " + text;
  return comparisons.title + ": " + text + " (level " + detail::rounded_text(100 * comparisons.level) + " %)";
}

CAMBIUM_COLD std::string csv_of(Report const& report) {
  auto text = detail::csv_line({"set", "behavior", "parameters_hash", "version", "against", "measure", "unit", "better",
                                "scenarios", "value", "low", "high", "p", "p_adjusted", "verdict"});
  // `whose` and `verdict`: the cells before and behind the measure and its value.
  auto const add = [&](std::vector<std::string> whose, Measure const& measure, std::size_t count, double value,
                       Interval const& interval, std::vector<std::string> const& verdict) {
    constexpr char const* better[] = {"", "more", "less"};
    whose.insert(whose.end(),
                 {measure.key, measure.is_share ? "" : measure.unit, better[static_cast<std::size_t>(measure.better)],
                  std::to_string(count), detail::csv_number(value), detail::csv_number(interval.low),
                  detail::csv_number(interval.high)});
    whose.insert(whose.end(), verdict.begin(), verdict.end());
    text += detail::csv_line(whose);
  };
  for (std::size_t g = 0; g < report.groups.size(); ++g)
    for (std::size_t m = 0; m < measures().size(); ++m) {
      auto const& group = report.groups[g];
      auto const& estimate = report.estimates[g][m];
      add({group.set_label, group.label, hash_text(group.parameters_hash), group.version, ""}, measures()[m],
          estimate.count, estimate.value, estimate.interval, {"", "", ""});
    }
  auto const add_all = [&](Comparisons const& comparisons) {
    for (auto const& comparison : comparisons.list)
      for (auto const& change : comparison.changes)
        add({comparison.set, comparison.after, "", "", comparison.before}, *change.measure, change.pairs,
            change.after - change.before, change.difference,
            {detail::csv_number(change.p),
             change.measure->better == Better::neither ? "" : detail::csv_number(change.p_adjusted),
             detail::finding_words[static_cast<std::size_t>(change.verdict)]});
  };
  add_all(report.each);
  for (auto const& comparisons : report.comparisons) add_all(comparisons);
  return text;
}

}  // namespace cambium::inline v0_1
