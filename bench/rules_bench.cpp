// What it costs to watch traffic rules: a label and step, for one agent among others on a highway and at a junction.

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "cambium/evaluation/collision.hpp"
#include "cambium/evaluation/rules.hpp"
#include "cambium/map/opendrive.hpp"
#include "cambium/scenario/highway_site.hpp"
#include "cambium/scenario/junction_site.hpp"

#include "yardstick/main.hpp"

namespace cb = cambium;

namespace {

using Rules = std::vector<cb::TrafficRule<cb::RuleLabels<>>>;

constexpr int steps = 50;

/// Successive frames of one scenario as worlds, with their traffic indices up to date, and the agent that is judged.
template <class World>
struct Course {
  std::vector<World> worlds;
  std::size_t ego;

  Course(World world, std::size_t judged) : ego(judged) {
    for (int i = 0; i < steps; ++i) {
      if (auto const result = world.step(0.2); !result) throw cb::WorldError("rules bench", to_string(result.problem));
      worlds.push_back(world);
      static_cast<void>(worlds.back().truth(cb::Slot{}));
    }
  }
};

/// The number of labels that a monitor evaluates over the whole course.
template <class World>
std::size_t labels_asked(Course<World>& course, Rules const& rules) {
  std::size_t count = 0;
  for (auto const& world : course.worlds) {
    std::size_t others = 0;
    for (cb::Slot slot{}; cb::index_of(slot) < world.size(); ++slot)
      others += cb::index_of(slot) != course.ego && cb::in_traffic(world, slot) ? 1 : 0;
    for (auto const& rule : rules)
      for (auto const& label : rule.labels)
        count +=
            label.label.visit([&]<class L>(L const&) -> std::size_t { return cb::PairLabel<L, World> ? others : 1; });
  }
  return count;
}

template <class World, class Make>
void register_rules(std::string const& name, Rules const& rules, Make make) {
  auto course = std::make_shared<std::unique_ptr<Course<World>>>();
  yardstick::add(name, [=](benchmark::State& state) {
    if (!*course) *course = std::make_unique<Course<World>>(make());
    std::vector<cb::RuleMonitor<cb::RuleLabels<>>> monitors(rules.begin(), rules.end());
    auto const watch = [&] {
      for (auto& world : (*course)->worlds)
        for (auto& monitor : monitors) benchmark::DoNotOptimize(monitor(world, static_cast<cb::Slot>((*course)->ego)));
    };
    watch();
    yardstick::measure_queries(state, labels_asked(**course, rules), watch);
  });
}

Course<cb::HighwaySite::World> highway() {
  auto const site = cb::find_highway_site(cb::load_opendrive(CAMBIUM_SOURCE_DIR "/maps/highway.xodr").map);
  auto world = site.sample(1, 0).make_world();
  auto const middle = world.size() / 2;
  return {std::move(world), middle};
}

Course<cb::JunctionSite::World> junction() {
  auto const site = cb::find_junction_site(cb::load_opendrive(CAMBIUM_SOURCE_DIR "/maps/intersection_4way.xodr").map);
  return {site.sample(1, 0, {.lights = true}).make_world(), 0};
}

void print_ratios(yardstick::Results const& results) {
  yardstick::print_targets(results, {{"rules/label_step", 50.0}});
}

}  // namespace

int main(int argc, char** argv) {
  auto const on_highways = cb::highway_rules();
  register_rules<cb::HighwaySite::World>("rules/label_step", on_highways, highway);
  for (auto const& rule : on_highways) register_rules<cb::HighwaySite::World>("rules/" + rule.name, {rule}, highway);
  for (auto const& rule : cb::intersection_rules())
    register_rules<cb::JunctionSite::World>("rules/" + rule.name, {rule}, junction);
  register_rules<cb::HighwaySite::World>("rules/zip_merge", cb::zip_merge_rules({500.0, 0.0}), highway);
  for (std::string const formula : {"G !constant"})
    register_rules<cb::HighwaySite::World>(
        "rules/constant", {{.name = "constant", .formula = formula, .labels = {cb::Constant{false}}}}, highway);
  return yardstick::run_benchmarks(argc, argv, "What it costs to watch traffic rules, in ns per label and step.",
                                   print_ratios);
}
