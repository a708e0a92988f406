#include "report.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "cambium/benchmark/statistics.hpp"

#include "part_file.hpp"
#include "version.hpp"

namespace {

using Json = nlohmann::ordered_json;

/// "lane changes" as a key: "lane_changes".
std::string in_one_word(std::string text) {
  std::replace(text.begin(), text.end(), ' ', '_');
  return text;
}

double mean(double sum, std::uint64_t n) { return n > 0 ? sum / static_cast<double>(n) : 0.0; }

/// The time of a number of steps [s], rounded to 1 microsecond.
double time_of(std::uint64_t steps) { return std::round(1e6 * static_cast<double>(steps) * examples::dt) / 1e6; }

/// Units and meaning of the figures.
Json units(examples::Words const& words) {
  Json json{{"dt", "s"},
            {"success", "share of the scenarios"},
            {"collision", "share of the scenarios"},
            {"time_out", "share of the scenarios"},
            {"off_road", "share of the scenarios"},
            {"intervals", "95 %, Wilson"},
            {"mean_speed", "m/s"},
            {"mean_steps", "steps of dt"},
            {"hard_brakings", "count"},
            {"time", "s"},
            {"steps", "steps of dt"},
            {"lowest_acceleration", "m/s^2"}};
  for (auto const& count : words.counts) json[in_one_word(count.name)] = "count";
  return json;
}

Json collisions(std::vector<examples::Outcome> const& outcomes) {
  Json list = Json::array();
  for (std::size_t i = 0; i < outcomes.size(); ++i)
    if (auto const& o = outcomes[i]; o.kind == examples::Outcome::Kind::collision)
      list.push_back({{"scenario", i},
                      {"time", time_of(o.steps)},
                      {"agents", {to_string(o.collided_first), to_string(o.collided_second)}},
                      {"ego", to_string(o.ego)}});
  return list;
}

Json head(examples::Settings const& settings, examples::Facts const& facts,
          std::vector<examples::Outcome> const& outcomes, examples::Totals const& t, examples::Words const& words) {
  auto const n = settings.scenarios;
  Json json;
  json["cambium_version"] = examples::version();
  json["map"] = std::filesystem::path(settings.map_file).filename().string();
  json["scenarios"] = n;
  json["seed"] = settings.seed;
  json["steps"] = settings.steps;
  json["dt"] = examples::dt;
  for (auto const& [name, count] : facts) json[name] = count;
  std::vector<std::pair<char const*, std::uint64_t>> const shares = {
      {"success", t.success}, {"collision", t.collision}, {"time_out", t.time_out}, {"off_road", t.off_road}};
  for (auto const& [name, count] : shares) json[name] = mean(static_cast<double>(count), n);
  json["mean_speed"] = mean(t.speed_sum, t.agent_steps);
  json["mean_steps"] = mean(static_cast<double>(t.steps), n);
  json["hard_brakings"] = t.hard_brakings;
  for (std::size_t k = 0; k < t.counts.size(); ++k) json[in_one_word(words.counts[k].name)] = t.counts[k];
  json["agents"] = t.agents;
  json["agent_steps"] = t.agent_steps;
  json["replayed_scenario"] = t.replayed;
  for (auto const& [name, count] : shares) {
    auto const interval = cambium::wilson_interval(count, n);
    json["counts"][name] = count;
    json["intervals"][name] = {interval.low, interval.high};
  }
  json["units"] = units(words);
  json["thresholds"] = {
      {"hard_braking", {{"acceleration_below", -examples::hard_braking.deceleration}, {"unit", "m/s^2"}}}};
  json["collisions"] = collisions(outcomes);
  return json;
}

}  // namespace

