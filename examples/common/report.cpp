#include "report.hpp"

#include <algorithm>
#include <cstdio>

#include "wilson.hpp"

std::string examples::explained(Words const& words) {
  std::string text =
      "  success: " + words.success +
      " before time was out, and nobody collided\n"
      "  ego off-road: a part of the ego was beyond the lanes to drive on, as that of a truck may be in\n"
      "    a tight bend, where its rear axle keeps to the lane\n"
      "  in brackets: the 95 % interval of the share (Wilson)\n";
  for (auto const& count : words.counts)
    if (!count.meaning.empty()) text += "  " + count.name + ": " + count.meaning + "\n";
  return text;
}

std::string examples::share_line(std::string const& name, std::uint64_t count, std::uint64_t total) {
  auto const percent = [](double share) { return 100.0 * share; };
  auto const interval = wilson(count, total);
  // As many digits as it takes to tell the interval's ends apart.
  int const digits = interval.high - interval.low > 0.01 ? 1 : interval.high - interval.low > 0.001 ? 2 : 3;
  auto const figures = std::to_string(total).size();
  char line[160];
  std::snprintf(line, sizeof line, "  %-14s %*llu of %llu  %*.*f %% (%.*f-%.*f)\n", name.c_str(),
                static_cast<int>(figures), static_cast<unsigned long long>(count),
                static_cast<unsigned long long>(total), digits + 4, digits,
                percent(static_cast<double>(count) / static_cast<double>(total)), digits, percent(interval.low), digits,
                percent(interval.high));
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
              -hard_braking);
  for (std::size_t k = 0; k < t.counts.size(); ++k)
    std::printf("  %-14s %.2f per scenario\n", words.counts[k].name.c_str(), static_cast<double>(t.counts[k]) / n);
  std::printf("  %-14s %.3g in %.2f s: %.3g per second on %llu thread%s, sampling and judging included\n", "agent-steps",
              steps, seconds, steps / seconds, static_cast<unsigned long long>(settings.threads),
              settings.threads == 1 ? "" : "s");
  if (t.time_out > 0)
    std::printf("  %s ended by the limit of %llu steps (%.0f s); --steps raises it\n",
                counted(t.time_out, "scenario").c_str(), static_cast<unsigned long long>(settings.steps),
                static_cast<double>(settings.steps) * dt);
  std::printf("%s\n", explained(words).c_str());
}
