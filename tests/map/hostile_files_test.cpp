// Files damaged at random, read in full: a map that can be driven on, or an error; nothing else. 200 of each file are a
// sample that takes seconds: CAMBIUM_SCALE=50 build/tests/test_map -tc='a damaged file*' takes that many times as many.
#include <doctest/doctest.h>

#include <cstdint>
#include <exception>
#include <filesystem>
#include <string>

#include <pugixml.hpp>

#include "../support/corpus.hpp"
#include "../support/map_faults.hpp"
#include "../support/scale.hpp"
#include "../support/xml_damage.hpp"
#include "cambium/behavior/behavior_set.hpp"
#include "cambium/behavior/drivers.hpp"
#include "cambium/core/distributions.hpp"
#include "cambium/dynamics/single_track.hpp"
#include "cambium/execution/interpolate.hpp"
#include "cambium/map/corridor/build_corridor.hpp"
#include "cambium/map/opendrive.hpp"
#include "cambium/world/world.hpp"
#include "../support/maps.hpp"

namespace {

namespace cb = cambium;
using Sim = cb::World<cb::BehaviorSet<cb::IdmClassic>, cb::InterpolateExecution, cb::SingleTrack>;

/// A file that was damaged, and how.
struct Damaged {
  std::string text;
  std::string what;
};

/// One to three places damaged; one file in twenty is cut off, too.
Damaged damage_file(pugi::xml_document const& original, cb::RandomStream random) {
  pugi::xml_document xml;
  xml.reset(original);
  Damaged result;
  for (auto left = 1 + xml_damage::any_of(3, random); left > 0; --left)
    result.what += xml_damage::damage_once(xml, random);
  result.text = xml_damage::text_of(xml);
  if (xml_damage::any_of(20, random) == 0) {
    result.text.resize(xml_damage::any_of(result.text.size(), random));
    result.what += "cut after " + std::to_string(result.text.size()) + " bytes; ";
  }
  return result;
}

/// What is wrong with a map; empty where nothing is.
std::string fault_of(std::shared_ptr<cb::Map const> const& map) {
  if (auto const fault = map_faults::first_fault(*map); !fault.empty()) return fault;
  Sim world(map);
  for (auto const& lane : map->lanes()) {
    if (!lane.drivable() || lane.length() <= 5.0) continue;
    auto const pose = lane.path.pose(lane.length() / 2);
    try {
      world.add({.position = pose.position(), .speed = 5.0, .route = cb::map::straight_route(*map, lane.id)});
    } catch (std::exception const& e) {
      return map->describe(lane.id) + ": nobody can enter: " + e.what();
    }
  }
  for (int i = 0; i < 3; ++i)
    if (auto const result = world.step(0.2); !result)
      return "agent " + cb::to_string(result.agent) + ": " + cb::to_string(result.problem);
  return "";
}

struct Count {
  int maps = 0, errors = 0;
};

/// Reads `cases` damaged variants of a file.
Count damage(std::filesystem::path const& file, std::uint32_t number, std::uint32_t cases) {
  pugi::xml_document original;
  REQUIRE(original.load_file(file.c_str()));
  Count count;
  for (std::uint32_t i = 0; i < cases; ++i) {
    auto const damaged = damage_file(original, cb::RandomStream(1, number, i));
    std::string const name = file.filename().string();
    CAPTURE(name);
    CAPTURE(i);
    CAPTURE(damaged.what);
    try {
      auto const loaded = cambium::parse_opendrive(damaged.text);
      CHECK(fault_of(loaded.map) == "");
      ++count.maps;
    } catch (cb::MapError const&) {
      ++count.errors;
    } catch (std::exception const& e) {
      FAIL_CHECK("neither map nor MapError: " << e.what());
    }
  }
  return count;
}

}  // namespace

TEST_CASE("a damaged file gives a map on which traffic runs, or a MapError, and never anything else") {
  auto const files = corpus::some_maps({"DR_DEU_Merging_MT_v01_shifted", "simple_3way_intersection_lht"});
  CHECK(files.size() >= 3);
  int errors = 0;
  for (std::uint32_t i = 0; i < files.size(); ++i) {
    auto const count = damage(files[i], i, support::runs(200));
    MESSAGE(files[i].filename().string() << ": " << count.maps << " maps, " << count.errors << " errors");
    CHECK(count.maps > 0.4 * support::runs(200));
    if (support::runs(200) >= 200) CHECK(count.errors > 2);
    errors += count.errors;
  }
  CHECK(errors > 0.01 * support::runs(200) * static_cast<double>(files.size()));
}
