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
#include "cambium/core/described.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/dynamics/single_track.hpp"
#include "cambium/execution/interpolate.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/geometry/shape.hpp"
#include "cambium/map/corridor/build_corridor.hpp"
#include "cambium/map/corridor/free_corridor.hpp"
#include "cambium/map/map.hpp"
#include "cambium/tracking/tracked_object.hpp"
#include "cambium/tracking/verdict.hpp"
#include "cambium/world/world.hpp"

namespace cambium::inline v0_1 {

/// The world of a tracker: drivers on their lanes, and what goes its own way.
using TrackedWorld = World<BehaviorSet<UrbanDriver, ConstantTurn>, InterpolateExecution, SingleTrack>;

/// How a `Tracker` tracks.
struct TrackerOptions {
  double keep_unseen = 1.0;
  double existence = 0.1;
  double longest_gap = 2.0;

  static constexpr char const* name = "tracker";
  static constexpr auto parameters() {
    using P = TrackerOptions;
    return parameter_list(
        parameter("keep_unseen", &P::keep_unseen, "s", Range{0, 60},
                  "that an object goes on as predicted when its list lacks it"),
        parameter("existence", &P::existence, "-", Range{0, 1}, "probability below which an object is refused"),
        parameter("longest_gap", &P::longest_gap, "s", Range{0.01, 60},
                  "between lists; after a longer one all objects are new"));
  }
};

/// Keeps a world in step with the objects that the host's perception tracks:
///
///     lists of objects  --update-->  verdicts, one an object
///                                    a world: the objects on their lanes and ways, with drivers that fit
///
/// Each list first moves the world on to its stamp, then corrects it. What drivers remember, the routes that fit, and
/// what was learnt of a driver (its desired speed) stay as long as the object does. What a sensor may send never
/// throws: an object is refused, with a reason, and nothing else changes.
///
/// Take the world, or a copy, to plan and predict in. Its agents' behaviours are alternatives of the world's set:
/// `Driver` on lanes, `ConstantTurn` elsewhere.
template <class WorldType = TrackedWorld, class DriverType = UrbanDriver>
class Tracker {
 public:
  using World = WorldType;
  using Driver = DriverType;
  static_assert(
      World::Behaviors::template contains<Driver> && World::Behaviors::template contains<ConstantTurn>,
      "cambium::Tracker<World, Driver>: the world's BehaviorSet must contain Driver and cambium::ConstantTurn");

  /// Throws `WorldError` without a map, `ParameterError` for options out of range. `driver`: what is not learnt of
  /// drivers.
  explicit Tracker(std::shared_ptr<Map const> map, TrackerOptions const& options = {}, Driver const& driver = {})
      : world_(map), options_(options), driver_(driver) {
    check_parameters(options, "tracker");
    detail::check_if_described(driver, "tracker: driver");
    // A way far to the east of the map, which leads away from it: on it is whatever is on no lane, always before its
    // begin.
    auto const& bounds = map->bounds();
    double const east = bounds.min_x <= bounds.max_x ? bounds.max_x + 1e5 : 0.0;
    std::vector<geometry::Point> const way{{east, 0.0}, {east + 20.0, 0.0}};
    off_lanes_ = detail::numbered_road(*map, {}, map::build_free_corridor(*map, way), "tracker");
  }

  /// The world at the last stamp; its time is counted from the first one. Valid until the next update.
  [[nodiscard]] World& world() { return world_; }

