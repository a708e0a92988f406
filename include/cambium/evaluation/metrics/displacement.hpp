#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "cambium/behavior/open_loop/static_trajectory.hpp"
#include "cambium/core/ids.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/core/state.hpp"
#include "cambium/world/frame.hpp"

namespace cambium::inline v0_1 {

/// How far an agent is from its recording: `mean` and `last` are the average and final displacement errors (ADE, FDE)
/// of trajectory prediction [m], over the frames within the time of the recording. 0 without any.
struct Displacement {
  StaticTrajectory recorded{};

  Displacement() = default;
  /// Compares with `recording`.
  explicit Displacement(StaticTrajectory recording) : recorded(std::move(recording)) {}

  template <class World>
  void observe(World const& world, Slot slot, double) {
    auto const& record = world.frame().agents[slot];
    if (record.status != AgentStatus::driving || !recorded.states || recorded.states->empty()) return;
    if (world.time() < recorded.states->front().time || world.time() > recorded.states->back().time) return;
    auto const was = recorded.at(world.time());
    last_ = portable::hypot(record.state.x - was.x, record.state.y - was.y);
    sum_ += last_;
    most_ = std::max(most_, last_);
    ++frames_;
  }

  [[nodiscard]] double value() const { return mean(); }
  [[nodiscard]] double mean() const { return frames_ > 0 ? sum_ / static_cast<double>(frames_) : 0.0; }
  [[nodiscard]] double last() const { return last_; }
  [[nodiscard]] double most() const { return most_; }

 private:
  double sum_ = 0.0, last_ = 0.0, most_ = 0.0;
  std::size_t frames_ = 0;
};

}  // namespace cambium::inline v0_1
