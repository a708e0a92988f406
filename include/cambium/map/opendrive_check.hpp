#pragma once

#include <cmath>
#include <cstddef>
#include <cstdio>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "cambium/core/diagnostic.hpp"
#include "cambium/map/opendrive_document.hpp"

namespace cambium::map {
namespace detail {

/// Looks at what single elements cannot show: double ids, links that lead nowhere, lengths that contradict each other.
class DocumentCheck {
 public:
  DocumentCheck(opendrive::Document& document, std::string file, std::vector<Diagnostic>& diagnostics)
      : document_(&document), file_(std::move(file)), diagnostics_(&diagnostics) {}

  void run() {
    if (document_->header.line == 0) report(Severity::warning, 0, "header", "", "the file has no header");
    index(document_->roads, roads_, "road", " is there twice; the second one was left out");
    index(document_->junctions, junctions_, "junction", " is there twice; the second one was left out");
    for (opendrive::Road& road : document_->roads) check(road);
    for (opendrive::Junction const& junction : document_->junctions)
      for (opendrive::Connection const& connection : junction.connections) check(junction, connection);
  }

 private:
  using Index = std::unordered_set<std::string_view>;

  /// Collects the ids and removes later elements of an id that was there before.
  template <class Element>
  void index(std::vector<Element>& elements, Index& ids, char const* kind, char const* sentence) {
    std::unordered_set<std::string> seen;
    std::erase_if(elements, [&](Element const& element) {
      if (seen.insert(element.id).second) return false;
      report(Severity::error, element.line, kind, "", "id " + element.id + sentence);
      return true;
    });
    for (Element const& element : elements) ids.insert(element.id);
  }

  void check(opendrive::Road& road) {
    std::string const ids = "road " + road.id;
    check_length(road, ids);
    for (auto const* link : {&road.predecessor, &road.successor}) {
      if (!*link) continue;
      bool const is_road = (*link)->element_type == opendrive::ElementType::road;
      if (!(is_road ? roads_ : junctions_).contains((*link)->id))
        report(Severity::warning, (*link)->line, link == &road.predecessor ? "predecessor" : "successor", ids,
               std::string("there is no usable ") + (is_road ? "road " : "junction ") + (*link)->id +
                   "; the link leads nowhere");
    }
    if (!road.junction.empty() && !junctions_.contains(road.junction))
      report(Severity::warning, road.line, "road", ids,
             "there is no junction " + road.junction + " that it could belong to");
    check_sections(road, ids);
  }

  void check_length(opendrive::Road const& road, std::string const& ids) {
    double const length = road.geometry_length();
    if (road.length < 0.0)
      report(Severity::warning, road.line, "road", ids, "the length is missing or negative; the geometries' counts");
    else if (std::abs(road.length - length) > 1e-3)
      report(Severity::warning, road.line, "road", ids,
             "the length is " + number(road.length) + " m, but the geometries end at " + number(length) +
                 " m; theirs counts");
    for (std::size_t i = 1; i < road.geometries.size(); ++i) {
      double const gap = road.geometries[i].s - road.geometries[i - 1].s - road.geometries[i - 1].length;
      if (std::abs(gap) > 1e-3)
        report(Severity::warning, road.geometry_lines[i], "geometry", ids,
               "s is " + number(gap) + " m behind the end of the geometry before; both are kept as written");
    }
  }

  /// Leaves out sections behind the road's end (the first one always stays) and looks at the links between the others.
  void check_sections(opendrive::Road& road, std::string const& ids) {
    while (road.lane_sections.size() > 1 && road.lane_sections.back().s > road.geometry_length() + 1e-9) {
      opendrive::LaneSection const& last = road.lane_sections.back();
      report(Severity::warning, last.line, "laneSection", ids,
             "the section starts at " + number(last.s) + " m, behind the road's end; it was left out");
      road.lane_sections.pop_back();
    }
    if (road.lane_sections.front().s > 0.0)
      report(
          Severity::warning, road.lane_sections.front().line, "laneSection", ids,
          "the first section starts at " + number(road.lane_sections.front().s) + " m, the road has no lanes before");
    for (std::size_t i = 0; i + 1 < road.lane_sections.size(); ++i)
      check_lane_links(road.lane_sections[i], road.lane_sections[i + 1], ids, i);
  }

  void check_lane_links(opendrive::LaneSection const& section, opendrive::LaneSection const& next,
                        std::string const& ids, std::size_t index) {
    auto const dangling = [&](opendrive::Lane const& lane, int to, std::size_t where, char const* element) {
      report(Severity::warning, lane.line, element,
             ids + ", section " + std::to_string(where) + ", lane " + std::to_string(lane.id),
             "there is no lane " + std::to_string(to) + " in the section beside; the link leads nowhere");
    };
    for (opendrive::Lane const& lane : section.lanes)
      for (int const to : lane.successors)
        if (!next.find(to)) dangling(lane, to, index, "successor");
    for (opendrive::Lane const& lane : next.lanes)
      for (int const to : lane.predecessors)
        if (!section.find(to)) dangling(lane, to, index + 1, "predecessor");
  }

  void check(opendrive::Junction const& junction, opendrive::Connection const& connection) {
    for (std::string const* id : {&connection.incoming_road, &connection.connecting_road})
      if (!roads_.contains(*id))
        report(Severity::warning, connection.line, "connection", "junction " + junction.id,
               "there is no usable road \"" + *id + "\"; connection " + connection.id + " leads nowhere");
  }

  void report(Severity severity, int line, std::string element, std::string ids, std::string sentence) {
    diagnostics_->push_back({severity, file_, line, std::move(element), std::move(ids), std::move(sentence)});
  }

  [[nodiscard]] static std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", value);
    return text;
  }

  opendrive::Document* document_;
  std::string file_;
  std::vector<Diagnostic>* diagnostics_;
  Index roads_;
  Index junctions_;
};

}  // namespace detail

/// Checks a document as a whole and appends what it finds: double ids (the later element is removed), links and
/// connections that lead nowhere (kept), lane sections behind the road's end (removed), lengths that contradict the
/// geometries (kept; the geometries count). Linear in the size of the document but for the few lanes of a section.
inline void check_opendrive_document(OpenDriveDocument& document, std::string file_name,
                                     std::vector<Diagnostic>& diagnostics) {
  detail::DocumentCheck(document, std::move(file_name), diagnostics).run();
}

}  // namespace cambium::map
