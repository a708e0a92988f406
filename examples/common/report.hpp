#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "options.hpp"
#include "roll_out.hpp"

namespace examples {

struct Totals {
  std::uint64_t success = 0, collision = 0, time_out = 0, off_road = 0, agents = 0, agent_steps = 0, hard_brakings = 0,
                steps = 0;
  double speed_sum = 0.0;
  std::uint64_t replayed = 0;
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
    if (o.interest() > outcomes[t.replayed].interest()) t.replayed = i;
  }
  return t;
}

/// "1 vehicle", "2 vehicles".
[[nodiscard]] inline std::string counted(std::uint64_t count, std::string const& thing) {
  return std::to_string(count) + " " + thing + (count == 1 ? "" : "s");
}

/// Facts about a site by name, such as its number of entrances.
using Facts = std::vector<std::pair<std::string, std::size_t>>;

/// Writes the figures, the collisions and each scenario's outcome as JSON, with units and thresholds.
void write_summary(std::filesystem::path const& file, Settings const& settings, Facts const& facts,
                   std::vector<Outcome> const& outcomes, Totals const& totals, Words const& words);

/// "99.990 % (99.984-99.993)": a share and its 95 % interval (Wilson). `total` > 0.
[[nodiscard]] std::string share_text(std::uint64_t count, std::uint64_t total);

/// "success     199979 of 200000   99.990 % (99.984-99.993)": a count, its share, and the 95 % interval of the share.
[[nodiscard]] std::string share_line(std::string const& name, std::uint64_t count, std::uint64_t total);

/// Prints the table of results.
void print_table(Settings const& settings, Totals const& totals, double seconds, Words const& words);

}  // namespace examples
