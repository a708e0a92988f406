#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <numeric>
#include <optional>
#include <span>
#include <utility>
#include <variant>
#include <vector>

#include "cambium/behavior/heed/conflicts.hpp"
#include "cambium/behavior/open_loop/constant_turn.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/geometry/pose.hpp"
#include "cambium/map/corridor/lane_place.hpp"
#include "cambium/tracking/detail/options.hpp"
#include "cambium/tracking/detail/track.hpp"
#include "cambium/tracking/detail/ways.hpp"
#include "cambium/tracking/predicted_modes.hpp"
#include "cambium/world/world.hpp"

namespace cambium::inline v0_1::detail {

/// A state of an object as its host gives it, and back: of its point, with the heading of its front.
template <class ObjectTrack, class State>
[[nodiscard]] PredictedState seen_by_host(ObjectTrack const& track, State const& state) {
  auto const at = geometry::Point{state.x, state.y} + track.to_point() * direction(state.heading);
  return {at.x(), at.y(), geometry::normalize_angle(state.heading + (track.reverses ? geometry::pi : 0.0)),
          track.reverses ? -state.speed : state.speed};
}
template <class ObjectTrack, class State>
void set_from_host(ObjectTrack const& track, PredictedState const& seen, State& state) {
  state.heading = geometry::normalize_angle(seen.heading + (track.reverses ? geometry::pi : 0.0));
  auto const at = geometry::Point{seen.x, seen.y} - track.to_point() * direction(state.heading);
  state.x = at.x();
  state.y = at.y();
  state.speed = std::max(0.0, track.reverses ? -seen.speed : seen.speed);
}

/// A trajectory with the headings and speeds that are missing, up to the first position that is not finite.
inline void complete(PredictedState before, std::span<PredictedState const> given, double step, std::size_t steps,
                     std::vector<PredictedState>& states) {
  constexpr double moves = 0.05, farthest = 1e8, highest_speed = 150.0;  // [m], [m], [m/s]
  states.clear();
  for (auto state : given) {
    if (states.size() == steps || !(std::abs(state.x) <= farthest && std::abs(state.y) <= farthest)) break;
    double const dx = state.x - before.x, dy = state.y - before.y, way = portable::hypot(dx, dy);
    if (!std::isfinite(state.heading)) state.heading = way > moves ? portable::atan2(dy, dx) : before.heading;
    if (!std::isfinite(state.speed)) state.speed = way / step;
    state.speed = std::clamp(state.speed, -highest_speed, highest_speed);
    states.push_back(state);
    before = state;
  }
}

/// Predicts the objects of a tracker: what each may do, and a rollout of the tracker's world for each mode.
template <class World, class Driver>
class Rollouts {
 public:
  using ObjectTrack = detail::ObjectTrack<World>;
  using Behavior = typename World::Behavior;

  /// See `Tracker::predict`. `now`: the tracker's world; `driver_of(track)`: who drives it on lanes.
  template <class DriverOf, class Choose>
  PredictedModes predict(World& now, std::span<ObjectTrack const> tracks,
                         std::shared_ptr<map::RoadCorridor const> const& off_lanes, PredictionRequest const& request,
                         std::span<PredictedState> states, DriverOf const& driver_of, Choose const& choose) {
    auto const count = request.objects.empty() ? tracks.size() : request.objects.size();
    check_request(request, count, states.size());
    find_objects(tracks, request);
    options_.resize(tracks.size());
    for (std::size_t i = 0; i < tracks.size(); ++i)
      list_options<Driver>(now, static_cast<Slot>(i), tracks[i], request.given,
                           static_cast<double>(request.steps) * request.step, options_[i]);
    assign_modes(request);
    for (std::size_t mode = 0; mode < request.modes; ++mode) {
      if (is_empty(mode)) {  // so many joint ones there are not
        std::copy_n(states.begin(), count * request.steps,
                    states.begin() + static_cast<std::ptrdiff_t>(mode * count * request.steps));
        continue;
      }
      begin(now, tracks, off_lanes, request, mode, driver_of, choose);
      roll(tracks, off_lanes, request, mode, states.subspan(mode * count * request.steps, count * request.steps),
           driver_of);
    }
    return {keys_, modes_, request.steps};
  }

