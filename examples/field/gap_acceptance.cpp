#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "cambium/core/portable_math.hpp"
#include "cambium/map/corridor/build_corridor.hpp"

#include "junction.hpp"
#include "row.hpp"

namespace field {
namespace {

constexpr double warm_up = 120.0;  // [s]

/// What passes the line of a stream in an hour, of those after the warm-up.
double per_hour(std::vector<double> const& times, double duration) {
  auto const count = std::count_if(times.begin(), times.end(), [](double t) { return t >= warm_up; });
  return static_cast<double>(count) * 3600.0 / duration;
}

/// A movement at a two-way stop, and what it gives way to.
struct Movement {
  char const* name;
  std::vector<std::string> roads;
  std::vector<std::vector<std::string>> rivals;
  double critical, follow_up;  ///< [s], HCM 7th ed., exh. 20-17 and 20-18: major street with two lanes
};

std::vector<Movement> movements() {
  std::vector<std::string> const from_west{"3", "31", "1"}, from_east{"1", "13", "3"};
  return {{"left from major", {"1", "14", "4"}, {from_west}, 4.1, 2.2},
          {"right from minor", {"4", "41", "1"}, {from_west}, 6.2, 3.3},
          {"through from minor", {"4", "42", "2"}, {from_west, from_east}, 6.5, 4.0},
          {"left from minor", {"4", "43", "3"}, {from_west, from_east}, 7.1, 3.5}};
}

constexpr char const* two_way_source = "HCM 7th ed., eq. 20-18, exh. 20-17 and 20-18";

/// Drives the movement against `flow` [1/h] for `duration` [s] after the warm-up.
Junction drive_movement(Movement const& movement, double flow, double duration, People people, std::uint64_t seed) {
  std::vector<Stream> streams{{movement.roads}};
  for (auto const& rival : movement.rivals)
    streams.push_back({rival, flow / static_cast<double>(movement.rivals.size())});
  Junction junction(crossing({priority, stop_sign, priority, stop_sign}), std::move(people), seed, streams);
  junction.drive(warm_up + duration);
  return junction;
}

/// What enters from a saturated minor stream, in shares of what the formula gives for the flow that it met.
double share_of_formula(Junction const& junction, double critical, double follow_up, double duration) {
  double flow = 0.0;
  for (auto const& rivalry : junction.rivalries()) flow += per_hour(rivalry.others, duration);
  return per_hour(junction.at_line(0), duration) / gap_capacity(flow, critical, follow_up);
}

std::vector<Row> two_way_stop(std::uint64_t seed) {
  constexpr double duration = 1800.0;
  std::vector<Row> rows, gaps;
  for (auto const& movement : movements()) {
    std::vector<double> shares, headways;
    std::vector<Decision> all;
    for (double const flow : {200.0, 400.0, 600.0, 800.0, 1000.0}) {
      auto const junction = drive_movement(movement, flow, duration, town_people(), ++seed);
      shares.push_back(share_of_formula(junction, movement.critical, movement.follow_up, duration));
      for (auto const& decision : decisions(junction)) all.push_back(decision);
      for (double const headway : follow_ups(junction)) headways.push_back(headway);
    }
    auto const off = [](double share) { return std::abs(cb::portable::log(std::max(0.01, share))); };
    std::string const name = movement.name;
    rows.push_back({"two-way stop, " + name + ": capacity in shares of people's", 0.85, 1.15, "-", two_way_source,
                    moments(shares).mean});
    rows.push_back(
        {"two-way stop, " + name + ": the share farthest off", 0.85, 1.15, "-", two_way_source,
         *std::max_element(shares.begin(), shares.end(), [&](double a, double b) { return off(a) < off(b); })});
    gaps.push_back({"critical gap, " + name, movement.critical - 0.5, movement.critical + 0.5, "s",
                    "HCM 7th ed., exh. 20-17", critical_gap(all)});
    gaps.push_back({"follow-up headway, " + name, movement.follow_up - 0.3, movement.follow_up + 0.3, "s",
                    "HCM 7th ed., exh. 20-18", moments(headways).mean});
  }
  rows.insert(rows.end(), gaps.begin(), gaps.end());
  return rows;
}

/// Entry capacity of a roundabout with one lane [1/h] at a circulating flow [1/h]: HCM 7th ed., eq. 22-1.
double roundabout_capacity(double flow) { return 1380.0 * cb::portable::exp(-0.00102 * flow); }

/// What enters at arm 1, and what circulates there: comes from arm 4 and leaves at arm 2 [1/h].
std::array<double, 2> roundabout_flows(double circulating, People people, std::uint64_t seed) {
  constexpr double duration = 1800.0;
  std::vector<Stream> streams{{{"1", "103", "11", "201", "12", "302", "3"}}};
  if (circulating > 0.0) streams.push_back({{"4", "403", "14", "101", "11", "202", "2"}, circulating});
  Junction junction(roundabout(), std::move(people), seed, streams);
  junction.drive(warm_up + duration);
  double flow = 0.0;
  for (auto const& rivalry : junction.rivalries()) flow += per_hour(rivalry.others, duration);
  return {per_hour(junction.at_line(0), duration), flow};
}

std::vector<Row> roundabout_entry(std::uint64_t seed) {
  std::vector<Row> rows;
  for (double const nominal : {0.0, 500.0, 1000.0}) {
    auto const [entering, circulating] = roundabout_flows(nominal, town_people(), ++seed);
    double const people = roundabout_capacity(nominal);
    // What circulates differs a little from what should.
    rows.push_back({"roundabout entry, " + std::to_string(static_cast<int>(nominal)) + " cars an hour in the ring",
                    std::round(0.88 * people), std::round(1.12 * people), "1/h", "HCM 7th ed., eq. 22-1",
                    entering / roundabout_capacity(circulating) * people});
  }
  return rows;
}

/// With queues on all arms drivers settle for many minutes into going one by one or two by two: several runs of each.
constexpr std::size_t all_way_runs = 6;

/// Mean headway [s] of those who leave an all-way stop from arm 4, all straight on, with queues on these other arms.
double all_way_headway(std::string const& others, People people, std::uint64_t seed) {
  constexpr double duration = 900.0;
  constexpr double demand = 1800.0;  // [1/h] more than passes, and at random: so the arms do not begin in step
  std::vector<Stream> streams{{{"4", "42", "2"}, demand}};
  for (char const arm : others) {
    std::string const from(1, arm), to(1, arm > '2' ? static_cast<char>(arm - 2) : static_cast<char>(arm + 2));
    streams.push_back({{from, from + to, to}, demand});
  }
  Junction junction(crossing({stop_sign, stop_sign, stop_sign, stop_sign}), std::move(people), seed, streams);
  junction.drive(warm_up + duration);
  return 3600.0 / per_hour(junction.at_line(0), duration);
}

std::vector<Row> all_way_stop(std::uint64_t seed) {
  struct Case {
    char const* name;
    std::vector<std::string> others;
    double headway, tolerance;
  };
  std::vector<Row> rows;
  for (auto const& [name, others, headway, tolerance] :
       {Case{"nobody else", {""}, 3.9, 0.5}, Case{"a queue opposite", {"2"}, 4.7, 0.5},
        Case{"a queue on one side", {"1", "3"}, 5.8, 0.5},
        Case{"queues on two other arms", {"12", "23", "13"}, 7.0, 0.5},
        Case{"queues on all arms", {"123"}, 9.6, 1.0}}) {
    std::vector<double> headways;
    for (std::size_t run = 0; run < all_way_runs; ++run)
      headways.push_back(all_way_headway(others[run % others.size()], town_people(), ++seed));
    rows.push_back({std::string("all-way stop, headway with ") + name, headway - tolerance, headway + tolerance, "s",
                    "HCM 7th ed., exh. 21-15", moments(headways).mean});
  }
  return rows;
}

/// Capacities with 15 % of lorries, in shares of what the handbook gives.
std::vector<Row> junctions_with_trucks(std::uint64_t seed) {
  constexpr double share = 0.15, duration = 1800.0, flow = 600.0;
  auto const people = town_people(share);
  std::vector<double> stops, headways;
  for (auto const& movement : movements())
    stops.push_back(share_of_formula(drive_movement(movement, flow, duration, people, ++seed),
                                     movement.critical + share, movement.follow_up + 0.9 * share, duration));
  for (std::size_t run = 0; run < all_way_runs; ++run) headways.push_back(all_way_headway("123", people, ++seed));
  auto const [entering, circulating] = roundabout_flows(500.0, people, ++seed);
  double const equivalents = 1.0 + share;  // of a vehicle, at two cars for a lorry
  return {{"two-way stop with 15 % lorries, capacity in shares", 0.85, 1.15, "-", "HCM 7th ed., eq. 20-30 and 20-31",
           moments(stops).mean},
          {"all-way stop with 15 % lorries, capacity in shares", 0.85, 1.15, "-", "HCM 7th ed., exh. 21-15",
           (9.6 + 1.7 * share) / moments(headways).mean},
          {"roundabout with 15 % lorries, capacity in shares", 0.85, 1.15, "-", "HCM 7th ed., eq. 22-1, exh. 22-11",
           entering * equivalents / roundabout_capacity(circulating * equivalents)}};
}

/// Whether a driver that stands at the stop sign, to turn right, takes a gap of `gap` [s] that begins after `wait` [s]
/// in which a car has come every 1.5 s.
bool takes_gap(std::shared_ptr<cb::Map const> const& map, Sim::AgentSpec subject, double wait, double gap,
               std::uint64_t seed) {
  constexpr double dt = 0.1, headway = 1.5, last = 20.0;  // [s]
  Sim world(map, {.seed = seed});
  auto const own = route_through(*map, {"4", "41", "1"}), other = route_through(*map, {"3", "31", "1"});
  auto const road = build_road_corridor(*map, own), other_road = build_road_corridor(*map, other);
  auto const& corridor = road->corridors[road->main];
  auto const& other_corridor = other_road->corridors[other_road->main];
  auto const& conflict = *std::find_if(corridor.conflicts.begin(), corridor.conflicts.end(), [&](auto const& c) {
    return c.other == other.lanes[1] && !c.zones[0][0].empty();
  });
  auto const& zone = conflict.zones[0][0];
  double const meets = other_corridor.position_of({other.lanes[1], 0.0}).value() + zone.other_begin;
  subject.position = corridor.center.pose(zone.line - subject.shape.front - 1.0).position();
  subject.speed = 0.0;
  subject.route = own;
  auto const id = world.add(subject);
  std::vector<double> passages;
  for (double t = wait; t > 0.0; t -= headway) passages.push_back(t);
  std::reverse(passages.begin(), passages.end());
  for (double t = wait + gap; t < wait + gap + last; t += headway) passages.push_back(t);
  for (std::size_t next = 0; world.time() < wait + gap;) {
    for (; next < passages.size(); ++next) {
      double const s = meets - town_limit * (passages[next] - world.time());
      if (s < 5.0) break;
      world.add({.position = other_corridor.center.pose(s).position(),
                 .speed = town_limit,
                 .behavior = cb::ConstantAcceleration{},
                 .route = other});
    }
    if (!world.step(dt)) throw cb::Error("a step of the simulation", "failed", "report this as a bug");
    if (world.record(id).lane.s > zone.begin) return true;
    world.remove_departed();
  }
  return false;
}

/// The shortest gap [s] that the driver takes after it has waited.
double shortest_gap(std::shared_ptr<cb::Map const> const& map, Sim::AgentSpec const& subject, double wait,
                    std::uint64_t seed) {
  double low = 1.5, high = 15.0;
  while (high - low > 0.1) {
    double const middle = 0.5 * (low + high);
    (takes_gap(map, subject, wait, middle, seed) ? high : low) = middle;
  }
  return high;
}

std::vector<Row> patience(std::uint64_t seed) {
  constexpr std::uint64_t drivers = 15;
  auto const map = crossing({priority, stop_sign, priority, stop_sign});
  std::vector<double> falls;
  for (std::uint64_t i = 0; i < drivers; ++i) {
    cb::RandomStream random(seed, static_cast<std::uint32_t>(i), 0);
    auto const subject = town_people().draw(random);
    falls.push_back(shortest_gap(map, subject, 3.0, seed + i) - shortest_gap(map, subject, 60.0, seed + i));
  }
  return {{"fall of the critical gap in 60 s of waiting", 0.5, 1.5, "s", "Polus 2003, 2005; Adebisi; size unverified",
           moments(falls).mean, true}};
}

}  // namespace

std::vector<Experiment> junction_experiments() {
  return {{"two-way stop", two_way_stop},
          {"roundabout", roundabout_entry},
          {"all-way stop", all_way_stop},
          {"junctions with trucks", junctions_with_trucks},
          {"patience", patience}};
}

}  // namespace field
