// The map example as a user meets it.
#include <doctest/doctest.h>

#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include "../support/corpus.hpp"
#include "../viewer/browser.hpp"
#include "program.hpp"

using namespace program;

namespace {

std::string const merging = CAMBIUM_SOURCE_DIR "/maps/merging.xodr";

/// A road of one lane as the text of an OpenDRIVE file.
std::string road(std::string const& id, std::string const& length, std::string const& lane_type) {
  return R"(<OpenDRIVE><road id=")" + id + R"(" length=")" + length +
         R"("><planView><geometry s="0" x="0" y="0" hdg="0" length=")" + length +
         R"("><line/></geometry></planView><lanes><laneSection s="0"><center><lane id="0"/></center><right>)" +
         R"(<lane id="-1" type=")" + lane_type + R"("><width sOffset="0" a="3" b="0" c="0" d="0"/></lane></right>)" +
         "</laneSection></lanes></road></OpenDRIVE>";
}

}  // namespace

TEST_CASE("the map example says what a map contains and draws it") {
  Program const map("map");
  browser::TemporaryFolder const folder;
  for (char const* name : {"map.svg", "map.html", "sketch.svg"}) {
    auto const picture = folder.path() / name;
    auto const said =
        map.output({merging, std::string(name) == "sketch.svg" ? "--sketch" : "--picture", picture.string()});
    for (char const* part : {"5, 8 lane sections", "1 default; 2 connections", "12 driving", "1 merges", "none"})
      CHECK(has(said, part));
    auto const text = content_of(picture);
    for (char const* part : {"<svg", "</svg>", "11:-1", "<title>merging.xodr</title>"}) CHECK(has(text, part));
    CHECK_FALSE(has(text, merging));  // a page that is passed on tells nobody's folders
  }
}

TEST_CASE("the map example reads Lanelet2 and CommonRoad files, draws them, and is strict about what is odd in them") {
  Program const map("map");
  browser::TemporaryFolder const folder;
  std::string const seeds = CAMBIUM_SOURCE_DIR "/tests/fuzz/lanelet_seeds/everything";
  struct Row {
    char const *kind, *words, *finding;
    bool is_odd;
  };
  for (auto const& row : {Row{".osm", "Lanelet2, 6 lanelets", "no lanelet refers to the rule 404", true},
                          Row{".xml", "CommonRoad \"ZAM_Everything-1_1_T-1\", 6 lanelets", "obstacle 84", false}}) {
    auto const picture = folder.file("map.svg");
    auto const said = map.output({seeds + row.kind, "--picture", picture});
    CHECK(has(said, row.words));
    CHECK(has(said, row.finding));
    CHECK(has(content_of(picture), "</svg>"));
    CHECK(map.run({seeds + row.kind, "--strict"}).code == (row.is_odd ? 1 : 0));
  }
  auto const nothing = map.run({folder.file("nothing.osm")});
  CHECK(nothing.code != 0);
  CHECK(has(nothing.err, "nothing.osm"));
}

TEST_CASE("a Lanelet2 map lies where its origin says") {
  Program const map("map");
  browser::TemporaryFolder const folder;
  auto const file = folder.file("a.osm");
  std::ofstream(file) << R"(<osm version="0.6"><node id="1" lat="49.00003" lon="8.4"/><node id="2" lat="49.00003" )"
                         R"(lon="8.401"/><node id="3" lat="49" lon="8.4"/><node id="4" lat="49" lon="8.401"/>)"
                         R"(<way id="5"><nd ref="1"/><nd ref="2"/></way><way id="6"><nd ref="3"/><nd ref="4"/></way>)"
                         R"(<relation id="7"><member type="way" ref="5" role="left"/><member type="way" ref="6" )"
                         R"(role="right"/><tag k="type" v="lanelet"/><tag k="subtype" v="road"/></relation></osm>)";
  auto const said = map.output({file, "--origin", "49.0,8.4"});
  CHECK_MESSAGE(has(said, "x from 0 to 73."), said);
  CHECK_MESSAGE(has(map.output({file}), "x from -36."), said);
  CHECK(has(map.run({file, "--origin", "95,8.4"}).err, "latitude"));
  CHECK(has(map.run({merging, "--origin", "49,8.4"}).err, "--origin: only Lanelet2 maps have an origin"));
}

