#pragma once

#include <algorithm>
#include <cstddef>
#include <type_traits>
#include <vector>

#include "cambium/map/opendrive/lanes.hpp"
#include "cambium/map/road/cubic.hpp"

namespace cambium::map::detail {

/// Moves records to a section that starts `shift` [m] later; what has ended before is dropped.
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

/// All records of a lane, likewise.
inline void move_records(opendrive::Lane& lane, double shift) {
  move_start(lane.widths, &CubicRecord::s, shift);
  move_start(lane.borders, &CubicRecord::s, shift);
  move_start(lane.road_marks, &opendrive::RoadMark::s_offset, shift);
  move_start(lane.speeds, &opendrive::SpeedRecord::s, shift);
  move_start(lane.heights, &opendrive::LaneHeight::s_offset, shift);
  move_start(lane.accesses, &opendrive::LaneAccess::s_offset, shift);
  move_start(lane.rules, &opendrive::LaneRule::s_offset, shift);
}

}  // namespace cambium::map::detail
