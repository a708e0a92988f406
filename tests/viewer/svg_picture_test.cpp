#include "cambium/viewer/svg_picture.hpp"

#include <string>

#include <doctest/doctest.h>

#include "browser.hpp"
#include "sample_recording.hpp"

using namespace cambium;
using support::count;
using support::has;

TEST_CASE("a map too long for the picture gets a close-up") {
  Recording recording = sample_recording();
  CHECK(count(svg_picture(recording), "<clipPath") == 1);
  recording.lanes[0].left.back().x() = recording.lanes[0].right.back().x() = 2000.0;
  CHECK(count(svg_picture(recording), "<clipPath") == 2);
}

TEST_CASE("labels are escaped, and left out when not wanted") {
  Recording recording = sample_recording();
  recording.lanes[0].label = "a<b>&c";
  CHECK(has(svg_picture(recording), "a&lt;b&gt;&amp;c"));
  CHECK(count(svg_picture(recording, {.labels = false}), "<text") == 0);
}

TEST_CASE("a picture of a frame that does not exist, or without width, is refused") {
  CHECK_THROWS_WITH_AS((void)svg_picture(sample_recording(), {.frame = 21}), doctest::Contains("no frame 21 in 21"),
                       Error);
  CHECK_THROWS_WITH_AS((void)svg_picture(sample_recording(), {.width = 0.0}), doctest::Contains("at least 100"), Error);
  browser::TemporaryFolder const folder;
  CHECK_THROWS_AS(write_svg_picture(folder.path() / "missing" / "map.svg", sample_recording()), Error);
}
