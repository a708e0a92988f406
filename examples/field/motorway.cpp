#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "road.hpp"
#include "row.hpp"

namespace field {
namespace {

constexpr double kmh = 1.0 / 3.6;
constexpr char const* hcm = "HCM 7th ed., exh. 12-4 and 12-6";

/// What passes a detector on three lanes in 15 minutes, after 10 minutes in which traffic builds up.
struct Segment {
  double flow{};   ///< [1/h] a lane
  double speed{};  ///< space mean [m/s]
  Moments followers{};
  double changes_per_kilometre{};
  std::vector<double> durations{};
  std::vector<Passage> passages{};
};

Segment segment(double limit, People const& people, double per_hour, std::uint64_t seed) {
  constexpr double warm_up = 600.0, duration = 900.0, length = 6000.0, detector = 4500.0;
  Observed road(straight_road(length, 3, limit), people, per_hour, seed, detector);
  road.drive(warm_up);
  road.clear();
  road.drive(duration);
  auto const& passages = road.passages();
  return {.flow = static_cast<double>(passages.size()) * 3600.0 / duration / static_cast<double>(road.lanes()),
          .speed = space_mean_speed(passages),
          .followers = moments(follower_headways(passages)),
          .changes_per_kilometre = static_cast<double>(road.lane_changes()) / road.kilometres(),
          .durations = road.durations(),
          .passages = passages};
}

/// The value at `x` of a curve through points of ascending x.
double interpolated(std::vector<std::array<double, 2>> const& curve, double x) {
  auto const right = std::find_if(curve.begin() + 1, curve.end() - 1, [&](auto const& point) { return point[0] >= x; });
  auto const &a = *(right - 1), &b = *right;
  return a[1] + (b[1] - a[1]) * (x - a[0]) / (b[0] - a[0]);
}

/// A segment of three lanes with cars and a limit of 70 mph, at which they drive freely with 113 km/h.
std::vector<Row> basic_segment(std::uint64_t seed) {
  constexpr double limit = 112.65 * kmh;
  std::vector<Segment> all;
  std::vector<std::array<double, 2>> speeds;
  for (double const demand : {100.0, 900.0, 1200.0, 1500.0, 1800.0, 2000.0, 2200.0, 2400.0, 2700.0}) {
    all.push_back(segment(limit, {}, demand, seed + static_cast<std::uint64_t>(demand)));
    if (speeds.empty() || all.back().flow > speeds.back()[0]) speeds.push_back({all.back().flow, all.back().speed});
  }
  auto const& most =
      *std::max_element(all.begin(), all.end(), [](auto const& a, auto const& b) { return a.flow < b.flow; });
  std::vector<double> means, deviations;
  for (std::size_t i = 1; i < 6; ++i) {
    means.push_back(all[i].followers.mean);
    deviations.push_back(all[i].followers.deviation);
  }
  auto const [least, highest] = std::minmax_element(means.begin(), means.end());
  // Lane changes below and near critical density, and how long they take.
  std::vector<double> durations;
  double changes = 0.0;
  for (std::size_t i = 3; i < 6; ++i) {
    changes += all[i].changes_per_kilometre / 3.0;
    durations.insert(durations.end(), all[i].durations.begin(), all[i].durations.end());
  }
  std::vector<double> shares;
  for (auto const& passage : all.front().passages) shares.push_back(passage.speed / limit);
  auto const free = moments(shares);
  auto const usual = std::count_if(durations.begin(), durations.end(), [](double t) { return t >= 2.5 && t <= 8.0; });
  return {
      {"free speed of the motorway below", 108, 118, "km/h", "condition of the next rows", all.front().speed / kmh,
       true},
      {"capacity of a lane, cars", 2150, 2450, "1/h", hcm, most.flow},
      {"speed at 1500 cars an hour", 105, 115, "km/h", hcm, interpolated(speeds, 1500.0) / kmh},
      {"speed at 2000 cars an hour", 93, 107, "km/h", hcm, interpolated(speeds, 2000.0) / kmh},
      {"density at capacity", 25, 31, "1/km", hcm, most.flow / (most.speed / kmh)},
      {"headway of followers, mean", 1.2, 1.5, "s", "Wasielewski 1979", moments(means).mean},
      {"headway of followers, standard deviation", 0.4, 0.65, "s", "Wasielewski 1979", moments(deviations).mean},
      {"change of that mean from 900 to 2000 cars an hour", 0.0, 0.15, "s", "Wasielewski 1979", *highest - *least},
      {"lane changes near critical density", 0.3, 0.7, "1/km", "Knoop et al. 2012", changes},
      {"duration of a lane change, mean", 4, 6, "s", "Toledo, Zohar 2007", moments(durations).mean},
      {"lane changes of 2.5 to 8 s", 0.9, 1.0, "-", "Toledo, Zohar 2007; Lankershim",
       static_cast<double>(usual) / static_cast<double>(durations.size())},
      {"speed in shares of the limit, mean", 0.97, 1.05, "-", "DfT 2019", free.mean},
      {"speed in shares of the limit, standard deviation", 0.1, 0.19, "-", "DfT 2019", free.deviation},
  };
}

/// Capacity with 15 % of lorries, in shares of what the handbook gives.
std::vector<Row> with_trucks(std::uint64_t seed) {
  constexpr double share = 0.15, equivalent = 2.0, base = 2400.0;
  double most = 0.0;
  for (double const demand : {1800.0, 2100.0, 2400.0})
    most = std::max(most, segment(112.65 * kmh, {.truck_share = share}, demand, seed + 1).flow);
  return {{"capacity with 15 % lorries, in shares of the handbook's", 0.85, 1.15, "-", "HCM 7th ed., exh. 12-25",
           most / (base / (1.0 + share * (equivalent - 1.0)))}};
}

/// Speeds of cars on a German motorway without a limit.
std::vector<Row> without_limit(std::uint64_t seed) {
  auto const traffic = segment(std::numeric_limits<double>::infinity(), {.truck_share = 0.1}, 500.0, seed);
  std::vector<double> speeds;
  for (auto const& passage : traffic.passages)
    if (passage.is_car) speeds.push_back(passage.speed / kmh);
  auto const fast = std::count_if(speeds.begin(), speeds.end(), [](double v) { return v > 130.0; });
  return {
      {"speed of cars without a limit, mean", 115, 125, "km/h", "Heidemann 1987; BASt 2010-14", moments(speeds).mean},
      {"of these above 130 km/h", 0.2, 0.35, "-", "Heidemann 1987; BASt; IW 2021",
       static_cast<double>(fast) / static_cast<double>(speeds.size())}};
}

/// Three lanes become two: what passes at a demand far above capacity, against the most that passes at any.
std::vector<Row> lane_drop(std::uint64_t seed) {
  constexpr double warm_up = 600.0, duration = 900.0, drop = 3000.0;  // [s, m]
  auto const map = straight_road(6000.0, 3, 112.65 * kmh, drop);
  double most = 0.0, at_last = 0.0;
  for (double const demand : {1200.0, 1300.0, 1400.0, 1500.0, 1600.0, 2200.0}) {
    Observed road(map, {}, demand, seed, drop + 1500.0);
    road.drive(warm_up);
    road.clear();
    road.drive(duration);
    at_last = static_cast<double>(road.passages().size());
    most = std::max(most, at_last);
  }
  return {{"capacity drop at a lane drop", 0.02, 0.2, "-", "HCM 7th ed., ch. 12; Treiber, Helbing 2002",
           1.0 - at_last / most}};
}

/// A queue on one lane is let go: the wave of those who start, and what flows out of it.
std::vector<Row> queue(std::uint64_t seed) {
  constexpr std::size_t count = 150;
  constexpr double dt = 0.1, moves = 20.0 * kmh;  // [s, m/s]
  Sim world(straight_road(6000.0, 1, 112.65 * kmh), {.seed = seed});
  cb::RandomStream random(seed, 0, 0);
  std::vector<cb::AgentId> ids;
  std::vector<double> places, started(count, -1.0);
  double rear = 4500.0;
  for (std::size_t i = 0; i < count; ++i) {
    auto spec = People{}.draw(random);
    spec.speed = 0.0;
    spec.position = {rear - std::get<Driver>(spec.behavior).law.minimum_gap - spec.shape.front, -1.875};
    rear = spec.position.x() - spec.shape.rear;
    places.push_back(spec.position.x());
    ids.push_back(world.add(spec));
  }
  while (world.time() < 600.0) {
    if (!world.step(dt)) throw cb::Error("a step of the simulation", "failed", "report this as a bug");
    for (std::size_t i = 0; i < count; ++i)
      if (started[i] < 0.0 && world.state(ids[i]).speed > moves) started[i] = world.time();
  }
  // Regression of the place on the time.
  double t = 0.0, x = 0.0, tt = 0.0, tx = 0.0;
  constexpr std::size_t first = 10;
  constexpr double n = count - first;
  for (std::size_t i = first; i < count; ++i) {
    t += started[i] / n;
    x += places[i] / n;
    tt += started[i] * started[i] / n;
    tx += started[i] * places[i] / n;
  }
  return {{"wave of those who start in a jam", -20, -15, "km/h", "Treiber, Kesting 2013; Stipdonk et al.: -18",
           (tx - t * x) / (tt - t * t) / kmh}};
}

/// A human driver follows one who keeps its speed.
std::vector<Row> noise(std::uint64_t seed) {
  constexpr double dt = 0.2, warm_up = 60.0, duration = 1800.0, speed = 20.0;
  auto const map = straight_road(45'000.0, 1, std::numeric_limits<double>::infinity());
  std::vector<double> all_deviations, all_lags;
  for (std::uint64_t number = 0; number < 8; ++number) {
    Sim world(map, {.seed = seed + number});
    cb::RandomStream random(seed, static_cast<std::uint32_t>(number), 0);
    auto spec = People{}.draw(random);
    spec.behavior = Human{.nominal = std::get<Driver>(spec.behavior)};
    spec.speed = speed;
    spec.position = {10.0, -1.875};
    auto const follower = world.add(spec);
    world.add({.position = {50.0, -1.875}, .speed = speed, .behavior = cb::ConstantAcceleration{}});
    std::vector<double> accelerations;
    while (world.time() < warm_up + duration) {
      double const before = world.state(follower).speed;
      if (!world.step(dt)) throw cb::Error("a step of the simulation", "failed", "report this as a bug");
      if (world.time() > warm_up) accelerations.push_back((world.state(follower).speed - before) / dt);
    }
    auto const [mean, deviation] = moments(accelerations);
    all_deviations.push_back(deviation);
    // The lag at which the autocorrelation has fallen to 1 / e.
    std::size_t lag = 0;
    for (double correlation = 1.0; correlation > std::exp(-1.0) && lag < 200;) {
      ++lag;
      double sum = 0.0;
      for (std::size_t i = lag; i < accelerations.size(); ++i)
        sum += (accelerations[i] - mean) * (accelerations[i - lag] - mean);
      correlation = sum / static_cast<double>(accelerations.size() - lag) / (deviation * deviation);
    }
    all_lags.push_back(static_cast<double>(lag) * dt);
  }
  return {{"noise of the acceleration in following, with human errors", 0.2, 0.3, "m/s^2", "Zhang, Sun 2022 (highD)",
           moments(all_deviations).mean},
          {"correlation time of that noise", 1, 2, "s", "Zhang, Sun 2022 (highD)", moments(all_lags).mean}};
}

}  // namespace

std::vector<Experiment> motorway_experiments() {
  return {{"segment", basic_segment}, {"trucks", with_trucks}, {"no limit", without_limit},
          {"lane drop", lane_drop},   {"queue", queue},        {"noise", noise}};
}

}  // namespace field
