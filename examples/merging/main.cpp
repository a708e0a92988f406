// Merging traffic: samples dense scenarios at the on-ramp or lane drop of an OpenDRIVE map, simulates them with the
// Intelligent Driver Model, judges each, and writes figures, trajectories and a replay for the browser.

#include "../common/command_line.hpp"
#include "../common/sampled_program.hpp"
#include "task.hpp"

namespace {

void run(examples::Settings& settings, cambium::MergingTraffic traffic) {
  settings.parameters.take(traffic);
  merging::Task const task{merging::find_site(settings, "merging"), traffic};
  examples::sample_and_report(task, settings, {"Merging", "the ego merged"});
}

}  // namespace

int main(int argc, char** argv) {
  examples::Settings settings;
  settings.map_file = CAMBIUM_SOURCE_DIR "/maps/merging.xodr";
  settings.out = "out/merging";
  CLI::App program("Samples dense merging scenarios, simulates and judges them.", "merging");
  examples::add_options(program, settings, "OpenDRIVE map with a merge");
  cambium::MergingTraffic traffic;
  program
      .add_option("--non-yielding", traffic.non_yielding_share,
                  "share of the drivers on the through road who open no gap for those that merge")
      ->type_name("SHARE")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  program.add_flag("--wait", traffic.ramp_waits, "drivers that merge wait for a gap; otherwise they force their way");
  return examples::run_program(program, argc, argv, [&] { run(settings, traffic); });
}
