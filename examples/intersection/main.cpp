// Traffic crosses: samples situations before the junctions of an OpenDRIVE map, where everybody heeds the right of way,
// rolls them forward, judges each, and writes figures, trajectories and a replay that plays in a browser.

#include "../common/map_file.hpp"
#include "../common/sampled_program.hpp"
#include "scenario.hpp"

int main(int argc, char** argv) {
  examples::Settings settings;
  settings.map_file = CAMBIUM_SOURCE_DIR "/maps/intersection_4way.xodr";
  settings.out = "out/intersection";
  settings.steps = 600;
  CLI::App program("Samples traffic before junctions, simulates and judges it.", "intersection");
  examples::add_options(program, settings, "OpenDRIVE map with an intersection");
  return examples::run_program(program, argc, argv, [&] {
    auto const site = intersection::find_site(examples::load_map(settings.map_file), settings.map_file);
    examples::sample_and_report(site, settings, {"Intersection", "everybody got through"});
  });
}
