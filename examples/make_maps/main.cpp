// Writes cambium's own OpenDRIVE maps: highway, lane_drop, merging, highway_exit, intersection_3way, intersection_4way
// and roundabout (.xodr).
//
//   examples/run make_maps --out maps
//
// It shows how to lay out a map in code: pieces of reference line, lanes with widths, junctions. It always writes the
// same bytes.

#include <cmath>
#include <filesystem>
#include <iostream>
#include <string>
#include <system_error>
#include <utility>

#include "cambium/core/write_file.hpp"
#include "cambium/geometry/box.hpp"
#include "cambium/map/opendrive/writer.hpp"

#include "../common/command_line.hpp"
#include "maps.hpp"

namespace make_maps {
namespace {

/// Sets the header's bounds to those of the ends of all geometries, in whole metres.
void set_bounds(opendrive::Document& document) {
  cambium::geometry::Box box;
  for (auto const& road : document.roads)
    for (auto const& g : road.geometries)
      for (double const ds : {0.0, g.length}) {
        auto const p = evaluate(g, ds);
        box.add(p.x, p.y);
      }
  auto const text = [](double metres) { return std::to_string(std::lround(metres)); };
  document.header.rest.attributes = {
      {"north", text(box.max_y)}, {"south", text(box.min_y)}, {"east", text(box.max_x)}, {"west", text(box.min_x)}};
}

std::string text_of(opendrive::Document document) {
  set_bounds(document);
  for (auto& road : document.roads)
    for (auto& type : road.types) type.unit = opendrive::SpeedUnit::kilometres_per_hour;
  auto text = write_opendrive(document);
  text.insert(text.find('\n') + 1, "<!-- Written by examples/make_maps; change that, not this. -->\n");
  return text;
}

void write_all(std::filesystem::path const& folder) {
  struct Entry {
    char const* name;
    MapBuilder (*make)();
  };
  std::error_code ignored;  // if the folder cannot be created, writing the files reports it
  std::filesystem::create_directories(folder, ignored);
  for (auto const& [name, make] :
       {Entry{"highway.xodr", highway}, Entry{"lane_drop.xodr", lane_drop}, Entry{"merging.xodr", merging},
        Entry{"highway_exit.xodr", highway_exit}, Entry{"intersection_3way.xodr", intersection_3way},
        Entry{"intersection_4way.xodr", intersection_4way}, Entry{"roundabout.xodr", roundabout}}) {
    auto document = make().document();
    if (make == intersection_4way) add_lights(document);
    auto const text = text_of(std::move(document));
    cambium::write_file(folder / name, text);
    std::cout << (folder / name).string() << ": " << text.size() << " bytes\n";
  }
}

}  // namespace
}  // namespace make_maps

int main(int argc, char** argv) {
  std::string folder = "maps";
  CLI::App program("Writes cambium's own maps.", "make_maps");
  program.add_option("--out", folder, "folder to write to; created if it does not exist")
      ->type_name("DIR")
      ->capture_default_str();
  return examples::run_program(program, argc, argv, [&] { make_maps::write_all(folder); });
}
