// Draws an OpenDRIVE map as an SVG picture, with a title that says what it contains.

#include <filesystem>
#include <iostream>
#include <string>

#include "cambium/viewer/record_world.hpp"
#include "cambium/viewer/svg_picture.hpp"

#include "common/command_line.hpp"
#include "common/map_file.hpp"

namespace {

void draw(std::string const& file, std::string const& out, double width) {
  auto const map = examples::load_map(file);
  double length = 0.0;
  for (auto const& road : map->roads()) length += road.length;
  cambium::Recording recording;
  recording.lanes = cambium::recorded_lanes(*map);
  auto const roads = map->roads().size();
  recording.title = std::filesystem::path(file).filename().string() + ": " + std::to_string(roads) +
                    (roads == 1 ? " road, " : " roads, ") + std::to_string(map->lanes().size()) + " lanes, " +
                    std::to_string(static_cast<int>(length)) + " m";
  cambium::write_svg_picture(out, recording, {.width = width});
  std::cout << out << "  " << recording.title << "\n";
}

}  // namespace

int main(int argc, char** argv) {
  std::string file = CAMBIUM_SOURCE_DIR "/maps/merging.xodr", out = "map.svg";
  double width = 1200;
  CLI::App program("Draws an OpenDRIVE map.", "map_picture");
  program.add_option("--map", file, "OpenDRIVE map")->type_name("FILE")->capture_default_str();
  program.add_option("--out", out, "picture to write (.svg)")->type_name("FILE")->capture_default_str();
  program.add_option("--width", width, "of the picture, in pixels")
      ->type_name("N")
      ->check(CLI::Range(100.0, 20000.0))
      ->capture_default_str();
  return examples::run_program(program, argc, argv, [&] { draw(file, out, width); });
}
