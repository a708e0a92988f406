#include <cambium/benchmark/comparison.hpp>
#include <cambium/benchmark/detail/box_plot.hpp>
#include <cambium/benchmark/html_report.hpp>
#include <cambium/benchmark/progress.hpp>
#include <cambium/benchmark/read_results.hpp>
#include <cambium/benchmark/report.hpp>
#include <cambium/core/distributions.hpp>
#include <cambium/core/error.hpp>
#include <cambium/core/write_file.hpp>
#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "../examples/program.hpp"

using namespace cambium;
using browser::TemporaryFolder;

namespace {

/// `count` results of a behaviour on set 1; `make(result, scenario)` fills each.
ResultGroup group_of(std::string const& behavior, std::int64_t count,
                     std::function<void(RunResult&, std::int64_t)> const& make) {
  ResultGroup group{.set_hash = 1,
                    .set = "merging",
                    .set_label = "merging",
                    .source = "--set 'my sets/merging.json'",
                    .behavior = behavior,
                    .version = library_version,
                    .label = behavior};
  for (std::int64_t i = 0; i < count; ++i) {
    group.rows.push_back({.scenario = i, .seed = static_cast<std::uint64_t>(i)});
    make(group.rows.back().result, i);
  }
  return group;
}

void write(ResultStore& store, ResultGroup const& group) {
  store.add_set(group.set_hash, group.set, group.rows.size(), group.source);
  store.add_behavior(group.behavior, group.parameters_hash, group.parameters);
  for (auto const& row : group.rows)
    store.add({{group.set_hash, row.scenario, group.behavior, group.parameters_hash, group.version},
               row.seed,
               row.result,
               row.times});
  store.commit();
}

Change const& change_of(Comparison const& comparison, std::string_view key) {
  return comparison.changes.at(measure_index(key));
}

/// A driver of whom success, score, proper responses and hard brakings scatter.
ResultGroup noisy(std::uint64_t seed, double success, std::int64_t count = 120) {
  return group_of("driver", count, [&](RunResult& result, std::int64_t i) {
    RandomStream stream(seed, static_cast<std::uint32_t>(i), 0);
    result.success = uniform01(stream) < success;
    result.closed_loop_score = uniform01(stream);
    result.rss_compliance = 1.0 - 0.2 * uniform01(stream) * uniform01(stream);
    result.hard_brakings = uniform_index(stream, 4);
  });
}

}  // namespace

