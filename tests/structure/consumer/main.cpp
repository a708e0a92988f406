#include <Eigen/Dense>

#include <cambium/core/ids.hpp>
#include <cambium/core/version.hpp>
#include <cambium/geometry/pose.hpp>
#ifdef CAMBIUM_COMPILED
#include <cambium/map/building/map_builder.hpp>
#endif

int main() {
#ifdef CAMBIUM_COMPILED
  cambium::MapBuilder builder;
  builder.add_road(
      {.line = cambium::map::lay_from({}, {{100.0}}), .sections = {{.right = cambium::map::equal_lanes(1)}}});
  if (builder.build()->lanes().size() != 1) return 1;
#endif
  Eigen::MatrixXd const twice =
      Eigen::MatrixXd::Identity(3, 3) * 2.0;  // Eigen comes with cambium, without its warnings
  cambium::geometry::Pose const pose{1.0, 2.0, 0.0};
  bool const moved = cambium::geometry::to_map(pose, {3.0, 4.0}) == cambium::geometry::Point(4.0, 6.0);
  return moved && twice.inverse()(0, 0) == 0.5 && cambium::index_of(cambium::AgentId{7}) == 7 ? 0 : 1;
}
