#include "trajectories.hpp"

#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

#include "cambium/geometry/angle.hpp"

#include "csv.hpp"

namespace examples {

char const* class_of(cambium::geometry::Shape const& shape) {
  namespace g = cambium::geometry;
  struct Named {
    char const* name;
    g::Shape shape;
  };
  static constexpr Named all[] = {{"car", g::car()},         {"van", g::van()},
                                  {"truck", g::truck()},     {"articulated truck", g::articulated_truck()},
                                  {"bus", g::bus()},         {"motorcycle", g::motorcycle()},
                                  {"bicycle", g::bicycle()}, {"pedestrian", g::pedestrian()}};
  char const* best = "";
  double least = std::numeric_limits<double>::infinity();
  for (auto const& [name, known] : all) {
    double const difference = std::abs(known.length() - shape.length()) + std::abs(known.width() - shape.width());
    if (difference >= least) continue;
    least = difference;
    best = name;
  }
  return best;
}

void append_row(std::string& rows, cambium::Map const& map, TrajectoryRow const& r) {
  char line[240];
  std::snprintf(line, sizeof line, "%llu,%.1f,%s,%.4f,%.4f,%.6f,%.4f,%.4f,%.2f,%.2f,%.2f,",
                static_cast<unsigned long long>(r.scenario), r.time, cambium::to_string(r.agent).c_str(), r.x, r.y,
                std::remainder(r.heading, 2 * cambium::geometry::pi), r.speed, r.acceleration, r.shape.front,
                r.shape.rear, r.shape.width());
  rows += line;
  if (r.lane != nullptr) rows += csv_cell(map.road(r.lane->road).name) + ',' + std::to_string(r.lane->number);
  if (r.lane == nullptr) rows += ',';
  rows += std::string(",") + class_of(r.shape) + ',' + r.behavior + (r.is_ego ? ",1\n" : ",0\n");
}

void RowsInOrder::put(std::uint64_t number, std::string rows) {
  std::unique_lock lock(mutex_);
  moved_.wait(lock, [&] { return given_up_ || number < next_ + ahead_; });  // scenario next_ never waits: no deadlock
  if (given_up_) return;
  waiting_.emplace(number, std::move(rows));
  for (auto first = waiting_.begin(); first != waiting_.end() && first->first == next_; first = waiting_.begin()) {
    file_.append(first->second);
    waiting_.erase(first);
    ++next_;
  }
  moved_.notify_all();
}

void RowsInOrder::give_up() {
  std::lock_guard const lock(mutex_);
  given_up_ = true;
  moved_.notify_all();
}

}  // namespace examples
