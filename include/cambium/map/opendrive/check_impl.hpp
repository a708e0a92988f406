#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <unordered_set>
#include <utility>

#include "cambium/core/error.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/map/detail/findings.hpp"
#include "cambium/map/detail/geometry_fault.hpp"
#include "cambium/map/detail/id_places.hpp"
#include "cambium/map/detail/move_records.hpp"
#include "cambium/map/detail/require_buildable.hpp"
#include "cambium/map/opendrive/check.hpp"
#include "cambium/map/opendrive/detail/geometry_check.hpp"
#include "cambium/map/opendrive/detail/record_check.hpp"
#include "cambium/map/road/lane_type.hpp"
#include "cambium/map/road/reference_line.hpp"

namespace cambium::inline v0_1::map {

namespace detail {

using cambium::detail::rounded_text;

/// Checks what no single element shows: ids that occur twice, links that lead nowhere, contradictory lengths.
class DocumentCheck {
 public:
  DocumentCheck(opendrive::Document& document, std::string file, std::vector<Diagnostic>& diagnostics)
      : document_(&document), findings_{std::move(file), diagnostics} {}

  void run() {
    if (document_->header.line == 0) findings_.add(Severity::warning, 0, "header", "", "the file has no header");
    auto const& header = document_->header;
    if (header.rev_major > 1 || (header.rev_major == 1 && header.rev_minor > 8))
      findings_.add(header.rev_major > 1 ? Severity::warning : Severity::info, header.line, "header", "",
                    "OpenDRIVE " + std::to_string(header.rev_major) + "." + std::to_string(header.rev_minor) +
                        " is newer than the latest known revision, 1.8; it was read as 1.8");
    if (!is_bearable(document_->header.offset)) {
      findings_.add(Severity::warning, document_->header.line, "offset", "", "it is beyond any map; it was left out");
      document_->header.offset = {};
    }
    std::erase_if(document_->roads, [this](opendrive::RoadElement& road) {
      return !is_whole(road) || !GeometryCheck(road, findings_).is_continuous() || !has_lanes(road);
    });
    index(document_->roads, roads_, "road", " occurs twice; the second one was left out");
    index(document_->junctions, junctions_, "junction", " occurs twice; the second one was left out");
    for (opendrive::RoadElement& road : document_->roads) check(road);
    auto const walked = junctions_to_walk();
    for (opendrive::JunctionElement const& junction : document_->junctions) {
      if (junction.connections.empty() && !walked.contains(junction.id))
        findings_.add(Severity::warning, junction.line, "junction", "junction " + junction.id,
                      "it has no connection; only the links of roads lead through it");
      for (opendrive::Connection const& connection : junction.connections) check(junction, connection);
    }
  }

 private:
  /// Collects the ids and removes later elements of an id that was there before.
  template <class Element>
  void index(std::vector<Element>& elements, IdPlaces& ids, char const* kind, char const* sentence) {
    std::unordered_set<std::string> known;
    std::erase_if(elements, [&](Element const& element) {
      bool const is_second = !known.insert(element.id).second;
      if (is_second) findings_.add(Severity::warning, element.line, kind, "", "id " + element.id + sentence);
      return is_second;
    });
    ids = places_of(elements);
  }

  /// The junctions with linked connecting roads, and no drivable lane on any: these need no connections.
  [[nodiscard]] IdPlaces junctions_to_walk() const {
    IdPlaces walked, driven;
    for (opendrive::RoadElement const& road : document_->roads) {
      if (road.junction.empty()) continue;
      bool const is_driven =
          std::any_of(road.lane_sections.begin(), road.lane_sections.end(), [](opendrive::LaneSection const& section) {
            return std::any_of(section.lanes.begin(), section.lanes.end(), [](opendrive::LaneElement const& lane) {
              return lane.id != 0 && is_drivable(lane.type);
            });
          });
      if (is_driven)
        driven.emplace(road.junction, 0);
      else if (road.predecessor && road.successor)
        walked.emplace(road.junction, 0);
    }
    for (auto const& entry : driven) walked.erase(entry.first);
    return walked;
  }

  void check(opendrive::RoadElement& road) {
    std::string const ids = "road " + road.id;
    check_length(road, ids);
    check_short_geometries(road, ids);
    for (auto const* link : {&road.predecessor, &road.successor}) {
      if (!*link) continue;
      bool const is_road = (*link)->element_type == opendrive::ElementType::road;
      if (!(is_road ? roads_ : junctions_).contains((*link)->id))
        findings_.add(Severity::warning, (*link)->line, link == &road.predecessor ? "predecessor" : "successor", ids,
                      std::string("there is no usable ") + (is_road ? "road " : "junction ") + (*link)->id +
                          "; the link leads nowhere");
    }
    if (!road.junction.empty() && !junctions_.contains(road.junction))
      findings_.add(Severity::warning, road.line, "road", ids,
                    "there is no junction " + road.junction + " that it could belong to");
    check_sections(road, ids);
    RecordCheck(road, findings_).run();
  }

  void check_length(opendrive::RoadElement& road, std::string const& ids) {
    double const length = road.geometry_length();
    if (road.length < 0.0) {
      findings_.add(Severity::warning, road.line, "road", ids,
                    "the length is missing or negative; the geometries' counts");
      road.length = length;
    } else if (std::abs(road.length - length) > 1e-3) {
      findings_.add(Severity::warning, road.line, "road", ids,
                    "the length is " + rounded_text(road.length) + " m, but the geometries end at " +
                        rounded_text(length) + " m; theirs counts");
    }
    for (std::size_t i = 1; i < road.geometries.size(); ++i) {
      double const gap = road.geometries[i].s - road.geometries[i - 1].s - road.geometries[i - 1].length;
      if (std::abs(gap) > 1e-3)
        findings_.add(
            Severity::warning, road.geometry_lines[i], "geometry", ids,
            "s is " + rounded_text(gap) + " m beyond the end of the previous geometry; both are kept as written");
    }
  }