TEST_CASE("poses, nearest lanes and links of real maps are those of the oracle") {
  Program const map("map");
  auto const folder = corpus::find("opendrive");
  if (!folder) return;
  browser::TemporaryFolder const out;
  for (char const* stem : {"fabriksgatan", "ParametricCubicCurveComplexRoad", "soderleden"}) {
    CAPTURE(stem);
    auto const file = (*folder / stem).string() + ".xodr";
    auto const oracle = *folder / "oracle" / (std::string(stem) + ".csv");
    REQUIRE(
        map.run({file, "--poses", oracle.string(), "--out", out.file("poses"), "--links", out.file("links")}).code ==
        0);
    REQUIRE(map.run({file, "--nearest", oracle.string(), "--out", out.file("nearest")}).code == 0);
    CHECK(has(content_of(out.file("poses")), "road,s,lane,x,y,hdg,width,t,rx,ry,rhdg,rk\n"));
    CHECK(has(content_of(out.file("nearest")), "road,lane,s,t,distance,query\n"));
    auto const expected = corpus::table(oracle), poses = corpus::table(out.file("poses"));
    REQUIRE(poses.size() == expected.size());
    for (std::size_t i = 0; i < poses.size(); ++i)
      for (auto const& [ours, theirs] : {std::pair{3, 5}, {4, 6}, {6, 8}, {7, 9}, {8, 14}, {9, 15}, {11, 17}})
        CHECK(std::abs(std::stod(poses[i][static_cast<std::size_t>(ours)]) -
                       std::stod(expected[i][static_cast<std::size_t>(theirs)])) < 1e-6);
    auto const nearest = corpus::table(out.file("nearest"));
    std::size_t found = 0, row = 0;
    for (std::size_t i = 0; i < expected.size(); ++i) {
      while (row < nearest.size() && std::stoul(nearest[row][5]) < i) ++row;
      if (expected[i][23] != "1" || std::stod(expected[i][8]) <= 0.5) continue;
      REQUIRE(row < nearest.size());
      CHECK(nearest[row][0] == expected[i][0]);
      CHECK(nearest[row][1] == expected[i][2]);
      CHECK(std::abs(std::stod(nearest[row][2]) - std::stod(expected[i][1])) < 1e-6);
      ++found;
    }
    CHECK(found > 40);
    std::size_t rows = 0;
    for (auto const& link : corpus::table(*folder / "oracle" / (std::string(stem) + ".links.csv")))
      rows += link.size() > 1;
    CHECK(corpus::table(out.file("links")).size() == rows);
  }
}

TEST_CASE("ids with commas and quotes are written in quotes and read again; the summary has no odd numbers") {
  Program const map("map");
  browser::TemporaryFolder const folder;
  auto const file = folder.file("m.xodr"), in = folder.file("in.csv"), out = folder.file("out.csv");
  std::ofstream(file) << road("a,&quot;b", "9", "driving");
  std::ofstream(in) << "\xEF\xBB\xBFroad,s,lane\r\n\"a,\"\"b\", 5 ,\"-1\"\r\n";
  CHECK(map.run({file, "--poses", in, "--out", out}).code == 0);
  CHECK(has(content_of(out), "\n\"a,\"\"b\",5,-1,5,-1.5,"));
  std::ofstream(in) << "5,-1\n";
  CHECK(map.run({file, "--nearest", in, "--out", out}).code == 0);
  CHECK(has(content_of(out), "\n\"a,\"\"b\",-1,5,"));
  std::ofstream(file) << road("a,&quot;b", "9", "sidewalk");
  auto const run = map.run({file});
  CHECK(run.code == 0);
  CHECK_FALSE(has(run.out, "inf"));
  CHECK(has(run.out, "no lane\n"));
  CHECK(has(run.out, "revision not written"));
}

TEST_CASE("a route is printed lane by lane, and where there is none it is an error") {
  Program const map("map");
  auto const run = map.run({merging, "--route", "2:-1:5", "3:-1:300"});
  CHECK(run.code == 0);
  CHECK(has(run.out, "route of 6 lanes, "));
  CHECK(has(run.out, "  road 11, section 0, lane -1: 49.82 m, 3.5 m wide, 80 km/h\n"));
  CHECK(has(run.out, "lane -3: 60.15 m, 3.5 to 0 m wide, 100 km/h, 3 of 3 from the left\n"));
  CHECK(has(run.out,
            "corridor of 10 lanes; those in line with the destination are 649.61 m long, where the road ends\n"));
  auto const by_pose = map.run({merging, "--route", "10,-1.75,0", "744,82.5"});
  CHECK(by_pose.code == 0);
  CHECK(has(by_pose.out, "route of 6 lanes\n  road 1, section 0, lane -1: 240.27 m"));
  map.refuses({merging, "--route", "3:-1:300", "2:-1:5"}, "there is no way from 3:-1:300 to 2:-1:5");
}

TEST_CASE("the list of reachable lanes begins with the nearest lane") {
  Program const map("map");
  auto const run = map.run({merging, "--reachable", "2:-1:5", "200"});
  CHECK(run.code == 0);
  CHECK(has(run.out, "2 lanes can be reached within 200 m\n  road 2, section 0, lane -1: 0 m\n  road 11, "));
}

