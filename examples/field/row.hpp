#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace field {

/// A quantity of traffic: what people are observed to do, and what came of the simulation.
struct Row {
  std::string quantity;
  double low{}, high{};  ///< band of people's; equal where the source gives a number
  std::string unit;
  std::string source;
  double cambium = std::numeric_limits<double>::quiet_NaN();
  /// Reported only: its band is not verified, or it takes more kilometres than a test may drive.
  bool is_only_reported = false;

  [[nodiscard]] bool is_within() const { return cambium >= low && cambium <= high; }
};

/// A simulation from which some of the rows come; the same seed gives the same rows.
struct Experiment {
  std::string name;
  std::function<std::vector<Row>(std::uint64_t seed)> run;
};

/// On motorways.
[[nodiscard]] std::vector<Experiment> motorway_experiments();
/// In town: streets, lights, signs, turns, errors.
[[nodiscard]] std::vector<Experiment> town_experiments();
/// At junctions without lights: gaps, and what passes.
[[nodiscard]] std::vector<Experiment> junction_experiments();

}  // namespace field