void examples::write_summary(std::filesystem::path const& file, Settings const& settings, Facts const& facts,
                             std::vector<Outcome> const& outcomes, Totals const& totals, Words const& words) {
  auto text = head(settings, facts, outcomes, totals, words).dump(1, ' ', false, Json::error_handler_t::replace);
  text.resize(text.rfind('\n'));
  PartFile out(file);
  out.append(text + ",\n \"outcomes\": [");
  char const* const names[] = {"success", "collision", "time_out"};
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    auto const& o = outcomes[i];
    Json row{{"scenario", i},
             {"outcome", names[static_cast<int>(o.kind)]},
             {"off_road", o.off_road},
             {"agents", o.agents},
             {"steps", o.steps},
             {"hard_brakings", o.hard_brakings},
             {"lowest_acceleration", std::round(1e4 * o.lowest_acceleration) / 1e4 + 0.0}};
    out.append((i == 0 ? "\n  " : ",\n  ") + row.dump());
  }
  out.append("\n ]\n}\n");
  out.finish();
}

std::string examples::explained(Words const& words) {
  std::string text = "  success: " + words.success +
                     " in time, and nobody collided\n"
                     "  ego off-road: a part of the ego was outside the drivable lanes, as can happen to a truck in\n"
                     "    a tight bend, where its rear axle keeps to the lane\n"
                     "  in brackets: the 95 % interval of the share (Wilson)\n";
  for (auto const& count : words.counts)
    if (!count.meaning.empty()) text += "  " + count.name + ": " + count.meaning + "\n";
  return text;
}

std::string examples::share_text(std::uint64_t count, std::uint64_t total) {
  auto const interval = cambium::wilson_interval(count, total);
  // Enough digits to tell the ends of the interval apart.
  int const digits = interval.high - interval.low > 0.01 ? 1 : interval.high - interval.low > 0.001 ? 2 : 3;
  char text[96];
  std::snprintf(text, sizeof text, "%*.*f %% (%.*f-%.*f)", digits + 4, digits,
                100.0 * static_cast<double>(count) / static_cast<double>(total), digits, 100.0 * interval.low, digits,
                100.0 * interval.high);
  return text;
}

std::string examples::share_line(std::string const& name, std::uint64_t count, std::uint64_t total) {
  char line[192];
  std::snprintf(line, sizeof line, "  %-14s %*llu of %llu  %s\n", name.c_str(),
                static_cast<int>(std::to_string(total).size()), static_cast<unsigned long long>(count),
                static_cast<unsigned long long>(total), share_text(count, total).c_str());
  return line;
}

void examples::print_table(Settings const& settings, Totals const& t, double seconds, Words const& words) {
  auto const n = static_cast<double>(settings.scenarios);
  auto const steps = static_cast<double>(t.agent_steps);
  auto const share = [&](char const* name, std::uint64_t count) {
    std::printf("%s", share_line(name, count, settings.scenarios).c_str());
  };
  std::printf("\n  %s on %s, %.1f agents each, seed %llu\n\n", counted(settings.scenarios, "scenario").c_str(),
              std::filesystem::path(settings.map_file).filename().c_str(), static_cast<double>(t.agents) / n,
              static_cast<unsigned long long>(settings.seed));
  share("success", t.success);
  share("collision", t.collision);
  share("time-out", t.time_out);
  share("ego off-road", t.off_road);
  std::printf("  %-14s %.2f m/s\n  %-14s %.2f per scenario (harder than %.0f m/s^2)\n", "mean speed",
              t.speed_sum / std::max(1.0, steps), "hard brakings", static_cast<double>(t.hard_brakings) / n,
              hard_braking.deceleration);
  for (std::size_t k = 0; k < t.counts.size(); ++k)
    std::printf("  %-14s %.2f per scenario\n", words.counts[k].name.c_str(), static_cast<double>(t.counts[k]) / n);
  std::printf("  %-14s %.3g in %.2f s: %.3g per second on %llu thread%s, sampling and judging included\n",
              "agent-steps", steps, seconds, steps / seconds, static_cast<unsigned long long>(settings.threads),
              settings.threads == 1 ? "" : "s");
  if (t.time_out > 0)
    std::printf("  %s ended by the limit of %s (%g s); --steps raises it\n", counted(t.time_out, "scenario").c_str(),
                counted(settings.steps, "step").c_str(), static_cast<double>(settings.steps) * dt);
  std::printf("%s\n", explained(words).c_str());
}
