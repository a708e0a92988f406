#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "cambium/behavior/drivers.hpp"
#include "cambium/behavior/open_loop/constant_turn.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/dynamics/single_track.hpp"
#include "cambium/execution/interpolate.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/geometry/polygon.hpp"
#include "cambium/geometry/shape.hpp"
#include "cambium/map/corridor/free_corridor.hpp"
#include "cambium/map/lanes/signals.hpp"
#include "cambium/map/map.hpp"
#include "cambium/tracking/detail/rollouts.hpp"
#include "cambium/tracking/detail/track.hpp"
#include "cambium/tracking/detail/ways.hpp"
#include "cambium/tracking/predicted_modes.hpp"
#include "cambium/tracking/tracked_object.hpp"
#include "cambium/tracking/tracker_options.hpp"
#include "cambium/tracking/verdict.hpp"
#include "cambium/world/world.hpp"

namespace cambium::inline v0_1 {

/// The world of a tracker: drivers on their lanes, and what goes its own way.
using TrackedWorld = World<BehaviorSet<UrbanDriver, ConstantTurn>, InterpolateExecution, SingleTrack>;

/// Keeps a world in step with the objects that the host's perception tracks:
///
///     lists of objects  --update-->  verdicts, one an object
///                                    a world: the objects on their lanes and ways, with drivers that fit
///
/// Each list first moves the world on to its stamp, then corrects it. What drivers remember, the routes that fit, and
/// what was learnt of a driver (its desired speed) stay as long as the object does. What a sensor may send never
/// throws: an object is refused, with a reason, and nothing else changes.
///
/// Take a copy of the world to plan in. Its agents' behaviours are alternatives of the world's set:
/// `Driver` on lanes, `ConstantTurn` elsewhere.
template <class WorldType = TrackedWorld, class DriverType = UrbanDriver>
class Tracker {
 public:
  using World = WorldType;
  using Driver = DriverType;
  static_assert(
      World::Behaviors::template contains<Driver> && World::Behaviors::template contains<ConstantTurn>,
      "cambium::Tracker<World, Driver>: the world's BehaviorSet must contain Driver and cambium::ConstantTurn");
  static_assert(
      requires(Driver driver) { driver.law.desired_speed; },
      "cambium::Tracker<World, Driver>: Driver must be a cambium::Driver<Law, Lateral, Heeds...>, such as UrbanDriver");

  /// Throws `WorldError` without a map, `ParameterError` for options out of range. `driver`: what is not learnt of
  /// drivers.
  explicit Tracker(std::shared_ptr<Map const> map, TrackerOptions const& options = {}, Driver const& driver = {})
      : world_(map), options_(options), driver_(driver) {
    check_parameters(options, "tracker");
    detail::check_if_described(driver, "tracker: driver");
    // A way east of all that may be tracked, which leads away from there: on it is whatever is on no lane, always
    // before its begin.
    constexpr double east = 3e8;  // [m]
    std::vector<geometry::Point> const way{{east, 0.0}, {east + 20.0, 0.0}};
    off_lanes_ = detail::numbered_road(*map, {}, map::build_free_corridor(*map, way), "tracker");
  }

  /// The world at the last stamp; its time is counted from the first one. Valid until the next update. Copy it to step
  /// it and to plan in it.
  [[nodiscard]] World const& world() const { return world_; }

  /// As `World::set_light`, `World::add_object`, `World::remove_object`; they last.
  void set_light(LightId id, map::LightPlan const& plan) { world_.set_light(id, plan); }
  ObjectId add_object(geometry::Polygon outline) { return world_.add_object(std::move(outline)); }
  void remove_object(ObjectId id) { world_.remove_object(id); }

  /// The agent of an object; nothing if it is not tracked. O(1).
  [[nodiscard]] std::optional<AgentId> agent_of(ObjectKey const& key) const {
    auto const found = places_.find(key);
    return found == places_.end() ? std::nullopt : std::optional(tracks_[found->second].agent);
  }

  /// The objects that are tracked now, in the order of their agents: those of the last list, and those that it lacked.
  /// Valid until the next update.
  [[nodiscard]] std::span<ObjectKey const> objects() const { return keys_; }

  /// Who drives an object on lanes, with what was learnt of it; nothing if it is not tracked, or on no lane. O(1).
  [[nodiscard]] std::optional<Driver> driver_of(ObjectKey const& key) const {
    auto const found = places_.find(key);
    if (found == places_.end() || tracks_[found->second].ways.empty()) return std::nullopt;
    return driver_of(tracks_[found->second]);
  }