 private:
  static constexpr double longest_step = 0.3;  // [s]
  static constexpr std::size_t unknown = std::numeric_limits<std::size_t>::max();

  struct Replay {
    std::size_t track = 0;
    std::vector<PredictedState> states;
    bool on_lanes = false;
  };

  void find_objects(std::span<ObjectTrack const> tracks, PredictionRequest const& request) {
    keys_.clear();
    places_.clear();
    if (request.objects.empty()) {
      for (auto const& track : tracks) keys_.push_back(track.key);
      places_.resize(tracks.size());
      std::iota(places_.begin(), places_.end(), std::size_t{0});
      return;
    }
    keys_.assign(request.objects.begin(), request.objects.end());
    std::vector<std::pair<ObjectKey, std::size_t>> sorted;
    for (std::size_t i = 0; i < tracks.size(); ++i) sorted.push_back({tracks[i].key, i});
    std::sort(sorted.begin(), sorted.end());
    for (auto const& key : keys_) {
      auto const at = std::lower_bound(sorted.begin(), sorted.end(), std::pair(key, std::size_t{0}));
      bool const is_tracked = at != sorted.end() && at->first == key;
      places_.push_back(is_tracked ? std::exchange(at->second, unknown) : unknown);
    }
  }

  /// Decides which option each object takes in each mode, and fills in the modes' probabilities.
  void assign_modes(PredictionRequest const& request) {
    auto const count = keys_.size(), tracks = options_.size();
    modes_.assign(request.modes * count, {});
    taken_.assign(request.modes * tracks, 0);
    if (request.joint) {
      asked_.clear();
      for (auto const place : places_) asked_.push_back(place == unknown ? std::vector<Option>(1) : options_[place]);
      combinations_.find(asked_, request.modes);
      double const all = std::accumulate(combinations_.odds.begin(), combinations_.odds.end(), 0.0);
      for (std::size_t m = 0; m < combinations_.odds.size(); ++m)
        for (std::size_t i = 0; i < count; ++i) set_mode(m, i, combinations_.chosen[m][i], combinations_.odds[m] / all);
      return;
    }
    for (std::size_t i = 0; i < count; ++i) {
      if (places_[i] == unknown) continue;
      auto const& options = options_[places_[i]];
      auto const used = std::min(options.size(), request.modes);
      double all = 0.0;
      for (std::size_t m = 0; m < used; ++m) all += options[m].probability;
      for (std::size_t m = 0; m < used; ++m) set_mode(m, i, m, options[m].probability / all);
    }
  }

  void set_mode(std::size_t mode, std::size_t object, std::size_t option, double probability) {
    auto const place = places_[object];
    if (place == unknown) return;
    modes_[mode * keys_.size() + object] = {probability, options_[place][option].maneuver, none<LaneId>};
    taken_[mode * options_.size() + place] = option;
  }

  [[nodiscard]] bool is_empty(std::size_t mode) const {
    auto const first = modes_.begin() + static_cast<std::ptrdiff_t>(mode * keys_.size());
    return mode > 0 && std::all_of(first, first + static_cast<std::ptrdiff_t>(keys_.size()),
                                   [](PredictedMode const& m) { return m.maneuver == Maneuver::none; });
  }

  void set_world(World const& world) {
    if (world_)
      *world_ = world;  // keeps its scratch memory
    else
      world_.emplace(world);
  }

  /// Sets the world to the begin of a mode: each object with its road, its driver and what that remembers.
  template <class DriverOf, class Choose>
  void begin(World const& now, std::span<ObjectTrack const> tracks,
             std::shared_ptr<map::RoadCorridor const> const& off_lanes, PredictionRequest const& request,
             std::size_t mode, DriverOf const& driver_of, Choose const& choose) {
    std::shared_ptr<typename World::RosterType> roster;
    auto frame = now.frame();
    replays_.clear();
    for (std::size_t i = 0; i < tracks.size(); ++i) {
      auto const slot = static_cast<Slot>(i);
      auto const& option = options_[i][taken_[mode * tracks.size() + i]];
      std::optional<Behavior> const other =
          choose(tracks[i].key, PredictedMode{option.probability, option.maneuver, none<LaneId>});
      if (option.maneuver == Maneuver::as_expected && option.place == 0 && !other) continue;
      auto agent = now.roster().agents[slot];
      auto& record = frame.agents[slot];
      bool changed = take(i, tracks[i], option, request, now.map(), off_lanes, driver_of, agent, record);
      if (other) {
        check_if_described(*other, "Tracker::predict: choose");
        agent.behavior = *other;
        record.memory = World::Behaviors::initial_memory(*other);
        changed = true;
      }
      if (!changed) continue;
      if (!roster) roster = std::make_shared<typename World::RosterType>(now.roster());
      roster->agents[slot] = std::move(agent);
    }
    if (roster) frame.roster_revision = ++roster->revision;
    set_world(World(now.shared_map(), roster ? std::move(roster) : now.shared_roster(), std::move(frame)));
  }

