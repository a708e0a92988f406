#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "cambium/core/ids.hpp"
#include "cambium/core/stable_sort.hpp"
#include "cambium/core/text.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/map/detail/findings.hpp"
#include "cambium/map/lanes/lane.hpp"
#include "cambium/map/lanes/signal_codes.hpp"
#include "cambium/map/opendrive/document.hpp"

namespace cambium::inline v0_1::map::detail {

/// Gives lanes the signs and lights that the file has for them, see `SignalKind`, and lists the lights. What it cannot
/// give to a lane, or does not know, becomes a finding.
class LaneSignals {
 public:
  LaneSignals(OpenDriveDocument const& document, std::span<Lane> lanes, Findings& findings)
      : document_(document), lanes_(lanes), findings_(findings) {
    for (std::size_t r = 0; r < document.roads.size(); ++r)
      for (auto const& signal : document.roads[r].signals) {
        roads_.emplace(&signal, r);
        if (!signals_.emplace(signal.id, &signal).second) shared_ids_.insert(signal.id);
      }
    of_road_.resize(document.roads.size());
    for (auto const& lane : lanes) of_road_[index_of(lane.road)].push_back(lane.id);
    for (auto const& controller : document.controllers)
      for (auto const& control : controller.controls) add_control(controller, control.signal_id);
  }

  [[nodiscard]] std::vector<TrafficLight> set() {
    for (std::size_t r = 0; r < document_.roads.size(); ++r) {
      auto const& road = document_.roads[r];
      for (auto const& signal : road.signals) add(r, signal, signal);
      for (auto const& reference : road.signal_references)
        if (auto const signal = signals_.find(reference.id); signal != signals_.end()) {
          if (shared_ids_.contains(reference.id))
            count("references to an id of several signals mean the first one", reference);
          add(r, *signal->second, reference);
        } else {
          report(reference, r, "no road has the signal that it refers to; it was left out");
        }
    }
    for (auto& lane : lanes_) {
      cambium::detail::stable_sort(lane.signals, [](LaneSignal const& s) { return std::tuple(s.s, s.kind, s.light); });
      lane.signals.erase(std::unique(lane.signals.begin(), lane.signals.end()), lane.signals.end());
    }
    report_rest();
    return std::move(lights_);
  }

 private:
  using Signal = opendrive::Signal;

  [[nodiscard]] static std::string_view attribute(Signal const& signal, std::string_view name) {
    auto const* const found = signal.rest.find_attribute(name);
    return found == nullptr ? std::string_view() : std::string_view(found->value);
  }

  void add_control(opendrive::Controller const& controller, std::string const& signal) {
    auto const [known, is_new] = controllers_.emplace(signal, controller.id);
    if (signals_.contains(signal) && (is_new || known->second == controller.id)) return;
    findings_.add(Severity::warning, 0, "controller", "controller " + controller.id,
                  signals_.contains(signal)
                      ? "controller " + known->second + " controls signal " + signal + ", too; that one counts"
                      : "signal " + signal + " is not there; it was left out");
  }

  /// `place` says where it counts: the signal itself, or a reference to it.
  void add(std::size_t road, Signal const& signal, Signal const& place) {
    auto const sense = find_signal(attribute(signal, "country"), signal.type, attribute(signal, "subtype"));
    auto const kind = sense ? kind_of(sense->meaning) : std::nullopt;
    if (!kind) {
      if (&signal == &place) count_unused(signal, sense);
      return;
    }
    if (&signal == &place && shared_ids_.contains(signal.id) && controllers_.contains(signal.id))
      count("controls of an id of several signals mean all of them", signal);
    auto& is_given = given_[&signal];
    bool const is_place_only =
        !place.validities.empty() && std::all_of(place.validities.begin(), place.validities.end(),
                                                 [](auto const& v) { return v.from_lane == 0 && v.to_lane == 0; });
    if (is_place_only) return;
    bool against_way = true, found = false;
    for (double const rounding : {0.0, 0.5}) {  // [m] by which it may stand beyond the end of a section
      for (auto const id : of_road_[road]) {
        auto& lane = lanes_[index_of(id)];
        bool const fits = place.orientation == opendrive::Orientation::both || place.orientation == way_of(lane);
        if (!lane.drivable() || !holds(lane, place, rounding) ||
            !(place.validities.empty() ? fits : is_valid_for(lane, place)))
          continue;
        found = true;
        against_way = against_way && !fits;
        if (!give(lane, lane.position_at(place.s), *kind, *sense, signal))
          report(
              signal, road,
              "no way behind lane " + std::to_string(lane.number) + " turns as its arrow says; it is left out there");
      }
      if (found) break;
    }
    is_given = is_given || found;
    if (found && against_way)
      count("signals and references whose orientation contradicts the lanes that they are valid for: the lanes count",
            place);
  }

