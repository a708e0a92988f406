#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "roll_out.hpp"

namespace examples {

struct Totals {
  std::uint64_t success = 0, collision = 0, time_out = 0, off_road = 0, agents = 0, agent_steps = 0, hard_brakings = 0,
                steps = 0;
  double speed_sum = 0.0;
  std::uint64_t most_interesting = 0;
  std::vector<std::uint64_t> counts;
};

[[nodiscard]] inline Totals total(std::vector<Outcome> const& outcomes) {
  Totals t;
  for (std::uint64_t i = 0; i < outcomes.size(); ++i) {
    auto const& o = outcomes[i];
    t.success += o.kind == Outcome::Kind::success;
    t.collision += o.kind == Outcome::Kind::collision;
    t.time_out += o.kind == Outcome::Kind::time_out;
    t.off_road += o.off_road;
    t.agents += o.agents;
    t.agent_steps += o.agent_steps;
    t.hard_brakings += o.hard_brakings;
    t.steps += o.steps;
    t.speed_sum += o.speed_sum;
    t.counts.resize(o.counts.size());
    for (std::size_t k = 0; k < o.counts.size(); ++k) t.counts[k] += o.counts[k];
    if (o.interest() > outcomes[t.most_interesting].interest()) t.most_interesting = i;
  }
  return t;
}

/// Something that the scenarios count: "lane changes"; `meaning` may be left out.
struct Count {
  std::string name, meaning{};
};

/// What a program of sampled scenarios calls things.
struct Words {
  std::string title;    ///< of the replay: "Merging"
  std::string success;  ///< "the ego merged"
  std::vector<Count> counts{};
};

/// "1 vehicle", "2 vehicles".
[[nodiscard]] inline std::string counted(std::uint64_t count, std::string const& thing) {
  return std::to_string(count) + " " + thing + (count == 1 ? "" : "s");
}

/// "lane changes" as a key: "lane_changes".
[[nodiscard]] inline std::string in_one_word(std::string text) {
  std::replace(text.begin(), text.end(), ' ', '_');
  return text;
}

/// The figures as a file keeps them. `add_facts(site, json)` beside the site
/// adds what there is to say about it.
template <class Site>
[[nodiscard]] nlohmann::ordered_json summary(Settings const& settings, Site const& site,
                                             std::vector<Outcome> const& outcomes, Totals const& t,
                                             Words const& words) {
  auto const n = static_cast<double>(settings.scenarios);
  nlohmann::ordered_json json;
  json["map"] = std::filesystem::path(settings.map_file).filename().string();
  json["scenarios"] = settings.scenarios;
  json["seed"] = settings.seed;
  json["steps"] = settings.steps;
  json["dt"] = dt;
  add_facts(site, json);
  json["success"] = static_cast<double>(t.success) / n;
  json["collision"] = static_cast<double>(t.collision) / n;
  json["time_out"] = static_cast<double>(t.time_out) / n;
  json["off_road"] = static_cast<double>(t.off_road) / n;
  json["mean_speed"] = t.agent_steps > 0 ? t.speed_sum / static_cast<double>(t.agent_steps) : 0.0;
  json["mean_steps"] = static_cast<double>(t.steps) / n;
  json["hard_brakings"] = t.hard_brakings;
  for (std::size_t k = 0; k < t.counts.size(); ++k) json[in_one_word(words.counts[k].name)] = t.counts[k];
  json["agents"] = t.agents;
  json["agent_steps"] = t.agent_steps;
  json["replayed_scenario"] = t.most_interesting;
  char const* const names[] = {"success", "collision", "time_out"};
  for (auto const& o : outcomes)
    json["outcomes"].push_back({{"outcome", names[static_cast<int>(o.kind)]},
                                {"off_road", o.off_road},
                                {"agents", o.agents},
                                {"steps", o.steps},
                                {"hard_brakings", o.hard_brakings}});
  return json;
}

/// What the words of the table mean.
[[nodiscard]] std::string explained(Words const& words);

/// "success     199979 of 200000   99.990 % (99.984-99.993)": a count, its share and the share's 95 % interval (Wilson).
[[nodiscard]] std::string share_line(std::string const& name, std::uint64_t count, std::uint64_t total);

/// The table of results, on the standard output.
void print_table(Settings const& settings, Totals const& totals, double seconds, Words const& words);

}  // namespace examples
