#pragma once

#include <condition_variable>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>

#include "cambium/core/ids.hpp"
#include "cambium/geometry/shape.hpp"
#include "cambium/map/map.hpp"

#include "part_file.hpp"

namespace examples {

/// Columns of the trajectories: x and y of the reference point (centre of the rear axle); front and rear, the distances
/// from there to the bumpers; acceleration of the step that led here; road and lane as in the map's file; ego, 1 for
/// the ego, else 0.
inline constexpr char const* trajectory_columns =
    "scenario,time [s],agent,x [m],y [m],heading [rad],speed [m/s],acceleration [m/s^2],front [m],rear [m],width [m],"
    "road,lane,class,behavior,ego\n";

/// One vehicle at one time.
struct TrajectoryRow {
  std::uint64_t scenario;
  double time;
  cambium::AgentId agent;
  double x, y, heading, speed, acceleration;
  cambium::geometry::Shape const& shape;
  cambium::map::Lane const* lane;  ///< null outside the map's lanes
  char const* behavior;
  bool is_ego;
};

/// Name of the shipped shape most similar to `shape`: "car", "truck", ...
[[nodiscard]] char const* class_of(cambium::geometry::Shape const& shape);

/// Adds a line of CSV.
void append_row(std::string& rows, cambium::Map const& map, TrajectoryRow const& row);

/// Writes the rows of the scenarios in order, although they come from several threads. A thread that is more than
/// `ahead` scenarios ahead of the file waits, so that memory stays bounded.
class RowsInOrder {
 public:
  RowsInOrder(PartFile& file, std::uint64_t ahead) : file_(file), ahead_(ahead) {}

  /// Hands over the rows of scenario `number`. Each number from 0 on must come exactly once.
  void put(std::uint64_t number, std::string rows);

  /// Releases all waiting threads, because a scenario has failed and its rows will not come.
  void give_up();

 private:
  PartFile& file_;
  std::uint64_t ahead_, next_ = 0;
  bool given_up_ = false;
  std::map<std::uint64_t, std::string> waiting_;  ///< rows whose turn has not come
  std::mutex mutex_;
  std::condition_variable moved_;
};

}  // namespace examples
