#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <iterator>
#include <limits>
#include <string>
#include <type_traits>
#include <variant>

#include "cambium/core/parameters.hpp"
#include "cambium/core/random.hpp"
#include "cambium/snapshot.hpp"

namespace support {

/// Calls `f(number)` for each number in `value` that can be changed in place.
template <class Value, class F>
void for_each_number(Value& value, F const& f) {
  using namespace cambium;
  if constexpr (Described<Value>) {
    for_each_parameter<Value>([&](auto const& p) { for_each_number(value.*p.field, f); });
  } else if constexpr (detail::Variant<Value>) {
    detail::with_alternative(value, [&](auto const&, auto place) { for_each_number(*std::get_if<place>(&value), f); });
  } else if constexpr (detail::Optional<Value>) {
    if (value) for_each_number(*value, f);
  } else if constexpr (requires { requires !std::is_const_v<std::remove_reference_t<decltype(value.data()[0])>>; }) {
    if constexpr (!std::is_same_v<Value, std::string>)
      for (std::size_t i = 0; i < value.size(); ++i) for_each_number(value.data()[i], f);
  } else if constexpr (std::is_arithmetic_v<Value> || std::is_enum_v<Value>) {
    f(value);
  }
}

/// Another number, often one that is easily forgotten. None is near overflow, as no state is: see `is_finite`.
template <class Number>
void spoil(Number& number, cambium::RandomStream& random) {
  using Limits = std::numeric_limits<Number>;
  if constexpr (std::is_enum_v<Number>) {
    auto whole = static_cast<std::underlying_type_t<Number>>(number);
    spoil(whole, random);
    number = static_cast<Number>(whole);
  } else if constexpr (std::is_same_v<Number, bool>) {
    number = !number;
  } else if constexpr (std::is_floating_point_v<Number>) {
    Number const all[] = {
        Limits::quiet_NaN(), Limits::infinity(),   -Limits::infinity(),   Number(1e30),
        Number(-1e30),       Number(1e9),          Number(1e-30),         Number(0),
        Number(-1),          Number(-number),      Number(number * 1000), Number(number + 1),
        Number(number - 1),  Number(number + 100), Number(number - 100),  Number(cambium::uniform01(random))};
    number = all[random() % std::size(all)];
  } else {
    using Whole = std::make_unsigned_t<Number>;  // wraps
    auto const whole = static_cast<Whole>(number);
    Whole const all[] = {0,
                         1,
                         2,
                         3,
                         255,
                         Whole(Limits::max()),
                         Whole(Limits::min()),
                         Whole(whole + 1u),
                         Whole(whole - 1u),
                         Whole(random() % 16),
                         Whole(random())};
    number = static_cast<Number>(all[random() % std::size(all)]);
  }
}

struct Spoilt {
  int refused = 0, worlds = 0;
};

/// A snapshot of what `archived` gave.
template <class Parts>
[[nodiscard]] std::string snapshot_of(Parts const& parts, cambium::Map const& map) {
  using namespace cambium::detail;
  SavedPart const part{"world", &parts, [](OutArchive& archive, char const* key, void const* object) {
                         FieldWriter(archive).write(key, *static_cast<Parts const*>(object));
                       }};
  return with_head(archive_parts(cambium::SnapshotFormat::binary, {&map, 0.0}, {&part, 1}), {});
}

/// Changes one to three numbers of `world`, `count` times. What comes of it must be refused with a `cambium::Error`, or
/// be a world that makes `steps` steps and can be saved and restored after each; else `tell(sentence)` is called.
template <class World, class Tell>
[[nodiscard]] Spoilt spoil_numbers(World const& world, int count, int steps, Tell const& tell) {
  using namespace cambium;
  Spoilt result;
  auto whole = detail::archived(world);
  std::size_t numbers = 0;
  for_each_number(whole, [&](auto const&) { ++numbers; });
  for (int i = 0; i < count; ++i) {
    RandomStream random(static_cast<std::uint64_t>(i), 0, 0);
    auto parts = whole;
    for (auto k = 1 + random() % 3; k > 0; --k) {
      std::size_t const at = random() % numbers;
      std::size_t j = 0;
      for_each_number(parts, [&](auto& number) {
        if (j++ == at) spoil(number, random);
      });
    }
    World other(world.shared_map());
    try {
      from_snapshot(snapshot_of(parts, world.map()), "spoilt", other);
    } catch (Error const&) {
      ++result.refused;
      continue;
    }
    ++result.worlds;
    try {
      for (int step = 0; step < steps; ++step) {
        static_cast<void>(other.step(0.2));
        World again(world.shared_map());
        from_snapshot(to_snapshot({}, other), "spoilt", again);
      }
    } catch (std::exception const& error) {
      tell("spoilt world " + std::to_string(i) + ": " + error.what());
    }
  }
  return result;
}

}  // namespace support
