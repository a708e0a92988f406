#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "cambium/map/corridor/build_corridor.hpp"
#include "cambium/map/map.hpp"

/// Imitates the stack: what its perception sends.
namespace stack {

enum class Label : std::uint8_t { car, truck, bicycle, pedestrian };

/// An object: centre of its box [m, rad, m/s], when it was measured [ns].
struct Object {
  std::string uuid;
  std::int64_t stamp;
  Label label;
  double x, y, yaw, speed, length, width;
};

/// Road users on the lanes of a map around a place, each odd in its way.
class Perception {
 public:
  explicit Perception(cambium::Map const& map) {
    std::vector<cambium::LaneId> lanes;
    for (auto const& lane : map.lanes())
      if (lane.drivable() && lane.length() > 15.0 && !map.in_junction(lane.id)) lanes.push_back(lane.id);
    for (std::size_t i = 0; i < 10 && !lanes.empty(); ++i)
      roads_.push_back(cambium::map::build_road_corridor(
          map, cambium::map::straight_route(map, lanes[i * lanes.size() / 10], 300.0)));
  }

  /// The list at `seconds` after the begin, stamped `stamp` [ns].
  [[nodiscard]] std::vector<Object> list(double seconds, std::int64_t stamp) const {
    std::vector<Object> objects;
    for (std::size_t i = 0; i < roads_.size(); ++i) {
      auto const& center = roads_[i]->corridors[roads_[i]->main].center;
      double const speed = 6.0 + static_cast<double>(i % 4), s = std::min(5.0 + speed * seconds, center.length());
      bool const follows = i < 1 || i > 4;
      auto const pose = center.pose(follows ? s : 0.5 * center.length());
      Object object{"vehicle-" + std::to_string(i), stamp, Label::car, pose.x, pose.y, pose.heading, speed, 4.5, 1.8};
      spoil(i, object);
      if (!follows) {  // it has gone its own way since the begin
        object.x += (seconds - 2.0) * object.speed * std::cos(object.yaw);
        object.y += (seconds - 2.0) * object.speed * std::sin(object.yaw);
      }
      objects.push_back(object);
    }
    if (!objects.empty()) objects.push_back(objects.front());  // twice
    return objects;
  }

 private:
  static void spoil(std::size_t i, Object& object) {
    constexpr double half_turn = 3.14159265358979;
    switch (i) {
      case 1:  // drives against its lane
        object.yaw += half_turn;
        break;
      case 2:  // reverses
        object.speed = -0.5;
        break;
      case 3:  // leaves a driveway, across the lane
        object.yaw += 1.4;
        object.speed = 2.0;
        break;
      case 4:
        object.label = Label::pedestrian;
        object.yaw += 1.5;
        object.speed = 1.3;
        object.length = object.width = 0.5;
        break;
      case 5:  // a box of no size
        object.length = object.width = 0.0;
        break;
      case 6:
        object.x = std::numeric_limits<double>::quiet_NaN();
        break;
      case 7:  // measured 30 ms before the list
        object.stamp -= 30'000'000;
        break;
      default:
        break;
    }
  }

  std::vector<std::shared_ptr<cambium::map::RoadCorridor const>> roads_;
};

}  // namespace stack
