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
  int agent{};
  cb::State state;
  double acceleration{};
  int corridor{}, front{};
  double front_gap{}, front_speed{};
};

/// The rows of a table by step and agent; none where there is no corpus.
std::map<std::pair<int, int>, Row> read_rows(std::string const& name) {
  std::map<std::pair<int, int>, Row> rows;
  auto const file = corpus::find("oracle/bark/" + name);
  if (!file) return rows;
  auto const number = [](std::string const& text) { return text.empty() ? 0.0 : std::stod(text); };
  for (auto const& c : corpus::table(*file))
    rows[{std::stoi(c[0]), std::stoi(c[2])}] = {
        std::stoi(c[2]),  {number(c[1]), number(c[4]), number(c[5]), number(c[6]), number(c[7])},
        number(c[8]),     std::stoi(c[10]),
        std::stoi(c[11]), number(c[12]),
        number(c[13])};
  return rows;
}

/// A lane of 3.5 m along `points`.
cb::map::LaneCorridor lane_along(std::vector<cb::geometry::Point> const& points) {
  cb::map::LaneCorridor lane;
  lane.center = cb::geometry::Line::from_points(points);
  lane.widths.assign(lane.center.segments().size() + 1, {1.75, 1.75});
  return lane;
}

std::vector<cb::map::LaneCorridor> straight_corridors() {
  return {lane_along({{0, -1.75}, {1000, -1.75}}), lane_along({{0, -5.25}, {1000, -5.25}})};
}

/// The centre lines on which BARK drives round a bend.
std::vector<cb::map::LaneCorridor> arc_corridors() {
  std::vector<std::vector<cb::geometry::Point>> points(2);
  for (auto const& c : corpus::table(*corpus::find("oracle/bark/bark_arc_centerlines.csv")))
    if (c[1] == "center")
      points[static_cast<std::size_t>(std::stoi(c[0]))].emplace_back(std::stod(c[3]), std::stod(c[4]));
  return {lane_along(points[0]), lane_along(points[1])};
}

/// BARK's car: its reference point is its middle.
constexpr cb::geometry::Shape bark_car{1.75, 2.25, 1.0, 1.0};

/// What an agent of a table sees in one row.
struct RowView {
  using State = cb::State;
  using Dynamics = cb::SingleTrack;

  Row const* row;
  Row const* leader;
  cb::map::LaneCorridor const* lane;
  cb::SingleTrack model{.steering_limit = 0.2, .lateral_acceleration_limit = 1000.0};
  cb::map::LanePlace at{};

