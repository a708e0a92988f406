#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

#include "cambium/cambium.h"
#include "cambium/core/error.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/core/version.hpp"
#include "cambium/predictor.hpp"

/// The functions of `cambium.h`, which `cambium::compiled_predictor` has.

namespace cambium::inline v0_1::detail {

/// What a `cambium_predictor*` points to: in the namespace, so that libraries that have each a version of their own
/// inside stay apart.
struct PredictorForC {
  Predictor predictor;
  std::vector<TrackedObject> objects{};
};

[[nodiscard]] inline PredictorForC* of_c(cambium_predictor* predictor) {
  return reinterpret_cast<PredictorForC*>(predictor);
}
[[nodiscard]] inline PredictorForC const* of_c(cambium_predictor const* predictor) {
  return reinterpret_cast<PredictorForC const*>(predictor);
}

/// What went wrong last in this thread. Setting it cannot fail.
[[nodiscard]] CAMBIUM_COLD std::array<char, 1024>& last_c_error() {
  thread_local std::array<char, 1024> text{};
  return text;
}
CAMBIUM_COLD void keep_c_error(char const* what) noexcept {
  auto& text = last_c_error();
  text[std::string_view(what).copy(text.data(), text.size() - 1)] = '\0';
}

/// Calls `f`; returns what it returns, or `failed` and keeps the reason if it throws.
template <class F>
[[nodiscard]] auto guarded(std::invoke_result_t<F> failed, F const& f) noexcept -> std::invoke_result_t<F> {
  try {
    return f();
  } catch (std::exception const& error) {
    keep_c_error(error.what());
  } catch (...) {
    keep_c_error("an exception that is no std::exception");
  }
  return failed;
}

[[noreturn]] CAMBIUM_COLD void refuse_call(char const* where, char const* what) {
  throw ParameterError(where, what, "see cambium/cambium.h");
}

/// An enum's value, or the first one where the number is none of the `count` that there are.
template <class E>
[[nodiscard]] E enum_of(std::int32_t number, std::int32_t count) {
  return number >= 0 && number < count ? static_cast<E>(number) : E{};
}

[[nodiscard]] CAMBIUM_COLD TrackedObject object_of(cambium_object const& o) {
  return {.key = {o.key.high, o.key.low},
          .stamp = o.stamp,
          .x = o.x,
          .y = o.y,
          .heading = o.heading,
          .vx = o.vx,
          .vy = o.vy,
          .length = o.length,
          .width = o.width,
          .kind = enum_of<ObjectClass>(o.kind, 10),
          .point = enum_of<ObjectPoint>(o.point, 2),
          .heading_known = enum_of<HeadingKnown>(o.heading_known, 3),
          .yaw_rate = o.yaw_rate,
          .acceleration = o.acceleration,
          .existence = o.existence,
          .is_parked = o.is_parked != 0};
}

}  // namespace cambium::inline v0_1::detail

