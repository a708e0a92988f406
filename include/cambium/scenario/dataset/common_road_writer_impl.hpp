#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cambium/core/error.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/map/lanelet/lanelet_map.hpp"
#include "cambium/map/opendrive/xml.hpp"
#include "cambium/scenario/dataset/common_road_writer.hpp"
#include "cambium/scenario/dataset/detail/common_road_lanes.hpp"

namespace cambium::inline v0_1 {

namespace detail {

/// Shortest text without an exponent that reads back as the same number: CommonRoad takes no others.
[[nodiscard]] inline std::string decimal_text(double value) {
  char text[400];
  return {text, std::to_chars(text, text + sizeof text, value, std::chars_format::fixed).ptr};
}

/// Writes a CommonRoad scenario, see `common_road_text`.
class CommonRoadWriter {
 public:
  CommonRoadWriter(RecordedTraffic const& traffic, CommonRoadHeader const& header)
      : traffic_(traffic), header_(header), lanelets_(traffic.lanelets) {
    if (lanelets_.empty() && traffic.map) lanelets_ = map::lanelets_of(*traffic.map);
  }

  [[nodiscard]] std::string write() {
    check_recorded_traffic(traffic_);
    if (!(traffic_.time_step > 0.0))
      throw Error(traffic_.name, "its time step is not above 0", "set RecordedTraffic::time_step");
    for (auto const& lanelet : lanelets_) check(lanelet);
    text_.element("commonRoad", [&] {
      attribute("timeStepSize", decimal_text(traffic_.time_step));
      attribute("commonRoadVersion", "2020a");
      attribute("author", header_.author);
      attribute("affiliation", header_.affiliation);
      attribute("source", header_.source);
      attribute("benchmarkID", header_.benchmark_id.empty() ? traffic_.name : header_.benchmark_id);
      attribute("date", header_.date.empty() ? "1970-01-01" : header_.date);
      text_.element("location", [&] {
        leaf("geoNameId", "-999");
        leaf("gpsLatitude", "999");
        leaf("gpsLongitude", "999");
      });
      text_.element("scenarioTags", [&] { text_.element("simulated", [] {}); });
      collect_signs();
      for (auto const& lanelet : lanelets_) write_lanelet(lanelet);
      write_signs();
      write_tracks();
      for (auto const& problem : traffic_.problems) write_problem(problem);
    });
    return text_.take();
  }

 private:
  using Id = std::int64_t;
  /// What a sign says: its number in the German catalogue, and its value.
  using Sign = std::pair<std::string, std::string>;

  /// Throws `Error` for what the format cannot say of it.
  void check(map::Lanelet const& lanelet) {
    auto const where = traffic_.name + ": lanelet " + std::to_string(lanelet.id);
    if (!used_.insert(lanelet.id).second) throw Error(where, "there is another one of that id", "give each its own");
    if (!lanelet.goes_before.empty())
      throw Error(where, "CommonRoad cannot say which lanelets it goes before",
                  "give RecordedTraffic::lanelets (such as map::lanelets_of) with signs and without goes_before");
    for (auto const& signal : lanelet.signals)
      if (std::abs(signal.before_end - lanelet.signals.front().before_end) > 1e-3)
        throw Error(where, "its signals are at several places, and CommonRoad has one stop line for a lanelet",
                    "put them at one place, or divide the lanelet");
    if (!is_drivable(lanelet.type) && word_of(lanelet) == "unknown" &&
        common_road_users(lanelet.type).front() == "vehicle")
      throw Error(where, "CommonRoad has no word for its type, \"" + std::string(to_string(lanelet.type)) + "\"",
                  "give it another type, or leave it out");
  }

  /// The word of a lanelet's type. Walkways that are no crossings have none, but users.
  [[nodiscard]] static std::string_view word_of(map::Lanelet const& lanelet) {
    if (lanelet.type == map::LaneType::walking && !lanelet.in_junction) return "unknown";
    for (auto const& [name, type] : common_road_lane_types)
      if (lanelet.type == type && type != map::LaneType::rail) return name;
    return "unknown";
  }