  RowView(Row const& seen, Row const* next, cb::map::LaneCorridor const& corridor_of_row)
      : row(&seen), leader(next), lane(&corridor_of_row) {
    auto const foot = lane->center.project({seen.state.x, seen.state.y});
    at.s = foot.s;
    at.lateral = foot.lateral;
    at.segment = foot.segment;
  }
  [[nodiscard]] double time() const { return row->state.time; }
  [[nodiscard]] State const& state() const { return row->state; }
  [[nodiscard]] Dynamics const& dynamics() const { return model; }
  [[nodiscard]] cb::map::LaneCorridor const& corridor() const { return *lane; }
  [[nodiscard]] cb::map::LanePlace const& place() const { return at; }
  [[nodiscard]] std::optional<cb::RoadUser> ahead() const {
    if (leader == nullptr) return std::nullopt;
    return cb::RoadUser{.gap = row->front_gap, .speed = row->front_speed};
  }
  [[nodiscard]] double acceleration(cb::RoadUser const&) const { return leader->acceleration; }
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
  Worst worst;
  for (auto const& [key, row] : rows) {
    auto const [step, agent] = key;
    auto const next = rows.find({step + 1, agent});
    if (next == rows.end() || step < first_step || agent > 5) continue;  // agent 6 stands still
    auto const* const leader = row.front < 0 ? nullptr : &rows.at({step, row.front});
    RowView const view(row, leader, corridors[static_cast<std::size_t>(row.corridor)]);
    auto const behavior = behavior_of(agent);
    cb::MemoryOf<std::remove_cvref_t<decltype(behavior)>> memory;
    auto const plan = behavior.plan(view, memory, 0.2);
    auto const end = cb::InterpolateExecution{}.execute(plan, row.state, view.model, row.state.time + 0.2);
    auto const& expected = next->second;
    worst.place = std::max(worst.place, std::hypot(end.state.x - expected.state.x, end.state.y - expected.state.y));
    double const turn = std::abs(cb::geometry::angle_difference(end.state.heading, expected.state.heading));
    if (turn > 1e-5)
      ++worst.at_kinks;  // the foot point is a vertex, where the line has two directions
    else
      worst.heading = std::max(worst.heading, turn);
    worst.speed = std::max(worst.speed, std::abs(end.state.speed - expected.state.speed));
    worst.action = std::max(worst.action, std::abs(plan.action.acceleration - expected.acceleration));
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
  int const steps = rows.rbegin()->first.first;
  double worst = 0.0;
  for (int agent = 1; agent <= 5 && rows.contains({0, agent}); ++agent) {
    auto const behavior = behavior_of(agent);
    cb::MemoryOf<std::remove_cvref_t<decltype(behavior)>> memory;
    auto state = rows.at({0, agent}).state;
    for (int k = 0; k < steps; ++k) {
      Row row = rows.at({k, agent});
      row.front_gap += row.state.x - state.x;  // on a lane along +x
      row.state = state;
      auto const* const leader = row.front < 0 ? nullptr : &rows.at({k, row.front});
      RowView const view(row, leader, corridors[static_cast<std::size_t>(row.corridor)]);
      auto const plan = behavior.plan(view, memory, 0.2);
      state = cb::InterpolateExecution{}.execute(plan, state, view.model, row.state.time + 0.2).state;
      auto const& expected = rows.at({k + 1, agent}).state;
      worst = std::max(worst, std::hypot(state.x - expected.x, state.y - expected.y));
    }
  }
  MESSAGE(file << ": after up to " << steps << " steps no farther off than " << worst << " m");
  return worst;
}

cb::Idm bark_idm(double desired_speed) {
  cb::Idm p{.desired_speed = desired_speed};
  p.comfortable_deceleration = 1.67f;  // BARK keeps it as a float
  return p;
}

bark::Driver idm_driver(int agent) {
  double const desired[] = {15, 12, 8, 18, 10};
  return {bark_idm(desired[agent - 1])};
}
bark::Driver acc_driver(int agent) {
  return {bark_idm(agent == 1 ? 15 : agent == 2 ? 12 : 8), cb::AdaptiveCruiseControl{}.law.coolness};
}
bark::LaneTracking straight_tracking(int agent) { return {bark_idm(agent == 1 ? 15 : agent == 2 ? 12 : 10)}; }

using World = Traffic<bark::Driver, cb::IdmClassic>;

}  // namespace

TEST_CASE("IDM and the ACC model with BARK's sub-steps reproduce BARK's highway traffic to 1e-9") {
  if (!corpus::root()) return;
  for (auto const& [worst, transitions] :
       {std::pair{compare("bark_idm_highway.csv", straight_corridors(), idm_driver), 250},
        std::pair{compare("bark_idm_coolness_highway.csv", straight_corridors(), acc_driver), 150}}) {
    CHECK(worst.compared == transitions);
    for (double const difference : {worst.place, worst.speed, worst.action}) CHECK(difference < 1e-9);
  }
}

