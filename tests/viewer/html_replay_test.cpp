#include "cambium/viewer/html_replay.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "cambium/core/write_file.hpp"
#include "browser.hpp"
#include "../support/text.hpp"
#include "sample_recording.hpp"

using namespace cambium;
using support::count;
using support::has;

namespace {

std::string data_of(std::string const& page) {
  std::string const start = "id=\"recording\">\n";
  std::size_t const at = page.find(start) + start.size();
  return page.substr(at, page.find("\n</script>", at) - at);
}

// Brackets outside strings close in order, and every string ends.
bool is_balanced(std::string const& json) {
  std::string open;
  bool in_string = false;
  for (std::size_t i = 0; i < json.size(); ++i) {
    char const c = json[i];
    if (in_string && c == '\\')
      ++i;
    else if (c == '"')
      in_string = !in_string;
    else if (in_string)
      continue;
    else if (c == '{' || c == '[')
      open += c == '{' ? '}' : ']';
    else if (c == '}' || c == ']') {
      if (open.empty() || open.back() != c) return false;
      open.pop_back();
    }
  }
  return open.empty() && !in_string;
}

}  // namespace

TEST_CASE("the same recording gives the same page, and it needs nothing from outside") {
  std::string const page = html_replay(sample_recording());
  CHECK(page == html_replay(sample_recording()));
  for (char const* outside : {"http://", "https://", "src=", "<link", "@import", "url("}) {
    CAPTURE(outside);
    CHECK_FALSE(has(page, outside));
  }
}

TEST_CASE("the page's data is balanced JSON with rounded numbers and one entry for each frame") {
  Recording recording = sample_recording();
  recording.frames[1].poses[0].x = 12.0 + 1.0 / 3.0;
  recording.frames[1].poses[1].present = false;
  recording.frames[2].poses[1].x = std::nan("");
  std::string const data = data_of(html_replay(recording));
  CHECK(is_balanced(data));
  CHECK(has(data, "[[12.33,0,0,10,0],0],\n[[14,0,0,10,0],0],\n[[16,0,0,10,0],[30,3.5,0,0,0]]"));
  CHECK(count(data, "[30,3.5,0,0,0]]") == 19);
  CHECK_FALSE(has(data, "nan"));
}

TEST_CASE("text of a recording cannot become markup or script") {
  std::string const attack = "</script><script>alert(1)</script><!-- & \" ' \\ \x01 \xFF";
  Recording recording = sample_recording();
  recording.title = attack;
  recording.notes = {attack};
  recording.lanes[0].label = attack;
  recording.agents[0].label = attack;
  std::string const page = html_replay(recording), data = data_of(page);
  CHECK_FALSE(has(page, "<script>alert"));
  CHECK_FALSE(has(page, "<!--"));
  CHECK(count(page, "</script") == count(html_replay(sample_recording()), "</script"));
  CHECK_FALSE(has(page, "\xFF"));
  CHECK(has(page, "&lt;/script&gt;"));
  CHECK(is_balanced(data));
  CHECK(has(data, "\\u003c/script\\u003e"));
}

TEST_CASE("a map in national coordinates is written near its own origin") {
  Recording recording = sample_recording();
  for (RecordedFrame& frame : recording.frames)
    for (RecordedPose& pose : frame.poses) pose.x += 691000.0, pose.y += 5335000.0;
  for (RecordedLane& lane : recording.lanes)
    for (auto* border : {&lane.left, &lane.right})
      for (geometry::Point& p : *border) p += geometry::Point(691000.0, 5335000.0);
  std::string const page = html_replay(recording);
  CHECK(has(page, "\"origin\":[691000,5335000]"));
  std::string const data = data_of(page), near = data_of(html_replay(sample_recording()));
  CHECK(data.substr(data.find("\"lanes\"")) == near.substr(near.find("\"lanes\"")));
}

TEST_CASE("a recording that contradicts itself is refused with its frame") {
  Recording recording = sample_recording();
  recording.frames[3].poses.pop_back();
  CHECK_THROWS_WITH_AS((void)html_replay(recording), doctest::Contains("frame 3: has 1 poses for 2 agents"), Error);
  recording = sample_recording();
  recording.frames[4].time = recording.frames[3].time;
  CHECK_THROWS_WITH_AS((void)html_replay(recording), doctest::Contains("frame 4: its time"), Error);
}

