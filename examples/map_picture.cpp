// Draws an OpenDRIVE map as an SVG picture, with a title that says what it contains.

#include <filesystem>
#include <iostream>
#include <string>

#include "cambium/viewer/record_world.hpp"
#include "cambium/viewer/svg_picture.hpp"

#include "common/map_file.hpp"
#include "common/options.hpp"

namespace {

int run(int argc, char** argv) {
  std::string file = CAMBIUM_SOURCE_DIR "/maps/merging.xodr", out = "map.svg";
  std::uint64_t width = 1200;
  examples::Options options("map_picture", "draws an OpenDRIVE map");
  options.text("--map", "FILE", file, "OpenDRIVE map");
  options.text("--out", "FILE", out, "picture to write (.svg)");
  options.number("--width", "PIXELS", width, 100, 20000, "of the picture");
  if (!options.parse(argc, argv)) return 0;

  auto const map = examples::load_map(file);
  double length = 0.0;
  for (auto const& road : map->roads()) length += road.length;
  cambium::Recording recording;
  recording.lanes = cambium::recorded_lanes(*map);
  recording.title = std::filesystem::path(file).filename().string() + ": " + std::to_string(map->roads().size()) + " roads, " +
                    std::to_string(map->lanes().size()) + " lanes, " + std::to_string(static_cast<int>(length)) + " m";
  cambium::write_svg_picture(out, recording, {.width = static_cast<double>(width)});
  std::cout << out << "  " << recording.title << "\n";
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return examples::run_program("map_picture", [&] { return run(argc, argv); });
}
