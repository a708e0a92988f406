// Reads a map: summarises its content, reports problems, draws it, and answers queries.

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "cambium/core/error.hpp"
#include "cambium/core/write_file.hpp"
#include "cambium/viewer/map_picture.hpp"
#include "cambium/viewer/record_world.hpp"
#include "cambium/viewer/svg_picture.hpp"

#include "../common/command_line.hpp"
#include "../common/map_file.hpp"
#include "opened_map.hpp"
#include "reports.hpp"
#include "summary.hpp"
#include "tables.hpp"

namespace {

struct Settings {
  std::string file, picture, sketch, poses, nearest, out, links, junction;
  std::vector<std::string> route, reachable;
  std::vector<double> part, origin;
  bool infer_links = false, in_space = false, network = false, strict = false;
};

/// Throws `Error` if an output would overwrite an input or another output, or if no output is requested for `--out`.
void check_files(Settings const& settings) {
  namespace fs = std::filesystem;
  if (!settings.out.empty() && settings.poses.empty() && settings.nearest.empty())
    throw cambium::Error("--out", "there is nothing to write", "give --poses or --nearest too");
  if (!settings.sketch.empty() && fs::path(settings.sketch).extension() != ".svg")
    throw cambium::Error("--sketch " + settings.sketch, "it is not an .svg file", "name a file that ends in .svg");
  auto const real = [](std::string const& name) {
    std::error_code problem;  // such a path cannot be opened either, which is reported later
    auto path = fs::weakly_canonical(name, problem);
    return problem ? fs::path(name) : path;
  };
  std::vector<fs::path> taken;
  for (auto const* input : {&settings.file, &settings.poses, &settings.nearest})
    if (!input->empty()) taken.push_back(real(*input));
  for (auto const* output : {&settings.picture, &settings.sketch, &settings.out, &settings.links}) {
    if (output->empty()) continue;
    auto path = real(*output);
    if (std::find(taken.begin(), taken.end(), path) != taken.end())
      throw cambium::Error(*output, "it is read, or written twice", "give every output a file of its own");
    taken.push_back(std::move(path));
  }
}

void draw(cambium::Map const& map, Settings const& settings) {
  if (!settings.picture.empty()) {
    cambium::MapPictureOptions options{.title = std::filesystem::path(settings.file).filename().string()};
    if (auto const& p = settings.part; !p.empty()) options.part = {p[0], p[1], p[2], p[3]};
    cambium::write_map_picture(settings.picture, map, options);
    std::cout << "picture: " << settings.picture << "\n";
  }
  if (!settings.sketch.empty()) {
    cambium::Recording recording;
    recording.lanes = cambium::recorded_lanes(map);
    recording.title = std::filesystem::path(settings.file).filename().string();
    cambium::write_svg_picture(settings.sketch, recording);
    std::cout << "sketch: " << settings.sketch << "\n";
  }
}

int run(Settings const& settings) {
  namespace example = map_example;
  check_files(settings);
  auto const opened = example::open_map(settings.file, {.infer_links = settings.infer_links},
                                        examples::origin_of(settings.origin, settings.file));
  auto const& map = *opened.map;
  std::cout << example::summary(opened, settings.file);
  for (auto const& diagnostic : opened.diagnostics) std::cout << "  " << to_string(diagnostic) << "\n";
  draw(map, settings);
  if (settings.network) std::cout << example::network(map);
  if (!settings.junction.empty()) std::cout << example::junction(map, settings.junction);
  if (!settings.route.empty()) std::cout << example::route(map, settings.route[0], settings.route[1]);
  if (!settings.reachable.empty()) std::cout << example::reachable(map, settings.reachable[0], settings.reachable[1]);
  if (!settings.poses.empty())
    cambium::write_file(settings.out, example::poses(map, settings.poses, settings.in_space));
  if (!settings.nearest.empty()) cambium::write_file(settings.out, example::nearest(map, settings.nearest));
  if (!settings.links.empty() && !opened.lanelets.empty())
    throw cambium::Error("--links", "the file has no OpenDRIVE roads", "give an .xodr file");
  if (!settings.links.empty()) cambium::write_file(settings.links, example::links(opened.document));
  return settings.strict && example::is_odd(opened) ? 1 : 0;
}

/// Adds the options with their help texts.
void describe(CLI::App& program, Settings& settings) {
  program
      .add_option(
          "FILE", settings.file,
          "OpenDRIVE (.xodr), Lanelet2 (.osm) or CommonRoad (.xml) map, or columns x,y: a lane's centre line (.csv)")
      ->type_name("")
      ->required();
  auto* const picture =
      program.add_option("--picture", settings.picture, "draw the map (.svg, or .html that zooms)")->type_name("OUT");
  program.add_option("--part", settings.part, "draw only this box of the map")
      ->type_name("XMIN YMIN XMAX YMAX")
      ->expected(4)
      ->needs(picture);
  program
      .add_option("--origin", settings.origin,
                  "place on Earth where a Lanelet2 map has (0, 0) [degrees]; default: its middle")
      ->type_name("LAT,LON")
      ->delimiter(',')
      ->expected(2);
  program.add_option("--sketch", settings.sketch, "draw a small picture with a close-up, for documents (.svg)")
      ->type_name("OUT");
  program.add_flag("--network", settings.network, "list gaps, kinks, dead ends and one-sided links between lanes");
  program
      .add_option("--junction", settings.junction, "list where lanes of this junction conflict, and who has priority")
      ->type_name("ID");
  program.add_option("--route", settings.route, "print the shortest route between two places, and its lanes")
      ->type_name("FROM TO")
      ->expected(2);
  program.add_option("--reachable", settings.reachable, "list the lanes that can be reached within a distance")
      ->type_name("FROM METRES")
      ->expected(2);
  auto* const poses =
      program.add_option("--poses", settings.poses, "read columns road,s,lane; compute the poses of these lanes");
  auto* const nearest =
      program.add_option("--nearest", settings.nearest, "read columns x,y; find the lanes that contain these points");
  auto* const out =
      program.add_option("--out", settings.out, "file that --poses or --nearest writes")->type_name("OUT.csv");
  poses->type_name("IN.csv")->needs(out)->excludes(nearest);
  nearest->type_name("IN.csv")->needs(out);
  program.add_flag("--surface", settings.in_space, "with --poses, add the points on the road's surface in space")
      ->needs(poses);
  program.add_option("--links", settings.links, "write which lanes meet at the ends of roads")->type_name("OUT.csv");
  auto const is_said = [](std::string const& word) { return std::string(word.empty() ? "needs a word, not ''" : ""); };
  for (auto* const option : program.get_options())
    if (option->get_expected_max() == 1) option->check(is_said, "");
  program.add_flag("--infer-links", settings.infer_links, "link lanes whose ends meet where the file lacks the link");
  program.add_flag("--strict", settings.strict, "exit code 1 if there is a warning, an error or a road left out");
}

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  CLI::App program("Reads a road map, summarises it, reports problems, draws it and answers queries.", "map");
  describe(program, settings);
  program.footer(
      "A place (FROM, TO) is road:lane:s, with s in m along the road, such as 12:-1:30.5. In a lane for both "
      "directions,\n"
      "12:-1:30.5:backward selects the one against the road. --route also takes x,y,heading and x,y.\n"
      "Columns of the written files, in m and rad:\n"
      "  --poses    road,s,lane,x,y,hdg,width,t,rx,ry,rhdg,rk: the lane's middle, the reference line (r...)\n"
      "             with --surface also sx,sy,sz: the lane's middle in space\n"
      "  --nearest  road,lane,s,t,distance,query: query is the number of the point, from 0; a point in no lane\n"
      "             has no row\n"
      "  --links    road,end,lane,next_road,next_contact,next_lane,via: as written in the file\n"
      "Exit code: 0 if the map could be built, even with warnings; 1 with --strict if there is a warning, an error or "
      "a\n"
      "road left out; 2 if there is no map, or another error.");
  return examples::run_program(program, argc, argv, [&] { return run(settings); });
}