TEST_CASE("findings about the network and conflicts of a junction are listed") {
  Program const map("map");
  auto const network = map.run({merging, "--network"});
  CHECK(has(network.out, "network        2 dead end, 3 no way in\n"));
  CHECK(has(network.out, "  dead end: road 3, section 2, lane -1\n"));
  auto const junction = map.run({CAMBIUM_SOURCE_DIR "/maps/intersection_4way.xodr", "--junction", "100"});
  CHECK(junction.code == 0);
  CHECK(has(junction.out, "52 of them in junctions, where priorities rule 0\n"));
  CHECK(has(junction.out, "junction 100: 12 roads, "));
  std::size_t lines = 0;
  for (char const* kind : {"\n  crossing: road ", "\n  merge: road ", "\n  split: road "})
    lines += count(junction.out, kind);
  CHECK(lines == 52);
}

TEST_CASE("the other direction of a lane for both is named with its direction") {
  Program const map("map");
  browser::TemporaryFolder const folder;
  auto const file = folder.file("m.xodr");
  std::ofstream(file) << road("a:1", "90", "bidirectional");
  auto const back = map.run({file, "--route", "a:1:-1:50:backward", "a:1:-1:20:backward"});
  CHECK(back.code == 0);
  CHECK(has(back.out, "route of 1 lanes, 30 m\n  road a:1, section 0, lane -1, backward: 90 m"));
  CHECK(map.run({file, "--route", "a:1:-1:20", "a:1:-1:50:forward"}).code == 0);
  CHECK(map.run({file, "--route", "a:1:-1:50", "a:1:-1:20"}).code == 2);
}

TEST_CASE("the table of a centre line is a map too, and poses come on the road's surface") {
  Program const map("map");
  browser::TemporaryFolder const folder;
  auto const line = folder.file("line.csv"), in = folder.file("in.csv"), out = folder.file("out.csv");
  std::ofstream(line) << "x,y\n0,0\n40,0\n80,0\n";
  std::ofstream(in) << "1,30,-1\n";
  auto const run = map.run({line, "--poses", in, "--out", out, "--surface"});
  CHECK(run.code == 0);
  CHECK(has(run.out, "1 driving"));
  auto const rows = corpus::table(out);
  REQUIRE(rows.size() == 1);
  REQUIRE(rows[0].size() == 15);
  CHECK(std::stod(rows[0][12]) == doctest::Approx(30));
  CHECK(std::stod(rows[0][14]) == 0.0);
}

TEST_CASE("an error is one line, with exit code 2 and nothing written") {
  Program const map("map");
  browser::TemporaryFolder const folder;
  auto const table = folder.file("in.csv"), out = folder.file("out.csv");
  auto const xodr = folder.file("in.xodr");
  auto const write = [&](std::string const& text) {
    for (auto const& file : {table, xodr}) std::ofstream(file) << text;
  };
  struct Wrong {
    std::string text;
    std::vector<std::string> words;
    char const* sentence;
  };
  for (auto const& wrong : std::vector<Wrong>{
           {"", {}, "FILE is required"},
           {"", {"nosuch.xodr"}, "nosuch.xodr: the file cannot be opened"},
           {"<a>", {xodr}, "in.xodr:1: the file is not well-formed XML"},
           {"<a/>", {xodr}, "not <OpenDRIVE>"},
           {"<a/>", {table}, "in.csv:1: there are no columns x and y"},
           {"", {merging, "--picture", out}, "an .svg or an .html"},
           {"", {merging, "--poses", table}, "--poses requires --out"},
           {"", {merging, "--poses", table, "--out", out}, "in.csv: it has no row"},
           {"road,s,lane\n1,5,-1\n1,5,-9\n",
            {merging, "--poses", table, "--out", out},
            "in.csv:3: road 1 has no lane -9"},
           {"1,five,-1\n", {merging, "--poses", table, "--out", out}, "in.csv:1: s is 'five'"},
           {"1,nan,-1\n", {merging, "--poses", table, "--out", out}, "in.csv:1: s is 'nan'"},
           {"77,5,-1\n", {merging, "--poses", table, "--out", out}, "in.csv:1: the map has no road 77"},
           {"Weg,Ort,Spur\n1,5,-1\n",
            {merging, "--poses", table, "--out", out},
            "in.csv:1: the first line names none of road,s,lane"},
           {"\"1,5,-1\n", {merging, "--poses", table, "--out", out}, "in.csv:1: a quote in it is not"},
           {"1,5,-1\n", {merging, "--poses", table, "--out", table}, "it is read, or written twice"},
           {"1,5,-1\n", {merging, "--poses", table, "--out", out, "--links", out}, "it is read, or written twice"},
           {"", {merging, "--out", out}, "--out: there is nothing to write"},
           {"", {merging, "--sketch", out}, "name a file that ends in .svg"},
           {"x,y\n1\n", {merging, "--nearest", table, "--out", out}, "in.csv:2: there is no y in it"},
           {"", {merging, "--route", "1:-1", "2:-1:5"}, "'1:-1' is no place"},
           {"", {merging, "--route", "1:-1:5", "9:-1:5"}, "road 9: the map has no such road"},
           {"", {merging, "--junction", "7"}, "--junction 7: the map has no such junction; it has 100"},
           {"", {merging, "--junction", ""}, "--junction: needs a word"},
           {"", {merging, "--route", "1:-1:5", "1:-1:999"}, "give a place from s 0 to 300 m"},
           {"", {merging, "--route", "1:-1:5:backward", "1:-1:9"}, "it is driven the other way only"},
           {"", {merging, "--route", "10,-1.75,0", "0,500"}, "no drivable lane near its goal (0, 500)"},
           {"", {merging, "--reachable", "1:-1:5", "nan"}, "'nan' is no distance"},
           {"", {merging, "--part", "0", "0", "1", "1"}, "--part requires --picture"},
           {"",
            {merging, "--picture", folder.file("a.svg"), "--part", "1", "0", "0", "1"},
            "the part to show has no area"},
           {"x,y\n1,2\n", {table, "--links", table}, "it is read, or written twice"},
           {"", {table}, "in.csv: it is empty; give a table"},
           {"", {folder.path().string()}, ": it is a folder; give an OpenDRIVE file"},
           {"", {merging, "--links", "/nosuch/folder/links.csv"}, "cannot be written"}}) {
    write(wrong.text);
    map.refuses(wrong.words, wrong.sentence);
    CHECK_FALSE(fs::exists(out));
  }
}

