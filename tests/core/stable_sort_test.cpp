#include <doctest/doctest.h>

#include <algorithm>
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
