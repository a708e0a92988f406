// Reads an OpenDRIVE map: says what it contains and what is odd about it, draws it, and answers queries from tables.

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

#include "cambium/core/error.hpp"
#include "cambium/core/write_file.hpp"
#include "cambium/viewer/map_picture.hpp"
#include "cambium/viewer/record_world.hpp"
#include "cambium/viewer/svg_picture.hpp"

#include "../common/command_line.hpp"
#include "../common/map_file.hpp"
#include "summary.hpp"
#include "tables.hpp"

namespace {

struct Settings {
  std::string file, picture, sketch, poses, nearest, out, links;
  std::vector<std::string> route;
  bool infer_links = false;
};

/// Throws where files would be overwritten that are read, or one by the other, or not be written at all.
void check_files(Settings const& settings) {
  namespace fs = std::filesystem;
  if (!settings.out.empty() && settings.poses.empty() && settings.nearest.empty())
    throw cambium::Error("--out", "there is nothing to write", "give --poses or --nearest too");
  if (!settings.sketch.empty() && fs::path(settings.sketch).extension() != ".svg")
    throw cambium::Error("--sketch " + settings.sketch, "it is no .svg", "name a file that ends in .svg");
  std::vector<fs::path> taken;
  for (auto const* input : {&settings.file, &settings.poses, &settings.nearest})
    if (!input->empty()) taken.push_back(fs::weakly_canonical(*input));
  for (auto const* output : {&settings.picture, &settings.sketch, &settings.out, &settings.links}) {
    if (output->empty()) continue;
    auto path = fs::weakly_canonical(*output);
    if (std::find(taken.begin(), taken.end(), path) != taken.end())
      throw cambium::Error(*output, "it is read, or written twice", "give every output a file of its own");
    taken.push_back(std::move(path));
  }
}

void run(Settings const& settings) {
  check_files(settings);
  auto const opened = examples::open_map(settings.file, {.infer_links = settings.infer_links});
  std::cout << map_example::summary(opened, settings.file);
  for (auto const& diagnostic : opened.diagnostics) std::cout << "  " << to_string(diagnostic) << "\n";
  if (!settings.picture.empty()) {
    cambium::write_map_picture(settings.picture, *opened.map, {.title = settings.file});
    std::cout << "picture: " << settings.picture << "\n";
  }
  if (!settings.sketch.empty()) {
    cambium::Recording recording;
    recording.lanes = cambium::recorded_lanes(*opened.map);
    recording.title = std::filesystem::path(settings.file).filename().string();
    cambium::write_svg_picture(settings.sketch, recording);
    std::cout << "sketch: " << settings.sketch << "\n";
  }
  if (!settings.poses.empty()) cambium::write_file(settings.out, map_example::poses(*opened.map, settings.poses));
  if (!settings.nearest.empty()) cambium::write_file(settings.out, map_example::nearest(*opened.map, settings.nearest));
  if (!settings.links.empty()) cambium::write_file(settings.links, map_example::links(opened.document));
  if (!settings.route.empty()) std::cout << map_example::route(*opened.map, settings.route[0], settings.route[1]);
}

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  CLI::App program("Reads an OpenDRIVE map: what it contains, what is odd about it, pictures, queries.", "map");
  program.add_option("FILE", settings.file, "OpenDRIVE map (.xodr)")->type_name("")->required();
  program.add_option("--picture", settings.picture, "draw the map (.svg, or .html that zooms)")->type_name("OUT");
  program.add_option("--sketch", settings.sketch, "draw it small, with a close-up, for a document (.svg)")
      ->type_name("OUT");
  auto* const poses = program.add_option("--poses", settings.poses, "columns road,s,lane: where these lanes are");
  auto* const nearest =
      program.add_option("--nearest", settings.nearest, "columns x,y: the lanes that hold the points");
  auto* const out = program.add_option("--out", settings.out, "what --poses or --nearest write")->type_name("OUT.csv");
  poses->type_name("IN.csv")->needs(out)->excludes(nearest);
  nearest->type_name("IN.csv")->needs(out);
  program.add_option("--links", settings.links, "write which lanes meet at the ends of roads")->type_name("OUT.csv");
  program.add_flag("--infer-links", settings.infer_links, "join lanes whose ends meet where the file forgot the link");
  program.add_option("--route", settings.route, "print the shortest route between two places, as road:lane:s each")
      ->type_name("FROM TO")
      ->expected(2);
  program.footer(
      "Columns that are written, in m and rad:\n"
      "  --poses    road,s,lane,x,y,hdg,width,t,rx,ry,rhdg,rk: the lane's middle, the reference line (r...)\n"
      "  --nearest  road,lane,s,t,distance,query: query is the number of the point from 0; a point in no lane gives "
      "no\n"
      "             row\n"
      "  --links    road,end,lane,next_road,next_contact,next_lane,via: as written in the file\n"
      "Exit code: 0 where there is a map, whatever is odd about it; 2 where there is none, or another error.");
  return examples::run_program(program, argc, argv, [&] { run(settings); });
}
