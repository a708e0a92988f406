#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "cambium/core/distributions.hpp"
#include "cambium/core/random.hpp"
#include "cambium/core/stable_sort.hpp"

using namespace cambium;

TEST_CASE("a sort of any type gives what the standard library's stable sort gives") {
  RandomStream random(1, 0, 0);
  for (int sample = 0; sample < 300; ++sample) {
    std::vector<std::pair<int, int>> list;  // key, place before
    int const size = static_cast<int>(uniform01(random) * 40.0);
    for (int i = 0; i < size; ++i) list.emplace_back(static_cast<int>(uniform01(random) * 10.0), i);
    auto expected = list;
    std::sort(expected.begin(), expected.end());  // by the place, too: that is what stable means
    bool const was_sorted = expected == list;
    CHECK(detail::stable_sort(list, &std::pair<int, int>::first) == !was_sorted);
    CHECK(list == expected);
  }
}

TEST_CASE("a sort takes each element to its place once") {
  std::vector<int> list;
  for (int i = 1; i < 300'000; ++i) list.push_back(i);
  list.push_back(0);  // one cycle: were it followed from each place anew, this would take a minute
  CHECK(detail::stable_sort_by(list, [](int l, int r) { return l < r; }));
  CHECK(std::is_sorted(list.begin(), list.end()));
}
