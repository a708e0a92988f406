#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "cambium/core/ids.hpp"
#include "cambium/core/stable_sort.hpp"
#include "cambium/map/lanes/lane.hpp"
#include "cambium/map/lanes/signals.hpp"
#include "cambium/map/opendrive/document.hpp"

namespace cambium::map::detail {

/// What a signal of the file says about who goes first; nothing for all others.
[[nodiscard]] inline std::optional<SignalKind> kind_of(opendrive::Signal const& signal) {
  if (signal.type == "205") return SignalKind::give_way;
  if (signal.type == "206") return SignalKind::stop;
  if (signal.type == "301" || signal.type == "306") return SignalKind::priority;
  if (signal.type == "1000001") return SignalKind::light;
  return std::nullopt;
}

/// Gives lanes the signs and lights that the file has for them, see `SignalKind`, and lists the lights.
class LaneSignals {
 public:
  LaneSignals(OpenDriveDocument const& document, std::span<Lane> lanes) : document_(document), lanes_(lanes) {
    for (auto const& controller : document.controllers)
      for (auto const& control : controller.controls) controllers_.emplace(control.signal_id, controller.id);
    for (auto const& road : document.roads)
      for (auto const& signal : road.signals) signals_.emplace(signal.id, &signal);
  }

  [[nodiscard]] std::vector<TrafficLight> set() {
    for (auto& lane : lanes_) {
      auto const& road = document_.roads[index_of(lane.road)];
      for (auto const& signal : road.signals) add(signal, signal, lane);
      for (auto const& reference : road.signal_references) {
        auto const signal = signals_.find(reference.id);
        if (signal != signals_.end()) add(*signal->second, reference, lane);
      }
      auto const order = [](LaneSignal const& a, LaneSignal const& b) {
        return std::tie(a.s, a.kind, a.light) < std::tie(b.s, b.kind, b.light);
      };
      cambium::detail::stable_sort_by(lane.signals, order);
      lane.signals.erase(std::unique(lane.signals.begin(), lane.signals.end()), lane.signals.end());
    }
    return std::move(lights_);
  }

 private:
  /// `place` says where it counts: the signal itself, or a reference to it.
  void add(opendrive::Signal const& signal, opendrive::Signal const& place, Lane& lane) {
    auto const kind = kind_of(signal);
    auto const way = lane.along_road ? opendrive::Orientation::along : opendrive::Orientation::against;
    if (!kind || (place.orientation != opendrive::Orientation::both && place.orientation != way)) return;
    if (!lane.drivable() || !(place.s >= lane.road_begin - 0.5 && place.s <= lane.road_end + 0.5)) return;
    bool const counts = place.validities.empty() ||
                        std::any_of(place.validities.begin(), place.validities.end(), [&](auto const& validity) {
                          return lane.number >= std::min(validity.from_lane, validity.to_lane) &&
                                 lane.number <= std::max(validity.from_lane, validity.to_lane);
                        });
    if (!counts) return;
    lane.signals.push_back(
        {lane.position_at(place.s), *kind, *kind == SignalKind::light ? light_of(signal) : none<LightId>});
  }

  [[nodiscard]] LightId light_of(opendrive::Signal const& signal) {
    auto const controller = controllers_.find(signal.id);
    auto const name = controller == controllers_.end() ? "signal " + signal.id : controller->second;
    auto const [known, is_new] = ids_.emplace(name, static_cast<LightId>(lights_.size()));
    if (is_new) lights_.push_back({known->second, name});
    return known->second;
  }

  OpenDriveDocument const& document_;
  std::span<Lane> lanes_;
  std::map<std::string, std::string> controllers_;  ///< by signal
  std::map<std::string, opendrive::Signal const*> signals_;
  std::map<std::string, LightId> ids_;
  std::vector<TrafficLight> lights_;
};

}  // namespace cambium::map::detail
