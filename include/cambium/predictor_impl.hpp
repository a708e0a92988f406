#pragma once

#include <cmath>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "cambium/core/diagnostic.hpp"
#include "cambium/core/error.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/map/corridor/build_corridor.hpp"
#include "cambium/map/lanelet/lanelet2.hpp"
#include "cambium/map/map.hpp"
#include "cambium/map/opendrive.hpp"
#include "cambium/predictor.hpp"
#include "cambium/scenario/dataset/common_road.hpp"
#include "cambium/tracking/tracker.hpp"

namespace cambium::inline v0_1 {

struct Predictor::Parts {
  std::shared_ptr<map::Map const> map;
  Tracker<> tracker;
  std::vector<std::string> warnings{};
  std::vector<map::LightColor> shown{};  ///< by light
  std::mutex holding{};
  std::vector<std::shared_ptr<map::RoadCorridor const>> held{};
};

namespace detail {

struct MapOfFile {
  std::shared_ptr<map::Map const> map;
  std::vector<std::string> warnings;
};

[[nodiscard]] CAMBIUM_COLD MapOfFile map_of_file(std::string const& file,
                                                 std::optional<map::Lanelet2Origin> const& origin) {
  MapOfFile made;
  auto const take = [&](auto const& loaded) {
    made.map = loaded.map;
    for (auto const& diagnostic : loaded.diagnostics)
      if (diagnostic.severity != Severity::info) made.warnings.push_back(to_string(diagnostic));
  };
  auto const extension = std::filesystem::path(file).extension();
  if (origin && extension != ".osm")
    throw MapError(file, "only Lanelet2 maps have an origin", "leave it out, or give a map that ends in .osm");
  if (extension == ".osm") {
    take(load_lanelet2(file, origin));
  } else if (extension == ".xml") {
    take(load_common_road(file));
    if (!made.map) throw MapError(file, "it has no lanelets", "give a CommonRoad scenario with lanelets");
  } else {
    take(load_opendrive(file));
  }
  return made;
}

}  // namespace detail

CAMBIUM_COLD Predictor::Predictor(std::string const& map_file, TrackerOptions const& options,
                                  std::optional<map::Lanelet2Origin> const& origin) {
  auto made = detail::map_of_file(map_file, origin);
  *this = Predictor(made.map, options);
  parts_->warnings = std::move(made.warnings);
}
CAMBIUM_COLD Predictor::Predictor(std::shared_ptr<map::Map const> map, TrackerOptions const& options)
    : parts_(new Parts{map, Tracker<>(map, options)}) {}
CAMBIUM_COLD Predictor::Predictor(Predictor&&) noexcept = default;
CAMBIUM_COLD Predictor& Predictor::operator=(Predictor&&) noexcept = default;
CAMBIUM_COLD Predictor::~Predictor() = default;

CAMBIUM_COLD std::vector<std::string> const& Predictor::map_warnings() const { return parts_->warnings; }
CAMBIUM_COLD std::shared_ptr<map::Map const> const& Predictor::map() const { return parts_->map; }
CAMBIUM_COLD std::span<ObjectKey const> Predictor::objects() const { return parts_->tracker.objects(); }

CAMBIUM_COLD std::span<Verdict const> Predictor::update(std::int64_t stamp, std::span<TrackedObject const> objects) {
  return parts_->tracker.update(stamp, objects);
}

CAMBIUM_COLD PredictedModes Predictor::predict(PredictionRequest const& request, std::span<PredictedState> states,
                                               Choose const& choose) {
  if (!choose) return parts_->tracker.predict(request, states);
  using Behavior = TrackedWorld::Behavior;
  return parts_->tracker.predict(
      request, states, [&](ObjectKey const& key, PredictedMode const& mode) -> std::optional<Behavior> {
        auto const chosen = choose(key, mode);
        if (!chosen) return std::nullopt;
        auto const within = [](double value, double least, double most) { return value >= least && value <= most; };
        auto driver = parts_->tracker.driver_of(key);
        if (!chosen->on_lanes || !driver) return ConstantTurn{};
        if (within(chosen->desired_speed, 0.1, 70.0)) {
          driver->law.desired_speed = chosen->desired_speed;
          driver->heed<SpeedLimit>().factor = 3.0;
        }
        if (within(chosen->time_headway, 1e-3, 10.0)) driver->law.time_headway = chosen->time_headway;
        if (!chosen->gives_way) driver->heed<Conflicts>().look_ahead = 0.0;
        return *driver;
      });
}

CAMBIUM_COLD void Predictor::prepare(double x, double y, double radius) {
  if (!(std::isfinite(x + y) && radius >= 0.0 && radius <= 1e5))
    throw ParameterError("Predictor::prepare", "a point that is no number, or a radius outside [0, 1e5] m",
                         "give a place on the map, in metres");
  std::vector<std::shared_ptr<map::RoadCorridor const>> roads;
  for (auto const lane : map()->lanes_in(geometry::Box{x, y, x, y}.grown(radius)))
    if (map()->lane(lane).drivable())
      for (auto& road : map::roads_ahead(*map(), lane)) roads.push_back(std::move(road));
  std::lock_guard const lock(parts_->holding);
  parts_->held.swap(roads);
}

CAMBIUM_COLD void Predictor::set_light(std::string const& name, map::LightColor color) {
  constexpr double always = 3600.0;  // [s]
  auto const light = map()->find_light(name);
  auto& shown = parts_->shown;
  shown.resize(map()->lights().size(), map::LightColor::off);
  if (std::exchange(shown[index_of(light)], color) == color) return;  // it goes on as since the first call
  map::LightPlan plan{.cycle = always, .green_begin = 0.0, .green_end = always, .yellow = 0.0};
  switch (color) {
    case map::LightColor::off:
      plan.cycle = 0.0;
      break;
    case map::LightColor::green:
      break;
    case map::LightColor::yellow:
      plan.green_begin = plan.green_end = std::fmod(parts_->tracker.world().time(), always);
      plan.yellow = always;
      break;
    case map::LightColor::red:
      plan.green_end = 0.0;
      break;
  }
  parts_->tracker.set_light(light, plan);
}

}  // namespace cambium::inline v0_1