  /// A signal that is neither a sign nor a light for lanes.
  void count_unused(Signal const& signal, std::optional<SignalSense> const& sense) {
    auto const name =
        "signals of type " + signal.type + " of country \"" + std::string(attribute(signal, "country")) + "\"";
    if (signal.type.empty() || signal.type == "-1" || signal.type == "none")
      count("signals without a type have no effect", signal, Severity::info);
    else if (!sense)
      count(name + " are not known", signal);
    else if (sense->meaning == SignalMeaning::speed_limit)
      count("signs that limit the speed do not count; the limits of roads and lanes do", signal, Severity::info);
    else
      count(name + " have no effect: only signs of priority and lights for vehicles have", signal, Severity::info);
  }

  [[nodiscard]] static opendrive::Orientation way_of(Lane const& lane) {
    return lane.along_road ? opendrive::Orientation::along : opendrive::Orientation::against;
  }
  /// Whether a place lies in the section of a lane; its end belongs to the next one.
  [[nodiscard]] static bool holds(Lane const& lane, Signal const& place, double rounding) {
    return place.s >= lane.road_begin - rounding && place.s < lane.road_end + rounding;
  }
  [[nodiscard]] static bool is_valid_for(Lane const& lane, Signal const& place) {
    return std::any_of(place.validities.begin(), place.validities.end(), [&](auto const& validity) {
      return lane.number >= std::min(validity.from_lane, validity.to_lane) &&
             lane.number <= std::max(validity.from_lane, validity.to_lane);
    });
  }

  /// An arrow light is for the ways that turn so where the lane forks; where it does not, for the lane. Whether there
  /// is such a way.
  bool give(Lane& lane, double s, SignalKind kind, SignalSense const& sense, Signal const& signal) {
    Arrow const arrow = sense.arrow;
    auto const& ways = ways_behind(lane);
    auto const is_meant = [&](LaneId way) { return has(arrow, turn_of(way)); };
    auto const meant = std::count_if(ways.begin(), ways.end(), is_meant);
    if (arrow != Arrow::none && ways.size() > 1 && meant == 0) return false;
    LightId const light = kind == SignalKind::light ? light_of(signal, sense) : none<LightId>;
    if (arrow == Arrow::none || ways.size() < 2 || meant == std::ssize(ways)) {
      lane.signals.push_back({s, kind, light});
      return true;
    }
    for (auto const way : ways)
      if (is_meant(way)) lanes_[index_of(way)].signals.push_back({0.0, kind, light});
    return true;
  }

  /// The lanes that one can choose between, driving on along a lane.
  [[nodiscard]] std::vector<LaneId> const& ways_behind(Lane const& lane) const {
    Lane const* at = &lane;
    for (std::size_t n = 0; at->successors.size() == 1 && n < lanes_.size() && !is_inside(*at); ++n)
      at = &lanes_[index_of(at->successors.front())];
    return is_inside(*at) ? lane.successors : at->successors;
  }
  [[nodiscard]] bool is_inside(Lane const& lane) const {
    return !document_.roads[index_of(lane.road)].junction.empty();
  }

