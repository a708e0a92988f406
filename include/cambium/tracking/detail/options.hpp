#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "cambium/behavior/heed/conflicts.hpp"
#include "cambium/core/error.hpp"
#include "cambium/map/corridor/corridor.hpp"
#include "cambium/core/ids.hpp"
#include "cambium/map/map.hpp"
#include "cambium/tracking/detail/ways.hpp"
#include "cambium/tracking/predicted_modes.hpp"
#include "cambium/tracking/verdict.hpp"

namespace cambium::inline v0_1::detail {

/// Something that an object may do.
struct Option {
  double probability = 1.0;
  Maneuver maneuver = Maneuver::as_expected;
  std::size_t place = 0;  ///< of its way among the object's, or of its trajectory among those given
};

/// Whether a state of the host's is somewhere.
[[nodiscard]] inline bool is_place(PredictedState const& state) {
  constexpr double farthest = 1e8;  // [m]
  return std::abs(state.x) <= farthest && std::abs(state.y) <= farthest;
}

/// Throws `ParameterError` if a request cannot be answered into `room` states.
inline void check_request(PredictionRequest const& request, std::size_t objects, std::size_t room) {
  constexpr std::size_t most_steps = 10'000, most_modes = 256;
  auto const refuse = [](char const* what, std::string const& is, char const* remedy) {
    throw ParameterError(std::string("PredictionRequest.") + what, is, remedy);
  };
  if (request.steps < 1 || request.steps > most_steps)
    refuse("steps", "is " + std::to_string(request.steps), "give a number in [1, 10000]");
  if (!(request.step >= 0.001 && request.step <= 10.0))
    refuse("step", "is " + std::to_string(request.step) + " s", "give a value in [0.001, 10] s");
  if (request.modes < 1 || request.modes > most_modes)
    refuse("modes", "is " + std::to_string(request.modes), "give a number in [1, 256]");
  if (auto const needed = request.modes * objects * request.steps; room < needed)
    throw ParameterError("states", "there is room for " + std::to_string(room) + " of " + std::to_string(needed),
                         "give an array of modes * objects * steps");
}

/// From a vehicle's front end to where it waits for others who may go first [m]; infinite where nobody comes.
template <class View>
[[nodiscard]] double distance_to_yield(View const& view) {
  constexpr double far = 60.0;  // [m]
  double const front = view.place().s + view.shape().front;
  for (auto const& conflict : view.corridor().conflicts) {
    double const distance = conflict.first_hold() - front;
    if (distance > far) break;
    if (distance < 0.0 || conflict.kind == map::OverlapKind::split || conflict.right_of_way == map::RightOfWay::first ||
        (is_valid(conflict.light) && view.light(conflict.light) != map::LightColor::off))
      continue;
    bool comes = false;
    for (auto const& way : conflict.ways)
      view.on_lane(way.index_begin, way.index_end,
                   [&](RoadUser const& user) { comes = comes || is_valid(user.agent); });
    if (comes) return distance;
  }
  return std::numeric_limits<double>::infinity();
}

/// What an object on a lane may do besides what is expected: shares of the probability of its first way; own choice.
template <class Driver, class View, class ObjectTrack>
void add_deviations(View const& view, ObjectTrack const& track, std::vector<Option>& options) {
  constexpr double rare = 0.03, drifts = 0.5, turns_back = 0.15, keeps_braking = 0.3, brakes = -1.0;
  auto const& way = track.ways.front();
  auto const& corridor = way.road->corridors[way.place.corridor];
  auto const deviate = [&](Maneuver maneuver, double share) { options.push_back({share, maneuver, 0}); };
  if constexpr (requires(typename Driver::Memory memory) { memory.lateral.change.target; }) {
    auto const* const memory = std::get_if<typename Driver::Memory>(&track.memory);
    if (memory != nullptr && memory->lateral.change.active()) {
      deviate(Maneuver::keeps_lane, turns_back);
    } else if (memory != nullptr && !view.map().in_junction(lane_of(way))) {
      auto const& lane = view.map().lane(lane_of(way));
      auto const& piece = corridor.pieces[way.place.piece];
      double const s = way.place.s + piece.lane_offset;
      bool const moves = track.motion == ObjectMotion::changes_lanes, to_left = way.place.heading_error > 0.0;
      if (is_valid(piece.left) && lane.may_change_left(s))
        deviate(Maneuver::changes_left, moves && to_left ? drifts : rare);
      if (is_valid(piece.right) && lane.may_change_right(s))
        deviate(Maneuver::changes_right, moves && !to_left ? drifts : rare);
    }
  }
  if constexpr (requires(Driver driver) { driver.heeds.template get<Conflicts>(); }) {
    double const distance = distance_to_yield(view);
    if (distance < std::numeric_limits<double>::infinity()) {
      // One who would have to brake hard by now, and does not, is not about to wait.
      double const needed = 0.5 * track.state.speed * track.state.speed / std::max(1.0, distance);
      double const late = track.acceleration > -0.5 ? std::clamp(0.5 * (needed - 1.0), 0.0, 1.0) : 0.0;
      deviate(Maneuver::goes_first, rare + 0.3 * late);
    }
  }
  if (track.acceleration < brakes) deviate(Maneuver::brakes_on, keeps_braking);
}

/// Whether two ways are one for the next `reach` [m].
[[nodiscard]] inline bool is_same(Map const& map, Way const& a, Way const& b, double reach) {
  auto const lane = lane_of(a);
  auto const &first = a.road->route, &second = b.road->route;
  auto i = std::find(first.begin(), first.end(), lane), j = std::find(second.begin(), second.end(), lane_of(b));
  auto const& piece = a.road->corridors[a.place.corridor].pieces[a.place.piece];
  for (double left = a.place.s + piece.lane_offset + reach; left > 0.0; ++i, ++j) {
    if (i == first.end() || j == second.end()) return i == first.end() && j == second.end();
    if (*i != *j) return false;
    left -= map.lane(*i).length();
  }
  return true;
}

/// Adds those of a track's ways that differ within `horizon` [s], and what else it may do on the first one.
template <class Driver, class View, class ObjectTrack>
void add_ways(View const& view, ObjectTrack const& track, double horizon, std::vector<Option>& options) {
  constexpr double gain = 2.0, margin = 10.0;  // [m/s^2], [m]
  double const reach = (track.state.speed + 0.5 * gain * horizon) * horizon + margin;
  for (std::size_t i = 0; i < track.ways.size(); ++i) {
    auto const same = std::find_if(options.begin(), options.end(), [&](Option const& option) {
      return is_same(view.map(), track.ways[option.place], track.ways[i], reach);
    });
    if (same != options.end())
      same->probability += track.ways[i].odds;
    else
      options.push_back({track.ways[i].odds, Maneuver::as_expected, i});
  }
  auto const ways = static_cast<std::ptrdiff_t>(options.size());
  add_deviations<Driver>(view, track, options);
  double const expected =
      options.front().probability / std::accumulate(options.begin() + ways, options.end(), 1.0,
                                                    [](double all, Option const& o) { return all + o.probability; });
  std::for_each(options.begin() + ways, options.end(), [&](Option& option) { option.probability *= expected; });
  options.front().probability = expected;
}

/// What an object may do within `horizon` [s], the most probable first; the probabilities sum to 1. `world` must be up
/// to date.
template <class Driver, class World, class ObjectTrack>
void list_options(World& world, Slot slot, ObjectTrack const& track, std::span<GivenTrajectory const> given,
                  double horizon, std::vector<Option>& options) {
  constexpr double starts = 0.2, most = 1e9;
  options.clear();
  for (std::size_t i = 0; i < given.size(); ++i)
    if (given[i].key == track.key && given[i].probability > 0.0 && std::isfinite(given[i].probability) &&
        !given[i].states.empty() && is_place(given[i].states[0]))
      options.push_back({std::min(given[i].probability, most), Maneuver::given, i});
  double const all = std::accumulate(options.begin(), options.end(), 0.0,
                                     [](double sum, Option const& option) { return sum + option.probability; });
  for (auto& option : options) option.probability /= all;
  bool const stands = track.motion == ObjectMotion::stands;
  if (options.empty() && !track.ways.empty() && !stands) add_ways<Driver>(world.observe(slot), track, horizon, options);
  if (options.empty()) options.push_back({});
  if (stands && track.may_drive && !track.ways.empty() && options.front().maneuver == Maneuver::as_expected) {
    options.front().probability = 1.0 - starts;
    options.push_back({starts, Maneuver::starts, 0});
  }
  // They are few: no need for a sort that allocates.
  for (std::size_t i = 1; i < options.size(); ++i)
    for (std::size_t j = i; j > 0 && options[j].probability > options[j - 1].probability; --j)
      std::swap(options[j], options[j - 1]);
}

/// The `most` most probable combinations of one option each of independent objects, whose options are sorted: the
/// numbers of the options, and the probabilities relative to that of the first one. O(objects * most * (objects +
/// options * log)).
struct Combinations {
  std::vector<std::vector<std::uint8_t>> chosen;
  std::vector<double> odds;

  void find(std::span<std::vector<Option> const> objects, std::size_t most) {
    chosen.assign(1, {});
    odds.assign(1, 1.0);
    std::vector<std::pair<double, std::pair<std::size_t, std::uint8_t>>> next;
    for (auto const& options : objects) {
      next.clear();
      for (std::size_t i = 0; i < chosen.size(); ++i)
        for (std::size_t o = 0; o < std::min<std::size_t>(options.size(), 255); ++o)
          next.push_back(
              {odds[i] * options[o].probability / options[0].probability, {i, static_cast<std::uint8_t>(o)}});
      // Of equal ones, those first whose objects before this one come first: an order that depends on nothing else.
      std::sort(next.begin(), next.end(), [](auto const& a, auto const& b) {
        return a.first != b.first ? a.first > b.first : a.second < b.second;
      });
      if (next.size() > most) next.resize(most);
      std::vector<std::vector<std::uint8_t>> combined;
      odds.clear();
      for (auto const& [probability, from] : next) {
        combined.push_back(chosen[from.first]);
        combined.back().push_back(from.second);
        odds.push_back(probability);
      }
      chosen.swap(combined);
    }
  }
};

}  // namespace cambium::inline v0_1::detail
