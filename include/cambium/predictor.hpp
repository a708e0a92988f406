#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cambium/core/ids.hpp"
#include "cambium/map/fwd.hpp"
#include "cambium/map/lanelet/lanelet2_origin.hpp"
#include "cambium/map/lanes/signals.hpp"
#include "cambium/tracking/predicted_modes.hpp"
#include "cambium/tracking/tracked_object.hpp"
#include "cambium/tracking/tracker_options.hpp"
#include "cambium/tracking/verdict.hpp"

namespace cambium::inline v0_1 {

/// What drives an object in a mode, in place of what the tracker would take.
struct ObjectModel {
  bool on_lanes = true;        ///< a driver on its way, if it is on one; else it goes on its own course
  double desired_speed = 0.0;  ///< of a driver [m/s]; 0: as learnt
  double time_headway = 0.0;   ///< likewise [s]; 0: the usual one
  bool gives_way = true;       ///< a driver heeds others at junctions
};

/// Tracks and predicts the objects of a planner stack: `Tracker<>`, behind a firewall. Who includes this compiles
/// neither templates nor Eigen, and links `cambium::compiled_predictor` (else each source that includes this compiles
/// it all).
///
///     cambium::Predictor predictor("town.xodr");
///     for each cycle:  verdicts = predictor.update(stamp, objects);
///                      modes = predictor.predict({.steps = 30, .step = 0.1, .modes = 3}, states);
///
/// One thread at a time.
class Predictor {
 public:
  /// Reads a map: OpenDRIVE (.xodr), Lanelet2 (.osm; with `origin` where its nodes have degrees alone) or a CommonRoad
  /// scenario (.xml). Throws `MapError` where that fails, `ParameterError` for options out of range.
  explicit Predictor(std::string const& map_file, TrackerOptions const& options = {},
                     std::optional<map::Lanelet2Origin> const& origin = {});
  /// On a map of the caller's. Throws `WorldError` without one.
  explicit Predictor(std::shared_ptr<map::Map const> map, TrackerOptions const& options = {});
  Predictor(Predictor&&) noexcept;
  Predictor& operator=(Predictor&&) noexcept;
  ~Predictor();

  /// What was odd about the map file, a sentence each.
  [[nodiscard]] std::vector<std::string> const& map_warnings() const;
  [[nodiscard]] std::shared_ptr<map::Map const> const& map() const;

  /// See `Tracker::update`.
  std::span<Verdict const> update(std::int64_t stamp, std::span<TrackedObject const> objects);

  /// The objects that are tracked now: those of the last list, and those that it lacked but are kept (see
  /// `TrackerOptions::keep_unseen`). Valid until the next update.
  [[nodiscard]] std::span<ObjectKey const> objects() const;

  /// See `Tracker::predict`. `choose` may say what drives an object in a mode; a value that is not finite or out of
  /// range (0.1 to 70 m/s, 0 to 10 s) counts as 0.
  using Choose = std::function<std::optional<ObjectModel>(ObjectKey const&, PredictedMode const&)>;
  PredictedModes predict(PredictionRequest const& request, std::span<PredictedState> states, Choose const& choose = {});

  /// Builds the roads within `radius` [m] of a point, so that no update has to; holds them, and lets go of those that
  /// it held before. Milliseconds to seconds. It may run on another thread than the cycle.
  void prepare(double x, double y, double radius);

  /// What a traffic light of the map shows, from now on; `off` by default, so that priorities count. Throws `MapError`
  /// if the map has no light of that name.
  void set_light(std::string const& name, map::LightColor color);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace cambium::inline v0_1

#ifndef CAMBIUM_COMPILED
#include "cambium/predictor_impl.hpp"
#endif
