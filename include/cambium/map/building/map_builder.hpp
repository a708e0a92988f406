#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cambium/core/diagnostic.hpp"
#include "cambium/geometry/pose.hpp"
#include "cambium/map/building/detail/document_index.hpp"
#include "cambium/map/building/road_plan.hpp"
#include "cambium/map/map.hpp"
#include "cambium/map/opendrive/document.hpp"
#include "cambium/map/road/curve_layout.hpp"

namespace cambium::inline v0_1::map {

/// A way through a junction to be made, see `MapBuilder::add_turn`.
struct TurnPlan {
  std::string id{};  ///< the connecting road's; empty: the next free number
  std::string name{};
  /// Lanes of the one road and of the other that it connects, from the middle of the road outwards and side by side.
  /// Empty: the drivable lanes that lead in and out, the first to the first and so on, while there are both.
  std::vector<opendrive::LaneLink> lanes{};
  std::optional<double> speed_limit{};  ///< [m/s]
};

/// Makes maps in code: roads, how they are linked, junctions. What it makes is an OpenDRIVE document (which can be
/// written to a file), and from that the map, just as from a file.
///
///     MapBuilder builder;
///     builder.add_road({.id = "1", .line = lay_from({}, {{500.0}}), .sections = {{.right = equal_lanes(2)}}});
///     auto const map = builder.build();
///
/// All functions throw `MapError` for roads and junctions that are not there, and for numbers that are not finite; a
/// call that throws changes nothing.
class MapBuilder {
 public:
  /// An empty map of this name.
  explicit MapBuilder(std::string name = "map");

  /// Adds a road and returns its id. Throws `MapError` where the id is taken or says none, the line or the first
  /// section is missing, a geometry does not begin where the previous one ends (to 1 cm and 0.01 rad), sections or
  /// records are not in order, or a width falls below 0. Linear in the plan.
  std::string add_road(RoadPlan plan);

  /// Adds an empty junction and returns its id (without one, the next free number). Throws `MapError` where the id is
  /// taken or says none.
  std::string add_junction(std::string id = {}, std::string name = {});

  /// The end of a road's reference line, looking away from the road: where another road can begin.
  [[nodiscard]] geometry::Pose end_pose(RoadEnd const& end) const;

  /// The middle of a lane at a road's end, looking away from the road. Throws `MapError` where there is no such lane.
  [[nodiscard]] geometry::Pose lane_pose(RoadEnd const& end, int lane) const;

  /// Links the ends of two roads, and there the lanes named, or without any, those of the same place: of equal ids
  /// where an end meets a start, else of opposite ones; drivable lanes to drivable ones only.
  ///
  /// Where one of the roads is a connecting road, the other becomes linked to its junction, with connections for the
  /// lanes that lead in. Else, where an end is linked already to another road, the two links become connections of a
  /// direct junction: so forks and joints need nothing but a `connect` for each of their branches. What is linked
  /// already stays so. Throws `MapError` where there is no such lane or none to be linked, or lanes to be linked lie
  /// more than 0.5 m or 0.5 rad apart. O(lanes and geometries of the roads, connections of the junction).
  void connect(RoadEnd const& a, RoadEnd const& b, std::vector<opendrive::LaneLink> links = {});

  /// Adds a connecting road to a junction: a smooth way (`connecting_curve`) from lanes that leave `from` to lanes that
  /// begin at `to`, along the middle of the first of them, and connects it to both. Its lanes' widths go smoothly from
  /// the one's to the other's. Gives its id. Throws `MapError` as `connect`, for lanes that lead the wrong way, and
  /// where there are none.
  std::string add_turn(std::string const& junction_id, RoadEnd const& from, RoadEnd const& to, TurnPlan plan = {});

  /// What has been made so far. Whoever needs more than the functions above (elevations, marks, a header offset) may
  /// change it, before the next call of another function.
  [[nodiscard]] opendrive::Document const& document() const { return document_; }
  [[nodiscard]] opendrive::Document& document();

  /// A road of the document, whose id is to be left as it is. Throws `MapError` where there is none of that id. O(1).
  [[nodiscard]] opendrive::RoadElement& road(std::string const& id) { return index_.road(document_, id); }
  [[nodiscard]] opendrive::RoadElement const& road(std::string const& id) const { return index_.road(document_, id); }

  /// The map of what has been made so far, checked as a file would be; what is odd goes to `diagnostics`. Throws
  /// `MapError` where there is no road or no lane, and as `build_map`, and `ParameterError` for options out of range.
  [[nodiscard]] std::shared_ptr<Map const> build(MapOptions const& options = {},
                                                 std::vector<Diagnostic>* diagnostics = nullptr) const;

 private:
  /// Files take "-1" for none, and pass over blanks around an id.
  static void check_id(std::string const& what, std::string const& id);

  /// The connecting road of a turn.
  [[nodiscard]] RoadPlan turn_plan(RoadEnd const& from, RoadEnd const& to,
                                   std::vector<opendrive::LaneLink> const& lanes, TurnPlan plan) const;

  [[nodiscard]] opendrive::RoadElement const& checked(RoadEnd const& end) const;

  opendrive::Document document_;
  detail::DocumentIndex index_;
};

}  // namespace cambium::inline v0_1::map

namespace cambium::inline v0_1 {
using map::MapBuilder;
}  // namespace cambium::inline v0_1

#ifndef CAMBIUM_COMPILED
#include "cambium/map/building/map_builder_impl.hpp"
#endif