TEST_CASE("a report of known results has their figures") {
  auto const mobil = group_of("mobil", 20, [](RunResult& result, std::int64_t i) {
    result.success = i >= 5;
    result.collision = i < 2;
    result.error = i == 4 ? "no plan" : "";
    result.mean_speed = static_cast<double>(i);
    if (i < 4) result.least_time_to_collision = 1.0 + static_cast<double>(i);
  });
  auto idm = group_of("idm", 15, [](RunResult& result, std::int64_t i) { result.success = i != 14; });
  idm.rows.erase(idm.rows.begin());  // another does not run all
  idm.rows[3].times = {.decisions = 7, .mean_ms = 2.0, .longest_ms = 9.5, .overruns = 1};
  TemporaryFolder const folder;
  ResultStore store(folder.path() / "results.db");
  write(store, mobil);
  write(store, idm);
  auto const report = make_report(read_results(store));
  REQUIRE(report.groups.size() == 2);
  CHECK(report.groups[0].label == "idm");
  auto const estimate = [&](std::size_t group, std::string const& key) {
    return report.estimates[group][measure_index(key)];
  };
  CHECK(estimate(1, "success").value == 0.75);
  CHECK(estimate(1, "success").interval == wilson_interval(15, 20));
  CHECK(estimate(1, "collision").value == 0.1);
  CHECK(estimate(1, "error").value == 0.05);
  std::vector<double> speeds;  // of all runs but that with an error
  for (int i = 0; i < 20; ++i)
    if (i != 4) speeds.push_back(i);
  CHECK(estimate(1, "mean_speed").value == doctest::Approx(186.0 / 19));
  CHECK(estimate(1, "mean_speed").interval == bootstrap_interval(speeds));
  CHECK(estimate(1, "least_time_to_collision").count == 4);
  CHECK(estimate(1, "least_time_to_collision").value == 2.5);
  CHECK(estimate(0, "success").value == doctest::Approx(13.0 / 14));
  CHECK(estimate(0, "longest_ms").most == 9.5);

  REQUIRE(report.each.list.size() == 1);
  auto const& pair = report.each.list.front();
  CHECK(pair.scenarios == 14);
  CHECK(pair.lost == std::vector<std::int64_t>{1, 2, 3, 4});  // idm to mobil
  CHECK(pair.won == std::vector<std::int64_t>{14});
  CHECK(pair.changes.front().p == mcnemar_p(4, 1));
  CHECK(pair.changes.front().before == doctest::Approx(13.0 / 14));
  CHECK(pair.changes.front().after == doctest::Approx(10.0 / 14));

  auto const tables = tables_of(report);
  CHECK(tables_of(report, 0).size() == tables_of(report, 1).size());
  auto const overview = text_of(tables.front());
  CHECK(overview.find("successes (collisions)") != overview.npos);
  CHECK(tables.front().rows.back()[0] == "mobil");
  CHECK(tables.front().rows.back()[1] == "15/20 (2)");
  CHECK(tables.front().rows.back()[2] == "15/20 (2)");
  auto const text = text_of(tables[1]);
  CHECK(text.find("merging: outcomes") != text.npos);
  CHECK(text.find("75.0 (53.1-88.8)") != text.npos);
  auto const latex = latex_of(tables[1]);
  CHECK(latex.find("mobil & 20 & 75.0 (53.1--88.8)") != latex.npos);
  CHECK(latex.find("success [\\%]") != latex.npos);
  auto const csv = csv_of(report);
  CHECK(csv.find("\nmerging,mobil,0000000000000000,0.1.0,,success,,more,20,0.75,0.53") != csv.npos);
  CHECK(csv.find("\nmerging,mobil,,,idm,success,,more,14,-0.21428571428571") != csv.npos);
}

TEST_CASE("behaviours of one name are told apart") {
  TemporaryFolder const folder;
  ResultStore store(folder.path() / "results.db");
  auto group = noisy(1, 0.5, 3);
  write(store, group);
  group.parameters_hash = 0xabcdef0123456789u;
  write(store, group);
  group.version = "9.9.9";
  write(store, group);
  group.set_hash = 2;
  write(store, group);
  std::string labels;
  for (auto const& g : read_results(store)) labels += g.set_label + ": " + g.label + "\n";
  CHECK(labels == "merging #00000000: driver #00000000 " + std::string(library_version) +
                      "\nmerging #00000000: driver #abcdef01 " + library_version +
                      "\nmerging #00000000: driver #abcdef01 9.9.9\nmerging #00000000: driver #abcdef01 9.9.9\n");
}

