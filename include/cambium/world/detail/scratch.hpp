#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "cambium/world/plane_index.hpp"
#include "cambium/world/traffic_index.hpp"

namespace cambium::inline v0_1::detail {

/// A world's working memory: never copied or compared; assignment to the world keeps its allocations.
template <class Frame, class Workspaces>
struct Scratch {
  TrafficIndex traffic;
  PlaneIndex plane;                             ///< only used if a behaviour looks around
  bool fresh = false;                           ///< the traffic index matches the current frame
  IdVector<typename Frame::Record, Slot> next;  ///< after a step: the records before it
  bool stepped = false;                         ///< the current frame came from a step
  Workspaces workspaces;                        ///< of behaviours
  std::vector<Frame> history;                   ///< ring of frames
  std::size_t kept = 0, newest = 0;

  Scratch() = default;
  Scratch(Scratch const&) {}
  Scratch(Scratch&&) = default;
  Scratch& operator=(Scratch&&) = default;
  Scratch& operator=(Scratch const&) {
    forget();
    return *this;
  }
  ~Scratch() = default;

  void forget() {
    fresh = false;
    stepped = false;
    kept = 0;
  }

  void keep(std::size_t frames) {
    history.resize(frames);
    kept = newest = 0;
  }

  void remember(Frame const& frame) {
    if (history.empty()) return;
    newest = (newest + 1) % history.size();
    history[newest] = frame;
    kept = std::min(kept + 1, history.size());
  }

  /// The frame `steps_back` steps ago, from 1 (the previous frame) to `kept`.
  [[nodiscard]] Frame const& back(std::size_t steps_back) const {
    return history[(newest + history.size() - (steps_back - 1)) % history.size()];
  }
};

}  // namespace cambium::inline v0_1::detail
