#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <utility>
#include <vector>

#include "cambium/benchmark/run_result.hpp"
#include "cambium/core/constants.hpp"
#include "cambium/core/ids.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/planner/planner_model.hpp"
#include "cambium/world/frame.hpp"

namespace cambium::inline v0_1::detail {

/// Compares what the planner of a run expects of the others with what they then do. Once a second it is asked about
/// those within 50 m: where they will be after 1, 3 and 5 s, and if it thinks of several ways, how likely each is. What
/// it does not foresee that far is not judged.
class PredictionJudge {
 public:
  /// Whether the planner is to be asked at this time [s].
  [[nodiscard]] bool asks(double time) const { return time >= next_ - same_time; }

  /// Which agents of `roster` drive within 50 m of `ego`, of which `now` is the frame.
  template <class Roster, class Frame>
  [[nodiscard]] static std::vector<AgentId> nearby(Roster const& roster, AgentId ego, Frame const& now) {
    std::vector<AgentId> ids;
    auto const own = roster.slot_of(ego);
    if (!own) return ids;
    auto const& from = now.agents[*own].state;
    for (Slot slot{}; index_of(slot) < roster.agents.size(); ++slot) {
      auto const& other = now.agents[slot];
      if (slot != *own && other.status == AgentStatus::driving &&
          portable::hypot(other.state.x - from.x, other.state.y - from.y) <= range)
        ids.push_back(roster.agents[slot].id);
    }
    return ids;
  }

  /// Notes the frames that it expects, of agents whose ids are those of `roster`.
  template <class Roster, class Frame>
  void note(Roster const& roster, AgentId ego, std::vector<Frame> const& course) {
    if (!roster.slot_of(ego) || course.empty()) return;
    double const now = course.front().time;
    next_ = now + interval;
    auto const asked = nearby(roster, ego, course.front());
    for (std::size_t span = 0; span < spans.size(); ++span) {
      double const time = now + spans[span];
      auto const then = std::ranges::find_if(course, [&](auto const& frame) { return frame.time > time - same_time; });
      if (then == course.end()) continue;  // it does not look as far ahead
      for (auto const id : asked) {
        auto const& end = then->agents[*roster.slot_of(id)];
        if (end.status == AgentStatus::driving) courses_.push_back({then->time, span, id, end.state.x, end.state.y});
      }
    }
  }

  /// How far ahead alternatives are asked for [s].
  static constexpr double span_of_alternatives = 3.0;

  /// Notes the ways in which, at `time` [s], it thinks that the agents `asked` may go on. The ways of an agent are
  /// judged when they end, if they end together.
  void note(std::vector<Alternative> const& all, double time, std::vector<AgentId> const& asked) {
    for (auto const id : asked) {
      std::vector<Alternative> ways;
      std::ranges::copy_if(all, std::back_inserter(ways), [&](Alternative const& way) { return way.agent == id; });
      if (ways.empty()) continue;
      double const end = ways.front().after.time;
      bool const is_together =
          std::ranges::all_of(ways, [&](Alternative const& way) { return std::abs(way.after.time - end) < same_time; });
      if (is_together && end > time + span_of_alternatives - same_time) alternatives_.push_back({end, std::move(ways)});
    }
  }

  /// Compares what was expected for the present time.
  template <class World>
  void compare(World const& world) {
    double const now = world.time();
    std::erase_if(courses_, [&](Expected const& expected) {
      if (expected.time > now + same_time) return false;
      if (auto const seen = place(world, expected.agent, expected.time); seen.is_known) {
        sums_[expected.span] += portable::hypot(seen.x - expected.x, seen.y - expected.y);
        ++counts_[expected.span];
      }
      return true;
    });
    std::erase_if(alternatives_, [&](Alternatives const& asked) {
      if (asked.time > now + same_time) return false;
      weigh(world, asked);
      return true;
    });
  }

  void write(RunResult& result) const {
    auto const mean = [](double sum, std::size_t count) {
      return count > 0 ? sum / static_cast<double>(count) : RunResult::undefined;
    };
    result.prediction_error_1s = mean(sums_[0], counts_[0]);
    result.prediction_error_3s = mean(sums_[1], counts_[1]);
    result.prediction_error_5s = mean(sums_[2], counts_[2]);
    result.prediction_brier = mean(brier_, weighed_);
  }

 private:
  static constexpr double interval = 1.0, range = 50.0, same_place = 1.0;  // [s], [m]
  static constexpr std::array<double, 3> spans{1.0, 3.0, 5.0};

  struct Expected {
    double time;
    std::size_t span;
    AgentId agent;
    double x, y;
  };
  /// Of one agent.
  struct Alternatives {
    double time;
    std::vector<Alternative> ways;
  };
  struct Seen {
    bool is_known = false;
    double x{}, y{};
  };

  /// Where an agent was at `time`, shortly before the present.
  template <class World>
  [[nodiscard]] static Seen place(World const& world, AgentId id, double time) {
    auto const slot = world.roster().slot_of(id);
    if (!slot || world.frame().agents[*slot].status != AgentStatus::driving) return {};
    auto const& state = world.frame().agents[*slot].state;
    auto const along = portable::sin_cos(state.heading);
    double const back = state.speed * (world.time() - time);
    return {true, state.x - back * along.cos, state.y - back * along.sin};
  }

  /// Adds the Brier score (Brier 1950) of the ways of an agent: the nearest to where it is has come true. Alternatives
  /// that end in the same place are one way. Who has only one, or only one that is not negligible, is not judged.
  template <class World>
  void weigh(World const& world, Alternatives const& asked) {
    auto const seen = place(world, asked.ways.front().agent, asked.time);
    if (!seen.is_known) return;
    std::vector<Alternative> ways;
    for (auto const& one : asked.ways) {
      auto const same = std::ranges::find_if(ways, [&](Alternative const& way) {
        return portable::hypot(way.after.x - one.after.x, way.after.y - one.after.y) < same_place;
      });
      if (same == ways.end())
        ways.push_back(one);
      else
        same->probability += one.probability;
    }
    constexpr double negligible = 0.01;
    auto const counts = [](Alternative const& way) { return way.probability > negligible; };
    if (std::ranges::count_if(ways, counts) < 2) return;
    auto const came_true = std::ranges::min_element(
        ways, {}, [&](Alternative const& way) { return portable::hypot(way.after.x - seen.x, way.after.y - seen.y); });
    for (auto way = ways.begin(); way != ways.end(); ++way) {
      double const off = way->probability - (way == came_true ? 1.0 : 0.0);
      brier_ += off * off;
    }
    ++weighed_;
  }

  double next_ = 0.0;
  std::vector<Expected> courses_{};
  std::vector<Alternatives> alternatives_{};
  std::array<double, 3> sums_{};
  std::array<std::size_t, 3> counts_{};
  double brier_ = 0.0;
  std::size_t weighed_ = 0;
};

}  // namespace cambium::inline v0_1::detail
