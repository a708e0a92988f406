// Merging traffic: samples dense scenarios at the on-ramp or lane drop of an OpenDRIVE map, simulates them with the
// Intelligent Driver Model, judges each, and writes figures, trajectories and a replay for the browser.

#include "../common/sampled_program.hpp"
#include "task.hpp"

namespace {

void run(examples::Settings const& settings) {
  merging::Task const task{merging::find_site(settings, "merging")};
  examples::sample_and_report(task, settings, {"Merging", "the ego merged"});
}

}  // namespace

int main(int argc, char** argv) {
  examples::Settings settings;
  settings.map_file = CAMBIUM_SOURCE_DIR "/maps/merging.xodr";
  settings.out = "out/merging";
  examples::Program const program{"merging", "Samples dense merging scenarios, simulates and judges them.",
                                  "OpenDRIVE map with a merge"};
  return examples::run_sampled(program, settings, argc, argv, [&] { run(settings); });
}
