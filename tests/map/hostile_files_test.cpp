// Files damaged at random, read in full: a map that can be driven on, or an error; nothing else.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <iterator>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include <pugixml.hpp>

#include "../support/corpus.hpp"
#include "cambium/behavior/behavior_set.hpp"
#include "cambium/behavior/idm_classic.hpp"
#include "cambium/core/distributions.hpp"
#include "cambium/dynamics/single_track.hpp"
#include "cambium/execution/interpolate.hpp"
#include "cambium/map/opendrive.hpp"
#include "cambium/world/world.hpp"

namespace {

namespace cb = cambium;
using Sim = cb::World<cb::BehaviorSet<cb::IdmClassic>, cb::InterpolateExecution, cb::SingleTrack>;

std::size_t any_of(std::size_t count, cb::RandomStream& random) { return static_cast<std::size_t>(random() % count); }

/// A file that was damaged, and how.
struct Damaged {
  std::string text;
  std::string what;
};

class Damage {
 public:
  Damage(pugi::xml_document const& original, cb::RandomStream random) : random_(random) { xml_.reset(original); }

  [[nodiscard]] Damaged make() {
    for (auto left = 1 + any_of(3, random_); left > 0; --left) damage_once();
    std::ostringstream text;
    xml_.save(text, " ", pugi::format_raw);
    Damaged result{text.str(), what_};
    if (any_of(20, random_) == 0) {
      result.text.resize(any_of(result.text.size(), random_));
      result.what += "cut after " + std::to_string(result.text.size()) + " bytes; ";
    }
    return result;
  }

 private:
  void damage_once() {
    std::vector<pugi::xml_node> elements;
    collect(xml_.document_element(), elements);
    if (elements.empty()) return;
    auto const element = elements[any_of(elements.size(), random_)];
    auto const kind = any_of(10, random_);
    if (kind == 0) {
      what_ += "deleted " + name_of(element) + "; ";
      element.parent().remove_child(element);
    } else if (kind == 1) {
      what_ += "doubled " + name_of(element) + "; ";
      element.parent().insert_copy_after(element, element);
    } else if (kind == 2) {  // moved, often to where it has no business
      auto to = elements[any_of(elements.size(), random_)];
      what_ += "copied " + name_of(element) + " into " + name_of(to) + "; ";
      to.append_copy(element);
    } else {
      damage_attribute(element, elements);
    }
  }

  void damage_attribute(pugi::xml_node element, std::vector<pugi::xml_node> const& elements) {
    static char const* const values[] = {"0",      "-1",  "1",      "-3.5",  "0.5",  "1e-9", "1e300",
                                         "-1e300", "1e7", "-1e7",   "100",   "-100", "1000", "nan",
                                         "-nan",   "inf", "-inf",   "",      "many", "1,5",  "1e999",
                                         "2",      "-2",  "1e-300", "3.7 m", "1e4",  "1e5",  "99999999999999999999"};
    auto const count = static_cast<std::size_t>(std::distance(element.attributes_begin(), element.attributes_end()));
    if (count == 0) return;
    auto attribute = *std::next(element.attributes_begin(), static_cast<std::ptrdiff_t>(any_of(count, random_)));
    std::string value = values[any_of(std::size(values), random_)];
    if (any_of(4, random_) == 0) {  // another element's
      auto const other = elements[any_of(elements.size(), random_)].attribute(attribute.name());
      if (other) value = other.value();
    }
    what_ += name_of(element) + "@" + attribute.name() + " " + attribute.value() + " -> " + value + "; ";
    attribute.set_value(value.c_str());
  }

  static void collect(pugi::xml_node node, std::vector<pugi::xml_node>& out) {
    for (auto const child : node.children()) {
      if (child.type() != pugi::node_element) continue;
      out.push_back(child);
      collect(child, out);
    }
  }

  /// "road[2]/lanes/laneSection[1]": which of its name within the parent.
  [[nodiscard]] static std::string name_of(pugi::xml_node node) {
    std::string path;
    for (; node.parent().parent(); node = node.parent()) {
      int number = 1;
      for (auto before = node.previous_sibling(node.name()); before; before = before.previous_sibling(node.name()))
        ++number;
      path = "/" + std::string(node.name()) + "[" + std::to_string(number) + "]" + path;
    }
    return path;
  }

  pugi::xml_document xml_;
  std::string what_;
  cb::RandomStream random_;
};

bool is_finite(cb::geometry::Line const& line) {
  for (auto const& g : line.segments())
    if (!std::isfinite(g.s + g.x + g.y + g.ux + g.uy + g.length + g.heading + g.curvature)) return false;
  return std::isfinite(line.length());
}

/// What is wrong with a map; empty where nothing is.
std::string fault_of(std::shared_ptr<cb::Map const> const& map) {
  for (auto const& lane : map->lanes()) {
    auto const name = map->describe(lane.id);
    if (!is_finite(lane.path) || !is_finite(lane.left) || !is_finite(lane.right))
      return name + ": a line is not finite";
    if (!(lane.length() > 0)) return name + ": no length";
    for (auto const& w : lane.widths)
      if (!std::isfinite(w.left) || !std::isfinite(w.right)) return name + ": a width is not finite";
    if (lane.widths.size() != lane.path.segments().size() + 1) return name + ": widths are missing";
    if (!std::isfinite(lane.index_begin + lane.merge_begin)) return name + ": a number is not finite";
    for (auto const& step : lane.speed_limits)
      if (!std::isfinite(step.begin) || !(step.limit > 0)) return name + ": a speed limit is none";
    for (auto const* changes : {&lane.left_changes, &lane.right_changes})
      for (auto const& stretch : *changes)
        if (!std::isfinite(stretch.begin + stretch.end)) return name + ": a lane change is not finite";
    for (auto const& o : lane.overlaps)
      if (!std::isfinite(o.begin + o.end + o.other_begin + o.other_end)) return name + ": an overlap is not finite";
  }
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
    auto const damaged = Damage(original, cb::RandomStream(1, number, i)).make();
    std::string const name = file.filename().string();
    CAPTURE(name);
    CAPTURE(i);
    CAPTURE(damaged.what);
    try {
      auto const loaded = cb::parse_opendrive(damaged.text);
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
  auto files = corpus::maps(std::filesystem::path(CAMBIUM_SOURCE_DIR) / "maps");
  CHECK(files.size() >= 3);
  for (auto const* name : {"DR_DEU_Merging_MT_v01_shifted.xodr", "simple_3way_intersection_lht.xodr"})
    if (auto const file = corpus::find(std::string("opendrive/") + name)) files.push_back(*file);
  for (std::uint32_t i = 0; i < files.size(); ++i) {
    auto const count = damage(files[i], i, 1000);
    MESSAGE(files[i].filename().string() << ": " << count.maps << " maps, " << count.errors << " errors");
    CHECK(count.maps > 500);
    CHECK(count.errors > 10);
  }
}