  /// The agent of an object; nothing if it is not tracked. O(1).
  [[nodiscard]] std::optional<AgentId> agent_of(ObjectKey const& key) const {
    auto const found = places_.find(key);
    return found == places_.end() ? std::nullopt : std::optional(tracks_[found->second].agent);
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
    double const gap = begins_ ? 0.0 : seconds(stamp, stamp_);
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

 private:
  using State = typename World::State;
  using Set = typename World::Behaviors;

  /// A road that an object may follow, its place there, and how probable that is.
  struct Way {
    std::shared_ptr<map::RoadCorridor const> road;
    map::LanePlace place;
    double odds = 1.0;
  };

  struct Track {
    ObjectKey key;
    AgentId agent;
    std::int64_t seen = 0;
    State state{};              ///< measured, or predicted since
    double acceleration = 0.0;  ///< likewise [m/s^2]
    geometry::Shape shape;
    struct {
      double heading = 0.0, speed = 0.0;          ///< as measured last, of its front
      double acceleration = 0.0, yaw_rate = 0.0;  ///< smoothed, where the host does not measure them
    } last{};
    double desired_speed = 0.0;  ///< learnt; 0: not yet [m/s]
    Motion motion = Motion::none;
    std::vector<Way> ways;  ///< the most probable one first; none: it is off the lanes
    typename Set::Memory memory;
  };

  [[nodiscard]] static double seconds(std::int64_t later, std::int64_t sooner) {
    // As unsigned numbers the difference cannot overflow.
    auto const apart = static_cast<std::uint64_t>(later) - static_cast<std::uint64_t>(sooner);
    return later >= sooner ? 1e-9 * static_cast<double>(apart) : -1e-9 * static_cast<double>(~apart + 1);
  }

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
      if (!track.ways.empty()) track.ways.front().place = record.lane;
    }
  }

  void index_tracks() {
    places_.clear();
    for (std::size_t i = 0; i < tracks_.size(); ++i) places_.emplace(tracks_[i].key, i);
  }

  void take(TrackedObject const& object, Verdict& verdict) {
    verdict.refusal = fault_of(object);
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
    double const since = is_new ? 0.0 : seconds(stamp_, track.seen);
    track.seen = stamp_;
    measure(object, track, since, verdict);
    find_ways(track, is_on_foot(object), since);
    judge_motion(track, object);
    verdict.agent = track.agent;
    if (!track.ways.empty()) {
      verdict.lane = lane_of(track.ways.front());
      verdict.probability = track.ways.front().odds;
    }
  }

  [[nodiscard]] Refusal fault_of(TrackedObject const& object) const {
    constexpr double farthest = 1e8, fastest = 150.0, latest = 1.0;  // [m], [m/s], [s]
    if (!std::isfinite(object.x + object.y + object.vx + object.vy)) return Refusal::not_finite;
    if (std::abs(object.x) > farthest || std::abs(object.y) > farthest ||
        portable::hypot(object.vx, object.vy) > fastest)
      return Refusal::out_of_range;
    if (object.stamp != 0 && std::abs(seconds(stamp_, object.stamp)) > latest) return Refusal::too_old;
    if (!(object.existence >= options_.existence)) return Refusal::unlikely;
    return Refusal::none;
  }

  /// The outline of an object about its reference point, by default that of its class.
  [[nodiscard]] static geometry::Shape shape_of(TrackedObject const& object, bool& is_assumed) {
    struct Size {
      double length, width;
    };
    constexpr Size usual[] = {{4.5, 1.8}, {4.5, 1.8}, {10.0, 2.5}, {12.0, 2.5}, {8.0, 2.5},
                              {2.2, 0.8}, {1.8, 0.6}, {0.5, 0.5},  {0.8, 0.4},  {1.0, 1.0}};
    constexpr double longest = 60.0, widest = 10.0;  // [m]
    auto const place = std::min<std::size_t>(static_cast<std::size_t>(object.kind), std::size(usual) - 1);
    auto const [length, width] = usual[place];
    auto const known = [&](double size, double most) { return size > 0.05 && size <= most; };
    is_assumed = !known(object.length, longest) || !known(object.width, widest);
    double const l = known(object.length, longest) ? object.length : length;
    double const w = known(object.width, widest) ? object.width : width;
    bool const has_axles = object.kind < ObjectClass::motorcycle;
    double const rear = has_axles ? 0.2 * l : 0.5 * l;
    return {l - rear, rear, 0.5 * w, 0.5 * w};
  }