  /// The turn rate of an agent [rad/s], as measured or by its headings; 0 if there is no such agent. O(agents).
  [[nodiscard]] double yaw_rate(AgentId agent) const {
    for (auto const& track : tracks_)
      if (track.agent == agent) return track.last.yaw_rate;
    return 0.0;
  }

  /// Takes a list of objects, measured at `stamp` [ns], any epoch; returns a verdict for each, valid until the next
  /// update. A list that is not newer than the last one is refused: where the clock begins anew, make a new tracker.
  /// Throws nothing but `std::bad_alloc`. O(objects log objects), plus finding a route for those that come into another
  /// lane.
  std::span<Verdict const> update(std::int64_t stamp, std::span<TrackedObject const> objects) {
    verdicts_.assign(objects.size(), {});
    for (std::size_t i = 0; i < objects.size(); ++i) verdicts_[i].key = objects[i].key;
    if (!begins_ && stamp <= stamp_) {
      for (auto& verdict : verdicts_) verdict.refusal = Refusal::too_old;
      return verdicts_;
    }
    double const gap = begins_ ? 0.0 : detail::seconds_between(stamp_, stamp);
    if (begins_ || gap > options_.longest_gap) {
      tracks_.clear();
      begin_ = begins_ ? stamp : begin_;
    } else {
      advance(gap);
    }
    begins_ = false;
    stamp_ = stamp;
    index_tracks();
    for (std::size_t i = 0; i < objects.size(); ++i) take(objects[i], verdicts_[i]);
    forget_unseen();
    rebuild();
    for (auto& verdict : verdicts_)
      if (verdict.refusal == Refusal::none) verdict.motion = tracks_[places_.at(verdict.key)].motion;
    return verdicts_;
  }

  /// Predicts the tracked objects into `states`, an array `[mode, object, step]` of the caller's; each of
  /// `request.modes` modes is a rollout of the world. In a mode an object follows one of its ways, or deviates from
  /// what is expected of it (`Maneuver`). `choose(key, mode)` may return another behaviour of the world's set that
  /// drives the object in that mode, as `std::optional<World::Behavior>`; a `Driver` carries out the maneuver, and is
  /// not taken where the object is on no lane. It must not update the tracker; what it throws passes through.
  /// `mode.probability` is the mode's share of all that the object may do. An object that is not tracked has no mode,
  /// and zeros as states. Rollouts take steps of up to 0.3 s; states between are interpolated. The same request gives
  /// the same bits. Throws `ParameterError` if a number of the request is out of range or `states` is too small
  /// (nothing is written then), or a parameter of a chosen behaviour. O(modes * agents * steps), plus O(agents * modes)
  /// for a joint one.
  template <class Choose>
  PredictedModes predict(PredictionRequest const& request, std::span<PredictedState> states, Choose const& choose) {
    auto const driver = [this](ObjectTrack const& track) { return driver_of(track); };
    return rollouts_.predict(
        typename Rollouts::template Job<decltype(driver)>{world_, tracks_, off_lanes_, request, driver}, states,
        choose);
  }
  PredictedModes predict(PredictionRequest const& request, std::span<PredictedState> states) {
    return predict(request, states, [](auto const&, auto const&) { return std::optional<typename World::Behavior>{}; });
  }

 private:
  using State = typename World::State;
  using Set = typename World::Behaviors;

  using ObjectTrack = detail::ObjectTrack<World>;
  using Rollouts = detail::Rollouts<World, Driver>;

  /// Moves the world, and with it what is predicted of each track, on by `gap` [s].
  void advance(double gap) {
    constexpr double longest = 0.25;  // [s]
    auto const steps = std::max(1.0, std::ceil(gap / longest - 1e-9));
    for (int i = 0; i < static_cast<int>(steps); ++i) static_cast<void>(world_.step(gap / steps));
    for (std::size_t i = 0; i < tracks_.size(); ++i) {
      auto& track = tracks_[i];
      auto const& record = world_.frame().agents[static_cast<Slot>(i)];
      track.memory = record.memory;
      if (record.status != AgentStatus::driving) continue;
      track.state = record.state;
      track.acceleration = static_cast<double>(record.acceleration);
      for (std::size_t k = 1; k < track.ways.size(); ++k) {
        auto& way = track.ways[k];
        way.place = detail::seen_place(world_.map(), *way.road, way.place, track.moving().pose, true);
      }
      if (!track.ways.empty()) track.ways.front().place = record.lane;
    }
  }

  void index_tracks() {
    places_.clear();
    keys_.clear();
    for (std::size_t i = 0; i < tracks_.size(); ++i) {
      places_.emplace(tracks_[i].key, i);
      keys_.push_back(tracks_[i].key);
    }
  }

