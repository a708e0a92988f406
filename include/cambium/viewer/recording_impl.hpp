#pragma once

#include <cmath>
#include <cstddef>
#include <string>

#include "cambium/core/error.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/viewer/recording.hpp"

namespace cambium::inline v0_1 {

CAMBIUM_COLD void check_recording(Recording const& recording) {
  for (std::size_t k = 0; k < recording.frames.size(); ++k) {
    RecordedFrame const& frame = recording.frames[k];
    std::string const where = "recording '" + recording.title + "', frame " + std::to_string(k);
    if (frame.poses.size() != recording.agents.size())
      throw Error(where,
                  "has " + std::to_string(frame.poses.size()) + " poses for " +
                      std::to_string(recording.agents.size()) + " agents",
                  "give one pose for each agent, with present = false while it is absent");
    bool const ascends = k == 0 || frame.time > recording.frames[k - 1].time;
    if (!std::isfinite(frame.time) || !ascends)
      throw Error(where, "its time " + std::to_string(frame.time) + " s does not come after the frame before",
                  "record frames in order of time");
  }
}

}  // namespace cambium::inline v0_1