  [[nodiscard]] static geometry::Point direction(double heading) {
    auto const [sin, cos] = portable::sin_cos(heading);
    return {cos, sin};
  }

  [[nodiscard]] static bool is_on_foot(TrackedObject const& object) {
    return object.kind == ObjectClass::pedestrian || object.kind == ObjectClass::animal;
  }

  /// Takes what was measured into the track, `since` [s] the last time, as the state of the reference point at the
  /// stamp of the list, with the heading in which it moves.
  void measure(TrackedObject const& object, Track& track, double since, Verdict& verdict) const {
    constexpr double moves = 0.5, hardest = 10.0, tightest = 1.5, smoothing = 0.3;  // [m/s], [m/s^2], [rad/s], [-]
    auto& last = track.last;
    track.shape = shape_of(object, verdict.assumed_size);
    double const over_ground = portable::hypot(object.vx, object.vy);
    double const before = since > 0.0 ? last.heading : std::isfinite(object.heading) ? object.heading : 0.0;
    double const towards = over_ground > moves ? portable::atan2(object.vy, object.vx) : before;
    double heading = object.heading;
    verdict.assumed_heading = object.heading_known == HeadingKnown::no || !std::isfinite(heading);
    if (verdict.assumed_heading || is_on_foot(object))
      heading = towards;
    else if (object.heading_known == HeadingKnown::up_to_sign &&
             std::abs(geometry::angle_difference(heading, towards)) > 0.5 * geometry::pi)
      heading += geometry::pi;
    heading = geometry::normalize_angle(heading);
    double const along = object.vx * portable::cos(heading) + object.vy * portable::sin(heading);
    auto const smooth = [&](double from, double measured, double by_difference, double most) {
      double const value = std::isfinite(measured) ? measured
                           : since > 0.0           ? from + smoothing * (by_difference - from)
                                                   : 0.0;
      return std::clamp(value, -most, most);
    };
    double const per = since > 0.0 ? 1.0 / since : 0.0;
    last.yaw_rate =
        smooth(last.yaw_rate, object.yaw_rate, geometry::angle_difference(heading, last.heading) * per, tightest);
    last.acceleration = smooth(last.acceleration, object.acceleration, (along - last.speed) * per, hardest);
    last.heading = heading;
    last.speed = along;

    double const late = object.stamp == 0 ? 0.0 : seconds(stamp_, object.stamp), turn = last.yaw_rate * late;
    geometry::Point at{object.x, object.y};
    if (object.point == ObjectPoint::box_center) at = at - track.shape.center_offset() * direction(heading);
    at = at + along * late * direction(heading + 0.5 * turn);
    double speed = along + last.acceleration * late;
    heading += turn;
    track.acceleration = last.acceleration;
    if (along < -standing) {  // it reverses: its rear goes first
      heading += geometry::pi;
      std::swap(track.shape.front, track.shape.rear);
      speed = -speed;
      track.acceleration = -track.acceleration;
    }
    track.state.time = seconds(stamp_, begin_);
    track.state.x = at.x();
    track.state.y = at.y();
    track.state.heading = geometry::normalize_angle(heading);
    track.state.speed = std::max(0.0, speed);
  }

  /// The lane of a way at its place.
  [[nodiscard]] static LaneId lane_of(Way const& way) {
    return way.road->corridors[way.place.corridor].pieces[way.place.piece].lane;
  }