  void take(TrackedObject const& object, Verdict& verdict) {
    verdict.refusal = detail::fault_of(object, stamp_, options_.existence);
    if (verdict.refusal != Refusal::none) return;
    auto const [entry, is_new] = places_.try_emplace(object.key, tracks_.size());
    if (is_new) {
      tracks_.emplace_back().key = object.key;
      tracks_.back().agent = static_cast<AgentId>(next_agent_++);
    } else if (tracks_[entry->second].seen == stamp_) {
      verdict.refusal = Refusal::duplicate;
      return;
    }
    auto& track = tracks_[entry->second];
    double const since = is_new ? 0.0 : detail::seconds_between(track.seen, stamp_);
    track.seen = stamp_;
    track.measure(object, stamp_, detail::seconds_between(begin_, stamp_), since, verdict);
    if (detail::is_on_foot(object))
      track.ways.clear();
    else
      detail::follow_ways(world_.map(), track.moving(), since, track.ways);
    judge_motion(track, object);
    verdict.agent = track.agent;
    if (!track.ways.empty()) {
      verdict.lane = detail::lane_of(track.ways.front());
      verdict.probability = track.ways.front().odds;
    }
  }

  void judge_motion(ObjectTrack& track, TrackedObject const& object) const {
    constexpr double against = 2.3, bends_off = 0.5, ahead = 2.5, drifts = 0.25;  // [rad], [rad], [s], [m/s]
    bool const stays = object.kind == ObjectClass::obstacle || object.is_parked;
    track.may_drive = !stays && !detail::is_on_foot(object);
    if (stays) {
      track.motion = ObjectMotion::stands;
    } else if (detail::is_on_foot(object)) {
      track.motion = track.state.speed < detail::standing_object ? ObjectMotion::stands : ObjectMotion::walks;
    } else if (track.ways.empty()) {
      auto const& state = track.state;
      bool is_against = false;
      world_.map().for_each_drivable_near({state.x, state.y}, 0.0, [&](map::LaneHit const& hit) {
        double const along = world_.map().lane(hit.lane).path.pose(hit.s).heading;
        is_against = is_against || std::abs(geometry::angle_difference(state.heading, along)) > against;
      });
      track.motion = state.speed < detail::standing_object ? ObjectMotion::stands
                     : track.reverses                      ? ObjectMotion::reverses
                     : is_against                          ? ObjectMotion::wrong_way
                                                           : ObjectMotion::off_lanes;
    } else {
      auto const& way = track.ways.front();
      auto const& line = way.road->corridors[way.place.corridor].center;
      double const there =
          line.pose(std::min(way.place.s + std::max(5.0, ahead * track.state.speed), line.length())).heading;
      double const turn = geometry::angle_difference(there, line.pose(way.place.s).heading);
      double const across = track.state.speed * portable::sin(way.place.heading_error);
      track.motion = std::abs(turn) > bends_off && way.road->route.size() > 1        ? ObjectMotion::turns
                     : std::abs(across) > drifts && across * way.place.lateral > 0.0 ? ObjectMotion::changes_lanes
                                                                                     : ObjectMotion::follows_lane;
    }
  }

  void forget_unseen() {
    std::erase_if(tracks_, [&](ObjectTrack const& track) {
      return detail::seconds_between(track.seen, stamp_) > options_.keep_unseen;
    });
    index_tracks();
  }

  /// Makes the world anew of the tracks, in the order of their agents.
  void rebuild() {
    using Roster = typename World::RosterType;
    auto const& old = world_.roster();
    auto roster = std::make_shared<Roster>();
    static_cast<RosterFacts&>(*roster) = old;
    ++roster->revision;
    roster->largest_shape = {0.0, 0.0, 0.0, 0.0};
    roster->next_agent_id = next_agent_;
    roster->objects = old.objects;
    roster->object_entries = old.object_entries;
    roster->free_roads = {{off_lanes_, off_lanes_}};
    typename World::FrameType frame{detail::seconds_between(begin_, stamp_), world_.frame().step, {}, roster->revision};
    for (std::size_t i = 0; i < tracks_.size(); ++i) {
      auto& track = tracks_[i];
      auto const before = old.slot_of(track.agent);
      auto const& road = track.ways.empty() ? off_lanes_ : track.ways.front().road;
      auto const behavior = behavior_of(track);
      geometry::Pose const pose{track.state.x, track.state.y, track.state.heading};
      bool const goes_on =
          before && old.agents[*before].road == road && old.agents[*before].behavior.index() == behavior.index();
      if (!goes_on) track.memory = Set::initial_memory(behavior);
      Set::was_set(track.memory);
      if (auto* const turn = std::get_if<ConstantTurn::Memory>(&track.memory); turn != nullptr && track.seen == stamp_)
        turn->curvature = track.curvature();
      roster->agents.push_back({track.agent, track.shape, road, behavior, {}, {}, {}});
      roster->assume_goal(nullptr, Slot{});
      roster->largest_shape = geometry::joined(roster->largest_shape, track.shape);
      typename World::Record record{};
      record.state = track.state;
      record.state.time = frame.time;
      record.lane = track.ways.empty() ? map::locate(*road, CorridorId{}, pose) : track.ways.front().place;
      record.action = {track.acceleration, 0.0};
      record.acceleration = static_cast<float>(track.acceleration);
      record.memory = track.memory;
      frame.agents.push_back(std::move(record));
    }
    World const made(world_.shared_map(), roster, std::move(frame));
    world_ = made;  // not moved: it keeps its scratch memory
    learn(*roster);
  }

