#pragma once

#include <filesystem>

#include <doctest/doctest.h>

#include "cambium/map/opendrive.hpp"
#include "../support/corpus.hpp"

/// Calls `visit(path, map)` for each map of the corpus; false where there is no corpus.
template <class Visit>
bool for_each_corpus_map(Visit const& visit) {
  auto const folder = corpus::find("opendrive");
  if (!folder) return false;
  for (auto const& file : corpus::maps(*folder)) {
    CAPTURE(file.stem().string());
    auto const map = cambium::load_opendrive(file.string()).map;
    visit(file, *map);
  }
  return true;
}