  /// How well a way fits a track, as the logarithm of a likelihood; -infinity where it does not.
  [[nodiscard]] static double fit(Track const& track, Way const& way) {
    constexpr double aside = 0.7, aslant = 0.15, turning = 0.15;  // standard deviations [m], [rad], [rad/s]
    auto const& corridor = way.road->corridors[way.place.corridor];
    auto const widths = corridor.widths_at(way.place.s, way.place.segment);
    double const lateral = way.place.lateral, outside = std::max(lateral - widths.left, -widths.right - lateral);
    if (outside > farthest_outside || std::abs(way.place.heading_error) > most_aslant ||
        way.place.s > corridor.length())
      return -std::numeric_limits<double>::infinity();
    auto const& segment = corridor.center.segments()[way.place.segment];
    double const turn = track.last.yaw_rate - segment.curvature * track.state.speed;
    auto const square = [](double x) { return x * x; };
    return -0.5 * (square(lateral / aside) + square(way.place.heading_error / aslant) + square(turn / turning));
  }

  /// Follows the ways of a track, or finds new ones where it has come into another lane or fits none.
  void find_ways(Track& track, bool on_foot, double since) {
    constexpr double independent = 0.4;  // [s] after which measurements are new evidence
    if (on_foot) return track.ways.clear();
    geometry::Pose const pose{track.state.x, track.state.y, track.state.heading};
    double best = -std::numeric_limits<double>::infinity();
    std::vector<double> fits;
    for (auto& way : track.ways) {
      way.place = detail::seen_place(world_.map(), *way.road, way.place, pose, true);
      fits.push_back(fit(track, way));
      best = std::max(best, fits.back());
    }
    if (!(best > -std::numeric_limits<double>::infinity())) {
      track.ways.clear();
    } else {
      for (std::size_t i = 0; i < fits.size(); ++i)
        track.ways[i].odds *= portable::exp(std::min(1.0, since / independent) * (fits[i] - best));
      normalize(track.ways);
    }
    if (track.ways.empty() || lane_of(track.ways.front()) != track.ways.front().road->route.front())
      track.ways = ways_at(track, pose);
  }

  static void normalize(std::vector<Way>& ways) {
    constexpr double negligible = 0.002;
    constexpr std::size_t most = 6;
    for (auto way = ways.begin(); way != ways.end(); ++way) {  // they are few, and mostly in order
      auto const at =
          std::upper_bound(ways.begin(), way, *way, [](Way const& a, Way const& b) { return a.odds > b.odds; });
      std::rotate(at, way, way + 1);
    }
    double sum = 0.0;
    for (auto const& way : ways) sum += way.odds;
    std::erase_if(ways, [&](Way const& way) { return !(way.odds > negligible * sum); });
    if (ways.size() > most) ways.resize(most);
    sum = 0.0;
    for (auto const& way : ways) sum += way.odds;
    for (auto& way : ways) way.odds /= sum;
  }

  /// The ways from where a track is. Those that go on like one that it had are as probable as that.
  [[nodiscard]] std::vector<Way> ways_at(Track const& track, geometry::Pose const& pose) {
    std::vector<Way> ways;
    auto const& map = world_.map();
    map.for_each_drivable_near(pose.position(), farthest_outside, [&](map::LaneHit const& hit) {
      auto const& lane = map.lane(hit.lane);
      double const error = geometry::angle_difference(pose.heading, lane.path.pose(hit.s).heading);
      if (std::abs(error) > most_aslant || hit.s < -1.0 || hit.s > lane.length() + 1.0) return;
      auto const& roads = roads_from(hit.lane);
      for (auto const& road : roads) {
        map::LanePlace hint;
        auto const& corridor = road->corridors[road->main];
        hint.segment = corridor.center.find(std::clamp(hit.s, 0.0, corridor.length()));
        Way way{road, map::locate(*road, road->main, pose, hint), 1.0};
        double const likelihood = fit(track, way);
        way.odds = inherited(track.ways, *road, roads.size()) * portable::exp(std::max(-700.0, likelihood));
        if (way.odds > 0.0 && likelihood > -std::numeric_limits<double>::infinity()) ways.push_back(std::move(way));
      }
    });
    if (!ways.empty()) normalize(ways);
    return ways;
  }

