#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "cambium/behavior/behavior_set.hpp"
#include "cambium/behavior/drivers.hpp"
#include "cambium/dynamics/single_track.hpp"
#include "cambium/evaluation/driving.hpp"
#include "cambium/execution/interpolate.hpp"
#include "cambium/scenario/merging_site.hpp"
#include "cambium/scenario/scenario.hpp"
#include "cambium/world/world.hpp"

#include "../common/report.hpp"

namespace zip_merge {

using Simulation =
    cambium::World<cambium::BehaviorSet<cambium::ZipMerge>, cambium::InterpolateExecution, cambium::SingleTrack>;

/// A zip merge driver with the parameters of `driver`.
[[nodiscard]] inline cambium::ZipMerge zip(cambium::IdmClassic const& driver) { return {.law = driver.law}; }

/// Counts pairs of vehicles that reach the merge in a row while other vehicles are still coming in the other lane.
class Watch {
 public:
  Watch(Simulation const& world, cambium::Slot ego, cambium::MergingSite const& site) : ego_(ego) {
    for (cambium::Slot slot{}; index_of(slot) < world.size(); ++slot)
      for (std::size_t k = 0; k < site.entrances.size(); ++k)
        if (site.entrances[k].merges() && site.entrances[k].route.lanes == world.roster().agents[slot].road->route)
          coming_.push_back({slot, k, site.entrances[k].merge_at});
  }

  /// Counts the vehicles that reached the merge in the last step. Returns whether the ego has merged.
  bool operator()(Simulation const& world) {
    auto const& agents = world.frame().agents;
    auto const beyond = [&](Coming const& one) { return agents[one.slot].lane.s - one.merge_at; };
    auto const arrived = std::partition(coming_.begin(), coming_.end(), [&](auto const& c) { return beyond(c) < 0.0; });
    std::sort(arrived, coming_.end(), [&](auto const& a, auto const& b) { return beyond(a) > beyond(b); });
    for (auto one = arrived; one != coming_.end(); ++one) {
      auto const is_on_other_lane = [&](Coming const& other) { return other.entrance != one->entrance; };
      if (last_ && std::any_of(coming_.begin(), coming_.end(), is_on_other_lane)) {
        ++counts[0];
        counts[1] += last_ == one->entrance;
      }
      last_ = one->entrance;
    }
    coming_.erase(arrived, coming_.end());
    return cambium::AtGoal{}(world, ego_);
  }

  std::array<std::uint64_t, 2> counts{};  ///< pairs at the merge; those from the same lane

 private:
  /// A vehicle on its way to the merge.
  struct Coming {
    cambium::Slot slot{};
    std::size_t entrance{};
    double merge_at{};  ///< corridor position of the merge [m]
  };

  cambium::Slot ego_;
  std::vector<Coming> coming_;
  std::optional<std::size_t> last_;  ///< entrance of the vehicle that reached the merge last
};

/// The task: the ego merges in dense traffic of drivers who merge like a zip. See `examples::run_scenario`.
struct Task {
  cambium::MergingSite site;
  cambium::MergingTraffic traffic{};

  [[nodiscard]] cambium::Scenario<Simulation> sample(std::uint64_t seed, std::uint32_t number) const {
    return cambium::with_behaviors<Simulation>(site.sample(seed, number, traffic), [](auto const& agent) {
      return zip(std::get<cambium::IdmClassic>(agent.behavior));
    });
  }

  [[nodiscard]] Watch watch(Simulation const& world, cambium::Slot ego) const { return Watch(world, ego, site); }

  [[nodiscard]] examples::Facts facts() const { return {{"entrances", site.entrances.size()}}; }
};

}  // namespace zip_merge
