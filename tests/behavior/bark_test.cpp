// BARK's drivers against BARK's tables: each row predicts the next one.
#include <doctest/doctest.h>

#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "../support/bark.hpp"
#include "../support/corpus.hpp"
#include "lane_traffic_fixtures.hpp"

using namespace lane_traffic;

namespace {

struct Row {
  int step, agent;
  cb::State state;
  double acceleration, steering;
  int corridor, front;
  double front_gap, front_speed;
};

std::vector<Row> read_rows(std::string const& name) {
  std::vector<Row> rows;
  auto const file = corpus::find("oracle/bark/" + name);
  if (!file) return rows;
  auto const number = [](std::string const& text) { return text.empty() ? 0.0 : std::stod(text); };
  for (auto const& c : corpus::table(*file))
    rows.push_back({std::stoi(c[0]),
                    std::stoi(c[2]),
                    {number(c[1]), number(c[4]), number(c[5]), number(c[6]), number(c[7])},
                    number(c[8]),
                    number(c[9]),
                    std::stoi(c[10]),
                    std::stoi(c[11]),
                    number(c[12]),
                    number(c[13])});
  return rows;
}

/// The centre lines on which BARK drives.
/// A lane of 3.5 m along `points`.
cb::map::LaneCorridor lane_along(std::vector<cb::geometry::Point> const& points) {
  cb::map::LaneCorridor lane;
  lane.center = cb::geometry::Line::from_points(points);
  lane.widths.assign(lane.center.segments().size() + 1, {1.75, 1.75});
  return lane;
}

std::vector<cb::map::LaneCorridor> straight_corridors() {
  std::vector<cb::map::LaneCorridor> corridors(2);
  for (int i = 0; i < 2; ++i) {
    std::vector<cb::geometry::Point> const points{{0, -1.75 - 3.5 * i}, {1000, -1.75 - 3.5 * i}};
    corridors[static_cast<std::size_t>(i)] = lane_along(points);
  }
  return corridors;
}
std::vector<cb::map::LaneCorridor> arc_corridors(std::string const& line) {
  std::vector<cb::map::LaneCorridor> corridors(2);
  std::vector<std::vector<cb::geometry::Point>> points(2);
  for (auto const& c : corpus::table(*corpus::find("oracle/bark/bark_arc_centerlines.csv")))
    if (c[1] == line) points[static_cast<std::size_t>(std::stoi(c[0]))].emplace_back(std::stod(c[3]), std::stod(c[4]));
  for (std::size_t i = 0; i < 2; ++i) corridors[i] = lane_along(points[i]);
  return corridors;
}

/// What an agent of a table sees in one row.
struct RowView {
  using State = cb::State;
  using Dynamics = cb::SingleTrack;

  Row const* row;
  Row const* leader;
  cb::map::LaneCorridor const* lane;
  cb::SingleTrack model{.steering_limit = 0.2, .lateral_acceleration_limit = 1000.0};
  cb::geometry::Shape box{1.75, 2.25, 1.0, 1.0};
  cb::map::LanePlace at{};

  RowView(Row const& seen, Row const* next, cb::map::LaneCorridor const& corridor_of_row)
      : row(&seen), leader(next), lane(&corridor_of_row) {
    cb::geometry::Point const p{seen.state.x, seen.state.y};
    auto const foot = lane->center.project(p);
    at.s = foot.s;
    at.lateral = foot.lateral;
    at.segment = foot.segment;
  }
  [[nodiscard]] double time() const { return row->state.time; }
  [[nodiscard]] State const& state() const { return row->state; }
  [[nodiscard]] cb::geometry::Shape const& shape() const { return box; }
  [[nodiscard]] Dynamics const& dynamics() const { return model; }
  [[nodiscard]] cb::map::LaneCorridor const& corridor() const { return *lane; }
  [[nodiscard]] cb::map::LanePlace const& place() const { return at; }
  template <class F>
  void each_ahead(cb::Look const& look, F&& f) const {
    if (auto const next = ahead(look)) f(*next);
  }
  [[nodiscard]] std::optional<cb::RoadUser> ahead(cb::Look const& = {}) const {
    if (leader == nullptr) return std::nullopt;
    return cb::RoadUser{.agent = cb::AgentId{1}, .gap = row->front_gap, .speed = row->front_speed};
  }
  [[nodiscard]] double acceleration(cb::RoadUser const&) const { return leader->acceleration; }
  [[nodiscard]] cb::map::LightColor light(cb::LightId) const { return cb::map::LightColor::off; }
  [[nodiscard]] double red_for(cb::LightId) const { return 0.0; }