TEST_CASE("map: no message names a function of the library") {
  auto const run = Program("map").run({merging, "--route", "99:-1:3", "1:-1:3"});
  CHECK(run.code == 2);
  CHECK(has(run.err, "99"));
  CHECK_FALSE(has(run.err, "Map::"));
  CHECK(has(run.err, "--picture"));
}

TEST_CASE("map --strict: exit code 1 where something is odd about the map or a road is left out, 0 where nothing is") {
  Program const map("map");
  browser::TemporaryFolder const folder;
  CHECK(map.run({merging, "--strict"}).code == 0);
  for (auto const& [element, attribute] : {std::pair{"<width ", " a=\""}, {"<geometry ", " length=\""}}) {
    CAPTURE(element);
    bool const is_width = std::string(element) == "<width ";
    auto text = content_of(merging);
    // All widths, or the length of the first road.
    for (auto at = text.find(element); at != std::string::npos;
         at = is_width ? text.find(element, at + 1) : text.npos) {
      auto const value = text.find(attribute, at) + std::string(attribute).size();
      text.replace(value, text.find('"', value) - value, "nan");
    }
    auto const file = folder.file("nan.xodr");
    std::ofstream(file) << text;
    auto const run = map.run({file, "--strict"});
    CAPTURE(run.out);
    CAPTURE(run.err);
    CHECK(run.code == 1);
    CHECK(map.run({file}).code == 0);
    if (is_width) CHECK(has(run.out, "to drive on    no lane"));  // not the lanes' length
  }
}

TEST_CASE("a checkout that belongs to another user is one sentence") {
  browser::TemporaryFolder const folder;
  auto const root = folder.path() / "checkout";
  fs::create_directories(root / "tests");
  fs::create_directories(root / "build");
  fs::copy(CAMBIUM_SOURCE_DIR "/tests/setup.sh", root / "tests");
  fs::permissions(folder.path(), fs::perms(0755));
  fs::permissions(root / "build", fs::perms(0555));
  auto const err = folder.path() / "err";
  std::string const as = std::system("test $(id -u) = 0") == 0 ? "setpriv --reuid=65534 --clear-groups " : "";
  if (!as.empty() && std::system((as + "true 2>/dev/null").c_str()) != 0) {
    return support::skip(
        "the superuser may write everywhere, and there is no setpriv (of util-linux) to be another user");
  }
  auto const script = "source " + browser::quoted((root / "tests/setup.sh").string()) + "; configure EXAMPLES";
  CHECK(std::system((as + "bash -c " + browser::quoted(script) + " 2>" + browser::quoted(err.string())).c_str()) != 0);
  auto const said = content_of(err);
  CAPTURE(said);
  CHECK(has(said, "cannot be written to by"));
  CHECK(said.find('\n') + 1 == said.size());
}
