#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cambium/core/error.hpp"
#include "cambium/map/lanes/lane.hpp"
#include "cambium/map/lanes/signal_codes.hpp"
#include "cambium/map/lanes/signals.hpp"
#include "cambium/map/opendrive/xml.hpp"
#include "cambium/scenario/dataset/detail/common_road_values.hpp"

namespace cambium::inline v0_1::detail {

/// What a sign says by the catalogue of a benchmark's country, "DEU_Test-1_1" or "C-USA_US101-1_1_T-1"; for Zamunda
/// (ZAM), which is not on Earth, by the American or the German one.
[[nodiscard]] inline std::optional<map::SignalSense> common_road_sign(std::string_view benchmark, std::string_view id) {
  if (benchmark.starts_with("C-")) benchmark.remove_prefix(2);
  auto const country = benchmark.substr(0, 3);
  return map::find_signal(country == "ZAM" ? "USA" : country, id, "");
}

/// A phase of a light.
struct CommonRoadPhase {
  map::LightColor color = map::LightColor::red;
  double duration = 0.0;  ///< [s]
};

/// Joins phases of one colour that follow each other, the last and the first one too; how much earlier than the first
/// one of `phases` the first one begins then [s].
[[nodiscard]] inline double join_phases(std::vector<CommonRoadPhase>& phases) {
  std::vector<CommonRoadPhase> joined;
  for (auto const& phase : phases)
    if (!joined.empty() && joined.back().color == phase.color)
      joined.back().duration += phase.duration;
    else
      joined.push_back(phase);
  double earlier = 0.0;
  if (joined.size() > 1 && joined.front().color == joined.back().color) {
    earlier = joined.back().duration;
    joined.front().duration += earlier;
    joined.pop_back();
  }
  phases = std::move(joined);
  return earlier;
}

/// Reads the signs and lights of a CommonRoad file.
class CommonRoadSignals : protected CommonRoadValues {
 protected:
  using CommonRoadValues::CommonRoadValues;

  struct Sign {
    std::optional<map::SignalKind> kind{};
    std::optional<double> speed{};  ///< limit [m/s]
  };
  struct Light {
    map::LightPlan plan{};
    map::Arrow arrow = map::Arrow::none;  ///< none: for all ways
  };

  void read_sign_or_light(Node node, std::string_view name) {
    if (name != "trafficSign" && name != "trafficLight") return;
    auto const id = id_of(node);
    if (!id) return;
    if (signs_.contains(*id) || lights_.contains(*id))
      return warn(node, "id " + std::to_string(*id) + " is taken already; it was left out");
    if (name == "trafficSign")
      signs_.emplace(*id, sign_of(node));
    else
      lights_.emplace(*id, Light{plan_of(node), arrow_of(node)});
  }

  std::map<Id, Sign> signs_;
  std::map<Id, Light> lights_;

 private:
  [[nodiscard]] Sign sign_of(Node node) {
    Sign sign;
    xml::for_each_child(node, "trafficSignElement", [&](Node element) {
      auto const word = text_of(xml::find_child(element, "trafficSignID"));
      auto const sense = common_road_sign(traffic_.name, word);
      if (!sense) return warn(element, "its sign " + std::string(word) + " is not known; it was left out");
      auto const kind = map::kind_of(sense->meaning);
      if (kind && kind != map::SignalKind::light)
        sign.kind = kind;
      else if (sense->meaning != map::SignalMeaning::speed_limit)
        note_once(element, "signs of the number " + std::string(word) +
                               " have no effect: only those of priority and speed have");
      if (sense->meaning != map::SignalMeaning::speed_limit) return;
      auto const limit = number(element, "additionalValue");
      if (limit && map::is_speed_limit(*limit))
        sign.speed = limit;
      else if (limit)
        warn(element, "its limit " + rounded_text(*limit) + " m/s is not between 0.1 and 200; it was left out");
    });
    return sign;
  }

  [[nodiscard]] map::Arrow arrow_of(Node node) {
    using map::Arrow;
    constexpr std::pair<std::string_view, Arrow> words[] = {{"all", Arrow::none},
                                                            {"left", Arrow::left},
                                                            {"straight", Arrow::straight},
                                                            {"right", Arrow::right},
                                                            {"leftStraight", Arrow::left | Arrow::straight},
                                                            {"straightRight", Arrow::straight | Arrow::right},
                                                            {"leftRight", Arrow::left | Arrow::right}};
    auto const child = xml::find_child(node, "direction");
    if (!child) return Arrow::none;
    for (auto const& [word, arrow] : words)
      if (word == text_of(child)) return arrow;
    warn(child, "\"" + std::string(text_of(child)) + "\" is no direction; the light counts for all");
    return Arrow::none;
  }