TEST_CASE("a planted loss is found, and which way it goes") {
  auto const before = noisy(1, 0.9);
  auto after = before;
  after.parameters_hash = 7;  // a change of parameters is still the same behaviour
  for (std::size_t i = 0; i < after.rows.size(); i += 8) after.rows[i].result.success = false;
  auto const loss = compare_against({before}, {after}, "old.db", "new.db");
  CHECK(loss.has_loss());
  auto const& success = change_of(loss.list.front(), "success");
  CHECK(success.verdict == Finding::worse);
  CHECK(success.difference.high < 0.0);
  CHECK(success.p == mcnemar_p(loss.list.front().lost.size(), 0));
  CHECK(success.p_adjusted == success.p);  // nothing else differs: a family of one
  CHECK(change_of(loss.list.front(), "closed_loop_score").verdict == Finding::none);
  CHECK(verdict_of(loss).find("significant loss: merging, driver: success") != std::string::npos);
  auto const gain = compare_against({after}, {before}, "old.db", "new.db");
  CHECK_FALSE(gain.has_loss());
  CHECK(change_of(gain.list.front(), "success").verdict == Finding::better);

  after = before;
  for (auto& row : after.rows) row.result.hard_brakings += row.scenario % 2;
  auto const brakings = compare_against({before}, {after}, "old.db", "new.db");
  CHECK(change_of(brakings.list.front(), "hard_brakings").verdict == Finding::worse);
  CHECK(change_of(brakings.list.front(), "hard_brakings").after -
            change_of(brakings.list.front(), "hard_brakings").before ==
        doctest::Approx(0.5));
  after = before;
  for (auto& row : after.rows) row.times.mean_ms = 100.0;
  CHECK_FALSE(compare_against({before}, {after}, "old.db", "new.db").has_loss());  // a slower machine
}

TEST_CASE("equally good behaviours seldom differ significantly") {
  // 500 pairs of 120 scenarios at a level of 10 %: 10 % ± 4 % are three standard deviations. McNemar's test is exact
  // and therefore errs less often than its level.
  constexpr int trials = 500;
  int any = 0, losses = 0;
  for (std::uint64_t trial = 0; trial < trials; ++trial) {
    auto const found =
        compare_against({noisy(2 * trial, 0.8, 60)}, {noisy(2 * trial + 1, 0.8, 60)}, "old.db", "new.db", 0.1);
    losses += found.has_loss();
    auto const& changes = found.list.front().changes;
    any += std::any_of(changes.begin(), changes.end(), [](auto const& c) { return c.verdict != Finding::none; });
  }
  CHECK(any / double(trials) < 0.15);
  CHECK(any / double(trials) > 0.05);
  CHECK(losses < any);
}

TEST_CASE("comparisons use equal scenarios only, and say what they left out") {
  auto const a = noisy(1, 0.5), b = noisy(2, 0.5, 30);
  auto other = noisy(3, 0.5);
  other.behavior = other.label = "new driver";
  auto const found = compare_against({a}, {b, other}, "old.db", "new.db");
  REQUIRE(found.list.size() == 1);
  CHECK(found.list.front().scenarios == 30);
  CHECK(found.left_out == std::vector<std::string>{"merging: new driver is only in new.db"});
  CHECK(found.missing == std::vector<std::string>{"merging: driver lacks 90 of 120 scenarios of old.db"});
  auto const dropped = compare_against({a, other}, {a}, "old.db", "new.db");
  CHECK(dropped.missing == std::vector<std::string>{"merging: new driver is only in old.db"});
  CHECK(verdict_of(dropped).find("results are missing") != std::string::npos);
  auto const with = compare_with_baseline({a, other}, "driver");
  REQUIRE(with.list.size() == 1);
  CHECK(with.list.front().before == "driver");
  CHECK(with.list.front().after == "new driver");
  CHECK_THROWS_AS(static_cast<void>(compare_with_baseline({a, other}, "nobody")), Error);
  CHECK_THROWS_AS(static_cast<void>(compare_with_baseline({a}, "driver")), Error);
  auto elsewhere = a;
  elsewhere.set_hash = 5;
  elsewhere.set = "highway";
  CHECK_THROWS_AS(static_cast<void>(compare_against({a}, {elsewhere}, "old.db", "new.db")), Error);
  CHECK_THROWS_AS(static_cast<void>(compare_against({a}, {other}, "old.db", "new.db")), Error);

  // With several of a name, the one of equal parameters counts, then the latest version.
  auto tuned = noisy(4, 0.5);
  tuned.parameters_hash = 9;
  auto const same = compare_against({tuned, a}, {tuned}, "old.db", "new.db");
  CHECK_FALSE(change_of(same.list.front(), "closed_loop_score").differs);
}

