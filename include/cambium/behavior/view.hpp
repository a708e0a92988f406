#pragma once

#include <cstdint>
#include <optional>

#include "cambium/core/ids.hpp"
#include "cambium/core/plan.hpp"
#include "cambium/core/random.hpp"
#include "cambium/dynamics/single_track.hpp"
#include "cambium/geometry/shape.hpp"
#include "cambium/map/corridor/corridor.hpp"
#include "cambium/map/corridor/lane_place.hpp"
#include "cambium/map/map.hpp"

namespace cambium::inline v0_1 {

namespace geometry {
class Polygon;
}

/// A road user as a view finds it: an agent or a static object. `ViewArchetype::state`, `shape` and `acceleration` give
/// more about an agent, `outline` about an object.
struct RoadUser {
  AgentId agent = none<AgentId>;     ///< the agent; none for a static object
  ObjectId object = none<ObjectId>;  ///< the static object; none for an agent
  Slot slot{};                       ///< index among the agents or the objects
  double gap{};  ///< free road to it, bumper to bumper [m]; negative where the two overlap lengthwise; in a lane that
                 ///< merges further ahead: see `gap_before_merge`; 0 where the query has no direction, as `around`
                 ///< in the plane
  double s{};    ///< position of its reference point, on the lane corridor or in the lane coordinate of the query [m]
  double front{}, rear{};  ///< extent from there along the lane, ahead and behind [m]
  double speed{};          ///< along its lane [m/s]

  [[nodiscard]] double length() const { return front + rear; }  ///< along its lane [m]
};

/// How a query along a lane corridor treats road users in lanes that merge into the corridor further ahead.
enum class Merging : std::uint8_t {
  counts,     ///< like those in the corridor, by their position relative to the merge
  by_rule,    ///< likewise, except in junctions, where the right of way decides, see `LaneCorridor::conflicts`
  ignored,    ///< until they have reached the merge, so that the driver opens no gap
  gives_way,  ///< like `counts`; the driver also waits for a gap before those behind, see `KeepLane::gap_to_wait_for`
};

/// Options of a query along a lane corridor.
struct Look {
  static constexpr double horizon = 400.0;  ///< no query looks farther [m]

  Merging merging = Merging::counts;
  double distance = horizon;  ///< longest distance along the corridor to the other's reference point [m]
};

/// Everything that a behaviour may ask of its view; `ObservedWorld` offers it, and `goal` and `predict` for planners.
/// Concepts are checked against this type, whose functions are only declared. SI units, map frame, radians. Nothing
/// tells of road users that the observer does not see.
struct ViewArchetype {
  using State = cambium::State;
  using Dynamics = SingleTrack;

  /// @name The agent itself
  ///@{
  [[nodiscard]] AgentId id() const;
  [[nodiscard]] double time() const;                               ///< of the frame that is seen [s]
  [[nodiscard]] State const& state() const;                        ///< own state, as observed
  [[nodiscard]] double last_acceleration() const;                  ///< own, over the last step [m/s^2]
  [[nodiscard]] geometry::Shape const& shape() const;              ///< own shape
  [[nodiscard]] Dynamics const& dynamics() const;                  ///< own vehicle model
  [[nodiscard]] RandomStream random(std::uint32_t purpose) const;  ///< own stream for (seed, agent, step, purpose)
  ///@}

  /// @name Where it is, and where it goes
  ///@{
  [[nodiscard]] Map const& map() const;
  [[nodiscard]] map::RoadCorridor const& road() const;            ///< all lanes along the own route
  [[nodiscard]] map::LaneCorridor const& corridor() const;        ///< the lane corridor that the agent is in
  [[nodiscard]] map::LanePlace const& place() const;              ///< its own place there
  [[nodiscard]] map::LanePlace place(CorridorId corridor) const;  ///< its place in another one
  [[nodiscard]] bool has_goal() const;                            ///< whether the lane in which the route ends matters
  ///@}

  /// @name Who is ahead and behind along the lanes
  ///@{
  [[nodiscard]] std::optional<RoadUser> ahead(Look const& = {}) const;   ///< next road user along the own lane corridor
  [[nodiscard]] std::optional<RoadUser> behind(Look const& = {}) const;  ///< next one behind
  /// The next road user ahead of (behind) a place on a lane corridor of the road, as if the agent were there.
  [[nodiscard]] std::optional<RoadUser> ahead(map::LanePlace const& place, Look const& = {}) const;
  [[nodiscard]] std::optional<RoadUser> behind(map::LanePlace const& place, Look const& = {}) const;
  /// Calls `f(RoadUser)` for the next road user along the own lane corridor, then for the next one in each lane that
  /// merges into it or has just split off: all to whom a driver keeps a gap.
  template <class F>
  void each_ahead(Look const& look, F&& f) const;
  /// The foremost road user, in the lanes that merge into the own corridor at `merge`, whose `s` does not exceed
  /// `limit`.
  [[nodiscard]] std::optional<RoadUser> merging(double merge, double limit) const;
  ///@}

  /// @name Who is near
  ///@{
  /// Calls `f(RoadUser)` for the agents along a corridor within `distance` [m] of a place, then for the next objects
  /// ahead and behind. May report an agent more than once.
  template <class F>
  void around(map::LanePlace const& place, double distance, F&& f) const;
  template <class F>
  void around(double distance, F&& f) const;  ///< for agents nearby, in any lane or none
  template <class F>
  void off_lanes(double distance, F&& f) const;  ///< for agents nearby that are on no drivable lane of their own
  template <class F>
  void on_lane(double index_begin, double index_end, F&& f) const;  ///< for agents that overlap a stretch of a lane
  template <class F>
  void for_each_object(F&& f) const;             ///< `f(id, outline)` for each static object; the outline is a polygon
  [[nodiscard]] bool anybody_off_lanes() const;  ///< it sees such an agent, however far
  [[nodiscard]] bool anybody_leaves_room() const;       ///< it sees one that drives aside in its lane: others may fit
  [[nodiscard]] geometry::Shape largest_shape() const;  ///< holds the own one and those of all that it sees
  ///@}

  /// @name What one of them is like
  ///@{
  [[nodiscard]] State const& state(RoadUser const& agent) const;  ///< as observed
  [[nodiscard]] geometry::Shape const& shape(RoadUser const& agent) const;
  [[nodiscard]] double acceleration(RoadUser const& agent) const;  ///< over the last step, along its heading [m/s^2]
  [[nodiscard]] geometry::Polygon const& outline(RoadUser const& object) const;
  [[nodiscard]] bool signals_way(RoadUser const& user, LaneId lane) const;  ///< its turn signal permits that way
  /// The section that it is in at a conflict, with positions on the way by which it comes; the sizes are
  /// its own, that of this agent, and the largest (see `map::LaneCorridor::section_of`). Nothing where its turn signals
  /// show another way.
  [[nodiscard]] std::optional<map::ConflictSection> section(RoadUser const& user, map::Conflict const& conflict,
                                                            bool is_large, bool own_large, bool any_large) const;
  ///@}

  /// @name Lights
  ///@{
  [[nodiscard]] map::LightColor light(LightId id) const;  ///< current colour of a traffic light
  [[nodiscard]] double shown_for(LightId id) const;       ///< time for which it has shown that colour [s]
  [[nodiscard]] double red_for(LightId id) const;         ///< time since it turned red [s]; negative: until it does
  ///@}
};

}  // namespace cambium::inline v0_1