  // What a driver asks only of merges, drifts and those beside it, which BARK's rows do not have.
  [[nodiscard]] cb::map::LanePlace place(cb::CorridorId) const { return at; }
  [[nodiscard]] std::optional<cb::RoadUser> behind(cb::Look const& = {}) const { return std::nullopt; }
  [[nodiscard]] std::optional<cb::RoadUser> merging(double, double) const { return std::nullopt; }
  [[nodiscard]] State const& state(cb::RoadUser const&) const { return leader->state; }
  [[nodiscard]] cb::geometry::Shape const& shape(cb::RoadUser const&) const { return box; }
  [[nodiscard]] cb::map::RoadCorridor const& road() const {
    static cb::map::RoadCorridor const none{};
    return none;
  }
  [[nodiscard]] cb::Map const& map() const {
    static auto const road = support::straight_road();
    return *road;
  }
  [[nodiscard]] cb::geometry::Polygon const& outline(cb::RoadUser const&) const {
    static cb::geometry::Polygon const none{};
    return none;
  }
  template <class F>
  void around(cb::map::LanePlace const&, double, F&&) const {}
  template <class F>
  void for_each_object(F&&) const {}
  [[nodiscard]] bool anybody_off_lanes() const { return false; }
  [[nodiscard]] bool anybody_leaves_room() const { return false; }
  template <class F>
  void off_lanes(double, F&&) const {}
  template <class F>
  void on_lane(double, double, F&&) const {}
};

struct Worst {
  double place = 0, heading = 0, speed = 0, action = 0;
  int compared = 0, at_kinks = 0;
};

/// Largest differences after one step from each row; `behavior_of(agent)`.
template <class BehaviorOf>
Worst compare(std::string const& file, std::vector<cb::map::LaneCorridor> const& corridors,
              BehaviorOf const& behavior_of, int first_step = 0) {
  auto const rows = read_rows(file);
  std::map<std::pair<int, int>, Row const*> by;
  for (auto const& row : rows) by[{row.step, row.agent}] = &row;
  Worst worst;
  for (auto const& row : rows) {
    auto const next = by.find({row.step + 1, row.agent});
    if (next == by.end() || row.step < first_step) continue;
    auto const* const leader = row.front < 0 ? nullptr : by.at({row.step, row.front});
    RowView const view(row, leader, corridors[static_cast<std::size_t>(row.corridor)]);
    auto const behavior = behavior_of(row.agent);
    cb::MemoryOf<std::remove_cvref_t<decltype(behavior)>> memory;
    auto const plan = behavior.plan(view, memory, 0.2);
    auto const end = cb::InterpolateExecution{}.execute(plan, row.state, view.model, row.state.time + 0.2);
    auto const& expected = *next->second;
    worst.place = std::max(worst.place, std::hypot(end.state.x - expected.state.x, end.state.y - expected.state.y));
    double const turn = std::abs(cb::geometry::angle_difference(end.state.heading, expected.state.heading));
    if (turn > 1e-5)
      ++worst.at_kinks;  // the foot point is a vertex, where the line has two directions
    else
      worst.heading = std::max(worst.heading, turn);
    worst.speed = std::max(worst.speed, std::abs(end.state.speed - expected.state.speed));
    worst.action = std::max({worst.action, std::abs(plan.action.acceleration - expected.acceleration)});
    ++worst.compared;
  }
  MESSAGE(file << ": " << worst.compared << " transitions, largest differences: place " << worst.place << " m, heading "
               << worst.heading << " rad, speed " << worst.speed << " m/s, acceleration " << worst.action << " m/s^2");
  return worst;
}

/// Largest distance [m] from BARK's agents over all 50 steps, if each agent drives by its own plans from its first row
/// on, behind the leader in BARK's table.
template <class BehaviorOf>
double roll_out(std::string const& file, std::vector<cb::map::LaneCorridor> const& corridors,
                BehaviorOf const& behavior_of) {
  auto const rows = read_rows(file);
  std::map<std::pair<int, int>, Row const*> by;
  int steps = 0;
  for (auto const& row : rows) {
    by[{row.step, row.agent}] = &row;
    steps = std::max(steps, row.step);
  }
  double worst = 0.0;
  for (auto const& first : rows) {
    if (first.step != 0 || first.agent > 5) continue;  // agent 6 stands still
    auto const behavior = behavior_of(first.agent);
    cb::MemoryOf<std::remove_cvref_t<decltype(behavior)>> memory;
    auto state = first.state;
    for (int k = 0; k < steps; ++k) {
      Row row = *by.at({k, first.agent});
      row.front_gap += row.state.x - state.x;  // on a lane along +x
      row.state = state;
      auto const* const leader = row.front < 0 ? nullptr : by.at({k, row.front});
      RowView const view(row, leader, corridors[static_cast<std::size_t>(row.corridor)]);
      auto const plan = behavior.plan(view, memory, 0.2);
      state = cb::InterpolateExecution{}.execute(plan, state, view.model, row.state.time + 0.2).state;
      auto const& expected = by.at({k + 1, first.agent})->state;
      worst = std::max(worst, std::hypot(state.x - expected.x, state.y - expected.y));
    }
  }
  MESSAGE(file << ": after up to " << steps << " steps no farther off than " << worst << " m");
  return worst;
}

cb::IdmParameters bark_idm(double desired_speed) {
  cb::IdmParameters p{.desired_speed = desired_speed};
  p.comfortable_deceleration = 1.67f;  // BARK keeps it as a float
  return p;
}

bark::Driver acc_driver(int agent) {
  return {bark_idm(agent == 1 ? 15 : agent == 2 ? 12 : 8), cb::AdaptiveCruiseControl{}.coolness};
}
bark::LaneTracking straight_tracking(int agent) { return {bark_idm(agent == 1 ? 15 : agent == 2 ? 12 : 10)}; }

cb::AgentId id_of(int agent) { return static_cast<cb::AgentId>(agent); }

using World = Traffic<bark::Driver, cb::IdmClassic, cb::ConstantAcceleration>;

/// The agents of one step as a world; only agent `only` if that is not 0.
World world_at(std::shared_ptr<cb::Map const> const& map, std::vector<Row> const& rows, int step, int only = 0) {
  std::map<int, double> const desired_speed{{1, 15.0}, {2, 12.0}, {3, 8.0}, {4, 18.0}, {5, 10.0}};
  World world(map);
  for (auto const& row : rows) {
    if (row.step != step || (only != 0 && row.agent != only)) continue;
    World::AgentSpec spec{.position = {row.state.x, row.state.y},
                          .heading = row.state.heading,
                          .speed = row.state.speed,
                          .shape = {1.75, 2.25, 1.0, 1.0}};
    spec.id = id_of(row.agent);
    if (auto const at = desired_speed.find(row.agent); at != desired_speed.end()) {
      spec.behavior = bark::Driver{bark_idm(at->second)};
    } else {
      spec.behavior = cb::ConstantAcceleration{};
    }
    world.add(spec);
  }
  return world;
}

}  // namespace