  [[nodiscard]] typename Set::Any behavior_of(ObjectTrack const& track) const {
    if (track.ways.empty() || track.motion == ObjectMotion::stands) return ConstantTurn{};
    return driver_of(track);
  }

  /// Who drives an object on lanes.
  [[nodiscard]] Driver driver_of(ObjectTrack const& track) const {
    auto driver = driver_;
    if (track.desired_speed > 0.0) driver.law.desired_speed = track.desired_speed;
    if constexpr (requires { driver.heeds.template get<SpeedLimit>(); }) {
      if (track.ways.empty()) return driver;
      auto const& way = track.ways.front();
      double const limit = way.road->corridors[way.place.corridor].speed_limit_at(way.place.s);
      auto& factor = driver.template heed<SpeedLimit>().factor;
      if (limit > 0.0) factor = std::clamp(track.desired_speed / limit, factor, 3.0);
    }
    return driver;
  }

  /// Learns the speed that a driver desires from what it drives while nothing hinders it, and who stands although
  /// nothing makes it wait: that one stays.
  void learn(typename World::RosterType& roster) {
    constexpr double slowest = 2.0, highest = 100.0, near = 20.0, headway = 3.0, pickup = 2.0, starts = 0.3;
    std::vector<Slot> staying;
    for (std::size_t i = 0; i < tracks_.size(); ++i) {
      auto& track = tracks_[i];
      if (track.seen != stamp_ || track.ways.empty() || track.motion == ObjectMotion::stands) continue;
      auto const slot = static_cast<Slot>(i);
      auto const view = world_.observe(slot);
      double const speed = track.state.speed;
      auto const ahead = view.ahead({.distance = 150.0});
      bool const hindered = ahead && ahead->gap < near + headway * speed;
      if (speed < detail::standing_object) {
        if (hindered || track.acceleration > starts || waits_for_right_of_way(view)) continue;
        track.motion = ObjectMotion::stands;
        staying.push_back(slot);
      } else {
        double const now = std::clamp(speed + pickup * std::max(0.0, track.acceleration), slowest, highest);
        track.desired_speed = hindered ? std::max(track.desired_speed, now) : now;
        roster.agents[slot].behavior = behavior_of(track);
      }
    }
    if (staying.empty()) return;
    auto frame = world_.frame();
    for (auto const slot : staying) {
      roster.agents[slot].behavior = ConstantTurn{};
      frame.agents[slot].memory = Set::initial_memory(ConstantTurn{});
    }
    world_.restore(frame);
  }

  /// Whether there is a junction, a light or a stop line close ahead.
  template <class View>
  [[nodiscard]] static bool waits_for_right_of_way(View const& view) {
    constexpr double close = 20.0;  // [m]
    auto const& corridor = view.corridor();
    double const s = view.place().s, until = s + view.shape().front + close;
    auto const is_ahead = [&](double at) { return at > s && at < until; };
    return std::any_of(corridor.signals.begin(), corridor.signals.end(),
                       [&](auto const& sign) { return is_ahead(sign.line); }) ||
           std::any_of(corridor.conflicts.begin(), corridor.conflicts.end(),
                       [&](auto const& conflict) { return is_ahead(conflict.hull().begin); });
  }

  World world_;
  TrackerOptions options_;
  Driver driver_;
  std::shared_ptr<map::RoadCorridor const> off_lanes_;
  std::int64_t stamp_ = 0, begin_ = 0;  ///< of the last list, and of the first one [ns]
  bool begins_ = true;                  ///< there was no list yet
  std::uint32_t next_agent_ = 1;
  std::vector<ObjectTrack> tracks_;  ///< in the order of their agents
  std::unordered_map<ObjectKey, std::size_t> places_;
  std::vector<ObjectKey> keys_;
  std::vector<Verdict> verdicts_;
  Rollouts rollouts_;
};

}  // namespace cambium::inline v0_1