TEST_CASE("verdicts that another judge changed are found with their reasons, also where it hashes sets otherwise") {
  auto const old = group_of("frenet", 40, [](RunResult& result, std::int64_t) { result.success = true; });
  auto judged = old;
  judged.set_hash = 77;
  for (std::size_t i = 3; i < 30; ++i) {
    judged.rows[i].result.success = false;
    judged.rows[i].result.red_light = true;
    judged.rows[i].result.violations = "1 s solid_line; 3.4 s red_light; 5 s wrong_way until 7.2 s";
    judged.rows[i].result.failed_by = "red_light wrong_way";
  }
  judged.rows[3].result.collision = judged.rows[3].result.at_fault = true;
  auto const found = compare_against({old}, {judged}, "old.db", "new.db");
  REQUIRE(found.list.size() == 1);
  CHECK(found.missing.empty());
  CHECK(found.list.front().set == "merging (by title and seeds; the sets differ, in their criteria or otherwise)");
  CHECK(change_of(found.list.front(), "red_light").verdict == Finding::worse);
  CHECK(change_of(found.list.front(), "violations").after == doctest::Approx(27.0 / 40));
  auto report = make_report({judged});
  report.comparisons.push_back(found);
  auto const tables = tables_of(report);
  CHECK(tables.back().note.find("Success lost in scenarios 3 (collision, at fault), 4 (red_light at 3.4 s), 5") !=
        std::string::npos);
  CHECK(tables[2].note.find("frenet failed by red_light 27, wrong_way 27.") != std::string::npos);
  auto const outcomes = text_of(tables[2]);
  CHECK(outcomes.find("merging: violations") != outcomes.npos);
  CHECK(outcomes.find("red light [%]") != outcomes.npos);
  auto const summary = text_of(summary_of({judged}).front());
  CHECK(summary.find("red light") != summary.npos);
  CHECK(summary.find("frenet failed by red_light 27, wrong_way 27.") != summary.npos);
  CHECK(summary.find("solid line") == summary.npos);  // there was none
  auto moved = judged;
  for (auto& row : moved.rows) row.seed += 1;
  CHECK_THROWS_AS(static_cast<void>(compare_against({old}, {moved}, "old.db", "new.db")), Error);
}

TEST_CASE("progress is told with a rate and what is left, and plots have round numbers along their axes") {
  CHECK(progress_text(120, 600, 8.0) == "120 of 600, 15/s, 32 s left");
  CHECK(progress_text(1, 21, 30.0) == "1 of 21, 0.0333/s, 10 min left");
  CHECK(progress_text(1, 1000, 36.0) == "1 of 1000, 0.0278/s, 10.0 h left");
  CHECK(detail::quantile_of({1.0, 2.0, 4.0}, 0.75) == 3.0);
  detail::PlotAxis const linear({{"a", {2.0, 4.0, 12.0}}, {"b", {7.0}}}, 100.0, 200.0);
  CHECK(linear.at(7.0) == 150.0);
  CHECK(linear.ticks() == std::vector{2.0, 4.0, 6.0, 8.0, 10.0, 12.0});
  detail::PlotAxis const decades({{"a", {0.5, 1.0}}, {"b", {40.0, 5000.0}}}, 0.0, 4.0);
  CHECK(decades.at(50.0) == doctest::Approx(2.0));
  CHECK(decades.ticks() == std::vector{1.0, 10.0, 100.0, 1000.0});
}