  /// Geometries so short that they are probably a mistake; they are kept, and do no harm.
  void check_short_geometries(opendrive::RoadElement const& road, std::string const& ids) {
    constexpr double short_one = 1e-9;  // [m]
    int count = 0, line = 0;
    for (std::size_t i = 0; i < road.geometries.size(); ++i)
      if (road.geometries[i].length < short_one && count++ == 0) line = road.geometry_lines[i];
    if (count > 0)
      findings_.add(Severity::warning, line, "geometry", ids,
                    "it is shorter than a millionth of a millimetre" +
                        (count > 1 ? " (and " + std::to_string(count - 1) + " more)" : std::string()) +
                        "; it is kept, but probably not intended");
  }

  /// False where all lane sections lie beyond the road's end.
  [[nodiscard]] bool has_lanes(opendrive::RoadElement const& road) {
    opendrive::LaneSection const& first = road.lane_sections.front();
    if (first.s <= road.geometry_length()) return true;
    findings_.add(
        Severity::warning, first.line, "laneSection", "road " + road.id,
        "the first section starts at " + rounded_text(first.s) + " m, beyond the road's end; the road was left out");
    return false;
  }

  /// Whether a road, which may have been made in code, has what every road has.
  [[nodiscard]] bool is_whole(opendrive::RoadElement& road) {
    road.geometry_lines.resize(road.geometries.size());
    char const* fault = road.lane_sections.empty() ? "it has no lane section"
                        : road.geometries.empty()  ? "it has no geometry"
                                                   : nullptr;
    for (std::size_t i = 0; i < road.geometries.size() && fault == nullptr; ++i) fault = fault_of(road.geometries[i]);
    if (fault == nullptr) return true;
    findings_.add(Severity::warning, road.line, "road", "road " + road.id,
                  std::string(fault) + "; the road was left out");
    return false;
  }

  /// Leaves out sections beyond the road's end (the first one always stays) and looks at the links between the others.
  void check_sections(opendrive::RoadElement& road, std::string const& ids) {
    while (road.lane_sections.size() > 1 && road.lane_sections.back().s > road.geometry_length() + 1e-9) {
      opendrive::LaneSection const& last = road.lane_sections.back();
      findings_.add(Severity::warning, last.line, "laneSection", ids,
                    "the section starts at " + rounded_text(last.s) + " m, beyond the road's end; it was left out");
      road.lane_sections.pop_back();
    }
    for (opendrive::LaneSection& section : road.lane_sections) {
      if (section.s >= 0.0) break;
      findings_.add(Severity::warning, section.line, "laneSection", ids,
                    "the section starts at " + rounded_text(section.s) + " m; it counts from the road's start on");
      for (opendrive::LaneElement& lane : section.lanes) move_records(lane, -section.s);
      section.s = 0.0;
    }
    if (road.lane_sections.front().s > 0.0)
      findings_.add(Severity::warning, road.lane_sections.front().line, "laneSection", ids,
                    "the first section starts at " + rounded_text(road.lane_sections.front().s) +
                        " m; the road has no lanes before that");
    for (std::size_t i = 0; i + 1 < road.lane_sections.size(); ++i)
      check_lane_links(road.lane_sections[i], road.lane_sections[i + 1], ids, i);
  }

  void check_lane_links(opendrive::LaneSection const& section, opendrive::LaneSection const& next,
                        std::string const& ids, std::size_t index) {
    auto const dangling = [&](opendrive::LaneElement const& lane, int to, std::size_t where, char const* element) {
      findings_.add(Severity::warning, lane.line, element,
                    ids + ", section " + std::to_string(where) + ", lane " + std::to_string(lane.id),
                    "there is no lane " + std::to_string(to) + " in the adjacent section; the link leads nowhere");
    };
    auto const ids_of = [](opendrive::LaneSection const& of) {
      std::vector<int> numbers;
      for (opendrive::LaneElement const& lane : of.lanes) numbers.push_back(lane.id);
      std::sort(numbers.begin(), numbers.end());
      return numbers;
    };
    auto const here = ids_of(section), there = ids_of(next);
    for (opendrive::LaneElement const& lane : section.lanes)
      for (int const to : lane.successors)
        if (!std::binary_search(there.begin(), there.end(), to)) dangling(lane, to, index, "successor");
    for (opendrive::LaneElement const& lane : next.lanes)
      for (int const to : lane.predecessors)
        if (!std::binary_search(here.begin(), here.end(), to)) dangling(lane, to, index + 1, "predecessor");
  }

  void check(opendrive::JunctionElement const& junction, opendrive::Connection const& connection) {
    if (connection.predecessor || connection.successor) return;
    for (std::string const* id : {&connection.incoming_road, &connection.entered_road()})
      if (!roads_.contains(*id))
        findings_.add(Severity::warning, connection.line, "connection", "junction " + junction.id,
                      "there is no usable road \"" + *id + "\"; connection " + connection.id + " leads nowhere");
  }

  opendrive::Document* document_;
  Findings findings_;
  IdPlaces roads_, junctions_;
};

}  // namespace detail

CAMBIUM_COLD void check_opendrive_document(OpenDriveDocument& document, std::string file_name,
                                           std::vector<Diagnostic>& diagnostics) {
  detail::DocumentCheck(document, std::move(file_name), diagnostics).run();
}

}  // namespace cambium::inline v0_1::map
