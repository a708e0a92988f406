#pragma once

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <map>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "cambium/core/parameters.hpp"
#include "cambium/core/text.hpp"
#include "cambium/map/opendrive/element.hpp"
#include "cambium/map/opendrive/lanes.hpp"
#include "cambium/map/road/cubic.hpp"

namespace cambium::inline v0_1::map::detail {

/// Moves records to a section that starts `shift` [m] later, and drops those that end before it.
template <class Record>
void move_start(std::vector<Record>& records, double Record::*start, double shift) {
  std::size_t ended = 0;
  while (ended + 1 < records.size() && records[ended + 1].*start <= shift) ++ended;
  records.erase(records.begin(), records.begin() + static_cast<std::ptrdiff_t>(ended));
  for (Record& record : records) {
    double const s = record.*start - shift;
    if constexpr (std::is_same_v<Record, CubicRecord>)
      if (s < 0.0)
        record = {0.0, record.value(shift), record.derivative(shift), 0.5 * record.second_derivative(shift), record.d};
    record.*start = std::max(0.0, s);
  }
}

/// The same for records in the rest: elements with an `sOffset`. Each ends where the next one of its name begins.
inline void move_start(std::vector<opendrive::Element>& elements, double shift) {
  std::map<std::string, double> begun;  // by name: where the last one begins that does so by the new start
  auto const has_ended = [&](opendrive::Element& element) {
    for (opendrive::Attribute& attribute : element.attributes) {
      if (attribute.name != "sOffset") continue;
      std::optional<double> const s = cambium::detail::parse_number<double>(attribute.value);
      if (!s) continue;
      if (*s <= shift && begun.emplace(element.name, *s).first->second > *s) return true;
      attribute.value = cambium::detail::number_text(std::max(0.0, *s - shift));
    }
    return false;
  };
  std::vector<opendrive::Element> kept;
  for (auto element = elements.rbegin(); element != elements.rend(); ++element)
    if (!has_ended(*element)) kept.push_back(std::move(*element));
  elements.assign(std::make_move_iterator(kept.rbegin()), std::make_move_iterator(kept.rend()));
}

/// The same for all records of a lane.
inline void move_records(opendrive::LaneElement& lane, double shift) {
  move_start(lane.widths, &CubicRecord::s, shift);
  move_start(lane.borders, &CubicRecord::s, shift);
  move_start(lane.road_marks, &opendrive::RoadMark::s_offset, shift);
  move_start(lane.speeds, &opendrive::SpeedRecord::s, shift);
  move_start(lane.heights, &opendrive::HeightRecord::s_offset, shift);
  move_start(lane.rest.elements, shift);
}

}  // namespace cambium::inline v0_1::map::detail
