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

namespace cambium {

namespace geometry {
class Polygon;
}

/// A road user as a view finds it: an agent, or a static object. `ViewArchetype::state`, `shape` and `acceleration`
/// tell more of an agent, `outline` of an object.
struct RoadUser {
  AgentId agent = none<AgentId>;     ///< who it is; none where it is a static object
  ObjectId object = none<ObjectId>;  ///< what it is; none where it is an agent
  Slot slot{};                       ///< its place among the agents or the objects
  double gap{};  ///< free road to it, bumper to bumper [m]; negative where the two overlap lengthwise. Where it
                 ///< is in a lane whose merge is still ahead: see `map::gap_before_merge`. 0 where none is asked
                 ///< for, as in a circle
  double s{};    ///< of its reference point, on the lane corridor or in the lane coordinate that was asked of [m]
  double front{}, rear{};  ///< how far it reaches from there along the lane [m]
  double speed{};          ///< along its lane [m/s]

  [[nodiscard]] double length() const { return front + rear; }  ///< along its lane [m]
};

/// How those count who are in a lane that is still to merge into the lane corridor asked of.
enum class Merging : std::uint8_t {
  counts,   ///< as those in the corridor, by where they will be at the merge
  by_rule,  ///< so, but not in junctions: there the right of way says who goes first, see `LaneCorridor::conflicts`
  ignored,
};

/// What counts when a view looks along a lane corridor.
struct Look {
  static constexpr double horizon = 400.0;  ///< nobody is found farther away [m]

  Merging merging = Merging::counts;
  double distance = horizon;  ///< along the corridor, to the reference point, at most [m]
};

/// The least a behaviour may ask of what it sees; `ObservedWorld` offers it. Concepts are checked against this type,
/// whose functions are declared only. Angles, frames and units as everywhere: SI, map frame, radians.
struct ViewArchetype {
  using State = cambium::State;
  using Dynamics = SingleTrack;

  [[nodiscard]] double time() const;                   ///< of the frame that is seen [s]
  [[nodiscard]] State const& state() const;            ///< own state, as observed
  [[nodiscard]] geometry::Shape const& shape() const;  ///< own shape
  [[nodiscard]] Dynamics const& dynamics() const;      ///< own vehicle model
  [[nodiscard]] Map const& map() const;
  [[nodiscard]] map::RoadCorridor const& road() const;                   ///< the lanes of the own route
  [[nodiscard]] map::LaneCorridor const& corridor() const;               ///< the lane corridor the agent is in
  [[nodiscard]] map::LanePlace const& place() const;                     ///< where it is in there
  [[nodiscard]] map::LanePlace place(CorridorId corridor) const;         ///< and on another one of the road
  [[nodiscard]] std::optional<RoadUser> ahead(Look const& = {}) const;   ///< next along the own lane corridor
  [[nodiscard]] std::optional<RoadUser> behind(Look const& = {}) const;  ///< the same to the rear
  /// The next ahead of a place on a lane corridor of the road, or behind it, as if the agent were there.
  [[nodiscard]] std::optional<RoadUser> ahead(map::LanePlace const& place, Look const& = {}) const;
  [[nodiscard]] std::optional<RoadUser> behind(map::LanePlace const& place, Look const& = {}) const;
  /// Of those in lanes that merge into the own corridor at `merge`, the foremost that is not beyond `limit`, in its
  /// `s`.
  [[nodiscard]] std::optional<RoadUser> merging(double merge, double limit) const;
  /// Calls `f(RoadUser)` for the agents that are along a corridor within `distance` [m] of a place, then for the next
  /// objects ahead and behind; for some agents more than once.
  template <class F>
  void around(map::LanePlace const& place, double distance, F&& f) const;
  template <class F>
  void around(double distance, F&& f) const;  ///< for the agents that are near, on whatever lane or none
  template <class F>
  void on_lane(double index_begin, double index_end, F&& f) const;  ///< for all who reach into a stretch of a lane
  template <class F>
  void for_each_object(F&& f) const;  ///< `f(id, outline)` for the static objects, outlines as polygons
  [[nodiscard]] State const& state(RoadUser const& agent) const;  ///< as observed
  [[nodiscard]] geometry::Shape const& shape(RoadUser const& agent) const;
  [[nodiscard]] double acceleration(RoadUser const& agent) const;  ///< over the last step, along its heading [m/s^2]
  [[nodiscard]] geometry::Polygon const& outline(RoadUser const& object) const;
  [[nodiscard]] bool signals_way(RoadUser const& user,
                                 LaneId lane) const;      ///< its turn signal says that it comes by it
  [[nodiscard]] map::LightColor light(LightId id) const;  ///< what a traffic light shows now
  [[nodiscard]] AgentId id() const;
  [[nodiscard]] bool has_goal() const;                             ///< it matters in which lane the route ends
  [[nodiscard]] RandomStream random(std::uint32_t purpose) const;  ///< of its own for (seed, agent, step, purpose)
};

}  // namespace cambium