  /// How a way turns until it leaves its road.
  [[nodiscard]] Arrow turn_of(LaneId way) const {
    Lane const *const begin = &lanes_[index_of(way)], *end = begin;
    while (end->successors.size() == 1 && lanes_[index_of(end->successors.front())].road == begin->road &&
           end->successors.front() != way)
      end = &lanes_[index_of(end->successors.front())];
    return arrow_of_turn(geometry::angle_difference(end->path.end_pose().heading, begin->path.begin_pose().heading));
  }

  /// The light that a signal belongs to: its controller's; bulbs without one are a light with those of the same arrow
  /// at their place.
  [[nodiscard]] LightId light_of(Signal const& signal, SignalSense const& sense) {
    auto const controller = controllers_.find(signal.id);
    auto name = controller != controllers_.end() ? controller->second : name_of(signal);
    if (controller == controllers_.end() && sense.meaning == SignalMeaning::bulb)
      name = name_of_bulb(signal, sense.arrow, name);
    auto const [known, is_new] = ids_.emplace(name, static_cast<LightId>(lights_.size()));
    if (is_new) lights_.push_back({known->second, name});
    return known->second;
  }

  /// The name of a light without a controller; with its place, where several signals have its id.
  [[nodiscard]] std::string name_of(Signal const& signal) const {
    auto const name = "signal " + signal.id;
    if (!shared_ids_.contains(signal.id)) return name;
    return name + " of road " + document_.roads[roads_.at(&signal)].id + " at " +
           cambium::detail::rounded_text(signal.s) + " m";
  }

  [[nodiscard]] std::string name_of_bulb(Signal const& signal, Arrow arrow, std::string const& name) {
    constexpr double reach = 0.5;  // [m] between the bulbs of a head, own choice
    double const t = cambium::detail::parse_number<double>(attribute(signal, "t")).value_or(0.0);
    Bulb const bulb{signal.s, t, arrow, name};
    auto& others = bulbs_[roads_.at(&signal)];
    for (auto const& other : others)
      if (std::abs(other.s - bulb.s) <= reach && std::abs(other.t - t) <= reach && other.arrow == bulb.arrow)
        return other.name;
    others.push_back(bulb);
    return name;
  }

  void report(Signal const& signal, std::size_t road, std::string sentence) {
    findings_.add(Severity::warning, signal.line, "signal",
                  "road " + document_.roads[road].id + ", signal " + signal.id, std::move(sentence));
  }

  /// Counts findings of one kind; the first says where.
  void count(std::string sentence, Signal const& signal, Severity severity = Severity::warning) {
    auto const [at, is_new] = counts_.try_emplace(std::move(sentence), Count{severity, &signal, 0});
    ++at->second.count;
  }

  void report_rest() {
    for (auto const& road : document_.roads)
      for (auto const& signal : road.signals)
        if (auto const at = given_.find(&signal); at != given_.end() && !at->second)
          report(signal, roads_.at(&signal), "it counts for no lane: see its s, orientation and validity");
    for (auto const& [sentence, of] : counts_)
      findings_.add(of.severity, of.first->line, "signal", "signal " + of.first->id,
                    sentence + (of.count > 1 ? " (" + std::to_string(of.count) + " of them)" : ""));
  }

  struct Count {
    Severity severity;
    Signal const* first;
    int count;
  };

  struct Bulb {
    double s, t;  ///< its place on its road [m]
    Arrow arrow;
    std::string name;  ///< of its light
  };

  OpenDriveDocument const& document_;
  std::span<Lane> lanes_;
  Findings& findings_;
  std::vector<std::vector<LaneId>> of_road_;
  std::map<std::string, std::string> controllers_;  ///< by signal
  std::map<std::string, Signal const*> signals_;    ///< the first of each id
  std::set<std::string> shared_ids_;                ///< of several signals
  std::map<Signal const*, std::size_t> roads_;      ///< of each signal
  std::map<Signal const*, bool> given_;             ///< whether a lane has it, of signs and lights that count
  std::map<std::string, Count> counts_;
  std::map<std::size_t, std::vector<Bulb>> bulbs_;  ///< the first of each head, by road
  std::map<std::string, LightId> ids_;
  std::vector<TrafficLight> lights_;
};

}  // namespace cambium::inline v0_1::map::detail