TEST_CASE("hostile names are escaped in every format") {
  std::string const evil = "<img src=x onerror=alert(1)>,\"'&$%_{}\\</script>\x1b[2J";
  auto group = group_of(evil, 3, [&](RunResult& result, std::int64_t) { result.error = evil; });
  group.set = group.set_label = group.parameters = group.command = group.source = evil;
  auto report = make_report({group, noisy(1, 0.5, 3)});
  report.comparisons.push_back({.title = evil, .left_out = {evil}});
  auto const page = html_report(report, {.title = evil});
  CHECK(page.find("<img") == page.npos);
  CHECK(page.find("&lt;img src=x onerror=alert(1)&gt;") != page.npos);
  CHECK(page.find('\x1b') == page.npos);
  std::size_t scripts = 0;
  for (auto at = page.find("</script"); at != page.npos; at = page.find("</script", at + 1)) ++scripts;
  CHECK(scripts == 2);
  for (char const* outside : {"http:", "https:", "url(", "@import", "<link", "<iframe", "<script src"}) {
    CAPTURE(outside);
    CHECK(page.find(outside) == page.npos);
  }
  CHECK(page.find("<div class=\"controls\">") != page.npos);
  auto const errors = errors_of(report.groups);
  REQUIRE(errors.size() == 1);
  CHECK(errors.front().find("3 of 3 runs ended with an error, scenario ") != std::string::npos);
  CHECK(errors.front().find('\x1b') == std::string::npos);
  auto const tables = tables_of(report);
  for (auto const& table : tables) CHECK(text_of(table).find('\x1b') == std::string::npos);
  auto const latex = latex_of(tables.front());
  CHECK(latex.find("\\&\\$\\%\\_\\{\\}\\textbackslash{}") != latex.npos);
  CHECK(csv_of(report).find("\"<img src=x onerror=alert(1)>,\"\"'&") != std::string::npos);
  CHECK(replay_file_name("a", "b", 1, 0, 7) != replay_file_name("a", "b", 0, 0, 7));
  CHECK(replay_file_name("a", "b", 0, 1, 7) != replay_file_name("a", "b", 0, 0, 7));
  CHECK(replay_file_name("a/../b", "c d\xC3\xA4", 0, 0, 7) == "a_.._b_c_d___00000000_7.html");
}