  /// Lets an object take an option; returns whether anything in its roster changed.
  template <class DriverOf, class Agent, class Record>
  bool take(std::size_t number, ObjectTrack const& track, Option const& option, PredictionRequest const& request,
            Map const& map, std::shared_ptr<map::RoadCorridor const> const& off_lanes, DriverOf const& driver_of,
            Agent& agent, Record& record) {
    using Set = typename World::Behaviors;
    auto const drive = [&](Driver const& driver, bool goes_on) {
      agent.behavior = driver;
      if (!goes_on) record.memory = Set::initial_memory(agent.behavior);
    };
    bool const has_driver = std::holds_alternative<typename Driver::Memory>(record.memory);
    switch (option.maneuver) {
      case Maneuver::changes_left:
      case Maneuver::changes_right:
      case Maneuver::keeps_lane:
        if constexpr (requires(typename Driver::Memory memory) { memory.lateral.change.target; }) {
          constexpr float always = 1e6f;  // [s]
          auto& lateral = std::get<typename Driver::Memory>(record.memory).lateral;
          auto const& piece = agent.road->corridors[record.lane.corridor].pieces[record.lane.piece];
          lateral.change = {};
          if (option.maneuver == Maneuver::keeps_lane)
            lateral.rest = always;
          else
            lateral.change.target = piece.beside(option.maneuver == Maneuver::changes_left);
        }
        return false;
      case Maneuver::goes_first:
        if constexpr (requires(Driver driver) { driver.heeds.template get<Conflicts>(); }) {
          auto driver = driver_of(track);
          driver.template heed<Conflicts>().look_ahead = 0.0;
          drive(driver, has_driver);
        }
        return true;
      case Maneuver::brakes_on: {
        agent.behavior = ConstantTurn{.acceleration_fade = 1e6};
        record.memory = Set::initial_memory(agent.behavior);
        std::get<ConstantTurn::Memory>(record.memory).curvature = track.curvature();
        return true;
      }
      case Maneuver::starts:
        drive(driver_of(track), false);
        return true;
      case Maneuver::given:
        begin_replay(number, track, option, request, map, off_lanes, driver_of, agent, record);
        return true;
      case Maneuver::as_expected:
      case Maneuver::none:
        break;
    }
    if (option.place == 0) return false;
    agent.road = track.ways[option.place].road;
    record.lane = track.ways[option.place].place;
    drive(driver_of(track), false);
    return true;
  }

  /// An object whose trajectory stays on one of its ways is on that, and its driver goes on at the end.
  template <class DriverOf, class Agent, class Record>
  void begin_replay(std::size_t number, ObjectTrack const& track, Option const& option,
                    PredictionRequest const& request, Map const& map,
                    std::shared_ptr<map::RoadCorridor const> const& off_lanes, DriverOf const& driver_of, Agent& agent,
                    Record& record) {
    auto& replay = replays_.emplace_back();
    replay.track = number;
    complete(seen_by_host(track, track.state), request.given[option.place].states, request.step, request.steps,
             replay.states);
    auto const stays_on = [&](Way way) {
      return std::all_of(replay.states.begin(), replay.states.end(), [&](PredictedState const& seen) {
        auto state = track.state;
        set_from_host(track, seen, state);
        Moving const moving{{state.x, state.y, state.heading}, state.speed, 0.0};
        way.place = seen_place(map, *way.road, way.place, moving.pose, true);
        return fit(moving, way) > -std::numeric_limits<double>::infinity();
      });
    };
    auto const way = std::find_if(track.ways.begin(), track.ways.end(), stays_on);
    replay.on_lanes = way != track.ways.end();
    set_road(agent, record, replay.on_lanes ? &*way : nullptr, off_lanes, driver_of(track), 0.0);
  }