TEST_CASE("leaders and gaps are BARK's, which loses a leader that is not among the four nearest agents") {
  auto const rows = read_rows("bark_idm_highway.csv");
  auto const map = straight_road(2, 1000.0);
  auto const id_of = [](int agent) { return static_cast<cb::AgentId>(agent); };
  int lost = 0;
  for (int step = 0; rows.contains({step, 1}); ++step) {
    World world(map);
    auto const begin = rows.lower_bound({step, 0}), end = rows.lower_bound({step + 1, 0});
    for (auto at = begin; at != end; ++at) {
      auto const& now = at->second.state;
      world.add({.position = {now.x, now.y},
                 .heading = now.heading,
                 .speed = now.speed,
                 .shape = bark_car,
                 .id = id_of(at->second.agent)});
    }
    for (auto at = begin; at != end; ++at) {
      auto const& row = at->second;
      auto const front = world.observe(id_of(row.agent)).ahead();
      lost += front && row.front == -1;
      if (row.front == -1) continue;
      REQUIRE(front);
      CHECK(front->agent == id_of(row.front));
      CHECK(front->gap == doctest::Approx(row.front_gap).epsilon(1e-9));
    }
  }
  if (!rows.empty()) CHECK(lost > 0);
}

TEST_CASE("BARK's sub-steps and the exact integration agree where nothing changes quickly") {
  auto const map = straight_road(1, 1000.0);
  World exact(map), bark(map);
  exact.add({.position = {10, -1.75}, .speed = 14, .behavior = cb::IdmClassic{}});
  bark.add({.position = {10, -1.75}, .speed = 14, .behavior = bark::Driver{}});
  step_all(100, 0.2, exact, bark);
  CHECK(exact.frame().agents[0].state.x == doctest::Approx(bark.frame().agents[0].state.x).epsilon(1e-3));
  CHECK(exact.frame().agents[0].state.x != bark.frame().agents[0].state.x);
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
  CHECK(roll_out("bark_idm_highway.csv", straight_corridors(), idm_driver) < 1e-9);
  CHECK(roll_out("bark_idm_coolness_highway.csv", straight_corridors(), acc_driver) < 1e-9);
  CHECK(roll_out("bark_lanetracking_straight.csv", straight_corridors(), straight_tracking) < 1e-4);
}

TEST_CASE("on an arc lane tracking equals BARK's along BARK's coarse line") {
  if (!corpus::root()) return;
  auto const driver = [](int agent) { return bark::LaneTracking{bark_idm(agent == 1 ? 15 : agent == 2 ? 9 : 12)}; };
  auto const worst = compare("bark_lanetracking_arc.csv", arc_corridors(), driver);
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
  auto const all = compare("bark_idm_arc.csv", arc_corridors(), driver_of);
  CHECK(all.place > 0.1);  // BARK's line is this far from the true arc
  auto const worst = compare("bark_idm_arc.csv", arc_corridors(), driver_of, 1);
  CHECK(worst.compared == 147);
  CHECK(worst.at_kinks == 0);
  CHECK(worst.place < 1e-6);
  CHECK(worst.heading < 5e-7);
  CHECK(worst.speed < 1e-9);
}

TEST_CASE("unlike in BARK, a standing vehicle does not creep back and a faster leader does not cause braking") {
  cb::Idm const p;
  World world(straight_road(1, 1000.0));
  auto const id = world.add({.position = {100, -1.75}, .behavior = cb::IdmClassic{}});
  world.add({.position = {101 + cb::geometry::car().length(), -1.75}, .behavior = cb::IdmClassic{}});
  auto const theirs = bark::Driver{p}.follow(world.observe(id), {.gap = 1.0}, 0.2).trajectory.back();
  REQUIRE(world.step(0.2));
  double const ours = world.state(id).x - 100.0;
  MESSAGE("standing 1 m behind another, after 0.2 s: BARK " << theirs.x - 100 << " m, here " << ours << " m");
  CHECK(theirs.x < 99.999);
  CHECK(ours == doctest::Approx(0.0));
  double const bark = bark::acceleration(p, 0.0, 10.0, {.gap = 10.0, .speed = 25.0}),
               law = cb::idm_acceleration(p, 10.0, 10.0, 25.0);
  MESSAGE("at 10 m/s, 10 m behind a leader of 25 m/s: BARK " << bark << " m/s^2, here " << law << " m/s^2");
  CHECK(bark == p.lowest_acceleration);
  CHECK(law > 0.5);
}
