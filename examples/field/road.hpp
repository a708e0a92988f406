#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <unordered_map>
#include <vector>

#include "cambium/behavior.hpp"
#include "cambium/behavior/people.hpp"
#include "cambium/core/random.hpp"
#include "cambium/dynamics/single_track.hpp"
#include "cambium/execution/interpolate.hpp"
#include "cambium/map/map.hpp"
#include "cambium/scenario/traffic_inflow.hpp"
#include "cambium/world/extern_world.hpp"
#include "cambium/world/world.hpp"

// Traffic on straight roads, and what detectors on them measure.
namespace field {

namespace cb = cambium;

using Driver = cb::UrbanDriver;
using Human = cb::HumanDriver<Driver>;
using Sim =
    cb::World<cb::BehaviorSet<Driver, Human, cb::ConstantAcceleration>, cb::InterpolateExecution, cb::SingleTrack>;

/// Who drives.
struct People {
  cb::Population cars = cb::presets::motorway_cars(), trucks = cb::presets::motorway_trucks();
  double truck_share = 0.0;

  /// The next vehicle, at the speed that it desires; without or with a human's errors.
  [[nodiscard]] Sim::AgentSpec draw(cb::RandomStream& random) const;
  [[nodiscard]] Sim::AgentSpec draw_erring(cb::RandomStream& random) const;
};

/// A straight road of `length` [m] with `lanes` lanes and a speed `limit` [m/s], infinite: none. Beyond `drop` [m], if
/// that is above 0, the rightmost lane is missing.
[[nodiscard]] std::shared_ptr<cb::Map const> straight_road(double length, std::size_t lanes, double limit,
                                                           double drop = 0.0);

/// A vehicle whose front end passes a detector.
struct Passage {
  double time{};   ///< [s]
  double speed{};  ///< [m/s]
  int lane{};      ///< 0: the leftmost one
  bool is_car{};
};

/// Drives traffic along a straight road that begins at x = 0 and leads along x, and notes what observers of real
/// traffic do.
class Observed {
 public:
  static constexpr double dt = 0.2;  ///< [s]

  /// Traffic of `per_hour` vehicles in each lane, and a detector at this place [m].
  Observed(std::shared_ptr<cb::Map const> map, People people, double per_hour, std::uint64_t seed, double detector);

  /// Drives for `duration` [s].
  void drive(double duration);
  /// Forgets what was observed so far.
  void clear();

  [[nodiscard]] std::vector<Passage> const& passages() const { return passages_; }  ///< in order of time
  [[nodiscard]] double kilometres() const { return kilometres_; }                   ///< of all vehicles
  [[nodiscard]] std::size_t lane_changes() const { return lane_changes_; }
  [[nodiscard]] std::vector<double> const& durations() const { return durations_; }  ///< of lane changes [s]
  [[nodiscard]] std::size_t lanes() const { return lanes_; }

 private:
  struct Seen {
    double front{}, change_began = -1.0;
    cb::CorridorId lane{};
    bool crossed = false;
  };
  void look();

  Sim world_;
  People people_;
  std::unordered_map<cb::LaneId, cb::map::Route> routes_;  ///< by the lane where they begin
  cb::TrafficInflow<Sim> inflow_;
  double detector_;
  std::vector<Passage> passages_;
  std::size_t lanes_;
  std::unordered_map<cb::AgentId, Seen> seen_;
  std::vector<double> durations_;
  double kilometres_ = 0.0;
  std::size_t lane_changes_ = 0;
};

/// Mean and standard deviation.
struct Moments {
  double mean{}, deviation{};
};
[[nodiscard]] Moments moments(std::vector<double> const& values);

/// Time headways [s] of followers: of vehicles up to `longest` [s] behind another one, and about as fast (2 m/s).
[[nodiscard]] std::vector<double> follower_headways(std::vector<Passage> const& passages, double longest = 3.0);

/// Speed [m/s] averaged over the road, as density needs it: the harmonic mean of those that pass.
[[nodiscard]] double space_mean_speed(std::vector<Passage> const& passages);

}  // namespace field

CAMBIUM_EXTERN_WORLD(field::Sim);