TEST_CASE("the page lists all runs, filters them, and links the replays and snapshots that there are") {
  auto const chromium = browser::find();
  if (!chromium) return support::skip("no Chromium");
  auto report = make_report({noisy(1, 0.5, 150), group_of("idm", 10, [](RunResult& result, std::int64_t i) {
                               result.success = i > 2;
                               result.collision = i < 2;
                               result.error = i == 2 ? "<b>no plan" : "";
                               result.steps = 50;
                               result.duration_s = 10.0;
                               if (i != 4) return;
                               result.violations = "1 s speeding; 3.4 s red_light; 5 s wrong_way until 7.2 s";
                               result.failed_by = "red_light wrong_way";
                             })});
  TemporaryFolder const folder;
  std::filesystem::create_directories(folder.path() / "replays");
  auto const replay =
      folder.path() / "replays" /
      replay_file_name("merging", "idm", report.groups.back().set_hash, report.groups.back().parameters_hash, 4);
  write_file(replay, "a replay");
  write_file(std::filesystem::path(replay).replace_extension(".snapshot"), "a snapshot");
  auto const page = html_report(report, {.page_folder = folder.path()});
  CHECK(page == html_report(report, {.page_folder = folder.path()}));
  auto const file = folder.path() / "report.html";
  write_file(file, browser::with_actions(page, "find", R"js(
const rows = () => [...document.querySelectorAll('#runs tbody tr')];
say('shown', rows().length, document.body.dataset.found);
say('links', ...[...document.querySelectorAll('#runs a')].map((a) => a.getAttribute('href')));
document.getElementById('behavior').value = 'idm';
document.getElementById('behavior').oninput();
say('idm', rows().length);
document.querySelectorAll('#runs th')[3].click();
say('sorted', rows()[0].cells[3].textContent, rows()[9].cells[3].textContent, rows()[9].cells[1].textContent);
rows()[9].click();
say('command', document.querySelector('.more code').textContent);
say('problem', rows()[9].cells[3].title === '<b>no plan',
    document.querySelector('.more p').textContent === '<b>no plan');
target.value = 'no plan';
target.oninput();
say('text', rows().length);
target.value = 'red light';
target.oninput();
const texts = (where) => [...where.querySelectorAll('.violation')].map((a) => a.textContent);
say('violations', rows().length, ...texts(rows()[0]));
say('decisive', rows()[0].querySelectorAll('.decisive').length);
rows()[0].querySelector('.violation:last-child').click();
say('all', ...texts(document.querySelector('.more')));
)js"));
  auto const document = browser::document(*chromium, file);
  auto const said = [&](std::string const& name) { return browser::attribute(document, "<body", "data-" + name); };
  CHECK(said("failure") == "");
  CHECK(said("shown") == "100 160");
  CHECK(said("links") ==
        "replays/merging_idm_00000001_4.html replays/merging_idm_00000001_4.snapshot "
        "replays/merging_idm_00000001_4.html#frame=17 replays/merging_idm_00000001_4.html#frame=25 #list");
  CHECK(said("idm") == "10");
  CHECK(said("sorted") == "success error 2");
  CHECK(said("command").find("examples/run benchmark --set 'my sets/merging.json' --only merging:2:idm --replay ") ==
        0);
  CHECK(said("problem") == "true true");
  CHECK(said("text") == "1");
  CHECK(said("violations") == "1 3.4 s red light 5 s wrong way until 7.2 s 1 more");  // what failed it comes first
  CHECK(said("decisive") == "2");
  CHECK(said("all") == "1 s speeding 3.4 s red light 5 s wrong way until 7.2 s");
}

TEST_CASE("the program reports, merges, and exits 1 on a significant loss") {
  program::Program const report("report");
  if (!report.is_there()) return;
  TemporaryFolder const folder;
  auto const path = [&](char const* name) { return (folder.path() / name).string(); };
  auto const before = noisy(1, 0.9);
  auto after = before, first = before, second = before;
  for (std::size_t i = 0; i < after.rows.size(); i += 5) after.rows[i].result.success = false;
  first.rows.resize(50);
  second.rows.erase(second.rows.begin(), second.rows.begin() + 50);
  for (auto const& [name, group] :
       {std::pair{"old.db", &before}, {"new.db", &after}, {"first.db", &first}, {"second.db", &second}}) {
    ResultStore store(folder.path() / name);
    write(store, *group);
  }
  auto const run = report.run({"--db", path("new.db"), "--against", path("old.db"), "--html", path("page/r.html"),
                               "--csv", path("r.csv"), "--latex", path("r.tex")});
  CHECK(run.code == 1);
  CHECK(run.err == "");
  CHECK(run.out.find("significant loss: merging, driver: success") != std::string::npos);
  CHECK(program::content_of(path("page/r.html")).find("</html>") != std::string::npos);
  CHECK(program::content_of(path("r.csv")).find(",worse\n") != std::string::npos);
  CHECK(program::content_of(path("r.tex")).find("\\toprule") != std::string::npos);
  CHECK(report.run({"--db", path("old.db"), "--against", path("new.db")}).code == 0);
  auto const merged = report.run(
      {"--db", path("all.db"), "--merge", path("first.db"), "--merge", path("second.db"), "--against", path("old.db")});
  CHECK(merged.code == 0);
  CHECK(merged.out.find("merging: driver, 120 equal scenarios\n    No difference.") != std::string::npos);
  for (auto const& words : std::vector<std::vector<std::string>>{{"--db", path("nowhere.db")},
                                                                 {"--db", path("r.csv")},
                                                                 {"--db", path("old.db"), "--against", path("r.tex")},
                                                                 {"--db", path("old.db"), "--merge", path("old.db")},
                                                                 {"--db", path("old.db"), "--baseline", "nobody"},
                                                                 {}}) {
    auto const refused = report.run(words);
    CHECK(refused.code == 2);
    CHECK(refused.out == "");
    CHECK(refused.err.find("report: ") == 0);
    CHECK(std::count(refused.err.begin(), refused.err.end(), '\n') == 1);
  }
  CHECK_FALSE(std::filesystem::exists(path("nowhere.db")));
}
