// The map's page as its reader handles it: with a pointer, two fingers, keys and words to look for.
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "cambium/core/write_file.hpp"
#include "cambium/viewer/map_picture.hpp"
#include "browser.hpp"
#include "../support/maps.hpp"
#include "../support/text.hpp"

using support::has;

namespace {

std::string const actions_of_all = R"js(
const place = (x, y) => {   // of the picture [m], as the browser shows it
  const p = new DOMPoint(x, y).matrixTransform(target.getScreenCTM().inverse());
  return p.x.toFixed(3) + ' ' + p.y.toFixed(3);
};
const scale = () => target.getScreenCTM().a;   // [px/m], as the browser shows it
const bar = () => {
  const [text, rule] = document.getElementById('scale').children, its = rule.getBoundingClientRect();
  const metres = parseFloat(text.textContent) * (text.textContent.endsWith('km') ? 1000 : 1);
  const seen = its.left >= 0 && its.right <= innerWidth && its.top >= 0 && its.bottom <= innerHeight && its.width > 20;
  return [metres, ((its.width / metres) / scale()).toFixed(3), seen];
};
const look = text => {
  document.getElementById('find').value = text;
  document.querySelector('form').requestSubmit();
  return document.getElementById('found').textContent;
};
const marked = () => [...new Set([...document.querySelectorAll('.found')].map(lane => lane.dataset.lane))].join(' ');
)js";

/// A map's page after its reader has done `script`, as markup; nothing without a browser.
std::string after(std::string const& script, std::string const& hash = {}, std::string const& flags = {}) {
  auto const chromium = browser::find();
  if (!chromium) return {};
  browser::TemporaryFolder const folder;
  auto const file = folder.path() / "map.html";
  auto const page = cambium::html_map_picture(*support::own_map("intersection_4way.xodr"), {.title = "a map"});
  cambium::write_file(file, browser::with_actions(page, "map", actions_of_all + script));
  auto const document = browser::document(*chromium, file, hash, 1000, flags);
  REQUIRE_FALSE(document.empty());
  CHECK(browser::attribute(document, "<body", "data-failure") == "");
  return document;
}

std::string said(std::string const& document, std::string const& name) {
  return browser::attribute(document, "<body", "data-" + name);
}

std::vector<double> numbers(std::string const& document, std::string const& name) {
  std::istringstream text(said(document, name));
  std::vector<double> list;
  for (double value = 0.0; text >> value;) list.push_back(value);
  return list;
}

void check_near(std::vector<double> const& one, std::vector<double> const& other, double tolerance) {
  REQUIRE(one.size() == other.size());
  REQUIRE_FALSE(one.empty());
  for (std::size_t i = 0; i < one.size(); ++i) CHECK(std::abs(one[i] - other[i]) < tolerance);
}

}  // namespace