  void attribute(char const* name, std::string_view value) { text_.attribute(name, value); }
  void leaf(char const* name, std::string_view value) {
    text_.element(name, [&] { text_.text(value); });
  }
  void exact(char const* name, std::string_view value) {
    text_.element(name, [&] { leaf("exact", value); });
  }
  void interval(char const* name, std::string_view begin, std::string_view end) {
    text_.element(name, [&] {
      leaf("intervalStart", begin);
      leaf("intervalEnd", end);
    });
  }
  void point(geometry::Point const& p, std::optional<double> height = {}) {
    text_.element("point", [&] {
      leaf("x", decimal_text(p.x()));
      leaf("y", decimal_text(p.y()));
      if (height) leaf("z", decimal_text(*height));
    });
  }
  void reference(char const* name, Id id) {
    text_.element(name, [&] { attribute("ref", std::to_string(id)); });
  }

  /// The id where nothing has it yet, else the next free number.
  [[nodiscard]] Id unused(Id id) {
    if (id > 0 && used_.insert(id).second) return id;
    return fresh();
  }
  [[nodiscard]] Id fresh() {
    while (!used_.insert(next_).second) ++next_;
    return next_;
  }

  [[nodiscard]] std::string steps(double time, std::string const& of) const {
    double const count = time / traffic_.time_step, whole = std::round(count);
    if (!(std::abs(count - whole) <= 0.01 && std::abs(whole) < 1e12))
      throw Error(traffic_.name + ": " + of,
                  "its time " + rounded_text(time) + " s is no multiple of the time step, " +
                      rounded_text(traffic_.time_step) + " s",
                  "set RecordedTraffic::time_step, or record at its multiples");
    return std::to_string(static_cast<std::int64_t>(whole));
  }

  [[nodiscard]] static Sign sign_of(map::SignalKind kind) {
    constexpr char const* numbers[] = {"306", "205", "206", ""};
    return {numbers[static_cast<std::size_t>(kind)], ""};
  }

  /// Ids for each different sign and light; those of lights are their names where these are numbers.
  void collect_signs() {
    auto const lanelets = used_;
    for (auto const& track : traffic_.tracks) used_.insert(track.id);
    for (auto const& problem : traffic_.problems) used_.insert(problem.id);
    for (auto const& lanelet : lanelets_) {
      if (lanelet.speed_limit) add_sign({"274", decimal_text(*lanelet.speed_limit)});
      for (auto const& signal : lanelet.signals)
        if (signal.kind != map::SignalKind::light)
          add_sign(sign_of(signal.kind));
        else if (!lights_.contains(signal.light))
          lights_.emplace(signal.light, unused(map::xml::parse_number<Id>(signal.light).value_or(0)));
    }
    used_ = lanelets;
    for (auto const& [sign, id] : signs_) used_.insert(id);
    for (auto const& [light, id] : lights_) used_.insert(id);
  }
  void add_sign(Sign const& sign) {
    if (!signs_.contains(sign)) signs_.emplace(sign, fresh());
  }

  void write_lanelet(map::Lanelet const& lanelet) {
    text_.element("lanelet", [&] {
      attribute("id", std::to_string(lanelet.id));
      write_bound("leftBound", lanelet.left, lanelet.left_heights, lanelet.may_change_left);
      write_bound("rightBound", lanelet.right, lanelet.right_heights, lanelet.may_change_right);
      for (auto const id : lanelet.predecessors) reference("predecessor", id);
      for (auto const id : lanelet.successors) reference("successor", id);
      if (lanelet.left_neighbor) write_neighbor("adjacentLeft", *lanelet.left_neighbor);
      if (lanelet.right_neighbor) write_neighbor("adjacentRight", *lanelet.right_neighbor);
      write_stop_line(lanelet);
      leaf("laneletType", word_of(lanelet));
      if (lanelet.in_junction) leaf("laneletType", "intersection");
      for (auto const user : common_road_users(lanelet.type))
        leaf(lanelet.both_directions ? "userBidirectional" : "userOneWay", user);
      if (lanelet.speed_limit) reference("trafficSignRef", signs_.at({"274", decimal_text(*lanelet.speed_limit)}));
      for (auto const& signal : lanelet.signals)
        if (signal.kind != map::SignalKind::light) reference("trafficSignRef", signs_.at(sign_of(signal.kind)));
      for (auto const& signal : lanelet.signals)
        if (signal.kind == map::SignalKind::light) reference("trafficLightRef", lights_.at(signal.light));
    });
  }