TEST_CASE("a page that cannot be written is an error that names the file, and leaves nothing behind") {
  browser::TemporaryFolder const folder;
  std::filesystem::path const missing = folder.path() / "missing" / "replay.html", taken = folder.path() / "taken";
  std::filesystem::create_directory(taken);
  CHECK_THROWS_WITH_AS(write_html_replay(missing, sample_recording()), doctest::Contains(missing.c_str()), Error);
  CHECK_THROWS_WITH_AS(write_html_replay(taken, sample_recording()), doctest::Contains(taken.c_str()), Error);
  CHECK(std::distance(std::filesystem::directory_iterator(folder.path()), {}) == 1);
}

TEST_CASE("writing replaces an older page as a whole") {
  browser::TemporaryFolder const folder;
  std::filesystem::path const file = folder.path() / "replay.html";
  std::ofstream(file) << "old";
  write_html_replay(file, sample_recording());
  CHECK(support::content_of(file) == html_replay(sample_recording()));
  CHECK(std::distance(std::filesystem::directory_iterator(folder.path()), {}) == 1);
}

TEST_CASE("a browser draws the page, plays it, and shows each vehicle where it is") {
  auto const chromium = browser::find();
  if (!chromium) return;
  browser::TemporaryFolder const folder;
  std::filesystem::path const file = folder.path() / "a replay #1.html";
  write_html_replay(file, sample_recording());
  std::string const first = browser::document(*chromium, file, "probe=12,0;30,3.5;100,0;62,0");
  std::string const last = browser::document(*chromium, file, "frame=20&probe=12,0;30,3.5;100,0;62,0");

  REQUIRE(browser::attribute(first, "<body", "data-ready") == "21");
  CHECK(has(first, "<title>a short drive</title>"));
  CHECK(has(first, "<li>mean speed 10 m/s</li>"));
  CHECK(browser::attribute(first, "<input id=\"slider\"", "max") == "20");
  CHECK(browser::attribute(first, "<body", "data-frame") == "0");
  CHECK(browser::attribute(last, "<body", "data-frame") == "20");

  auto const at_first = support::split(browser::attribute(first, "<body", "data-pixel"), ';'),
             at_last = support::split(browser::attribute(last, "<body", "data-pixel"), ';');
  REQUIRE(at_first.size() == 4);
  REQUIRE(at_last.size() == 4);
  std::string const ego = at_first[0], obstacle = at_first[1], asphalt = at_first[2];
  CHECK(ego != asphalt);
  CHECK(obstacle != asphalt);
  CHECK(obstacle != ego);
  CHECK(at_first[3] == asphalt);
  CHECK(at_last == std::vector<std::string>{at_last[0], obstacle, asphalt, ego});
  CHECK(at_last[0] != ego);  // only its trail is left there
}

TEST_CASE("traffic lights are kept where they change, and shown as they are") {
  Recording recording = sample_recording();
  recording.stop_lines = {{{100.0, 1.75}, {100.0, -1.75}, LightId{1}}, {{50.0, 1.75}, {50.0, -1.75}}};
  using map::LightColor;
  for (std::size_t k = 0; k < recording.frames.size(); ++k)
    recording.frames[k].lights = {LightColor::off, k < 10 ? LightColor::green : LightColor::red};
  std::string const data = data_of(html_replay(recording));
  CHECK(is_balanced(data));
  CHECK(has(data, "\"stops\":[[[100,1.75,100,-1.75],1],\n[[50,1.75,50,-1.75],-1]]"));
  CHECK(has(data, "\"lights\":[[0,\"01\"],\n[10,\"03\"]]"));
  auto const chromium = browser::find();
  if (!chromium) return;
  browser::TemporaryFolder const folder;
  write_html_replay(folder.path() / "lights.html", recording);
  auto const seen = [&](char const* frame) {
    auto list = browser::pixels(*chromium, folder.path() / "lights.html",
                                std::string("follow=0&frame=") + frame + "&probe=100,0;101.2,0;50,0;51.2,0;80,0");
    list.resize(5);
    return list;
  };
  auto const before = seen("9"), after = seen("10");
  std::string const asphalt = before[4];
  CHECK(before[0] == "255,255,255");
  CHECK(before[1] == "47,208,95");  // green
  CHECK(after[1] == "255,59,48");   // red
  CHECK(before[2] == "255,255,255");
  CHECK(before[3] == asphalt);  // a sign has no lamp
}

