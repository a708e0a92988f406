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

#include "cambium/behavior/course.hpp"
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

/// How an object is seen by its host: of its point, with the heading of its front. `reverses`: its rear goes first.
template <class ObjectTrack>
[[nodiscard]] double to_point(ObjectTrack const& track, bool reverses) {
  return reverses == track.reverses ? track.to_point() : -track.to_point();
}
template <class ObjectTrack, class State>
[[nodiscard]] PredictedState seen_by_host(ObjectTrack const& track, bool reverses, State const& state) {
  auto const at = geometry::Point{state.x, state.y} + to_point(track, reverses) * direction(state.heading);
  return {at.x(), at.y(), geometry::normalize_angle(state.heading + (reverses ? geometry::pi : 0.0)),
          reverses ? -state.speed : state.speed};
}
/// The state of the world that a host sees so.
template <class ObjectTrack>
[[nodiscard]] auto state_of(ObjectTrack const& track, bool reverses, PredictedState const& seen) {
  auto state = track.state;
  state.heading = geometry::normalize_angle(seen.heading + (reverses ? geometry::pi : 0.0));
  auto const at = geometry::Point{seen.x, seen.y} - to_point(track, reverses) * direction(state.heading);
  state.x = at.x();
  state.y = at.y();
  state.speed = std::max(0.0, reverses ? -seen.speed : seen.speed);
  return state;
}

