// Highway traffic: cars and trucks on several lanes. The drivers have parameters from the literature, follow by the
// Intelligent Driver Model, change lanes by MOBIL, keep right and take their exits. The program samples scenarios,
// judges each, and writes figures, trajectories and a replay for the browser.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "cambium/evaluation/driving.hpp"
#include "cambium/scenario/highway_site.hpp"

#include "../common/map_file.hpp"
#include "../common/sampled_program.hpp"

namespace {

using Simulation = cambium::HighwaySite::World;

/// Counts lane changes. The ego is done when it has reached its exit; without an exit, after 500 m or near the end.
class Watch {
 public:
  Watch(Simulation const& world, cambium::Slot ego) : ego_(ego), start_(position(world)) {
    for (auto const& record : world.frame().agents) lanes_.push_back(record.lane.corridor);
  }

  bool operator()(Simulation const& world) {
    for (std::size_t i = 0; i < world.size(); ++i) {
      auto const corridor = world.frame().agents[i].lane.corridor;
      counts[0] += corridor != lanes_[i];
      lanes_[i] = corridor;
    }
    if (!std::holds_alternative<cambium::NoGoal>(world.roster().goals[ego_])) return cambium::AtGoal{}(world, ego_);
    auto const& lane = world.frame().agents[ego_].lane;
    auto const& corridor = world.roster().agents[ego_].road->corridors[lane.corridor];
    return corridor.length_until_end(lane.s) < 30.0 || (position(world) - start_).norm() > 500.0;
  }

  std::array<std::uint64_t, 1> counts{};  ///< lane changes of all agents

 private:
  [[nodiscard]] cambium::geometry::Point position(Simulation const& world) const {
    auto const& state = world.frame().agents[ego_].state;
    return {state.x, state.y};
  }

  cambium::Slot ego_;
  cambium::geometry::Point start_;
  std::vector<cambium::CorridorId> lanes_;  ///< lane corridor of each agent, by slot
};

/// The task: the ego takes its exit or, without one, drives to the end. See `examples::run_scenario`.
struct Task {
  cambium::HighwaySite site;

  [[nodiscard]] auto sample(std::uint64_t seed, std::uint32_t number) const { return site.sample(seed, number); }
  [[nodiscard]] Watch watch(Simulation const& world, cambium::Slot ego) const { return {world, ego}; }
  [[nodiscard]] examples::Facts facts() const { return {{"lanes", site.lanes.size()}, {"exits", site.exits.size()}}; }
};

void run(examples::Settings& settings) {
  Task const task{cambium::find_highway_site(examples::load_map(settings.map_file), settings.map_file)};
  std::string const success = task.site.exits.empty() ? "the ego reached the end" : "the ego took its exit";
  examples::sample_and_report(task, settings, {"Highway", success, {{"lane changes"}}});
}

}  // namespace

int main(int argc, char** argv) {
  examples::Settings settings;
  settings.map_file = CAMBIUM_SOURCE_DIR "/maps/highway_exit.xodr";
  settings.out = "out/highway";
  examples::Program const program{"highway", "Samples traffic on a multi-lane highway, simulates and judges it.",
                                  "OpenDRIVE map with a road of several lanes"};
  return examples::run_sampled(program, settings, argc, argv, [&] { run(settings); });
}
