#include "cambium/world/plane_index.hpp"

#include <doctest/doctest.h>

#include <map>

#include "cambium/core/distributions.hpp"
#include "cambium/core/random.hpp"

#include "../support/allocations.hpp"

namespace cb = cambium;
using cb::Slot;
using cb::geometry::Box;

TEST_CASE("everybody whose box meets the one asked for is found once, as by comparing all") {
  cb::RandomStream random(9, 0, 0);
  cb::PlaneIndex index;
  for (int round = 0; round < 40; ++round) {
    double const side = round % 2 ? 60.0 : 3000.0, far = round % 5 == 0 ? 1e6 : 0.0;
    cb::IdVector<Box, Slot> boxes(cb::uniform_index(random, 150));
    for (auto& box : boxes) {
      if (cb::uniform01(random) < 0.1) continue;  // is nowhere
      double const x = far + side * cb::uniform01(random), y = -side * cb::uniform01(random);
      box.add(x, y);
      box.add(x + 17.0 * cb::uniform01(random), y + 3.0 * cb::uniform01(random));
    }
    index.refresh(boxes.size(), [&](Slot slot) { return boxes[slot]; });
    for (int query = 0; query < 50; ++query) {
      double const x = far + side * cb::uniform01(random), y = -side * cb::uniform01(random);
      Box const asked{x, y, x + 20.0 * cb::uniform01(random), y + 20.0 * cb::uniform01(random)};
      std::map<Slot, int> found;
      index.for_each_near(asked, [&](Slot slot) { ++found[slot]; });
      for (auto const& [slot, times] : found) {
        CHECK(times == 1);
        CHECK(boxes[slot].grown(4.0).intersects(asked.grown(4.0)));
      }
      for (Slot i{}; index_of(i) < boxes.size(); ++i)
        if (boxes[i].intersects(asked)) CHECK(found.contains(i));
    }
  }
}

TEST_CASE("once warm the index needs no memory, and no place is too far for it") {
  cb::PlaneIndex index;
  double shift = 0.0;
  auto const box_of = [&](Slot slot) {
    double const x = 3.0 * static_cast<double>(index_of(slot)) + shift;
    return Box{x, 0.0, x + 5.0, 2.0};
  };
  index.refresh(100, box_of);
  auto const before = support::allocations();
  for (; shift < 50.0; shift += 0.7) index.refresh(100, box_of);
  CHECK(support::allocations() == before);

  shift = 1e300;
  index.refresh(3, box_of);
  int found = 0;
  index.for_each_near({1e299, -1.0, 1e301, 1.0}, [&](Slot) { ++found; });
  CHECK(found == 3);
  index.refresh(0, box_of);
  index.for_each_near({-1e301, -1.0, 1e301, 1.0}, [&](Slot) { ++found; });
  CHECK(found == 3);
}