TEST_CASE("a map's page fits a phone's screen, has a name, and needs nothing from outside") {
  auto const map = support::own_map("merging.xodr");
  auto const page = cambium::html_map_picture(*map);
  CHECK(page == cambium::html_map_picture(*map));
  CHECK(has(page, "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">"));
  CHECK(has(page, "<title>Map</title>"));
  for (char const* outside : {"src=", "<link", "@import", "url("}) CHECK_FALSE(has(page, outside));
}

TEST_CASE("a dragged map follows the pointer, and two fingers keep what they hold") {
  auto const page = after(R"js(
say('held', place(600, 400));
point('down', 1, 600, 400); point('move', 1, 640, 370); point('move', 1, 700, 350); point('up', 1, 700, 350);
say('dragged', place(700, 350));
point('move', 1, 300, 300);
say('left', place(700, 350));
say('before', scale(), place(550, 400), place(650, 400));
point('down', 1, 550, 400); point('down', 2, 650, 400);
point('move', 2, 700, 450); point('move', 1, 500, 350); point('move', 1, 520, 450); point('move', 2, 720, 450);
say('pinched', scale(), place(520, 450), place(720, 450));
point('up', 1, 520, 450);
say('one', place(720, 450));
point('move', 2, 700, 430); point('up', 2, 700, 430);
say('alone', place(700, 430));
)js");
  if (page.empty()) return;
  check_near(numbers(page, "held"), numbers(page, "dragged"), 0.01);
  check_near(numbers(page, "dragged"), numbers(page, "left"), 0.001);  // no button is down
  auto const before = numbers(page, "before"), pinched = numbers(page, "pinched");
  REQUIRE(before.size() == 5);
  REQUIRE(pinched.size() == 5);
  CHECK(pinched[0] / before[0] == doctest::Approx(2.0).epsilon(0.001));  // 200 px apart instead of 100
  // The middle of the fingers stays between them; a map does not turn, so that each keeps its place along x.
  CHECK(0.5 * (pinched[1] + pinched[3]) == doctest::Approx(0.5 * (before[1] + before[3])).epsilon(0.001));
  CHECK(0.5 * (pinched[2] + pinched[4]) == doctest::Approx(0.5 * (before[2] + before[4])).epsilon(0.001));
  CHECK(pinched[1] == doctest::Approx(before[1]).epsilon(0.001));
  check_near(numbers(page, "one"), numbers(page, "alone"), 0.01);
}

TEST_CASE("the wheel zooms about the pointer") {
  auto const page = after(R"js(
say('before', place(700, 300)); say('from', scale());
wheel(-400, 700, 300);
say('after', place(700, 300)); say('to', scale());
)js");
  if (page.empty()) return;
  check_near(numbers(page, "before"), numbers(page, "after"), 0.01);
  CHECK(numbers(page, "to").at(0) > 1.5 * numbers(page, "from").at(0));
}

TEST_CASE("the scale bar stays in view and tells the truth at each zoom") {
  auto const page = after(R"js(
const all = [bar()];
for (const turn of [-500, -500, -1500, -1500, 1500, 1500, 1500, 1500, 900]) { wheel(turn, 800, 300); all.push(bar()); }
for (const arrow of ['ArrowLeft', 'ArrowDown']) { key(arrow); all.push(bar()); }
say('metres', new Set(all.map(([metres]) => metres)).size);
say('ratios', all.map(([, ratio]) => ratio).join(' '));
say('unseen', all.filter(([, , seen]) => !seen).length);
)js");
  if (page.empty()) return;
  CHECK(numbers(page, "metres").at(0) > 4);
  auto const ratios = numbers(page, "ratios");
  CHECK(ratios.size() == 12);
  for (double const ratio : ratios) CHECK(ratio == doctest::Approx(1.0).epsilon(0.03));
  CHECK(said(page, "unseen") == "0");
}

TEST_CASE("keys pan, zoom, fit the map and open the search") {
  auto const page = after(R"js(
const at = () => [scale(), place(600, 400)].join(' ');
say('first', at());
for (const [name, its] of [['left', 'ArrowLeft'], ['right', 'ArrowRight'], ['up', 'ArrowUp'], ['down', 'ArrowDown'],
    ['in', '+'], ['out', '-'], ['fit', '0']]) { key(its); say(name, at()); }
key('ArrowLeft'); key('+'); key('0');
say('again', at());
key('/');
say('focus', document.activeElement.id);
key('+', document.activeElement); key('ArrowLeft', document.activeElement); key('0', document.activeElement);
say('typed', at());
key('Escape', document.activeElement);
say('focusafter', document.activeElement.id);
)js");
  if (page.empty()) return;
  auto const of = [&](char const* name) {
    auto list = numbers(page, name);
    list.resize(3);
    return list;
  };
  CHECK(of("left")[1] < of("first")[1] - 1.0);
  check_near(of("right"), of("first"), 0.01);
  CHECK(of("up")[2] < of("first")[2] - 1.0);
  check_near(of("down"), of("first"), 0.01);
  CHECK(of("in")[0] == doctest::Approx(1.25 * of("first")[0]));
  for (char const* name : {"out", "fit", "again", "typed"}) check_near(of(name), of("first"), 0.01);
  CHECK(said(page, "focus") == "find");
  CHECK(said(page, "focusafter") == "map");
}

TEST_CASE("the search zooms to a road, a lane or a junction, marks it, and says what it does not find") {
  auto const page = after(R"js(
const whole = scale();
const seen = () => [...document.querySelectorAll('.found')].every(lane => {
  const its = lane.getBoundingClientRect();
  return its.left >= 0 && its.right <= innerWidth && its.top >= 0 && its.bottom <= innerHeight;
});
const closer = () => scale() > whole;
say('lane', look(' 1:-1 '), '|', marked(), '|', seen(), closer());
look('122:-1');
const mine = document.querySelector('.areas [data-lane="122:-1"]');
say('above', [...document.querySelector('#map > .areas').children].every(lane => lane === mine ||
    lane.compareDocumentPosition(document.querySelector('.found')) & Node.DOCUMENT_POSITION_FOLLOWING));
say('road', look('road 1'), '|', seen(), closer(), marked().split(' ').every(lane => lane.startsWith('1:')));
const junction = document.querySelector('[data-junction]').dataset.junction;
say('junction', look('junction ' + junction), '|', seen(), closer(),
    document.querySelectorAll('.found').length === document.querySelectorAll('.areas [data-junction]').length);
say('none', look('no such road'), '|', marked());
say('empty', look(''), '|', marked());
)js");
  if (page.empty()) return;
  CHECK(said(page, "lane") == "lane 1:-1 | 1:-1 | true true");
  CHECK(said(page, "above") == "true");  // the lanes that cross it do not hide it
  CHECK(said(page, "road").find("road 1: ") == 0);
  CHECK(has(said(page, "road"), "| true true true"));
  CHECK(said(page, "junction").find("junction ") == 0);
  CHECK(has(said(page, "junction"), "| true true true"));
  CHECK(has(said(page, "none"), "no such road\u201d not found"));
  CHECK(said(page, "none").back() == ' ');
  CHECK(said(page, "empty") == " | ");
}

TEST_CASE("a window that changes its size keeps in view what was found, and the scale of a view that was chosen") {
  auto const page = after(R"js(
const sizes = [[1200, 600], [300, 600], [800, 400]];
const turn = ([width, height]) => {
  target.getBoundingClientRect = () => ({left: 0, top: 0, width, height});
  window.dispatchEvent(new Event('resize'));
  return target.viewBox.baseVal;
};
look('1');
const boxes = [...document.querySelectorAll('.found')].map(lane => lane.getBBox());
say('seen', sizes.map(size => {
  const v = turn(size);
  return boxes.every(b => b.x > v.x && b.y > v.y && b.x + b.width < v.x + v.width && b.y + b.height < v.y + v.height);
}).join(' '));
key('+');
say('scales', sizes.map(size => (size[0] / turn(size).width).toFixed(3)).join(' '));
)js");
  if (page.empty()) return;
  CHECK(said(page, "seen") == "true true true");
  auto const scales = numbers(page, "scales");
  REQUIRE(scales.size() == 3);
  check_near(scales, {scales[0], scales[0], scales[0]}, 0.002);
}

TEST_CASE("an address looks for an id, and where two things have it, the page names both") {
  auto const page = after(R"js(
say('hash', document.getElementById('found').textContent, '|', document.querySelectorAll('.found').length > 5);
for (const lane of document.querySelectorAll('[data-junction]')) lane.dataset.junction = '2';
say('both', look('2'));
say('words', look('<b>x</b>'), document.querySelectorAll('#found b').length);
)js",
                          "find=junction%20100");
  if (page.empty()) return;
  CHECK(said(page, "hash").find("junction 100: ") == 0);
  CHECK(has(said(page, "hash"), "| true"));
  CHECK(said(page, "both").find("road 2: ") == 0);
  CHECK(has(said(page, "both"), "\nthere is a junction 2, too"));
  CHECK(said(page, "words").back() == '0');
}

TEST_CASE("a tap says what lies there") {
  auto const page = after(R"js(
look('1:-1');
const [x, y] = [innerWidth / 2 + document.querySelector('nav').getBoundingClientRect().right / 2, innerHeight / 2];
point('down', 1, x, y); point('up', 1, x, y);
say('tapped', document.getElementById('found').textContent);
point('down', 1, x, y); point('move', 1, x + 50, y); point('up', 1, x + 50, y);
say('dragged', document.getElementById('found').textContent);
)js");
  if (page.empty()) return;
  CHECK(said(page, "tapped").find("road 1, section 0, lane -1 (driving)") == 0);
  CHECK(said(page, "dragged") == said(page, "tapped"));
}

TEST_CASE("an address opens a map's page at its place") {
  auto const page = after("say('at', place(600, 400), scale() * 60 / innerWidth);", "at=12,-7.5,60");
  if (page.empty()) return;
  auto const map = support::own_map("intersection_4way.xodr");
  auto const box = map->bounds().grown(5.0);
  auto const at = numbers(page, "at");
  REQUIRE(at.size() == 3);
  CHECK(at[0] + box.min_x == doctest::Approx(12.0).epsilon(0.01));
  CHECK(at[2] == doctest::Approx(1.0).epsilon(0.001));
}

TEST_CASE("a map's page is dark where its reader prefers that, and readable in both") {
  std::string const script = R"js(
const light = colour => { const [r, g, b] = colour.match(/[\d.]+/g).map(Number); return .3 * r + .59 * g + .11 * b; };
const style = (selector, name) => light(getComputedStyle(document.querySelector(selector))[name]);
say('ground', style('.ground', 'fill')); say('lane', style('#map .driving', 'fill'));
say('label', style('#map .labels text', 'fill')); say('panel', style('nav', 'backgroundColor'));
say('text', style('nav b', 'color')); say('legend', style('.legend text', 'fill'));
)js";
  auto const day = after(script), night = after(script, "", browser::dark);
  if (day.empty()) return;
  auto const value = [](std::string const& page, char const* name) { return numbers(page, name).at(0); };
  for (char const* area : {"ground", "panel"}) {
    CAPTURE(area);
    CHECK(value(day, area) > 200.0);
    CHECK(value(night, area) < 60.0);
  }
  CHECK(value(night, "lane") > value(night, "ground") + 30.0);
  CHECK(value(day, "lane") < value(day, "ground") - 30.0);
  for (auto const* page : {&day, &night}) {
    CHECK(std::abs(value(*page, "text") - value(*page, "panel")) > 150.0);
    CHECK(std::abs(value(*page, "legend") - value(*page, "panel")) > 150.0);
    CHECK(std::abs(value(*page, "label") - value(*page, "lane")) > 100.0);
  }
}

TEST_CASE("on a phone the panel leaves room for the map") {
  auto const page = after(R"js(
const panel = document.querySelector('nav').getBoundingClientRect();
say('width', innerWidth); say('panel', panel.right <= innerWidth, panel.bottom < innerHeight / 2);
say('sideways', document.documentElement.scrollWidth <= innerWidth);
say('bar', bar().slice(1).join(' '));
)js",
                          "", "--window-size=500,844");
  if (page.empty()) return;
  CHECK(numbers(page, "width").at(0) <= 500);
  CHECK(said(page, "panel") == "true true");
  CHECK(said(page, "sideways") == "true");
  CHECK(said(page, "bar") == "1.000 true");
}