  void write_bound(char const* name, std::vector<geometry::Point> const& points, std::vector<double> const& heights,
                   bool may_change) {
    text_.element(name, [&] {
      for (std::size_t i = 0; i < points.size(); ++i)
        point(points[i], heights.size() == points.size() ? std::optional(heights[i]) : std::nullopt);
      leaf("lineMarking", may_change ? "dashed" : "solid");
    });
  }
  void write_neighbor(char const* name, Id id) {
    text_.element(name, [&] {
      attribute("ref", std::to_string(id));
      attribute("drivingDir", "same");
    });
  }

  /// Across the lanelet, where its signals count; nothing where that is its end.
  void write_stop_line(map::Lanelet const& lanelet) {
    if (lanelet.signals.empty() || !(lanelet.signals.front().before_end > 0.0)) return;
    auto const line = map::line_before_end(lanelet, lanelet.signals.front().before_end);
    if (!line) return;
    text_.element("stopLine", [&] {
      point((*line)[0]);
      point((*line)[1]);
      leaf("lineMarking", "solid");
    });
  }

  void write_signs() {
    for (auto const& entry : signs_)
      text_.element("trafficSign", [&] {
        attribute("id", std::to_string(entry.second));
        text_.element("trafficSignElement", [&] {
          leaf("trafficSignID", entry.first.first);
          if (!entry.first.second.empty()) leaf("additionalValue", entry.first.second);
        });
        leaf("virtual", "false");
      });
    for (auto const& [light, id] : lights_) write_light(light, id);
  }

  void write_light(std::string const& name, Id id) {
    map::LightPlan plan;
    if (traffic_.map)
      for (auto const& light : traffic_.map->lights())
        if (light.name == name && index_of(light.id) < traffic_.lights.size())
          plan = traffic_.lights[index_of(light.id)];
    bool const is_on = plan.cycle > 0.0;
    auto const in_steps = [&](double time) { return steps(time, "light " + name); };
    text_.element("trafficLight", [&] {
      attribute("id", std::to_string(id));
      text_.element("cycle", [&] {
        auto const phase = [&](std::string const& duration, char const* color) {
          if (duration == "0") return;
          text_.element("cycleElement", [&] {
            leaf("duration", duration);
            leaf("color", color);
          });
        };
        double const green = std::min(plan.cycle, plan.green_end - plan.green_begin),
                     yellow = std::min(plan.yellow, plan.cycle - green), red = plan.cycle - green - yellow;
        if (!is_on) phase("1", "green");
        if (green > 0.0) phase(in_steps(green), "green");
        if (yellow > 0.0) phase(in_steps(yellow), "yellow");
        if (red > 0.0) phase(in_steps(red), "red");
        double const offset = is_on ? plan.green_begin - std::floor(plan.green_begin / plan.cycle) * plan.cycle : 0.0;
        if (offset > 0.0) leaf("timeOffset", in_steps(offset));
      });
      leaf("active", is_on ? "true" : "false");
    });
  }

  void write_tracks() {
    for (bool const stands : {true, false})
      for (auto const& track : traffic_.tracks)
        if (track.stands == stands) write_track(track);
  }