extern "C" {

CAMBIUM_COLD char const* cambium_version(void) { return cambium::library_version; }

CAMBIUM_COLD cambium_object cambium_object_default(void) {
  cambium::TrackedObject const usual;
  return {.key = {0, 0},
          .stamp = 0,
          .x = usual.x,
          .y = usual.y,
          .heading = usual.heading,
          .vx = 0.0,
          .vy = 0.0,
          .length = 0.0,
          .width = 0.0,
          .yaw_rate = usual.yaw_rate,
          .acceleration = usual.acceleration,
          .existence = usual.existence,
          .kind = CAMBIUM_UNKNOWN,
          .point = CAMBIUM_BOX_CENTER,
          .heading_known = CAMBIUM_HEADING_YES,
          .is_parked = 0};
}

CAMBIUM_COLD cambium_request cambium_request_default(void) {
  cambium::PredictionRequest const usual;
  return {usual.steps, usual.modes, usual.step, 0, nullptr, 0, nullptr, 0};
}

CAMBIUM_COLD cambium_key cambium_key_of(char const* name) {
  auto const key = cambium::key_of(name != nullptr ? name : "");
  return {key.high, key.low};
}

CAMBIUM_COLD char const* cambium_motion_name(int32_t motion) {
  return motion >= 0 && motion <= static_cast<int32_t>(cambium::ObjectMotion::none)
             ? to_string(static_cast<cambium::ObjectMotion>(motion))
             : "no motion of this number";
}
CAMBIUM_COLD char const* cambium_refusal_name(int32_t refusal) {
  return refusal >= 0 && refusal <= static_cast<int32_t>(cambium::Refusal::unlikely)
             ? to_string(static_cast<cambium::Refusal>(refusal))
             : "no reason of this number";
}
CAMBIUM_COLD char const* cambium_maneuver_name(int32_t maneuver) {
  return maneuver >= 0 && maneuver <= static_cast<int32_t>(cambium::Maneuver::none)
             ? to_string(static_cast<cambium::Maneuver>(maneuver))
             : "no maneuver of this number";
}

CAMBIUM_COLD char const* cambium_error(void) { return cambium::detail::last_c_error().data(); }

CAMBIUM_COLD cambium_predictor* cambium_open(char const* map_file, double const* origin) {
  return cambium::detail::guarded(nullptr, [&]() -> cambium_predictor* {
    if (map_file == nullptr) cambium::detail::refuse_call("cambium_open", "there is no file name");
    std::optional<cambium::map::Lanelet2Origin> begin;
    if (origin != nullptr) begin = {origin[0], origin[1]};
    return reinterpret_cast<cambium_predictor*>(
        new cambium::detail::PredictorForC{cambium::Predictor(map_file, {}, begin)});
  });
}
CAMBIUM_COLD void cambium_close(cambium_predictor* predictor) { delete cambium::detail::of_c(predictor); }

CAMBIUM_COLD int cambium_update(cambium_predictor* predictor, int64_t stamp, cambium_object const* objects,
                                size_t count, cambium_verdict* verdicts) {
  return cambium::detail::guarded(0, [&] {
    if (predictor == nullptr || (count > 0 && (objects == nullptr || verdicts == nullptr)))
      cambium::detail::refuse_call("cambium_update", "a pointer is null");
    auto& list = cambium::detail::of_c(predictor)->objects;
    list.clear();
    for (size_t i = 0; i < count; ++i) list.push_back(cambium::detail::object_of(objects[i]));
    for (auto const& v : cambium::detail::of_c(predictor)->predictor.update(stamp, list))
      *verdicts++ = {{v.key.high, v.key.low},
                     v.probability,
                     static_cast<uint32_t>(v.lane),
                     static_cast<int32_t>(v.motion),
                     static_cast<int32_t>(v.refusal),
                     v.assumed_size,
                     v.assumed_heading};
    return 1;
  });
}

CAMBIUM_COLD size_t cambium_objects(cambium_predictor const* predictor, cambium_key* keys, size_t room) {
  if (predictor == nullptr) return 0;
  auto const objects = cambium::detail::of_c(predictor)->predictor.objects();
  for (size_t i = 0; keys != nullptr && i < std::min(room, objects.size()); ++i)
    keys[i] = {objects[i].high, objects[i].low};
  return objects.size();
}

CAMBIUM_COLD int cambium_predict(cambium_predictor* predictor, cambium_request const* request, cambium_state* states,
                                 size_t state_room, cambium_mode* modes, size_t mode_room) {
  static_assert(sizeof(cambium_state) == sizeof(cambium::PredictedState) &&
                sizeof(cambium_key) == sizeof(cambium::ObjectKey));
  return cambium::detail::guarded(0, [&] {
    using cambium::detail::refuse_call;
    if (predictor == nullptr || request == nullptr) refuse_call("cambium_predict", "a pointer is null");
    if ((request->given == nullptr && request->given_count > 0))
      refuse_call("cambium_predict", "given is null, given_count is not 0");
    auto const state_of = [](cambium_state const& s) { return cambium::PredictedState{s.x, s.y, s.heading, s.speed}; };
    std::vector<cambium::ObjectKey> keys;
    for (size_t i = 0; request->objects != nullptr && i < request->object_count; ++i)
      keys.push_back({request->objects[i].high, request->objects[i].low});
    std::vector<std::vector<cambium::PredictedState>> courses(request->given_count);
    std::vector<cambium::GivenTrajectory> given;
    for (size_t i = 0; i < request->given_count; ++i) {
      auto const& t = request->given[i];
      if (t.states == nullptr && t.count > 0) refuse_call("cambium_predict", "a trajectory's states are null");
      for (size_t k = 0; k < t.count; ++k) courses[i].push_back(state_of(t.states[k]));
      given.push_back({{t.key.high, t.key.low}, courses[i], t.probability});
    }
    auto const count = keys.empty() ? cambium::detail::of_c(predictor)->predictor.objects().size() : keys.size();
    if (count > 0 && (states == nullptr || modes == nullptr)) refuse_call("cambium_predict", "a pointer is null");
    if (request->modes > 0 && mode_room / request->modes < count)
      refuse_call("cambium_predict", "there is no room for all modes: give modes * objects");
    bool const is_possible = request->modes <= 256 && request->steps <= 10'000;  // else predict says so
    std::vector<cambium::PredictedState> predicted(
        is_possible ? std::min(state_room, request->modes * count * request->steps) : 0);
    auto const result = cambium::detail::of_c(predictor)->predictor.predict({.steps = request->steps,
                                                                             .step = request->step,
                                                                             .modes = request->modes,
                                                                             .joint = request->joint != 0,
                                                                             .objects = keys,
                                                                             .given = given},
                                                                            predicted);
    for (auto const& s : predicted) *states++ = {s.x, s.y, s.heading, s.speed};
    for (auto const& m : result.modes)
      *modes++ = {m.probability, static_cast<int32_t>(m.maneuver), static_cast<uint32_t>(m.lane)};
    return 1;
  });
}

CAMBIUM_COLD int cambium_prepare(cambium_predictor* predictor, double x, double y, double radius) {
  return cambium::detail::guarded(0, [&] {
    if (predictor == nullptr) cambium::detail::refuse_call("cambium_prepare", "the predictor is null");
    cambium::detail::of_c(predictor)->predictor.prepare(x, y, radius);
    return 1;
  });
}

CAMBIUM_COLD int cambium_set_light(cambium_predictor* predictor, char const* name, int32_t color) {
  return cambium::detail::guarded(0, [&] {
    if (predictor == nullptr || name == nullptr) cambium::detail::refuse_call("cambium_set_light", "a pointer is null");
    if (color < CAMBIUM_LIGHT_OFF || color > CAMBIUM_LIGHT_RED)
      cambium::detail::refuse_call("cambium_set_light", "the colour is none of CAMBIUM_LIGHT_OFF to CAMBIUM_LIGHT_RED");
    cambium::detail::of_c(predictor)->predictor.set_light(name, static_cast<cambium::map::LightColor>(color));
    return 1;
  });
}

}  // extern "C"