  /// The phases of a light: green, then yellow; all else is red. One that is always red has a green of 0 s.
  [[nodiscard]] map::LightPlan plan_of(Node node) {
    auto const active = xml::find_child(node, "active");
    if (auto const word = text_of(active); word == "false" || word == "0") {
      note(active, "the light is off");
      return {};
    }
    if (active && text_of(active) != "true" && text_of(active) != "1")
      warn(active, "\"" + std::string(text_of(active)) + "\" is neither true nor false; true was taken");
    auto const cycle = xml::find_child(node, "cycle");
    if (!cycle) {
      warn(node, "it has no <cycle>; the light is off");
      return {};
    }
    auto phases = phases_of(cycle);
    double total = 0.0;
    for (auto const& phase : phases) total += phase.duration;
    double begin = offset_of(cycle) - join_phases(phases);
    if (phases.empty() ||
        (phases.size() == 1 && phases[0].color != map::LightColor::green && phases[0].color != map::LightColor::red)) {
      warn(cycle, "it shows neither green nor red; the light is off");
      return {};
    }
    auto const plan = plan_of(cycle, phases, begin, total);
    if (plan.is_possible()) return plan;
    warn(node, "its cycle is impossible; the light is off");
    return {};
  }

  [[nodiscard]] map::LightPlan plan_of(Node cycle, std::vector<CommonRoadPhase> const& phases, double begin,
                                       double total) {
    using map::LightColor;
    auto const first = [&](LightColor color) {
      std::size_t i = 0;
      while (i < phases.size() && phases[i].color != color) ++i;
      return i;
    };
    std::size_t from = first(LightColor::green);
    bool const is_green = from < phases.size();
    if (!is_green) from = first(LightColor::yellow);
    map::LightPlan plan{.cycle = total, .green_begin = 0.0, .green_end = 0.0, .yellow = 0.0};
    if (from == phases.size()) return plan;
    for (std::size_t i = 0; i < from; ++i) begin += phases[i].duration;
    plan.green_begin = begin;
    plan.green_end = begin + (is_green ? phases[from].duration : 0.0);
    std::size_t const behind = is_green ? (from + 1) % phases.size() : from;
    bool const has_yellow = phases[behind].color == LightColor::yellow;
    if (has_yellow) plan.yellow = phases[behind].duration;
    for (std::size_t i = 0; i < phases.size(); ++i)
      if (phases[i].color != LightColor::red && i != from && !(has_yellow && i == behind))
        note(cycle, phases[i].color == LightColor::green ? "a second green phase was left out: it is red"
                                                         : "a yellow phase that is not behind the green one is red");
    return plan;
  }

  [[nodiscard]] std::vector<CommonRoadPhase> phases_of(Node cycle) {
    using map::LightColor;
    std::vector<CommonRoadPhase> phases;
    std::size_t inactive = 0;
    xml::for_each_child(cycle, "cycleElement", [&](Node element) {
      auto const steps = number(element, "duration");
      if (!steps) return;
      if (!(*steps > 0.0 && *steps <= 1e6))
        return warn(element, "its duration " + rounded_text(*steps) + " is not above 0; the phase was left out");
      auto const color = text_of(xml::find_child(element, "color"));
      CommonRoadPhase phase{LightColor::red, *steps * traffic_.time_step};
      if (color == "green") phase.color = LightColor::green;
      if (color == "yellow") phase.color = LightColor::yellow;
      bool const is_known = color == "red" || color == "redYellow" || phase.color != LightColor::red;
      if (color == "inactive")
        ++inactive;
      else if (!is_known)
        warn(element, "\"" + std::string(color) + "\" is no colour of a light; the phase counts as red");
      phases.push_back(phase);
    });
    if (inactive == phases.size()) return {};
    if (inactive > 0) note(cycle, "its inactive phases count as red");
    return phases;
  }

  [[nodiscard]] double offset_of(Node cycle) {
    return xml::find_child(cycle, "timeOffset") ? number(cycle, "timeOffset").value_or(0.0) * traffic_.time_step : 0.0;
  }
};

}  // namespace cambium::inline v0_1::detail
