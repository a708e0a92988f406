// Traffic crosses: samples situations before the junctions of an OpenDRIVE map, where everybody heeds the right of way,
// rolls them forward, judges each, and writes figures, trajectories and a replay that plays in a browser.

#include "../common/command_line.hpp"
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
  bool lights = false;
  program.add_flag("--lights", lights,
                   "switch the map's traffic lights on; else signs and who comes from the right count");
  return examples::run_program(program, argc, argv, [&] {
    auto site = intersection::find_site(examples::load_map(settings.map_file), settings.map_file);
    site.lights = lights;
    if (lights && site.map->lights().empty())
      throw cambium::MapError(settings.map_file, "this map has no traffic lights",
                              "leave out --lights or give a map with some, such as maps/intersection_4way.xodr");
    examples::sample_and_report(site, settings, {"Intersection", "everybody got through"});
  });
}
