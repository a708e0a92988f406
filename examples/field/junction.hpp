#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "gaps.hpp"
#include "road.hpp"

// Traffic at junctions with one lane each way, and what observers beside the road note.
namespace field {

constexpr double town_limit = 50.0 / 3.6;  ///< [m/s]

/// Who drives in town.
[[nodiscard]] People town_people(double truck_share = 0.0);

/// Signs of OpenDRIVE's catalogue.
inline constexpr char const *priority = "306", *stop_sign = "206", *light = "1000001";

/// Two streets that cross, with one lane each way and a speed `limit` [m/s]. Arms 1 (east) and 3 (west) are 200 m long,
/// 2 (north) and 4 (south) 100 m; `signs` stand at them in that order. Road "13" leads from arm 1 to arm 3, and so on.
/// The light of arm 1 is "signal 1".
[[nodiscard]] std::shared_ptr<cb::Map const> crossing(std::array<char const*, 4> const& signs,
                                                      double limit = town_limit);

/// The roundabout of `maps`: one lane, 20 m radius, four arms; arm 1 is entered by road "103", arm 2 left by "202".
[[nodiscard]] std::shared_ptr<cb::Map const> roundabout();

/// The route through these roads. Throws `cambium::Error` where they do not lead into each other.
[[nodiscard]] cb::map::Route route_through(cb::Map const& map, std::vector<std::string> const& roads);

/// Vehicles of one way through the junction.
struct Stream {
  std::vector<std::string> roads;
  double per_hour = cb::TrafficSource::saturated;  ///< saturated: a queue that does not end
};

/// Drives streams through a junction and notes when each vehicle passes. Nobody overtakes, so the n-th time at any
/// place of a stream is that of its n-th vehicle.
class Junction {
 public:
  /// Each stream enters on a lane of its own. Those of streams 1, 2, ... that cross stream 0 or join it are its rivals.
  Junction(std::shared_ptr<cb::Map const> map, People people, std::uint64_t seed, std::vector<Stream> streams);

  /// Drives for `duration` [s].
  void drive(double duration);

  [[nodiscard]] Sim& world() { return world_; }
  /// When front wheels passed the line where the stream enters the junction [s].
  [[nodiscard]] std::vector<double> const& at_line(std::size_t stream) const { return ways_[stream].line.times; }
  /// When vehicles of stream 0 became the first at the line and stood there, or were within 3 m of it [s].
  [[nodiscard]] std::vector<double> const& became_first() const { return became_first_; }

  /// When reference points of vehicles of stream 0 came to where they can touch a rival, and the reverse [s].
  struct Rivalry {
    std::size_t stream{};
    std::vector<double> const& own;
    std::vector<double> const& others;
  };
  [[nodiscard]] std::vector<Rivalry> rivalries() const;

 private:
  static constexpr double dt = 0.2;

  struct Detector {
    double place{};  ///< on the corridor [m]
    std::vector<double> times{};
  };
  struct Way {
    cb::map::Route route;
    Detector line;                  ///< of front wheels
    std::vector<Detector> meets{};  ///< of reference points: where it meets stream 0, or of that, its rivals
  };
  struct Seen {
    std::size_t way{}, number{};
    double s{};
  };
  void look();

  Sim world_;
  People people_;
  std::vector<Way> ways_;
  std::vector<std::size_t> rivals_;  ///< in the order of `ways_[0].meets`
  cb::TrafficInflow<Sim> inflow_;
  std::unordered_map<cb::AgentId, Seen> seen_;
  std::vector<std::size_t> entered_;
  std::vector<double> became_first_;
};

/// The decisions of those in stream 0 that were first at the line when the gap that they took began. A gap is the time
/// from one rival to the next, at the places where their ways meet.
[[nodiscard]] std::vector<Decision> decisions(Junction const& junction);

/// Headways [s] at the line of those in stream 0 that follow each other in the same gap.
[[nodiscard]] std::vector<double> follow_ups(Junction const& junction);

}  // namespace field