  /// Puts an agent on a way with a driver, or off the lanes on its own course.
  template <class Agent, class Record>
  static void set_road(Agent& agent, Record& record, Way const* way,
                       std::shared_ptr<map::RoadCorridor const> const& off_lanes, Driver const& driver,
                       double curvature) {
    agent.road = way != nullptr ? way->road : off_lanes;
    record.lane = way != nullptr
                      ? way->place
                      : map::locate(*off_lanes, CorridorId{}, {record.state.x, record.state.y, record.state.heading});
    if (way != nullptr)
      agent.behavior = driver;
    else
      agent.behavior = ConstantTurn{};
    record.memory = World::Behaviors::initial_memory(agent.behavior);
    if (auto* const memory = std::get_if<ConstantTurn::Memory>(&record.memory)) memory->curvature = curvature;
  }

  /// Rolls the world of a mode, in steps longer than those asked for where that is permitted, and writes its states.
  template <class DriverOf>
  void roll(std::span<ObjectTrack const> tracks, std::shared_ptr<map::RoadCorridor const> const& off_lanes,
            PredictionRequest const& request, std::size_t mode, std::span<PredictedState> states,
            DriverOf const& driver_of) {
    auto const at_once = std::max<std::size_t>(1, static_cast<std::size_t>(longest_step / request.step + 1e-9));
    auto const parts = std::max(1, static_cast<int>(std::ceil(request.step / longest_step - 1e-9)));
    for (std::size_t done = 0, steps; done < request.steps; done += steps) {
      steps = std::min(at_once, request.steps - done);
      for (auto const& replay : replays_)  // where one ends, a model takes over
        if (replay.states.size() > done) steps = std::min(steps, replay.states.size() - done);
      double const duration = static_cast<double>(steps) * request.step;
      before_.clear();
      for (auto const& record : world_->frame().agents) before_.push_back(record.state);
      for (int part = 0; part < parts; ++part) static_cast<void>(world_->step(duration / parts));
      replay(tracks, done + steps);
      pass_on_departed(tracks, off_lanes, driver_of, done + steps);
      for (std::size_t i = 0; i < places_.size(); ++i) {
        if (places_[i] == unknown) continue;
        auto const& after = world_->frame().agents[static_cast<Slot>(places_[i])].state;
        for (std::size_t k = 1; k <= steps; ++k)
          states[i * request.steps + done + k - 1] = seen_by_host(
              tracks[places_[i]], k == steps ? after
                                             : between(before_[places_[i]], after, duration,
                                                       static_cast<double>(k) / static_cast<double>(steps)));
      }
    }
    finish(request, mode, states);
  }

  /// Moves those who are replayed to their states after `done` steps.
  void replay(std::span<ObjectTrack const> tracks, std::size_t done) {
    if (std::none_of(replays_.begin(), replays_.end(), [&](Replay const& r) { return r.states.size() >= done; }))
      return;
    auto frame = world_->frame();
    for (auto const& [place, states, on_lanes] : replays_) {
      if (states.size() < done) continue;
      auto const& track = tracks[place];
      auto& record = frame.agents[static_cast<Slot>(place)];
      auto const before = before_[place];
      set_from_host(track, states[done - 1], record.state);
      auto const& road = *world_->roster().agents[static_cast<Slot>(place)].road;
      geometry::Pose const pose{record.state.x, record.state.y, record.state.heading};
      record.lane = seen_place(world_->map(), road, record.lane, pose, on_lanes);
      record.status = AgentStatus::driving;
      double const time = record.state.time - before.time;
      record.acceleration = static_cast<float>(std::clamp((record.state.speed - before.speed) / time, -10.0, 10.0));
      World::Behaviors::was_set(record.memory);
      if (auto* const memory = std::get_if<ConstantTurn::Memory>(&record.memory))
        memory->curvature =
            curvature_at(geometry::angle_difference(pose.heading, before.heading) / time, record.state.speed);
    }
    world_->restore(frame);
  }

