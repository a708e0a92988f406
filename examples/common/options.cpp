#include "options.hpp"

#include <cstdint>

#include <CLI/CLI.hpp>

#include "command_line.hpp"

namespace examples {

void add_options(CLI::App& program, Settings& settings, std::string const& map_sentence) {
  auto const number = [&](char const* name, std::uint64_t& target, std::uint64_t low, std::uint64_t high,
                          char const* sentence) {
    program.add_option(name, target, sentence)->type_name("N")->check(whole_number(low, high))->capture_default_str();
  };
  number("--scenarios", settings.scenarios, 1, 10'000'000, "number of scenarios to sample");
  number("--seed", settings.seed, 0, ~std::uint64_t{0}, "seed of all random numbers");
  number("--threads", settings.threads, 1, 1024, "number of threads; the results do not depend on it");
  number("--steps", settings.steps, 1, 1'000'000, "limit of steps of 0.2 s; a scenario that takes more has timed out");
  number("--trajectories", settings.trajectories, 0, 10'000'000,
         "scenarios whose trajectories are written, besides the replayed one");
  program
      .add_option("--replay", settings.replay,
                  "number of the scenario, from 0, that replay.html plays; default: a collision if there is one, else "
                  "a time-out, else the ego off-road, else the closest call, the scenario with the hardest braking")
      ->type_name("N")
      ->check(whole_number(0, 9'999'999));
  program.add_option("--map", settings.map_file, map_sentence)
      ->type_name("FILE")
      ->check(not_empty())
      ->capture_default_str();
  program.add_option("--out", settings.out, "folder for summary.json, trajectories.csv and replay.html")
      ->type_name("DIR")
      ->check(not_empty())
      ->capture_default_str();
  settings.parameters.add_options(program);
  program.footer("What it prints:\n" + explained({"", "the ego, or everybody, completed the task"}) +
                 "What it writes to trajectories.csv:\n"
                 "  a line for each vehicle and step; x and y are the centre of the rear axle, front and rear the\n"
                 "    distances from there to the bumpers; acceleration is that of the step before");
}

int run_sampled(Program const& program, Settings& settings, int argc, char** argv, std::function<void()> const& body) {
  CLI::App app(program.sentence, program.name);
  add_options(app, settings, program.map_sentence);
  return run_program(app, argc, argv, body);
}

}  // namespace examples
