// Zip merge: the dense situations of the example merging, at a lane drop, with drivers who let one vehicle of the other
// lane in before them; counts how often two of one lane go one after the other, and writes figures, trajectories and a
// replay that plays in a browser.

#include "../common/sampled_program.hpp"
#include "../merging/task.hpp"
#include "task.hpp"

namespace {

void run(examples::Settings const& settings) {
  zip_merge::Task const task{merging::find_site(settings, "zip_merge")};
  examples::sample_and_report(
      task, settings,
      {"Zip merge",
       "the ego merged",
       {{"pairs at merge", "two who come to the merge one after the other, while others still come on both lanes"},
        {"of one lane", "those of these pairs who came on the same lane; a perfect zip has none"}}});
}

}  // namespace

int main(int argc, char** argv) {
  examples::Settings settings;
  settings.map_file = CAMBIUM_SOURCE_DIR "/maps/lane_drop.xodr";
  settings.out = "out/zip_merge";
  examples::Program const program{
      "zip_merge",
      "Samples dense situations before a merge where drivers let one another in, simulates and judges them.",
      "OpenDRIVE map with a merge"};
  return examples::run_sampled(program, settings, argc, argv, [&] { run(settings); });
}
