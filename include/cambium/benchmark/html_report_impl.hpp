#pragma once

#include <cstdio>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <set>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "cambium/benchmark/detail/box_plot.hpp"
#include "cambium/benchmark/detail/report_page.hpp"
#include "cambium/benchmark/detail/report_text.hpp"
#include "cambium/benchmark/html_report.hpp"
#include "cambium/benchmark/run_result.hpp"
#include "cambium/core/error.hpp"
#include "cambium/core/ids.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/core/markup.hpp"

namespace cambium::inline v0_1 {

namespace detail {

/// `text` with all characters but letters, digits, dots and dashes replaced by _.
[[nodiscard]] inline std::string file_word(std::string text) {
  for (char& c : text) {
    bool const is_plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-';
    if (!is_plain && c != '.') c = '_';
  }
  return text;
}

/// The name of a run's replay up to the number of its scenario.
[[nodiscard]] inline std::string replay_prefix(std::string const& set, std::string const& behavior,
                                               std::uint64_t set_hash, std::uint64_t parameters_hash) {
  char digits[9];
  std::uint64_t const mixed = set_hash ^ (parameters_hash << 1);
  std::snprintf(digits, sizeof digits, "%08x", static_cast<unsigned>(mixed ^ (mixed >> 32)));
  return file_word(set) + "_" + file_word(behavior) + "_" + digits;
}

/// A cell; an interval in brackets is set smaller.
[[nodiscard]] inline std::string html_cell(std::string const& cell) {
  auto const at = cell.find(" (");
  std::string const kind = cell == "better" ? " class=\"better\"" : cell == "WORSE" ? " class=\"worse\"" : "";
  if (at == cell.npos) return "<td" + kind + ">" + escape_markup(cell) + "</td>";
  return "<td>" + escape_markup(cell.substr(0, at)) + " <span class=\"ci\">" + escape_markup(cell.substr(at + 1)) +
         "</span></td>";
}

/// "<p>Missing: a; b</p>"; empty for no words.
[[nodiscard]] inline std::string listed(std::string const& what, std::vector<std::string> const& words) {
  std::string html;
  for (auto const& one : words) html += (html.empty() ? "<p>" + what + ": " : "; ") + escape_markup(one);
  return html.empty() ? html : html + "</p>";
}

[[nodiscard]] inline std::string html_table(Table const& table, std::string_view title) {
  std::string html = "<h3>" + escape_markup(title) + "</h3>\n";
  if (!table.rows.empty()) {
    html += "<div class=\"scroll\"><table><thead><tr>";
    for (auto const& name : table.head) html += "<th>" + escape_markup(name) + "</th>";
    html += "</tr></thead><tbody>\n";
    for (auto const& row : table.rows) {
      html += "<tr>";
      for (std::size_t c = 0; c < row.size(); ++c)
        html += c == 0 ? "<td>" + escape_markup(row[c]) + "</td>" : html_cell(row[c]);
      html += "</tr>\n";
    }
    html += "</tbody></table></div>";
  }
  return table.note.empty() ? html : html + "<p class=\"note\">" + escape_markup(table.note) + "</p>\n";
}

/// A bar for each behaviour that shows how its runs ended.
[[nodiscard]] inline std::string outcome_bars(Report const& report, std::vector<std::size_t> const& set) {
  std::string html = "<div class=\"bars\">";
  std::set<std::size_t> seen;
  for (auto const g : set) {
    auto const& group = report.groups[g];
    std::array<std::size_t, run_outcomes.size()> counts{};
    for (auto const& row : group.rows) ++counts[outcome_of(row.result)];
    html += "<span title=\"" + escape_markup(group.label) + "\">" + escape_markup(group.label) +
            "</span><svg viewBox=\"0 0 1000 10\" preserveAspectRatio=\"none\" role=\"img\">";
    double x = 0.0;
    for (std::size_t o = 0; o < counts.size(); ++o) {
      if (counts[o] == 0) continue;
      seen.insert(o);
      double const share = static_cast<double>(counts[o]) / static_cast<double>(group.rows.size());
      html += "<rect x=\"" + fixed_text(x, 1) + "\" y=\"0\" width=\"" + fixed_text(1000 * share, 1) +
              "\" height=\"10\" style=\"fill:var(--o" + std::to_string(o) + ")\"><title>" + run_outcomes[o] + ": " +
              std::to_string(counts[o]) + " of " + std::to_string(group.rows.size()) + "</title></rect>";
      x += 1000 * share;
    }
    html += "</svg>";
  }
  html += "</div><div class=\"legend\">";
  for (auto const o : seen)
    html += "<span><i style=\"background:var(--o" + std::to_string(o) + ")\"></i>" + run_outcomes[o] + "</span>";
  return html + "</div>\n";
}

[[nodiscard]] inline std::string distributions(Report const& report, std::vector<std::size_t> const& set) {
  std::string html =
      "<h3>Distributions</h3><p class=\"note\">Box: quartiles and median; line: 5 to 95 %; dots: runs, at most 200, "
      "the extremes among them. None: runs without a value.</p><div class=\"plots\">\n";
  for (auto const& measure : measures()) {
    if (measure.is_share || measure.key == "steps" || measure.key == "decisions") continue;
    std::vector<BoxPlotRow> rows;
    double least = 0.0, most = 0.0;
    for (auto const g : set) {
      BoxPlotRow row{report.groups[g].label, {}, 0};
      for (auto const& run : report.groups[g].rows)
        if (double const value = measure.value(run); std::isfinite(value))
          row.values.push_back(value);
        else
          ++row.not_finite;
      std::sort(row.values.begin(), row.values.end());
      if (!row.values.empty()) {
        least = std::min(least, row.values.front());
        most = std::max(most, row.values.back());
      }
      rows.push_back(std::move(row));
    }
    if (least == 0.0 && most == 0.0) continue;  // nothing happened
    html += "<figure style=\"margin:0\"><h4 title=\"" + escape_markup(measure.sentence) + "\">" +
            escape_markup(titled(measure)) + "</h4>" + box_plot(rows) + "</figure>\n";
  }
  return html + "</div>\n";
}

/// The data of the list of runs as JSON, safe inside a script element.
[[nodiscard]] inline std::string list_data(Report const& report, HtmlReportOptions const& options) {
  auto const add = [](std::string& list, std::string const& item, char const* separator = ",") {
    list += (list.empty() ? "" : separator) + item;
  };
  std::string names, outcomes, groups, rows, errors, seeds, hits, violations, made, frozen;
  std::vector<std::size_t> columns;
  for (char const* key :
       {"duration_s", "mean_speed", "least_gap", "least_time_to_collision", "post_encroachment_time", "hardest_braking",
        "largest_jerk", "rss_compliance", "closed_loop_score", "mean_ms", "longest_ms"}) {
    columns.push_back(measure_index(key));
    add(names, json_string(titled(measures()[columns.back()])));
  }
  for (char const* outcome : run_outcomes) add(outcomes, json_string(outcome));  // their colours are --o0 to --o6
  std::size_t index = 0;
  for (std::size_t g = 0; g < report.groups.size(); ++g) {
    auto const& group = report.groups[g];
    add(groups,
        "{\"set\":" + json_string(group.set_label) + ",\"title\":" + json_string(group.set) +
            ",\"source\":" + json_string(group.source) +
            ",\"command\":" + json_string(group.command.empty() ? "examples/run benchmark" : group.command) +
            ",\"label\":" + json_string(group.label) + ",\"behavior\":" + json_string(group.behavior) + ",\"hash\":\"" +
            std::to_string(group.set_hash) + "\",\"file\":" +
            json_string(replay_prefix(group.set, group.behavior, group.set_hash, group.parameters_hash)) + "}",
        ",\n");
    for (auto const& row : group.rows) {
      auto numbers =
          "[" + std::to_string(g) + "," + std::to_string(row.scenario) + "," + std::to_string(outcome_of(row.result));
      for (auto const m : columns) numbers += "," + short_number(measures()[m].value(row));
      add(rows, numbers + "]", ",\n");
      auto const key = "\"" + std::to_string(index) + "\":";
      if (!row.result.error.empty()) add(errors, key + json_string(row.result.error));
      std::string items;
      auto const criteria = split(row.result.failed_by, " ");
      auto const is_decisive = [&](std::string_view text) {
        return std::ranges::any_of(criteria, [&](auto one) { return !one.empty() && text.starts_with(one); });
      };
      double const step = row.result.steps > 0 ? row.result.duration_s / static_cast<double>(row.result.steps) : 0.0;
      for (auto const& [time, text] : violations_of(row.result))
        add(items, "[" + std::to_string(step > 0.0 ? std::llround(time / step) : 0) + "," +
                       json_string(rounded_text(time) + " s " + text) + (is_decisive(text) ? ",1]" : "]"));
      if (!items.empty()) add(violations, key + "[" + items + "]");
      if (is_valid(row.result.hit)) add(hits, key + "\"" + to_string(row.result.hit) + "\"");
      add(seeds, "\"" + std::to_string(row.seed) + "\"");
      std::error_code ignored;
      auto file = options.page_folder / options.replays /
                  replay_file_name(group.set, group.behavior, group.set_hash, group.parameters_hash, row.scenario);
      for (auto* const list : {&made, &frozen}) {
        if (std::filesystem::exists(file, ignored)) add(*list, std::to_string(index));
        file.replace_extension(".snapshot");
      }
      ++index;
    }
  }
  return "{\"replays\":" + json_string(options.replays.generic_string()) +
         ",\"folder\":" + json_string((options.page_folder / options.replays).lexically_normal().generic_string()) +
         ",\"columns\":[" + names + "],\"outcomes\":[" + outcomes + "],\n\"groups\":[" + groups + "],\n\"rows\":[" +
         rows + "],\n\"errors\":{" + errors + "},\n\"hits\":{" + hits + "},\n\"violations\":{" + violations +
         "},\n\"made\":[" + made + "],\n\"frozen\":[" + frozen + "],\n\"seeds\":[" + seeds + "]}";
}

}  // namespace detail

CAMBIUM_COLD std::string replay_file_name(std::string const& set, std::string const& behavior, std::uint64_t set_hash,
                                          std::uint64_t parameters_hash, std::int64_t scenario) {
  return detail::replay_prefix(set, behavior, set_hash, parameters_hash) + "_" + std::to_string(scenario) + ".html";
}

CAMBIUM_COLD std::string html_report(Report const& report, HtmlReportOptions const& options) {
  using detail::escape_markup;
  auto const sets = detail::groups_by_set(report.groups);
  auto const tables = tables_of(report);
  std::size_t runs = 0;
  std::set<std::string> behaviors, versions;
  for (auto const& group : report.groups) {
    runs += group.rows.size();
    behaviors.insert(group.behavior);
    versions.insert(group.version);
  }
  auto const counted = [](std::size_t count, std::string const& thing) {
    return std::to_string(count) + " " + thing + (count == 1 ? "" : "s");
  };
  std::string page =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta name=\"generator\" content=\"cambium\">\n<title>" +
      escape_markup(options.title) + "</title>\n<style>" + std::string(detail::report_style) +
      "</style>\n</head>\n<body>\n<header><h1>" + escape_markup(options.title) + "</h1><p class=\"soft\">" +
      counted(sets.size(), "set") + ", " + counted(behaviors.size(), "behaviour") + ", " + counted(runs, "run") +
      "; cambium";
  for (auto const& one : versions) page += " " + escape_markup(one);
  page += "</p><nav>";
  for (std::size_t s = 0; s < sets.size(); ++s)
    page +=
        "<a href=\"#s" + std::to_string(s) + "\">" + escape_markup(report.groups[sets[s].front()].set_label) + "</a>";
  page += "<a href=\"#list\">all runs</a></nav></header>\n<main>\n";
  for (auto const& comparisons : report.comparisons)
    page += std::string("<section class=\"verdict") + (comparisons.has_loss() ? " loss" : "") + "\">" +
            escape_markup(verdict_of(comparisons)) + detail::listed("Missing", comparisons.missing) +
            detail::listed("Not compared", comparisons.left_out) + "</section>\n";
  std::size_t next = 0;
  if (!tables.empty() && tables[next].set.empty())
    page += "<section>" + detail::html_table(tables[next], "Successes (collisions)") + "</section>\n";
  ++next;
  for (std::size_t s = 0; s < sets.size(); ++s) {
    auto const& name = report.groups[sets[s].front()].set_label;
    page += "<section id=\"s" + std::to_string(s) + "\"><h2>" + escape_markup(name) + "</h2>\n" +
            detail::outcome_bars(report, sets[s]);
    for (; next < tables.size() && tables[next].set == name; ++next)
      page += detail::html_table(tables[next], tables[next].title);
    page += detail::distributions(report, sets[s]) + "<details><summary>Parameters</summary>";
    for (auto const g : sets[s])
      page += "<p class=\"mono\"><b>" + escape_markup(report.groups[g].label) + "</b> " +
              escape_markup(report.groups[g].parameters) + "</p>";
    page += "</details></section>\n";
  }
  if (next < tables.size()) {
    page += "<section><h2>Comparisons</h2>\n";
    for (; next < tables.size(); ++next) page += detail::html_table(tables[next], tables[next].title);
    page += "</section>\n";
  }
  page += std::string(detail::report_list) + "</main>\n<script type=\"application/json\" id=\"data\">\n" +
          detail::list_data(report, options) + "\n</script>\n<script>(() => {" + std::string(detail::report_script) +
          "})();</script>\n</body>\n</html>\n";
  return page;
}

}  // namespace cambium::inline v0_1