TEST_CASE("IDM with BARK's sub-steps reproduces BARK's highway traffic to 1e-9") {
  auto const rows = read_rows("bark_idm_highway.csv");
  if (rows.empty()) return;
  auto const map = straight_road(2, 1000.0);
  int compared = 0, lost_leaders = 0;
  double worst = 0;
  for (auto const& row : rows) {
    auto world = world_at(map, rows, row.step);
    auto const front = world.observe(id_of(row.agent)).ahead();
    int const ours = front ? static_cast<int>(front->agent) : -1;
    // BARK loses a leader that is not among the four nearest agents; the follower then drives as if alone.
    bool const lost = row.front == -1 && ours != -1;
    lost_leaders += lost;
    if (!lost) {
      CHECK(ours == row.front);
      if (front) CHECK(front->gap == doctest::Approx(row.front_gap).epsilon(1e-9));
    }
    if (lost) world = world_at(map, rows, row.step, row.agent);
    REQUIRE(world.step(0.2));
    for (auto const& next : rows) {
      if (next.agent != row.agent || next.step != row.step + 1) continue;
      auto const& record = world.record(id_of(row.agent));
      for (double const difference :
           {record.state.x - next.state.x, record.state.y - next.state.y, record.state.speed - next.state.speed})
        worst = std::max(worst, std::abs(difference));
      if (row.agent != 6) worst = std::max(worst, std::abs(record.action.acceleration - next.acceleration));
      ++compared;
    }
  }
  MESSAGE(compared << " transitions, largest difference " << worst << "; BARK had lost the leader in " << lost_leaders);
  CHECK(compared == 300);
  CHECK(lost_leaders > 0);
  CHECK(worst < 1e-9);
}

TEST_CASE("BARK's sub-steps and the exact integration agree where nothing changes quickly") {
  auto const map = straight_road(1, 1000.0);
  World exact(map), bark(map);
  exact.add({.position = {10, -1.75}, .speed = 14, .behavior = cb::IdmClassic{}});
  bark.add({.position = {10, -1.75}, .speed = 14, .behavior = bark::Driver{}});
  for (int i = 0; i < 100; ++i) {
    REQUIRE(exact.step(0.2));
    REQUIRE(bark.step(0.2));
  }
  CHECK(exact.frame().agents[0].state.x == doctest::Approx(bark.frame().agents[0].state.x).epsilon(1e-3));
  CHECK(exact.frame().agents[0].state.x != bark.frame().agents[0].state.x);
}

