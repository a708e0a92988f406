#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <thread>
#include <tuple>
#include <utility>
#include <vector>

#include "cambium/benchmark/comparison.hpp"
#include "cambium/benchmark/run_on_threads.hpp"
#include "cambium/core/error.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/core/text.hpp"

namespace cambium::inline v0_1 {

namespace detail {

/// "0.10.2" as {0, 10, 2}.
[[nodiscard]] inline std::vector<std::uint64_t> numbers_of(std::string const& version) {
  std::vector<std::uint64_t> numbers;
  for (auto const part : split(version, ".")) numbers.push_back(parse_number<std::uint64_t>(part).value_or(0));
  return numbers;
}

/// Which groups to compare.
struct GroupPair {
  ResultGroup const* before;
  ResultGroup const* after;
};

/// Calls `f(row of a, row of b)` for each scenario that both have.
template <class F>
void for_each_common(ResultGroup const& a, ResultGroup const& b, F const& f) {
  for (auto i = a.rows.begin(), j = b.rows.begin(); i != a.rows.end() && j != b.rows.end();) {
    if (i->scenario == j->scenario) f(*i, *j);
    bool const next_a = i->scenario <= j->scenario, next_b = j->scenario <= i->scenario;
    if (next_a) ++i;
    if (next_b) ++j;
  }
}

/// Whether two groups ran the same scenarios: by the hash of their set, or by its title and the seeds, which are drawn.
[[nodiscard]] inline bool same_scenarios(ResultGroup const& a, ResultGroup const& b) {
  if (a.set_hash == b.set_hash) return true;
  bool equal = a.set == b.set, any = false;
  for_each_common(a, b, [&](auto const& x, auto const& y) {
    equal = equal && x.seed == y.seed;
    any = any || x.seed != 0;
  });
  return equal && any;
}

/// Why a run was no success, in a word or two.
[[nodiscard]] inline std::string why_failed(RunResult const& result) {
  auto const outcome = outcome_of(result);
  auto const violations = violations_of(result);
  if (std::string(run_outcomes[outcome]) != "violation") return run_outcomes[outcome];
  for (auto const criterion : split(result.failed_by, " "))
    for (auto const& one : violations)
      if (one.text.starts_with(criterion)) return std::string(criterion) + " at " + rounded_text(one.time) + " s";
  return run_outcomes[outcome];
}

/// A change without p value and interval; `differences` receives those of its pairs.
[[nodiscard]] inline Change change_of(GroupPair const& pair, Measure const& measure, std::vector<double>& differences) {
  Change change{.measure = &measure};
  for_each_common(*pair.before, *pair.after, [&](auto const& a, auto const& b) {
    double const before = measure.value(a), after = measure.value(b);
    if (!std::isfinite(before) || !std::isfinite(after)) return;
    change.before += before;
    change.after += after;
    differences.push_back(after - before);
    change.differs |= after != before;
  });
  change.pairs = differences.size();
  auto const n = static_cast<double>(std::max<std::size_t>(1, change.pairs));
  change.before /= n;
  change.after /= n;
  return change;
}

/// Fills in the p value and the interval.
inline void test_change(Change& change, std::vector<double> const& differences, std::size_t resamples) {
  if (!change.differs) return;
  change.difference = bootstrap_interval(differences);
  if (!change.measure->is_share) {
    change.p = paired_bootstrap_p(differences, resamples);
    return;
  }
  auto const number = [&](double wanted) {
    return static_cast<std::uint64_t>(std::count(differences.begin(), differences.end(), wanted));
  };
  change.p = mcnemar_p(number(-1.0), number(1.0));
}

/// Adjusts the p values of measures that can be better or worse, and gives verdicts. Measures in which no pair differs
/// are not counted: they cannot be significant, whatever the level.
inline void judge_changes(Comparisons& comparisons) {
  std::vector<Change*> judged;
  std::vector<double> p;
  for (auto& comparison : comparisons.list)
    for (auto& change : comparison.changes)
      if (change.differs && change.measure->better != Better::neither) {
        judged.push_back(&change);
        p.push_back(change.p);
      }
  auto const adjusted = holm(p);
  for (std::size_t i = 0; i < judged.size(); ++i) {
    auto& change = *judged[i];
    change.p_adjusted = adjusted[i];
    if (adjusted[i] >= comparisons.level) continue;
    bool const is_more = change.after > change.before;
    change.verdict = is_more == (change.measure->better == Better::more) ? Finding::better : Finding::worse;
  }
}

[[nodiscard]] inline Comparisons compare_pairs(std::vector<GroupPair> const& pairs, std::string title, double level,
                                               std::function<bool(Measure const&)> const& wanted) {
  struct Job {
    std::size_t comparison, change;
    std::vector<double> differences;
  };
  Comparisons result{.title = std::move(title), .level = level};
  std::vector<Job> jobs;
  std::size_t tests = 0;
  for (auto const& pair : pairs) {
    Comparison comparison{.set = pair.after->set_label, .before = pair.before->label, .after = pair.after->label};
    if (pair.before->set_hash != pair.after->set_hash)
      comparison.set += " (by title and seeds; the sets differ, in their criteria or otherwise)";
    for_each_common(*pair.before, *pair.after, [&](auto const& a, auto const& b) {
      ++comparison.scenarios;
      if (a.result.success && !b.result.success) {
        comparison.lost.push_back(a.scenario);
        comparison.why_lost.push_back(why_failed(b.result));
      }
      if (!a.result.success && b.result.success) comparison.won.push_back(a.scenario);
    });
    if (comparison.scenarios == 0) continue;
    for (auto const& measure : measures()) {
      if (!wanted(measure)) continue;
      Job job{result.list.size(), comparison.changes.size(), {}};
      comparison.changes.push_back(change_of(pair, measure, job.differences));
      tests += comparison.changes.back().differs;
      jobs.push_back(std::move(job));
    }
    result.list.push_back(std::move(comparison));
  }
  // Enough resamples that the least p value stays significant after the correction.
  auto const resamples =
      std::max<std::size_t>(9999, static_cast<std::size_t>(4.0 * static_cast<double>(tests) / level));
  run_on_threads(jobs.size(), std::thread::hardware_concurrency(), [&](std::size_t i) {
    auto& change = result.list[jobs[i].comparison].changes[jobs[i].change];
    test_change(change, jobs[i].differences, resamples);
  });
  judge_changes(result);
  return result;
}

[[nodiscard]] inline bool any_measure(Measure const&) { return true; }

}  // namespace detail

CAMBIUM_COLD Comparisons compare_against(std::vector<ResultGroup> const& old_groups,
                                         std::vector<ResultGroup> const& new_groups, std::string const& old_name,
                                         std::string const& new_name, double level) {
  std::vector<detail::GroupPair> pairs;
  std::vector<std::string> left_out, missing;
  std::vector<ResultGroup const*> used;
  for (auto const& group : new_groups) {
    ResultGroup const* found = nullptr;
    for (auto const& old : old_groups) {
      if (old.behavior != group.behavior || !detail::same_scenarios(old, group)) continue;
      auto const rank = [&](ResultGroup const& other) {
        return std::tuple(other.set_hash == group.set_hash, other.parameters_hash == group.parameters_hash,
                          detail::numbers_of(other.version));
      };
      if (found == nullptr || rank(old) >= rank(*found)) found = &old;
    }
    if (found == nullptr) {
      left_out.push_back(group.set_label + ": " + group.label + " is only in " + new_name);
      continue;
    }
    std::size_t common = 0;
    detail::for_each_common(*found, group, [&](auto const&, auto const&) { ++common; });
    if (common < found->rows.size())
      missing.push_back(group.set_label + ": " + group.label + " lacks " + std::to_string(found->rows.size() - common) +
                        " of " + std::to_string(found->rows.size()) + " scenarios of " + old_name);
    pairs.push_back({found, &group});
    used.push_back(found);
  }
  for (auto const& old : old_groups) {
    if (std::find(used.begin(), used.end(), &old) != used.end()) continue;
    bool const has_heir = std::any_of(used.begin(), used.end(), [&](auto const* other) {
      return other->behavior == old.behavior && detail::same_scenarios(*other, old);
    });
    (has_heir ? left_out : missing).push_back(old.set_label + ": " + old.label + " is only in " + old_name);
  }
  auto result = detail::compare_pairs(pairs, new_name + " against " + old_name, level, detail::any_measure);
  result.left_out = std::move(left_out);
  result.missing = std::move(missing);
  if (result.list.empty())
    throw Error(new_name, "has no scenario and behaviour in common with " + old_name,
                "run the same set with behaviours of the same names: a set that was changed may be another set");
  return result;
}

CAMBIUM_COLD Comparisons compare_with_baseline(std::vector<ResultGroup> const& groups, std::string const& baseline,
                                               double level) {
  std::vector<detail::GroupPair> pairs;
  std::string known;
  bool is_known = false;
  auto const is_meant = [&](ResultGroup const& base) {  // by label, or by name where that is enough
    return base.label == baseline ||
           (base.behavior == baseline && std::ranges::count_if(groups, [&](auto const& other) {
                                           return other.set_hash == base.set_hash && other.behavior == baseline;
                                         }) == 1);
  };
  for (auto const& base : groups) {
    if (!is_meant(base)) {
      if (known.find("'" + base.label + "'") == known.npos) known += (known.empty() ? "'" : ", '") + base.label + "'";
      continue;
    }
    is_known = true;
    for (auto const& other : groups)
      if (&other != &base && other.set_hash == base.set_hash) pairs.push_back({&base, &other});
  }
  if (!is_known) throw Error("baseline '" + baseline + "'", "there is no result of it", "there are " + known);
  auto result = detail::compare_pairs(pairs, "compared with " + baseline, level, detail::any_measure);
  if (result.list.empty())
    throw Error("baseline '" + baseline + "'", "no other behaviour has run its scenarios", "run others, too");
  return result;
}

CAMBIUM_COLD Comparisons compare_each(std::vector<ResultGroup> const& groups, double level) {
  std::vector<detail::GroupPair> pairs;
  for (auto const& base : groups)
    for (auto const& other : groups)
      if (&base < &other && other.set_hash == base.set_hash) pairs.push_back({&base, &other});
  return detail::compare_pairs(pairs, "each two behaviours", level, [](Measure const& measure) {
    return measure.key == "success" || measure.key == "closed_loop_score";
  });
}

}  // namespace cambium::inline v0_1