  void write_track(Track const& track) {
    auto const name = "track " + std::to_string(track.id);
    text_.element(track.stands ? "staticObstacle" : "dynamicObstacle", [&] {
      attribute("id", std::to_string(unused(track.id)));
      leaf("type", type_word(track));
      text_.element("shape", [&] {
        if (!track.outline.empty())
          return text_.element("polygon", [&] {
            for (auto const& corner : track.outline) point(corner);
          });
        text_.element("rectangle", [&] {
          leaf("length", decimal_text(track.length));
          leaf("width", decimal_text(track.width));
        });
      });
      text_.element("initialState", [&] { write_state(track.states.front(), !track.stands, name); });
      if (track.stands || track.states.size() < 2) return;
      text_.element("trajectory", [&] {
        for (std::size_t i = 1; i < track.states.size(); ++i)
          text_.element("state", [&] { write_state(track.states[i], true, name); });
      });
    });
  }

  /// Obstacles that stand are parked vehicles or unknown: CommonRoad has no other words for them.
  [[nodiscard]] static char const* type_word(Track const& track) {
    if (track.stands) return track.type == TrackType::car ? "parkedVehicle" : "unknown";
    return track.type == TrackType::other ? "unknown" : to_string(track.type);
  }

  void write_state(State const& state, bool moves, std::string const& of) {
    text_.element("position", [&] { point({state.x, state.y}); });
    exact("orientation", decimal_text(state.heading));
    exact("time", steps(state.time, of));
    if (moves) exact("velocity", decimal_text(state.speed));
  }

  void write_problem(PlanningProblem const& problem) {
    auto const name = "planning problem " + std::to_string(problem.id);
    if (!is_finite(problem.initial))
      throw Error(traffic_.name + ": " + name, "its initial state is not finite", "set PlanningProblem::initial");
    text_.element("planningProblem", [&] {
      attribute("id", std::to_string(unused(problem.id)));
      text_.element("initialState", [&] {
        write_state(problem.initial, true, name);
        exact("yawRate", "0");
        exact("slipAngle", "0");
      });
      for (auto const& goal : problem.goals) text_.element("goalState", [&] { write_goal(goal, name); });
    });
  }

  void write_goal(GoalState const& goal, std::string const& of) {
    if (!goal.areas.empty())
      text_.element("position", [&] {
        for (auto const& area : goal.areas)
          text_.element("polygon", [&] {
            for (auto const& p : area.points()) point(p);
          });
      });
    auto const& limits = goal.limits;
    if (limits.heading_to - limits.heading_from < 2.0 * geometry::pi)
      interval("orientation", decimal_text(limits.heading_from), decimal_text(limits.heading_to));
    if (!std::isfinite(goal.first_time) || !std::isfinite(goal.last_time))
      throw Error(traffic_.name + ": " + of, "a goal has no first or no last time, which CommonRoad wants",
                  "set GoalState::first_time and last_time");
    interval("time", steps(goal.first_time, of), steps(goal.last_time, of));
    constexpr double fast = 1000.0;  // [m/s] where there is no limit
    bool const is_low = std::isfinite(limits.lowest_speed), is_high = std::isfinite(limits.highest_speed);
    if (is_low || is_high)
      interval("velocity", decimal_text(is_low ? limits.lowest_speed : std::min(-fast, limits.highest_speed - fast)),
               decimal_text(is_high ? limits.highest_speed : std::max(fast, limits.lowest_speed + fast)));
  }

  RecordedTraffic const& traffic_;
  CommonRoadHeader const& header_;
  std::vector<map::Lanelet> lanelets_;
  map::xml::XmlText text_;
  std::set<Id> used_;
  Id next_ = 1;
  std::map<Sign, Id> signs_;
  std::map<std::string, Id> lights_;
};

}  // namespace detail

CAMBIUM_COLD std::string common_road_text(RecordedTraffic const& traffic, CommonRoadHeader const& header) {
  return detail::CommonRoadWriter(traffic, header).write();
}

}  // namespace cambium::inline v0_1
