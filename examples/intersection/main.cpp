// Crossing traffic: samples scenarios before the junctions of an OpenDRIVE map, in which all drivers obey the right of
// way, simulates and judges each, and writes figures, trajectories and a replay for the browser.

#include <cstdint>

#include "cambium/evaluation/driving.hpp"
#include "cambium/scenario/junction_site.hpp"

#include "../common/command_line.hpp"
#include "../common/map_file.hpp"
#include "../common/sampled_program.hpp"

namespace {

/// The task: all vehicles get through the junctions. See `examples::run_scenario`.
struct Task {
  cambium::JunctionSite site;
  cambium::JunctionTraffic traffic;

  [[nodiscard]] auto sample(std::uint64_t seed, std::uint32_t number) const {
    return site.sample(seed, number, traffic);
  }

  template <class World>
  [[nodiscard]] auto watch(World const&, cambium::Slot) const {
    return [](World const& world) {
      for (cambium::Slot slot{}; index_of(slot) < world.size(); ++slot)
        if (!cambium::PastJunctions{}(world, slot)) return false;
      return true;
    };
  }

  [[nodiscard]] examples::Facts facts() const {
    return {{"entrances", site.entrances.size()}, {"lights", traffic.lights ? 1 : 0}};
  }
};

void run(examples::Settings& settings, cambium::JunctionTraffic traffic) {
  settings.parameters.take(traffic);
  Task const task{cambium::find_junction_site(examples::load_map(settings.map_file), settings.map_file), traffic};
  if (traffic.lights && task.site.map->lights().empty())
    throw cambium::MapError(settings.map_file, "this map has no traffic lights",
                            "leave out --lights or give a map with some, such as maps/intersection_4way.xodr");
  examples::sample_and_report(task, settings, {"Intersection", "everybody got through"});
}

}  // namespace

int main(int argc, char** argv) {
  examples::Settings settings;
  settings.map_file = CAMBIUM_SOURCE_DIR "/maps/intersection_4way.xodr";
  settings.out = "out/intersection";
  settings.steps = 600;
  CLI::App program("Samples traffic before junctions, simulates and judges it.", "intersection");
  examples::add_options(program, settings, "OpenDRIVE map with an intersection");
  cambium::JunctionTraffic traffic;
  program.add_flag("--lights", traffic.lights,
                   "switch on the map's traffic lights; otherwise signs and right before left apply");
  auto const add_share = [&](char const* option, double& share, char const* text) {
    program.add_option(option, share, text)->type_name("SHARE")->check(CLI::Range(0.0, 1.0))->capture_default_str();
  };
  add_share("--trucks", traffic.mix.truck_share, "share of trucks, on routes whose bends they can drive");
  add_share("--bicycles", traffic.mix.bicycle_share, "share of bicycles");
  return examples::run_program(program, argc, argv, [&] { run(settings, traffic); });
}
