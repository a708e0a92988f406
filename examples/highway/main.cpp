// Traffic on a highway: cars and trucks on several lanes, drivers by the presets of the literature, who follow by the
// Intelligent Driver Model and change lanes by MOBIL, keep right and find their exits; judges each scenario, and writes
// figures, trajectories and a replay that plays in a browser.

#include "../common/map_file.hpp"
#include "../common/sampled_program.hpp"
#include "scenario.hpp"

namespace {

void run(examples::Settings const& settings) {
  auto const site = highway::find_site(examples::load_map(settings.map_file), settings.map_file);
  std::string const success = site.exits.empty() ? "the ego came to the end" : "the ego took its exit";
  examples::sample_and_report(site, settings, {"Highway", success, {{"lane changes"}}});
}

}  // namespace

int main(int argc, char** argv) {
  examples::Settings settings;
  settings.map_file = CAMBIUM_SOURCE_DIR "/maps/highway_exit.xodr";
  settings.out = "out/highway";
  examples::Program const program{"highway", "Samples traffic on a highway of several lanes, simulates and judges it.",
                                  "OpenDRIVE map with a road of several lanes"};
  return examples::run_sampled(program, settings, argc, argv, [&] { run(settings); });
}
