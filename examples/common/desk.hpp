#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <string>
#include <string_view>

#include "cambium/behavior/drivers.hpp"
#include "cambium/behavior/actions/driver_actions.hpp"
#include "cambium/behavior/law/follow_lane.hpp"
#include "cambium/behavior/law/idm.hpp"
#include "cambium/dynamics/single_track.hpp"
#include "cambium/execution/interpolate.hpp"
#include "cambium/planner/mcts/mcts.hpp"
#include "cambium/world/extern_world.hpp"
#include "cambium/world/world.hpp"

#include "thawed.hpp"

// What `record_snapshots` drives and `debug_snapshot` takes apart.

namespace desk {

namespace cb = cambium;

/// A follower with a defect, for the case study. It plans accelerations in steps of half a second, and in its next
/// cycle goes on from the planned one, with limited jerk. Between two planned values it interpolates, wrongly if the
/// cycle comes late: the share of the way from one to the other then counts from the begin of the plan.
struct SmoothFollower : cb::Idm {
  static constexpr std::size_t knots = 5;
  static constexpr double spacing = 0.5;  // [s]

  struct Memory {
    double planned_at = -1e9;             ///< [s]
    std::array<double, knots> planned{};  ///< accelerations from then on [m/s^2]

    static constexpr char const* name = "smooth_follower_memory";
    static constexpr auto parameters() {
      return cb::parameter_list(
          cb::parameter("planned_at", &Memory::planned_at, "s", cb::any_finite, "time of the plan"),
          cb::parameter("planned", &Memory::planned, "m/s^2", cb::any_finite, "accelerations from then on"));
    }
    friend bool operator==(Memory const&, Memory const&) = default;
  };

  double jerk = 0.8;
  double mended = 0.0;

  static constexpr char const* name = "smooth_follower";
  static constexpr char const* summary = "IDM with limited jerk; has a defect, for practice";
  static constexpr char const* source = "own";
  static constexpr auto parameters() {
    using P = SmoothFollower;
    return cb::join_parameters(cb::idm_parameters<P>(),
                               cb::parameter_list(cb::parameter("jerk", &P::jerk, "m/s^3", cb::positive, "limit"),
                                                  cb::parameter("mended", &P::mended, "-", cb::Range{0, 1},
                                                                "1: it interpolates as it should")));
  }

  /// The acceleration that was planned for `since` [s] after the plan was made.
  [[nodiscard]] double interpolated(Memory const& memory, double since) const {
    double const place = std::clamp(since / spacing, 0.0, knots - 1.001);
    auto const i = static_cast<std::size_t>(place);
    double const share = mended > 0.5 ? place - static_cast<double>(i) : place;  // the defect: not of this interval
    return memory.planned[i] + share * (memory.planned[i + 1] - memory.planned[i]);
  }

  template <class View>
  [[nodiscard]] cb::Plan<View> plan(View const& view, Memory& memory, double dt) const {
    double const speed = std::max(0.0, view.state().speed);
    auto const leader = view.ahead();
    double const infinite = std::numeric_limits<double>::infinity();
    double const wanted =
        cb::idm_acceleration(*this, speed, leader ? leader->gap : infinite, leader ? leader->speed : speed);
    double const since = view.time() - memory.planned_at;
    double begin = since < 2.0 ? interpolated(memory, since) : wanted;
    memory.planned_at = view.time();
    for (auto& acceleration : memory.planned) {
      acceleration = begin;
      begin += std::clamp(wanted - begin, -jerk * spacing, jerk * spacing);
    }
    double const acceleration = std::max(interpolated(memory, 0.5 * dt), -speed / dt);
    return cb::plan_along_lane(view, {(speed + 0.5 * acceleration * dt) * dt, speed + acceleration * dt}, dt);
  }
};

using Predicted = cb::World<cb::BehaviorSet<cb::DriverActions<cb::UrbanDriver>, cb::UrbanDriver>,
                            cb::InterpolateExecution, cb::SingleTrack>;
using Planner = cb::Mcts<Predicted>;
using World = cb::World<cb::BehaviorSet<SmoothFollower, Planner, cb::UrbanDriver, cb::Mobil, cb::IdmClassic>,
                        cb::InterpolateExecution, cb::SingleTrack>;

/// Its name in snapshots.
inline constexpr char const* component = "record_snapshots";

/// The agent that plans.
inline constexpr cb::AgentId ego{0};

/// What a cycle needs besides the world.
struct Cycle {
  static constexpr cb::AgentId ego = desk::ego;
  double time_step = 0.2;
  double late = 0.0;

  static constexpr char const* name = "cycle";
  static constexpr auto parameters() {
    return cb::parameter_list(
        cb::parameter("time_step", &Cycle::time_step, "s", cb::Range{1e-3, 10}, "from one to the next"),
        cb::parameter("late", &Cycle::late, "s", cb::Range{0, 10}, "how much later the next one comes"));
  }
};

/// Restores its snapshots.
[[nodiscard]] std::unique_ptr<examples::Thawed> thaw(std::shared_ptr<cb::Map const> map, std::string_view bytes,
                                                     std::string const& where);

}  // namespace desk

CAMBIUM_EXTERN_WORLD(desk::World);
CAMBIUM_EXTERN_PLANNING(desk::World, desk::Planner);
