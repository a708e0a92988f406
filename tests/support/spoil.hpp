#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <iterator>
#include <limits>
#include <string>

#include "cambium/core/parameters.hpp"
#include "cambium/core/random.hpp"
#include "cambium/snapshot.hpp"

namespace support {

/// Another number, often one that is easily forgotten. None is near overflow, as no state is: see `is_finite`.
inline void spoil(cambium::TypeInfo const& type, void* place, cambium::RandomStream& random) {
  using cambium::TypeInfo;
  auto value = cambium::PlainValue::at(place, type);
  if (type.kind == TypeInfo::Kind::boolean) {
    value.bits = value.bits == 0;
  } else if (type.is_real()) {
    using Limits = std::numeric_limits<double>;
    double const number = value.number;
    double const all[] = {Limits::quiet_NaN(),
                          Limits::infinity(),
                          -Limits::infinity(),
                          1e30,
                          -1e30,
                          1e9,
                          1e-30,
                          0.0,
                          -1.0,
                          -number,
                          number * 1000,
                          number + 1,
                          number - 1,
                          number + 100,
                          number - 100,
                          cambium::uniform01(random)};
    value.number = all[random() % std::size(all)];
  } else {
    auto const highest = cambium::PlainValue::highest(type).bits, lowest = cambium::PlainValue::lowest(type).bits;
    std::uint64_t const all[] = {0,       1, 2, 3, 255, highest, lowest, value.bits + 1, value.bits - 1, random() % 16,
                                 random()};
    value.bits = all[random() % std::size(all)];  // wraps
  }
  value.store(place, type);
}

struct Spoilt {
  int refused = 0, worlds = 0;
};

/// A snapshot of what `archived` gave.
template <class Parts>
[[nodiscard]] std::string snapshot_of(Parts const& parts, cambium::Map const& map) {
  using namespace cambium::detail;
  SavedPart const part{"world", &parts, [](OutArchive& archive, char const* key, void const* object) {
                         archive_fields(archive, key, *static_cast<Parts const*>(object));
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
  auto const& type = type_info<decltype(whole)>();
  detail::edit_values(type, &whole, "spoilt", [&](TypeInfo const&, void*) { ++numbers; });
  for (int i = 0; i < count; ++i) {
    RandomStream random(static_cast<std::uint64_t>(i), 0, 0);
    auto parts = whole;
    World other(world.shared_map());
    try {
      for (auto k = 1 + random() % 3; k > 0; --k) {
        std::size_t const at = random() % numbers;
        std::size_t j = 0;
        detail::edit_values(type, &parts, "spoilt", [&](TypeInfo const& plain, void* number) {
          if (j++ == at) spoil(plain, number, random);
        });
      }
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
