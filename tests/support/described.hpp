#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cambium/core/ids.hpp"
#include "cambium/core/one_of.hpp"
#include "cambium/core/parameters.hpp"

/// Described structs with all kinds of fields.
namespace support {

using cambium::any_finite, cambium::parameter, cambium::parameter_list, cambium::Range;

/// A struct of one field.
template <class Value>
struct One {
  Value value{};

  static constexpr char const* name = "one";
  static constexpr auto parameters() {
    return parameter_list(parameter("value", &One::value, "-", any_finite, "the only field"));
  }
};

enum class Mood : std::uint8_t { calm, hasty };

struct Window {
  double from = 0.0, to = 1.0;

  static constexpr char const* name = "window";
  static constexpr auto parameters() {
    return parameter_list(parameter("from", &Window::from, "s", any_finite, "begins"),
                          parameter("to", &Window::to, "s", any_finite, "ends"));
  }
  void check(std::string const& where) const {
    if (from > to) throw cambium::ParameterError(where, "ends before it begins", "swap the two");
  }
  friend bool operator==(Window const&, Window const&) = default;
};

struct Straight {
  static constexpr char const* name = "straight";
  static constexpr auto parameters() { return parameter_list(); }
};
struct Turn {
  double radius = 10.0;
  std::vector<Window> windows{};

  static constexpr char const* name = "turn";
  static constexpr auto parameters() {
    return parameter_list(parameter("radius", &Turn::radius, "m", cambium::positive, "of the bend"),
                          parameter("windows", &Turn::windows, "when"));
  }
};
struct Secret {};  // not described

struct Everything {
  double number = 1.5;
  float single = 0.1f;
  int integer = -3;
  std::int64_t wide = 0;
  std::uint64_t natural = 7;
  std::uint8_t small = 1;
  bool truth = false;
  Mood mood = Mood::calm;
  cambium::AgentId agent = cambium::none<cambium::AgentId>;
  cambium::LaneId lane = cambium::none<cambium::LaneId>;
  std::string text = "usual";
  Window window{};
  cambium::OneOf<Straight, Turn, Secret> way{};
  std::optional<double> maybe{};
  std::array<double, 2> pair{1.0, 2.0};
  std::vector<Window> windows{};
  std::vector<double> numbers{1.0};
  std::shared_ptr<std::vector<double> const> shared{};

  static constexpr char const* name = "everything";
  static constexpr auto parameters() {
    using P = Everything;
    return parameter_list(
        parameter("number", &P::number, "m", detail_range, "a number"),
        parameter("single", &P::single, "m", any_finite, "in single precision"),
        parameter("integer", &P::integer, "-", Range{-10, 10}, "an integer"),
        parameter("wide", &P::wide, "-", any_finite, "of eight bytes"),
        parameter("natural", &P::natural, "-", Range{0, 1.8446744073709552e19}, "a natural number"),
        parameter("small", &P::small, "-", Range{0, 255}, "a byte"), parameter("truth", &P::truth, "yes or no"),
        cambium::choice("mood", &P::mood, "calm|hasty", "a choice"), parameter("agent", &P::agent, "an id"),
        parameter("lane", &P::lane, "a lane"), parameter("text", &P::text, "a text"),
        parameter("window", &P::window, "a struct"), parameter("way", &P::way, "an alternative"),
        parameter("maybe", &P::maybe, "-", any_finite, "an optional"),
        parameter("pair", &P::pair, "-", any_finite, "of fixed length"), parameter("windows", &P::windows, "structs"),
        parameter("numbers", &P::numbers, "-", any_finite, "numbers"),
        parameter("shared", &P::shared, "-", any_finite, "behind a pointer"));
  }
  static constexpr Range detail_range{-1e3, std::numeric_limits<double>::infinity()};
};

/// One whose fields are all other than usual.
inline Everything unusual() {
  return {.number = std::numeric_limits<double>::infinity(),
          .single = 0.3f,
          .integer = -7,
          .wide = -1234567890123456789,
          .natural = std::numeric_limits<std::uint64_t>::max(),
          .small = 200,
          .truth = true,
          .mood = Mood::hasty,
          .agent = cambium::AgentId{12},
          .lane = cambium::LaneId{4},
          .text = "\"a\\b\"\n\x01 \u00e9",
          .window = {.from = 0.1 + 0.2, .to = 1e300},
          .way = Turn{.radius = 3.0, .windows = {{.from = -1.0}}},
          .maybe = 5e-324,
          .pair = {3.0, -0.0},
          .windows = {{}, {.to = 2.0}},
          .numbers = {},
          .shared = std::make_shared<std::vector<double> const>(std::vector<double>{1.0, 0.1})};
}

}  // namespace support
