// All that users do with a map, on every map there is: the same uses that the fuzzer makes of damaged ones.
#include <doctest/doctest.h>

#include <string>

#include "../support/corpus.hpp"
#include "../support/map_use.hpp"
#include "../support/maps.hpp"

TEST_CASE("routes, corridors, junctions, look-ups and pictures work on every map of the repository") {
  for (auto const* name :
       {"merging", "lane_drop", "highway_exit", "intersection_3way", "intersection_4way", "roundabout"}) {
    CAPTURE(name);
    CHECK(map_use::first_failure(*support::own_map(name + std::string(".xodr"))) == "");
  }
}

TEST_CASE("and on maps of the corpus") {
  for (auto const* name :
       {"DR_DEU_Merging_MT_v01_shifted", "fabriksgatan", "multi_intersections", "virtual_junction_priority"}) {
    auto const map = support::corpus_map(name + std::string(".xodr"));
    if (!map) return;
    CAPTURE(name);
    CHECK(map_use::first_failure(*map) == "");
  }
}