TEST_CASE("the ACC model with BARK's sub-steps equals BARK's to 1e-9") {
  if (!corpus::root()) return;
  auto const worst = compare("bark_idm_coolness_highway.csv", straight_corridors(), acc_driver);
  CHECK(worst.compared == 150);
  CHECK(worst.place < 1e-9);
  CHECK(worst.speed < 1e-9);
  CHECK(worst.action < 1e-9);
}

TEST_CASE("lane tracking with BARK's sub-steps equals BARK's, except for its angles of single precision") {
  if (!corpus::root()) return;
  auto const worst = compare("bark_lanetracking_straight.csv", straight_corridors(), straight_tracking);
  CHECK(worst.compared == 150);
  CHECK(worst.place < 1e-6);
  CHECK(worst.heading < 5e-7);
  CHECK(worst.speed < 1e-9);
  CHECK(worst.action < 1e-7);
}

TEST_CASE("over 50 steps the models stay with BARK's agents within the tables' tolerances") {
  if (!corpus::root()) return;
  auto const idm = [](int agent) {
    double const desired[] = {15, 12, 8, 18, 10};
    return bark::Driver{bark_idm(desired[agent - 1])};
  };
  CHECK(roll_out("bark_idm_highway.csv", straight_corridors(), idm) < 1e-9);
  CHECK(roll_out("bark_idm_coolness_highway.csv", straight_corridors(), acc_driver) < 1e-9);
  CHECK(roll_out("bark_lanetracking_straight.csv", straight_corridors(), straight_tracking) < 1e-4);
}

TEST_CASE("on an arc lane tracking equals BARK's along BARK's coarse line") {
  if (!corpus::root()) return;
  auto const driver = [](int agent) { return bark::LaneTracking{bark_idm(agent == 1 ? 15 : agent == 2 ? 9 : 12)}; };
  auto const worst = compare("bark_lanetracking_arc.csv", arc_corridors("center"), driver);
  CHECK(worst.compared == 150);
  CHECK(worst.at_kinks <= 1);
  CHECK(worst.place < 1e-6);
  CHECK(worst.heading < 5e-7);
  CHECK(worst.speed < 1e-9);
}

TEST_CASE(
    "on an arc IDM equals BARK's along BARK's coarse line after the first step, in which BARK moves the agent onto "
    "it") {
  if (!corpus::root()) return;
  auto const driver_of = [](int agent) { return bark::Driver{bark_idm(agent == 1 ? 15.0 : agent == 2 ? 9.0 : 12.0)}; };
  auto const all = compare("bark_idm_arc.csv", arc_corridors("center"), driver_of);
  CHECK(all.place > 0.1);  // BARK's line is this far from the true arc
  auto const worst = compare("bark_idm_arc.csv", arc_corridors("center"), driver_of, 1);
  CHECK(worst.compared == 147);
  CHECK(worst.at_kinks == 0);
  CHECK(worst.place < 1e-6);
  CHECK(worst.heading < 5e-7);
  CHECK(worst.speed < 1e-9);
}

TEST_CASE("unlike in BARK, a standing vehicle does not creep back and a faster leader does not cause braking") {
  cb::IdmParameters const p;
  cb::map::LaneCorridor lane = straight_corridors()[0];
  Row self{0, 1, {0, 100, -1.75, 0, 0}, 0, 0, 0, 2, 1.0, 0.0};
  RowView const view(self, &self, lane);
  auto const theirs = bark::Driver{p}.follow(view, {.gap = 1.0}, 0.2).trajectory.back();
  cb::IdmClassic::Memory memory;
  auto const ours = cb::IdmClassic{}.plan(view, memory, 0.2).trajectory.back();
  MESSAGE("standing 1 m behind another, after 0.2 s: BARK " << theirs.x - 100 << " m, here " << ours.x - 100 << " m");
  CHECK(theirs.x < 100.0);
  CHECK(ours.x == 100.0);
  double const bark = bark::acceleration(p, 0.0, 10.0, {.gap = 10.0, .speed = 25.0}),
               law = cb::idm_acceleration(p, 10.0, 10.0, 25.0);
  MESSAGE("at 10 m/s, 10 m behind a leader of 25 m/s: BARK " << bark << " m/s^2, here " << law << " m/s^2");
  CHECK(bark == p.lowest_acceleration);
  CHECK(law > 0.5);
}
