#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "cambium/core/ids.hpp"
#include "cambium/core/plan.hpp"
#include "cambium/core/random.hpp"
#include "cambium/dynamics/single_track.hpp"
#include "cambium/geometry/shape.hpp"
#include "cambium/map/corridor.hpp"
#include "cambium/map/lane_position.hpp"
#include "cambium/map/map.hpp"

namespace cambium {

/// The next road user ahead or behind along a lane corridor.
struct Neighbor {
  AgentId agent = none<AgentId>;     ///< who it is; none where it is a static object
  ObjectId object = none<ObjectId>;  ///< what it is; none where it is an agent
  double gap{};  ///< free road between the two, bumper to bumper [m]; negative where they overlap lengthwise. Where the
                 ///< other is in a merging lane and the merge is still ahead: see `TrafficIndex::gap_between`.
  double speed{};        ///< of the other along its lane [m/s]
  double length{};       ///< of the other along its lane [m]
  std::uint32_t slot{};  ///< its place among the agents or the objects
};

/// The next road users ahead and behind on one lane corridor, and the own place there.
struct Neighbors {
  std::optional<Neighbor> front, rear;
  map::LanePosition position;
};

/// A road user in a lane that is still to merge into the own lane corridor, by where it will be there.
struct MergingNeighbor {
  AgentId agent = none<AgentId>;
  double s{};      ///< of its reference point: as far from the merge as it is on its own lane [m]
  double front{};  ///< how far it reaches from there forward [m]
  double rear{};   ///< and back [m]
  double speed{};  ///< [m/s]
};

/// A place on another lane corridor beside the own one: to ask for neighbours there, see `ViewArchetype::beside`.
struct BesidePlace {
  double s{};               ///< along the corridor's centre line [m]
  std::uint32_t segment{};  ///< of the centre line there
  std::uint16_t corridor = map::no_corridor;
  std::uint16_t piece{};
  std::size_t entry{};  ///< where the search for neighbours begins
};

/// A road user somewhere on a lane: an agent, or an object.
struct LaneUser {
  AgentId agent = none<AgentId>;     ///< who it is; none where it is a static object
  ObjectId object = none<ObjectId>;  ///< what it is; none where it is an agent
  double position{};                 ///< of its reference point, lane coordinate [m]
  double front{}, rear{};            ///< its reach from there along the lane [m]
  double speed{};                    ///< along the lane [m/s]
  std::uint32_t slot{};              ///< its place among the agents or the objects
  geometry::Shape shape{};           ///< of an agent
};

/// Another agent as seen by an observer.
template <MotionState S>
struct ObservedAgent {
  AgentId id = none<AgentId>;
  S state;
  geometry::Shape shape;
  double acceleration{};  ///< over the last step, along its heading [m/s^2]: what brake lights tell
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
  [[nodiscard]] map::RoadCorridor const& road() const;                          ///< the lanes of the own route
  [[nodiscard]] map::LaneCorridor const& corridor() const;                      ///< the lane corridor the agent is in
  [[nodiscard]] map::LanePosition const& lane_position() const;                 ///< where it is in there
  [[nodiscard]] map::LanePosition lane_position(std::uint16_t corridor) const;  ///< and on another one of the road
  [[nodiscard]] std::optional<Neighbor> front() const;          ///< next ahead along the own lane corridor
  [[nodiscard]] std::optional<Neighbor> front_by_rule() const;  ///< but for those who are still to merge in a junction
  [[nodiscard]] std::optional<Neighbor> rear() const;           ///< next behind
  [[nodiscard]] Neighbors neighbors(std::uint16_t corridor) const;  ///< both, along another lane corridor of the road
  /// Calls `f(ObservedAgent)` for who is near along a lane corridor; returns the next objects there.
  template <class F>
  Neighbors for_each_near(std::uint16_t corridor, double distance, F&& f) const;
  [[nodiscard]] BesidePlace beside(std::uint16_t corridor) const;  ///< the place there beside the own one, and from it
  [[nodiscard]] std::optional<Neighbor> front(BesidePlace const& place) const;  ///< next ahead
  [[nodiscard]] std::optional<Neighbor> rear(BesidePlace const& place) const;   ///< next behind
  [[nodiscard]] std::optional<Neighbor> front_in_lane() const;  ///< as `front`, without lanes that are still to merge
  [[nodiscard]] std::optional<MergingNeighbor> merging(double merge, double behind) const;  ///< the foremost behind
  [[nodiscard]] AgentId id() const;
  [[nodiscard]] bool has_goal() const;  ///< whether it matters in which lane the route ends
  [[nodiscard]] ObservedAgent<State> agent(Neighbor const& neighbor) const;  ///< the neighbour itself; not of objects
  template <class F>
  void for_each_on_lane(double index_begin, double index_end, F&& f) const;  ///< `f(LaneUser)` for those who reach in
  template <class F>
  void for_each_around(double distance, F&& f) const;  ///< `f(ObservedAgent)` for who is near, on whatever lane or none
  template <class F>
  void for_each_object(F&& f) const;  ///< `f(id, outline)` for the static objects, outlines as polygons
  [[nodiscard]] bool signals_way(LaneUser const& user,
                                 LaneId lane) const;      ///< whether its turn signal says that it will come by `lane`
  [[nodiscard]] map::LightColor light(LightId id) const;  ///< what a traffic light shows now
  [[nodiscard]] RandomStream random(
      std::uint32_t purpose) const;  ///< numbers of their own for (seed, agent, step, purpose)
};

}  // namespace cambium