  /// Gives a road to those who have come to the end of theirs, and to those off the lanes whose trajectory has ended.
  template <class DriverOf>
  void pass_on_departed(std::span<ObjectTrack const> tracks, std::shared_ptr<map::RoadCorridor const> const& off_lanes,
                        DriverOf const& driver_of, std::size_t done) {
    std::shared_ptr<typename World::RosterType> roster;
    auto const pass_on = [&](std::size_t place, auto& frame) {
      if (!roster) roster = std::make_shared<typename World::RosterType>(world_->roster());
      auto& record = frame.agents[static_cast<Slot>(place)];
      auto const& state = record.state;
      auto const* const memory = std::get_if<ConstantTurn::Memory>(&record.memory);
      double const curvature = memory != nullptr ? memory->curvature : 0.0;
      auto const ways =
          ways_at(world_->map(), {{state.x, state.y, state.heading}, state.speed, curvature * state.speed}, {});
      set_road(roster->agents[static_cast<Slot>(place)], record, ways.empty() ? nullptr : &ways.front(), off_lanes,
               driver_of(tracks[place]), curvature);
      record.status = AgentStatus::driving;
    };
    auto const has_ended = [&](Replay const& r) { return r.states.size() == done && !r.on_lanes; };
    auto const is_departed = [](auto const& record) { return record.status != AgentStatus::driving; };
    auto const& agents = world_->frame().agents;
    if (std::none_of(replays_.begin(), replays_.end(), has_ended) &&
        std::none_of(agents.begin(), agents.end(), is_departed))
      return;
    auto frame = world_->frame();
    for (std::size_t i = 0; i < tracks.size(); ++i)
      if (is_departed(frame.agents[static_cast<Slot>(i)])) pass_on(i, frame);
    for (auto const& r : replays_)
      if (has_ended(r)) pass_on(r.track, frame);
    frame.roster_revision = ++roster->revision;
    set_world(World(world_->shared_map(), std::move(roster), std::move(frame)));
  }

  /// The state at a share of the way between two, `duration` [s] apart: a cubic through both, along their headings
  /// (Hermite).
  template <class State>
  [[nodiscard]] static State between(State const& a, State const& b, double duration, double share) {
    double const u = share, v = 1.0 - u, of_b = u * u * (3.0 - 2.0 * u);
    double const out = u * v * v * duration, in = -u * u * v * duration;
    auto const from = out * a.speed * direction(a.heading), to = in * b.speed * direction(b.heading);
    State state = a;
    state.x += of_b * (b.x - a.x) + from.x() + to.x();
    state.y += of_b * (b.y - a.y) + from.y() + to.y();
    state.heading += u * geometry::angle_difference(b.heading, a.heading);
    state.speed += u * (b.speed - a.speed);
    return state;
  }

  /// Writes what was given as it was given, and the modes' lanes.
  void finish(PredictionRequest const& request, std::size_t mode, std::span<PredictedState> states) {
    auto const to = [&](std::size_t object) {
      return states.begin() + static_cast<std::ptrdiff_t>(object * request.steps);
    };
    for (std::size_t i = 0; i < places_.size(); ++i) {
      if (places_[i] == unknown) {
        std::fill_n(to(i), request.steps, PredictedState{});
        continue;
      }
      for (auto const& r : replays_)
        if (r.track == places_[i]) std::copy(r.states.begin(), r.states.end(), to(i));
      auto const slot = static_cast<Slot>(places_[i]);
      auto const& at = world_->frame().agents[slot].lane;
      modes_[mode * places_.size() + i].lane =
          world_->roster().agents[slot].road->corridors[at.corridor].pieces[at.piece].lane;
    }
  }

  std::vector<ObjectKey> keys_;
  std::vector<std::size_t> places_;  ///< of the objects among the tracks; `unknown`: not tracked
  std::vector<std::vector<Option>> options_, asked_;
  Combinations combinations_;
  std::vector<PredictedMode> modes_;
  std::vector<std::size_t> taken_;  ///< which option each track takes in each mode
  std::vector<Replay> replays_;
  std::vector<typename World::State> before_;
  std::optional<World> world_;
};

}  // namespace cambium::inline v0_1::detail
