#include "cambium/geometry/box_tree.hpp"

#include <cstdint>
#include <vector>

#include <doctest/doctest.h>

#include "cambium/core/distributions.hpp"
#include "cambium/core/random.hpp"
#include "cambium/geometry/box.hpp"

using cambium::geometry::Box;
using cambium::geometry::BoxTree;

TEST_CASE("a box tree finds exactly the boxes that meet the query, up to the rounding of float") {
  cambium::RandomStream stream(3, 0, 0);
  auto const random = [&stream](double low, double high) { return low + (high - low) * cambium::uniform01(stream); };
  for (int count : {0, 1, 7, 8, 9, 64, 65, 1000}) {
    std::vector<Box> boxes;
    for (int i = 0; i < count; ++i) {
      double const x = random(1e6, 1e6 + 500), y = random(-500, 0), size = random(0, 20);
      boxes.push_back({x, y, x + size, y + random(0, 20)});
    }
    BoxTree const tree(boxes);
    for (int k = 0; k < 200; ++k) {
      double const x = random(1e6, 1e6 + 500), y = random(-500, 0), size = random(0, 30);
      Box const query{x, y, x + size, y + size};
      std::vector<bool> found(boxes.size());
      CHECK_FALSE(tree.visit(query, [&](std::uint32_t i) {
        CHECK_FALSE(found[i]);  // once each
        found[i] = true;
        return false;
      }));
      auto const meets = [&query](Box const& b) {
        return b.min_x <= query.max_x && b.max_x >= query.min_x && b.min_y <= query.max_y && b.max_y >= query.min_y;
      };
      for (std::size_t i = 0; i < boxes.size(); ++i) {
        if (meets(boxes[i])) CHECK(found[i]);
        if (found[i]) CHECK(meets(boxes[i].grown(1e-3)));
      }
    }
  }
}