  /// The odds before anything was measured there of a road among `forks` that begin in its lane.
  [[nodiscard]] static double inherited(std::vector<Way> const& before, map::RoadCorridor const& road,
                                        std::size_t forks) {
    constexpr double unforeseen = 0.02;
    double odds = before.empty() ? 1.0 : unforeseen;
    auto const& route = road.route;
    for (auto const& way : before) {
      auto const& old = way.road->route;
      auto const at = std::find(old.begin(), old.end(), route.front());
      if (at == old.end()) continue;
      auto const same = std::mismatch(at, old.end(), route.begin(), route.end());
      if (same.first == old.end() || same.second == route.end() || same.first - at > 1) odds += way.odds;
    }
    return odds / static_cast<double>(forks);
  }

  /// The roads along the routes from a lane: straight on, and by each way at the next fork. Kept, since building one
  /// takes a millisecond.
  [[nodiscard]] std::vector<std::shared_ptr<map::RoadCorridor const>> const& roads_from(LaneId lane) {
    constexpr double forks_within = 120.0, far = 300.0;  // [m]
    constexpr std::size_t most_kept = 4096;
    auto const found = roads_.find(lane);
    if (found != roads_.end()) return found->second;
    if (roads_.size() >= most_kept) roads_.clear();
    auto const& map = world_.map();
    std::vector<LaneId> stem{lane};
    double ahead = 0.0;
    auto const next_of = [&](LaneId id) {
      auto next = map.lane(id).successors;
      std::erase_if(next, [&](LaneId after) {
        return !map.lane(after).drivable() || std::find(stem.begin(), stem.end(), after) != stem.end();
      });
      return next;
    };
    auto next = next_of(lane);
    while (next.size() == 1 && ahead < forks_within) {
      stem.push_back(next.front());
      ahead += map.lane(next.front()).length();
      next = next_of(stem.back());
    }
    std::vector<map::Route> routes;
    if (next.size() > 1 && ahead < forks_within) {
      for (auto const after : next) routes.push_back(map::straight_route(map, after, far));
    } else {
      auto const last = stem.back();
      stem.pop_back();
      routes.push_back(map::straight_route(map, last, far));
    }
    std::vector<std::shared_ptr<map::RoadCorridor const>> roads;
    for (auto& route : routes) {
      auto const again = [&](LaneId id) { return std::find(stem.begin(), stem.end(), id) != stem.end(); };
      route.lanes.erase(std::find_if(route.lanes.begin(), route.lanes.end(), again), route.lanes.end());
      route.lanes.insert(route.lanes.begin(), stem.begin(), stem.end());
      roads.push_back(map::build_road_corridor(map, route));
    }
    return roads_.emplace(lane, std::move(roads)).first->second;
  }

  void judge_motion(Track& track, TrackedObject const& object) const {
    constexpr double against = 2.3, bends_off = 0.5, ahead = 2.5, drifts = 0.25;  // [rad], [rad], [s], [m/s]
    if (object.kind == ObjectClass::obstacle || object.is_parked) {
      track.motion = Motion::stands;
    } else if (is_on_foot(object)) {
      track.motion = track.state.speed < standing ? Motion::stands : Motion::walks;
    } else if (track.ways.empty()) {
      auto const& state = track.state;
      bool is_against = false;
      world_.map().for_each_drivable_near({state.x, state.y}, 0.0, [&](map::LaneHit const& hit) {
        double const along = world_.map().lane(hit.lane).path.pose(hit.s).heading;
        is_against = is_against || std::abs(geometry::angle_difference(state.heading, along)) > against;
      });
      track.motion = state.speed < standing ? Motion::stands : is_against ? Motion::wrong_way : Motion::off_lanes;
    } else {
      auto const& way = track.ways.front();
      auto const& line = way.road->corridors[way.place.corridor].center;
      double const there =
          line.pose(std::min(way.place.s + std::max(5.0, ahead * track.state.speed), line.length())).heading;
      double const turn = geometry::angle_difference(there, line.pose(way.place.s).heading);
      double const across = track.state.speed * portable::sin(way.place.heading_error);
      track.motion = std::abs(turn) > bends_off && way.road->route.size() > 1        ? Motion::turns
                     : std::abs(across) > drifts && across * way.place.lateral > 0.0 ? Motion::changes_lanes
                                                                                     : Motion::follows_lane;
    }
  }

