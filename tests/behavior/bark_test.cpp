// BARK's trajectories, as far as cambium means to reproduce them.
#include <doctest/doctest.h>

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "../support/bark.hpp"
#include "../support/corpus.hpp"
#include "../world/fixtures.hpp"

using namespace fixtures;

namespace {

/// A line of the table: an agent at a step.
struct Row {
  int step, agent;
  cb::State state;
  double acceleration;
  int front;
  double front_gap;
};

std::vector<Row> read_rows(std::filesystem::path const& file) {
  std::vector<Row> rows;
  auto const number = [](std::string const& text) { return text.empty() ? 0.0 : std::stod(text); };
  for (auto const& c : corpus::table(file))
    rows.push_back({std::stoi(c[0]),
                    std::stoi(c[2]),
                    {number(c[1]), number(c[4]), number(c[5]), number(c[6]), number(c[7])},
                    number(c[8]),
                    std::stoi(c[11]),
                    number(c[12])});
  return rows;
}

cb::AgentId id_of(int agent) { return static_cast<cb::AgentId>(agent); }

using World = cb::World<cb::BehaviorSet<bark::Driver, cb::IdmClassic, cb::ConstantAcceleration>,
                        cb::InterpolateExecution, cb::SingleTrack>;

/// The agents of one step as a world; `only`: just this one.
World world_at(std::shared_ptr<cb::Map const> const& map, std::vector<Row> const& rows, int step, int only = 0) {
  std::map<int, double> const desired_speed{{1, 15.0}, {2, 12.0}, {3, 8.0}, {4, 18.0}, {5, 10.0}};
  World world(map);
  for (auto const& row : rows) {
    if (row.step != step || (only != 0 && row.agent != only)) continue;
    World::AgentSpec spec{.position = {row.state.x, row.state.y},
                          .heading = row.state.heading,
                          .speed = row.state.speed,
                          .shape = box(1.75, 2.25)};
    spec.id = id_of(row.agent);
    bark::Driver driver;
    driver.idm.comfortable_deceleration = 1.67f;  // BARK keeps it as a float
    if (auto const at = desired_speed.find(row.agent); at != desired_speed.end()) {
      driver.idm.desired_speed = at->second;
      spec.behavior = driver;
    } else {
      spec.behavior = cb::ConstantAcceleration{};
    }
    world.add(spec);
  }
  return world;
}

}  // namespace

TEST_CASE("IDM with BARK's sub-steps reproduces BARK's highway traffic to 1e-9") {
  auto const file = corpus::find("oracle/bark/bark_idm_highway.csv");
  if (!file) return;
  auto const rows = read_rows(*file);
  auto const map = straight_road(2, 1000.0);
  int compared = 0, lost_leaders = 0;
  double worst = 0;
  for (auto const& row : rows) {
    auto world = world_at(map, rows, row.step);
    auto const front = world.observe(id_of(row.agent)).ahead();
    int const ours = front ? static_cast<int>(front->agent) : -1;
    // BARK loses a leader that is not among the four nearest agents; there the agent is alone on its road for BARK.
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

TEST_CASE("BARK's sub-steps and the exact integration agree where nothing changes fast") {
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
