#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <string_view>

namespace cambium::inline v0_1 {

/// The name that the host's tracker gives an object: 128 bits hold a UUID; a number fits into `low`.
struct ObjectKey {
  std::uint64_t high = 0, low = 0;

  friend constexpr bool operator==(ObjectKey const&, ObjectKey const&) = default;
  friend constexpr auto operator<=>(ObjectKey const&, ObjectKey const&) = default;
};

/// The key of a name, such as a token: two hashes of it (FNV-1a), so that names that differ have different keys but for
/// one pair in 10^19 names.
[[nodiscard]] constexpr ObjectKey key_of(std::string_view name) {
  ObjectKey key{0xcbf29ce484222325u, 0x84222325cbf29ce4u};
  for (char const c : name) {
    auto const byte = static_cast<std::uint64_t>(static_cast<unsigned char>(c));
    key.high = (key.high ^ byte) * 0x100000001b3u;
    key.low = (key.low ^ (byte + 0x9eu)) * 0x100000001b3u;
    key.low ^= key.low >> 29;
  }
  return key;
}

/// What an object is. Those that a tracker knows more exactly fall into one of these.
enum class ObjectClass : std::uint8_t {
  unknown,
  car,
  truck,
  bus,
  trailer,
  motorcycle,
  bicycle,
  pedestrian,
  animal,
  obstacle,  ///< it does not move by itself
};

/// Which point of the object its position is.
enum class ObjectPoint : std::uint8_t {
  box_center,
  rear_axle,  ///< middle of it: cambium's reference point; of what has no two axles of wheels beside, the box's centre
};

/// What is known of the heading.
enum class HeadingKnown : std::uint8_t {
  yes,
  up_to_sign,  ///< the box's axis is known, front and rear are not
  no,
};

/// An object of the host's perception at one moment, in the map frame, SI units, radians. What the host does not know
/// keeps its default. The fields are those that autoware, Apollo, nuPlan and OSI have in common.
struct TrackedObject {
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

  ObjectKey key{};
  std::int64_t stamp = 0;  ///< when it was measured [ns], any epoch; 0: when the list was
  double x = unknown, y = unknown;
  double heading = unknown;          ///< of its front
  double vx = 0.0, vy = 0.0;         ///< velocity in the map frame, not in the object's
  double length = 0.0, width = 0.0;  ///< 0: as usual for its class
  ObjectClass kind = ObjectClass::unknown;
  ObjectPoint point = ObjectPoint::box_center;
  HeadingKnown heading_known = HeadingKnown::yes;
  double yaw_rate = unknown;      ///< [rad/s]; unknown: taken from the headings
  double acceleration = unknown;  ///< along its motion [m/s^2]; unknown: taken from the speeds
  double existence = 1.0;         ///< probability that it is there
  bool is_parked = false;         ///< the host knows that it stays
};

}  // namespace cambium::inline v0_1

template <>
struct std::hash<cambium::ObjectKey> {
  std::size_t operator()(cambium::ObjectKey const& key) const noexcept {
    return static_cast<std::size_t>(key.high * 0x9e3779b97f4a7c15u ^ key.low);
  }
};