  void forget_unseen() {
    std::erase_if(tracks_, [&](Track const& track) { return seconds(stamp_, track.seen) > options_.keep_unseen; });
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
    typename World::FrameType frame{seconds(stamp_, begin_), world_.frame().step, {}, roster->revision};
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
        turn->curvature = curvature_of(track);
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
    world_ = World(world_.shared_map(), roster, std::move(frame));
    learn(*roster);
  }

  [[nodiscard]] static double curvature_of(Track const& track) {
    constexpr double tightest = 0.2, slow = 1.0;  // [1/m], [m/s]
    return std::clamp(track.last.yaw_rate / std::max(slow, track.state.speed), -tightest, tightest);
  }

  [[nodiscard]] typename Set::Any behavior_of(Track const& track) const {
    if (track.ways.empty() || track.motion == Motion::stands) return ConstantTurn{};
    auto driver = driver_;
    if (track.desired_speed > 0.0) driver.law.desired_speed = track.desired_speed;
    if constexpr (requires { driver.template heed<SpeedLimit>(); }) {
      auto const& way = track.ways.front();
      double const limit = way.road->corridors[way.place.corridor].speed_limit_at(way.place.s);
      auto& factor = driver.template heed<SpeedLimit>().factor;
      factor = std::clamp(track.desired_speed / limit, factor, 3.0);
    }
    return driver;
  }

  /// Learns the speed that a driver desires from what it drives while nothing hinders it, and who stands although
  /// nothing makes it wait: that one stays.
  void learn(typename World::RosterType& roster) {
    constexpr double slowest = 2.0, near = 20.0, headway = 3.0, pickup = 2.0, starts = 0.3;
    std::vector<Slot> staying;
    for (std::size_t i = 0; i < tracks_.size(); ++i) {
      auto& track = tracks_[i];
      if (track.seen != stamp_ || track.ways.empty() || track.motion == Motion::stands) continue;
      auto const slot = static_cast<Slot>(i);
      auto const view = world_.observe(slot);
      double const speed = track.state.speed;
      auto const ahead = view.ahead({.distance = 150.0});
      bool const hindered = ahead && ahead->gap < near + headway * speed;
      if (speed < standing) {
        if (hindered || track.acceleration > starts || waits_for_right_of_way(view)) continue;
        track.motion = Motion::stands;
        staying.push_back(slot);
      } else {
        double const now = std::max(slowest, speed + pickup * std::max(0.0, track.acceleration));
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

  static constexpr double standing = 0.3;          ///< slower counts as standing [m/s]
  static constexpr double most_aslant = 0.8;       ///< to its lane: more is off the lanes [rad]
  static constexpr double farthest_outside = 0.5;  ///< of its lane: likewise [m]

  World world_;
  TrackerOptions options_;
  Driver driver_;
  std::shared_ptr<map::RoadCorridor const> off_lanes_;
  std::int64_t stamp_ = 0, begin_ = 0;  ///< of the last list, and of the first one [ns]
  bool begins_ = true;                  ///< there was no list yet
  std::uint32_t next_agent_ = 1;
  std::vector<Track> tracks_;  ///< in the order of their agents
  std::unordered_map<ObjectKey, std::size_t> places_;
  std::unordered_map<LaneId, std::vector<std::shared_ptr<map::RoadCorridor const>>> roads_;
  std::vector<Verdict> verdicts_;
};

}  // namespace cambium::inline v0_1
