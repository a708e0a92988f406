#include "cambium/viewer/svg_picture.hpp"

#include <string>

#include <doctest/doctest.h>

#include "browser.hpp"
#include "sample_recording.hpp"

using namespace cambium;

namespace {

std::size_t occurrences(std::string const& text, std::string const& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

}  // namespace

TEST_CASE("a picture has the asked width, and the same recording gives the same picture") {
  std::string const picture = svg_picture(sample_recording(), {.width = 900.0});
  CHECK(picture.find("width=\"900\"") != std::string::npos);
  CHECK(picture == svg_picture(sample_recording(), {.width = 900.0}));
}

TEST_CASE("a picture shows a frame's vehicles only when asked") {
  std::string const shape = "fill=\"#1e90ff\"";
  CHECK(occurrences(svg_picture(sample_recording()), shape) == 0);
  CHECK(occurrences(svg_picture(sample_recording(), {.frame = 3}), shape) == 1);
}

TEST_CASE("a map too long for the picture gets a close-up") {
  Recording recording = sample_recording();
  CHECK(occurrences(svg_picture(recording), "<clipPath") == 1);
  recording.lanes[0].left.back().x() = recording.lanes[0].right.back().x() = 2000.0;
  CHECK(occurrences(svg_picture(recording), "<clipPath") == 2);
}

TEST_CASE("labels are escaped, and left out when not wanted") {
  Recording recording = sample_recording();
  recording.lanes[0].label = "a<b>&c";
  CHECK(svg_picture(recording).find("a&lt;b&gt;&amp;c") != std::string::npos);
  CHECK(occurrences(svg_picture(recording, {.labels = false}), "<text") == 0);
}

TEST_CASE("an empty recording is an empty picture") {
  CHECK(svg_picture(Recording{}).find("</svg>") != std::string::npos);
}

TEST_CASE("a picture of a frame that does not exist, or without width, is refused") {
  CHECK_THROWS_WITH_AS((void)svg_picture(sample_recording(), {.frame = 21}), doctest::Contains("no frame 21 in 21"),
                       Error);
  CHECK_THROWS_WITH_AS((void)svg_picture(sample_recording(), {.width = 0.0}), doctest::Contains("at least 100"), Error);
  browser::TemporaryFolder const folder;
  CHECK_THROWS_AS(write_svg_picture(folder.path() / "missing" / "map.svg", sample_recording()), Error);
}
