// Zip merge: the dense scenarios of the example merging, at a lane drop, with drivers who each let one vehicle from the
// other lane in. Counts how often two vehicles from the same lane merge in a row, and writes figures, trajectories and
// a replay for the browser.

#include "../common/sampled_program.hpp"
#include "../merging/task.hpp"
#include "task.hpp"

namespace {

void run(examples::Settings& settings) {
  zip_merge::Task task{merging::find_site(settings, "zip_merge")};
  settings.parameters.take(task.traffic);
  examples::sample_and_report(
      task, settings,
      {"Zip merge",
       "the ego merged",
       {{"pairs at merge", "two vehicles in a row at the merge, while others still approach in the other lane"},
        {"of one lane", "those of these pairs that came from the same lane; a perfect zip has none"}}});
}

}  // namespace

int main(int argc, char** argv) {
  examples::Settings settings;
  settings.map_file = CAMBIUM_SOURCE_DIR "/maps/lane_drop.xodr";
  settings.out = "out/zip_merge";
  examples::Program const program{
      "zip_merge",
      "Samples dense scenarios before a merge where drivers let one another in, simulates and judges them.",
      "OpenDRIVE map with a merge"};
  return examples::run_sampled(program, settings, argc, argv, [&] { run(settings); });
}