/// A given trajectory with the headings and speeds that it lacks, up to the first position that is no place. A vehicle
/// that moves against its heading reverses; who is on foot turns round.
inline void complete(PredictedState before, std::span<PredictedState const> given, double step, bool is_vehicle,
                     std::vector<PredictedState>& states) {
  constexpr double moves = 0.05, highest_speed = 150.0;  // [m], [m/s]
  states.clear();
  for (auto state : given) {
    if (!is_place(state)) break;
    double const dx = state.x - before.x, dy = state.y - before.y, way = portable::hypot(dx, dy);
    double const towards = way > moves ? portable::atan2(dy, dx) : before.heading;
    auto const is_against = [&](double heading) {
      return is_vehicle && std::abs(geometry::angle_difference(heading, towards)) > 0.5 * geometry::pi;
    };
    if (!std::isfinite(state.heading))
      state.heading = geometry::normalize_angle(is_against(before.heading) ? towards + geometry::pi : towards);
    if (!std::isfinite(state.speed)) state.speed = (is_against(state.heading) ? -way : way) / step;
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

  /// What does not change during a prediction. `now`: the tracker's world; `driver_of(track)`: who drives it on lanes.
  template <class DriverOf>
  struct Job {
    World& now;
    std::span<ObjectTrack const> tracks;
    std::shared_ptr<map::RoadCorridor const> const& off_lanes;
    PredictionRequest const& request;
    DriverOf driver_of;
  };

  /// See `Tracker::predict`.
  template <class DriverOf, class Choose>
  PredictedModes predict(Job<DriverOf> const& job, std::span<PredictedState> states, Choose const& choose) {
    auto const& request = job.request;
    auto const count = request.objects.empty() ? job.tracks.size() : request.objects.size();
    check_request(request, count, states.size());
    find_objects(job.tracks, request);
    options_.resize(job.tracks.size());
    for (std::size_t i = 0; i < job.tracks.size(); ++i)
      list_options<Driver>(job.now, static_cast<Slot>(i), job.tracks[i], request.given,
                           static_cast<double>(request.steps) * request.step, options_[i]);
    copy_given(request);
    assign_modes(request);
    for (std::size_t mode = 0; mode < request.modes; ++mode) {
      if (is_empty(mode)) {  // there are fewer combinations than modes
        std::copy_n(states.begin(), count * request.steps,
                    states.begin() + static_cast<std::ptrdiff_t>(mode * count * request.steps));
        continue;
      }
      begin(job, mode, choose);
      roll(job, mode, states.subspan(mode * count * request.steps, count * request.steps));
    }
    return {keys_, modes_, request.steps};
  }

 private:
  using State = typename World::State;
  using Set = typename World::Behaviors;

  static constexpr double longest_step = 0.3;  // [s]
  static constexpr std::size_t unknown = std::numeric_limits<std::size_t>::max();

  /// A trajectory of the host's, and the same in the world, from the present state on.
  struct Replay {
    std::size_t track = 0;
    std::vector<PredictedState> seen;
    std::vector<State> states;
    bool on_lanes = false;
    bool drives = false;  ///< a driver goes on where it ends, if that is on a lane
  };

  void find_objects(std::span<ObjectTrack const> tracks, PredictionRequest const& request) {
    std::vector<ObjectKey> keys(request.objects.begin(),
                                request.objects.end());  // they may be those of the last result
    places_.clear();
    if (keys.empty()) {
      for (auto const& track : tracks) keys.push_back(track.key);
      places_.resize(tracks.size());
      std::iota(places_.begin(), places_.end(), std::size_t{0});
    } else {
      std::vector<std::pair<ObjectKey, std::size_t>> sorted;
      for (std::size_t i = 0; i < tracks.size(); ++i) sorted.push_back({tracks[i].key, i});
      std::sort(sorted.begin(), sorted.end());
      for (auto const& key : keys) {
        auto const at = std::lower_bound(sorted.begin(), sorted.end(), std::pair(key, std::size_t{0}));
        bool const is_tracked = at != sorted.end() && at->first == key;
        places_.push_back(is_tracked ? std::exchange(at->second, unknown) : unknown);
      }
    }
    keys_.swap(keys);
  }

  /// Copies what is given, which may lie in the array of the results.
  void copy_given(PredictionRequest const& request) {
    given_.resize(request.given.size());
    for (std::size_t i = 0; i < given_.size(); ++i) {
      auto const& states = request.given[i].states;
      given_[i].assign(states.begin(),
                       states.begin() + static_cast<std::ptrdiff_t>(std::min(states.size(), request.steps)));
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

  /// Who drives an object on lanes in this mode.
  template <class DriverOf>
  [[nodiscard]] Driver driver_of(Job<DriverOf> const& job, std::size_t place) const {
    if (auto const* const driver = driver_in(chosen_[place])) return *driver;
    return job.driver_of(job.tracks[place]);
  }
  [[nodiscard]] static Driver const* driver_in(std::optional<Behavior> const& behavior) {
    return behavior ? std::get_if<Driver>(&*behavior) : nullptr;
  }

  /// Sets the world to the begin of a mode: each object with its road, its driver and what that remembers.
  template <class DriverOf, class Choose>
  void begin(Job<DriverOf> const& job, std::size_t mode, Choose const& choose) {
    std::shared_ptr<typename World::RosterType> roster;
    auto frame = job.now.frame();
    replays_.clear();
    chosen_.resize(job.tracks.size());
    reverses_.resize(job.tracks.size());
    for (std::size_t i = 0; i < job.tracks.size(); ++i) {
      auto const slot = static_cast<Slot>(i);
      auto const& track = job.tracks[i];
      auto const& option = options_[i][taken_[mode * job.tracks.size() + i]];
      reverses_[i] = track.reverses;
      chosen_[i] = choose(track.key, PredictedMode{option.probability, option.maneuver, none<LaneId>});
      if (chosen_[i]) check_if_described(*chosen_[i], "Tracker::predict: choose");
      if (track.ways.empty() && driver_in(chosen_[i]) != nullptr) chosen_[i].reset();  // there is nowhere to drive
      if (option.maneuver == Maneuver::as_expected && option.place == 0 && !chosen_[i]) continue;
      if (!roster) roster = std::make_shared<typename World::RosterType>(job.now.roster());
      auto& agent = roster->agents[slot];
      auto& record = frame.agents[slot];
      if (chosen_[i]) assume(track, *chosen_[i], agent, record);
      if (option.maneuver == Maneuver::given)
        begin_replay(job, i, given_[option.place], agent, record);
      else
        take(job, i, option, agent, record);
    }
    if (roster) frame.roster_revision = ++roster->revision;
    set_world(World(job.now.shared_map(), roster ? std::move(roster) : job.now.shared_roster(), std::move(frame)));
  }

  /// Gives an agent a behaviour. It remembers what it did if it had one of that type.
  template <class Agent, class Record>
  static void assume(ObjectTrack const& track, Behavior const& behavior, Agent& agent, Record& record) {
    bool const goes_on = behavior.index() == agent.behavior.index();
    agent.behavior = behavior;
    if (goes_on) return;
    record.memory = Set::initial_memory(behavior);
    if (auto* const memory = std::get_if<ConstantTurn::Memory>(&record.memory)) memory->curvature = track.curvature();
  }

  /// Lets an object take an option.
  template <class DriverOf, class Agent, class Record>
  void take(Job<DriverOf> const& job, std::size_t place, Option const& option, Agent& agent, Record& record) const {
    auto const& track = job.tracks[place];
    if (option.maneuver == Maneuver::as_expected && option.place != 0) {
      agent.road = track.ways[option.place].road;
      record.lane = track.ways[option.place].place;
      if (chosen_[place] && driver_in(chosen_[place]) == nullptr) return;
      agent.behavior = driver_of(job, place);
      record.memory = Set::initial_memory(agent.behavior);  // lane corridors have other numbers there
    } else if (option.maneuver == Maneuver::brakes_on) {
      assume(track, ConstantTurn{.acceleration_fade = 1e6}, agent, record);
    } else if (option.maneuver == Maneuver::starts) {
      assume(track, driver_of(job, place), agent, record);
    } else if (option.maneuver == Maneuver::goes_first) {
      if constexpr (requires(Driver driver) { driver.heeds.template get<Conflicts>(); })
        if (auto* const driver = std::get_if<Driver>(&agent.behavior))
          driver->template heed<Conflicts>().look_ahead = 0.0;
    } else if (option.maneuver != Maneuver::as_expected) {
      change_lanes(option.maneuver, agent, record);
    }
  }

  template <class Agent, class Record>
  static void change_lanes(Maneuver maneuver, Agent const& agent, Record& record) {
    if constexpr (requires(typename Driver::Memory memory) { memory.lateral.change.target; }) {
      constexpr float always = 1e6f;  // [s]
      auto* const memory = std::get_if<typename Driver::Memory>(&record.memory);
      if (memory == nullptr) return;
      auto const& piece = agent.road->corridors[record.lane.corridor].pieces[record.lane.piece];
      memory->lateral.change = {};
      if (maneuver == Maneuver::keeps_lane)
        memory->lateral.rest = always;
      else
        memory->lateral.change.target = piece.beside(maneuver == Maneuver::changes_left);
    }
  }

  /// An object whose trajectory follows one of its ways keeps to it; a driver takes over at the end, if one may.
  template <class DriverOf, class Agent, class Record>
  void begin_replay(Job<DriverOf> const& job, std::size_t place, std::span<PredictedState const> given, Agent& agent,
                    Record& record) {
    auto const& track = job.tracks[place];
    auto& replay = replays_.emplace_back();
    replay.track = place;
    complete(seen_by_host(track, track.reverses, track.state), given, job.request.step, track.may_drive, replay.seen);
    double way = 0.0;
    for (auto const& seen : replay.seen) way += seen.speed;
    bool const reverses = way < 0.0 || (way == 0.0 && track.reverses);
    if (reverses != track.reverses) std::swap(agent.shape.front, agent.shape.rear);
    reverses_[place] = reverses;
    auto start = track.state;
    if (reverses != track.reverses) start = state_of(track, reverses, seen_by_host(track, track.reverses, track.state));
    record.state = start;
    record.state.time = job.now.time();
    replay.states.assign(1, start);
    for (auto const& seen : replay.seen) replay.states.push_back(state_of(track, reverses, seen));
    bool const stays = track.motion == ObjectMotion::stands && replay.states.back().speed < standing_object;
    replay.drives = track.may_drive && !stays && !reverses && (!chosen_[place] || driver_in(chosen_[place]) != nullptr);
    auto const followed = std::find_if(track.ways.begin(), track.ways.end(), [&](Way const& candidate) {
      auto at = candidate;
      return std::all_of(replay.states.begin(), replay.states.end(), [&](State const& state) {
        Moving const moving{{state.x, state.y, state.heading}, state.speed, 0.0};
        at.place = seen_place(job.now.map(), *at.road, at.place, moving.pose, true);
        return fit(moving, at) > -std::numeric_limits<double>::infinity();
      });
    });
    replay.on_lanes = followed != track.ways.end();
    set_road(job, place, replay.on_lanes ? &*followed : nullptr, replay.drives, 0.0, agent, record);
  }

  /// Puts an agent on a way, or off the lanes. A behaviour that cannot go on there is replaced.
  template <class DriverOf, class Agent, class Record>
  void set_road(Job<DriverOf> const& job, std::size_t place, Way const* way, bool drives, double curvature,
                Agent& agent, Record& record) const {
    auto const& state = record.state;
    bool const has_driver = std::holds_alternative<Driver>(agent.behavior);
    agent.road = way != nullptr ? way->road : job.off_lanes;
    record.lane =
        way != nullptr ? way->place : map::locate(*job.off_lanes, CorridorId{}, {state.x, state.y, state.heading});
    if (way != nullptr && drives)
      agent.behavior = has_driver ? agent.behavior : Behavior(driver_of(job, place));
    else if (has_driver)
      agent.behavior = ConstantTurn{};
    else if (!std::holds_alternative<ConstantTurn>(agent.behavior))
      return;
    record.memory = Set::initial_memory(agent.behavior);
    if (auto* const memory = std::get_if<ConstantTurn::Memory>(&record.memory)) memory->curvature = curvature;
  }

  /// Rolls the world of a mode, in steps longer than those asked for where that is permitted, else in parts of them,
  /// and writes its states.
  template <class DriverOf>
  void roll(Job<DriverOf> const& job, std::size_t mode, std::span<PredictedState> states) {
    auto const& request = job.request;
    auto const at_once = std::max<std::size_t>(1, static_cast<std::size_t>(longest_step / request.step + 1e-9));
    auto const parts = std::max(1, static_cast<int>(std::ceil(request.step / longest_step - 1e-9)));
    for (std::size_t done = 0, steps; done < request.steps; done += steps) {
      steps = std::min(at_once, request.steps - done);
      for (auto const& replay : replays_)  // where one ends, a model takes over
        if (replay.seen.size() > done) steps = std::min(steps, replay.seen.size() - done);
      double const duration = static_cast<double>(steps) * request.step / parts;
      before_.clear();
      for (auto const& record : world_->frame().agents) before_.push_back(record.state);
      for (int part = 1; part <= parts; ++part) {
        static_cast<void>(world_->step(duration));
        double const at = static_cast<double>(done) + static_cast<double>(steps) * part / parts;
        move_replayed(at - static_cast<double>(steps) / parts, at, duration);
        pass_on_departed(job, at);
      }
      for (std::size_t i = 0; i < places_.size(); ++i) {
        if (places_[i] == unknown) continue;
        auto const& after = world_->frame().agents[static_cast<Slot>(places_[i])].state;
        for (std::size_t k = 1; k <= steps; ++k) {
          double const share = static_cast<double>(k) / static_cast<double>(steps);
          states[i * request.steps + done + k - 1] =
              seen_by_host(job.tracks[places_[i]], reverses_[places_[i]] != 0,
                           k == steps ? after : between(before_[places_[i]], after, share));
        }
      }
    }
    finish(request, mode, states);
  }

  /// Moves those who are replayed from where they were after `from` steps to where they are after `to`, `duration` [s]
  /// later.
  void move_replayed(double from, double to, double duration) {
    auto const goes_on = [&](Replay const& r) { return static_cast<double>(r.seen.size()) >= to; };
    if (std::none_of(replays_.begin(), replays_.end(), goes_on)) return;
    auto const state_at = [](Replay const& replay, double at) {
      auto const last = static_cast<std::size_t>(at);
      double const share = at - static_cast<double>(last);
      return share > 0.0 ? between(replay.states[last], replay.states[last + 1], share) : replay.states[last];
    };
    auto frame = world_->frame();
    for (auto const& replay : replays_) {
      if (!goes_on(replay)) continue;
      auto const slot = static_cast<Slot>(replay.track);
      auto const before = state_at(replay, from);
      auto& record = frame.agents[slot];
      record.state = state_at(replay, to);
      record.state.time = frame.time;
      geometry::Pose const pose{record.state.x, record.state.y, record.state.heading};
      record.lane = seen_place(world_->map(), *world_->roster().agents[slot].road, record.lane, pose, replay.on_lanes);
      record.status = AgentStatus::driving;
      record.acceleration = static_cast<float>(std::clamp((record.state.speed - before.speed) / duration, -10.0, 10.0));
      Set::was_set(record.memory);
      if (auto* const memory = std::get_if<ConstantTurn::Memory>(&record.memory))
        memory->curvature =
            curvature_at(geometry::angle_difference(pose.heading, before.heading) / duration, record.state.speed);
    }
    world_->restore(frame);
  }

  /// Gives a road to those who have come to the end of theirs, and to those off the lanes whose trajectory ends `at`
  /// that many steps.
  template <class DriverOf>
  void pass_on_departed(Job<DriverOf> const& job, double at) {
    auto const has_ended = [&](Replay const& r) {
      return static_cast<double>(r.seen.size()) == at && !r.on_lanes && r.drives;
    };
    auto const is_departed = [](auto const& record) { return record.status != AgentStatus::driving; };
    auto const& agents = world_->frame().agents;
    if (std::none_of(replays_.begin(), replays_.end(), has_ended) &&
        std::none_of(agents.begin(), agents.end(), is_departed))
      return;
    auto roster = std::make_shared<typename World::RosterType>(world_->roster());
    auto frame = world_->frame();
    auto const pass_on = [&](std::size_t place, bool drives) {
      auto& record = frame.agents[static_cast<Slot>(place)];
      auto const& state = record.state;
      auto const* const memory = std::get_if<ConstantTurn::Memory>(&record.memory);
      double const curvature = memory != nullptr ? memory->curvature : 0.0;
      std::vector<Way> ways;
      if (drives)
        ways = ways_at(world_->map(), {{state.x, state.y, state.heading}, state.speed, curvature * state.speed}, {});
      set_road(job, place, ways.empty() ? nullptr : &ways.front(), drives, curvature,
               roster->agents[static_cast<Slot>(place)], record);
      record.status = AgentStatus::driving;
    };
    for (std::size_t i = 0; i < job.tracks.size(); ++i)
      if (auto const slot = static_cast<Slot>(i); is_departed(frame.agents[slot]))
        pass_on(i, std::holds_alternative<Driver>(roster->agents[slot].behavior));
    for (auto const& replay : replays_)
      if (has_ended(replay)) pass_on(replay.track, true);
    frame.roster_revision = ++roster->revision;
    set_world(World(world_->shared_map(), std::move(roster), std::move(frame)));
  }

  /// The state at a share of the time between two: on the curve through both, evenly accelerated.
  [[nodiscard]] static State between(State const& a, State const& b, double share) {
    double const sum = a.speed + b.speed;
    double const u = sum > 0.0 ? share * (2.0 * a.speed + (b.speed - a.speed) * share) / sum : share;
    State state = a;
    place_between(a, b, way_between(a, b), u, state);
    state.speed += share * (b.speed - a.speed);
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
      for (auto const& replay : replays_)
        if (replay.track == places_[i]) std::copy(replay.seen.begin(), replay.seen.end(), to(i));
      auto const slot = static_cast<Slot>(places_[i]);
      auto const& at = world_->frame().agents[slot].lane;
      auto& its = modes_[mode * places_.size() + i];
      if (its.maneuver != Maneuver::none)
        its.lane = world_->roster().agents[slot].road->corridors[at.corridor].pieces[at.piece].lane;
    }
  }

  std::vector<ObjectKey> keys_;
  std::vector<std::size_t> places_;  ///< of the objects among the tracks; `unknown`: not tracked, or named before
  std::vector<std::vector<Option>> options_, asked_;
  Combinations combinations_;
  std::vector<PredictedMode> modes_;
  std::vector<std::size_t> taken_;  ///< which option each track takes in each mode
  std::vector<std::vector<PredictedState>> given_;
  std::vector<std::optional<Behavior>> chosen_;  ///< by the caller, for each track in this mode
  std::vector<std::uint8_t> reverses_;           ///< likewise: its rear goes first
  std::vector<Replay> replays_;
  std::vector<State> before_;
  std::optional<World> world_;
};

}  // namespace cambium::inline v0_1::detail