TEST_CASE("the replay runs by itself and stops at its end") {
  auto const chromium = browser::find();
  if (!chromium) return;
  browser::TemporaryFolder const folder;
  write_html_replay(folder.path() / "replay.html", sample_recording());
  std::string const page = browser::document(*chromium, folder.path() / "replay.html", "play", 2000);
  int const frame = std::stoi("0" + browser::attribute(page, "<body", "data-frame"));
  CHECK(frame > 2);
  CHECK(frame < 20);
  CHECK(browser::attribute(page, "<button id=\"play\"", "aria-label") == "Pause");
  std::string const end = browser::document(*chromium, folder.path() / "replay.html", "play", 20000);
  CHECK(browser::attribute(end, "<body", "data-frame") == "20");
  CHECK(browser::attribute(end, "<button id=\"play\"", "aria-label") == "Play");
}

TEST_CASE("two fingers zoom a replay and hold what lies between them, and its scale bar tells the truth") {
  auto const chromium = browser::find();
  if (!chromium) return;
  browser::TemporaryFolder const folder;
  write_file(folder.path() / "replay.html", browser::with_actions(html_replay(sample_recording()), "view", R"js(
const context = target.getContext('2d'), [text, rule] = document.getElementById('scale').children;
// Middle and width [px] of what has the obstacle's colour; it is 2 m wide.
const obstacle = () => {
  const {data, width} = context.getImageData(0, 0, target.width, target.height), xs = [], ys = [];
  for (let i = 0; i < data.length; i += 4)
    if (data[i] === 0xb7 && data[i + 1] === 0x9b && data[i + 2] === 0xff)
      xs.push(i / 4 % width), ys.push(i / 4 / width | 0);
  const middle = list => (Math.max(...list) + Math.min(...list)) / 2;
  return [middle(xs), middle(ys), Math.max(...xs) - Math.min(...xs) + 1];
};
const look = name => say(name, ...obstacle(), parseFloat(rule.style.width) / parseFloat(text.textContent));
const later = action => setTimeout(() => {
  try { action(); } catch (error) { say('failure', error.message); }
}, 300);
later(() => {
  look('first');
  const [x, y] = obstacle();
  point('down', 1, x - 50, y + 100); point('down', 2, x + 50, y + 100);
  for (const [dx, dy] of [[10, 5], [40, 30]])
    point('move', 1, x - 50 + dx, y + 100 + dy), point('move', 2, x + 50 + dx, y + 100 + dy);
  later(() => {
    look('dragged');
    point('move', 1, x - 160, y + 130); point('move', 2, x + 240, y + 130);
    later(() => look('pinched'));
  });
});
)js"));
  auto const page = browser::document(*chromium, folder.path() / "replay.html", "follow=0&fit", 2000);
  CHECK(browser::attribute(page, "<body", "data-failure") == "");
  auto const of = [&](char const* name) {
    std::istringstream text(browser::attribute(page, "<body", std::string("data-") + name));
    std::vector<double> list(4);
    for (double& value : list) text >> value;
    return list;
  };
  auto const first = of("first"), dragged = of("dragged"), pinched = of("pinched");
  CHECK(dragged[0] - first[0] == doctest::Approx(40.0).epsilon(0.05));
  CHECK(dragged[1] - first[1] == doctest::Approx(30.0).epsilon(0.05));
  CHECK(pinched[3] / dragged[3] == doctest::Approx(4.0).epsilon(0.01));  // 400 px apart instead of 100
  CHECK(pinched[2] == doctest::Approx(2.0 * pinched[3]).epsilon(0.2));   // its outline covers a part
}

TEST_CASE("a replay fits a phone's screen, and is dark where its reader prefers that") {
  CHECK(
      has(html_replay(sample_recording()), "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">"));
  auto const chromium = browser::find();
  if (!chromium) return;
  browser::TemporaryFolder const folder;
  write_html_replay(folder.path() / "replay.html", sample_recording());
  auto const asphalt = [&](std::string const& flags) {
    auto const colours = browser::pixels(*chromium, folder.path() / "replay.html", "probe=100,0", flags);
    REQUIRE(colours.size() == 1);
    return std::stoi("0" + colours[0]);
  };
  CHECK(asphalt("") > 90);
  CHECK(asphalt(browser::dark) < 70);
  CHECK(asphalt("--window-size=500,844") > 90);
}

TEST_CASE("an empty recording is a page that says so") {
  std::string const text = html_replay(Recording{});
  CHECK(is_balanced(data_of(text)));
  auto const chromium = browser::find();
  if (!chromium) return;
  browser::TemporaryFolder const folder;
  write_html_replay(folder.path() / "empty.html", Recording{});
  std::string const page = browser::document(*chromium, folder.path() / "empty.html");
  CHECK(browser::attribute(page, "<body", "data-ready") == "0");
  CHECK(has(page, ">This recording has no frames.</p>"));
}
