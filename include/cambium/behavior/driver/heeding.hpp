#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>

#include "cambium/behavior/behavior_model.hpp"
#include "cambium/core/described.hpp"

namespace cambium::inline v0_1 {

namespace detail {

/// One part of a pack.
template <class Part>
struct Slotted {
  [[no_unique_address]] Part part{};
  friend bool operator==(Slotted const&, Slotted const&) = default;
};

/// The memory of a heed in a pack; nothing for a heed that has none.
template <class Heed, class Memory = MemoryOf<Heed>>
struct HeedMemory {
  Memory memory{};
  friend bool operator==(HeedMemory const&, HeedMemory const&) = default;
};
template <class Heed>
struct HeedMemory<Heed, NoMemory> {
  friend bool operator==(HeedMemory const&, HeedMemory const&) = default;
};

/// Index of the first of `Parts` that is `T` or derived from it; `sizeof...(Parts)` if none is.
template <class T, class... Parts>
[[nodiscard]] constexpr std::size_t place_of() {
  constexpr bool is[] = {std::derived_from<Parts, T>..., true};
  std::size_t i = 0;
  while (!is[i]) ++i;
  return i;
}

template <class T, class... Parts>
using FoundPart = std::tuple_element_t<place_of<T, Parts...>(), std::tuple<Parts...>>;

/// A heed that messages and files can name.
template <class H>
concept HeedText = std::copyable<H> && std::default_initializable<H> && Described<H> && requires {
  { H::name } -> std::convertible_to<std::string_view>;
  { H::summary } -> std::convertible_to<char const*>;
};

struct HeedNames {
  int desired_speed, merging;
};
/// A second member of these names makes those of a heed ambiguous, even templates.
template <class H>
struct WithHeedNames : H, HeedNames {};
template <class H>
[[nodiscard]] constexpr bool names_desired_speed() {
  if constexpr (!std::is_final_v<H>) return !requires {
      &WithHeedNames<H>::desired_speed;
    };
  return false;
}
template <class H>
[[nodiscard]] constexpr bool names_merging() {
  if constexpr (!std::is_final_v<H>) return !requires {
      &WithHeedNames<H>::merging;
    };
  return false;
}

/// Returns true; fails to compile with a sentence that says what is wrong with a driver's heeds.
template <class... Heeds>
[[nodiscard]] constexpr bool check_heeds() {
  constexpr bool have_text = (HeedText<Heeds> && ...);
  static_assert(
      have_text,
      "cambium::Driver<Law, Lateral, Heeds...>: each heed must be a copyable struct with `static constexpr char "
      "const *name = ..., *summary = ...` and `static constexpr auto parameters()` (see Heeding)");
  if constexpr (have_text) {
    constexpr bool have_own_names = [] {
      std::string_view const names[] = {Heeds::name..., {}};
      for (std::size_t i = 0; i < sizeof...(Heeds); ++i)
        for (std::size_t k = 0; k < i; ++k)
          if (names[i] == names[k]) return false;
      return true;
    }();
    static_assert(have_own_names,
                  "cambium::Driver<Law, Lateral, Heeds...>: name each heed once; two with one name would have one key");
  }
  return true;
}

/// The memory of a heed as a list of fields; none for a heed without one.
template <class Owner, class Heed>
[[nodiscard]] constexpr auto memory_parameter() {
  if constexpr (std::is_same_v<MemoryOf<Heed>, NoMemory>)
    return parameter_list();
  else
    return parameter_list(parameter<Owner, MemoryOf<Heed>>(
        Heed::name, static_cast<MemoryOf<Heed> Owner::*>(&HeedMemory<Heed>::memory), "of this heed"));
}

}  // namespace detail

/// What a driver heeds besides the road users in its lane, in this order. A heed is a described struct with a `summary`
/// and one of these functions:
/// - `heed(view, limits, dt)`, or with a `Memory` of its own `heed(view, memory, limits, dt)`, adds to the
///   `Limits` of a step of `dt` [s];
/// - `double desired_speed(law, view, speed)` lowers the driver's desired speed [m/s], but not below 0.1 m/s.
/// It may also have `Merging merging(view, merging)`, which changes how road users count that merge into the lane.
template <class... Heeds>
struct Heeding : detail::Slotted<Heeds>... {
  static_assert(detail::check_heeds<Heeds...>());

  /// Whether `H`, or one derived from it, is among the heeds.
  template <class H>
  static constexpr bool contains = detail::place_of<H, Heeds...>() < sizeof...(Heeds);

  struct Memory : detail::HeedMemory<Heeds>... {
    /// Of one of the heeds that have one.
    template <class H>
    [[nodiscard]] auto const& get() const requires contains<H> {
      return static_cast<detail::HeedMemory<detail::FoundPart<H, Heeds...>> const&>(*this).memory;
    }

    static constexpr char const* name = "heeds_memory";
    static constexpr auto parameters() {
      return [](auto&& visit) { (detail::memory_parameter<Memory, Heeds>()(visit), ...); };
    }
    friend bool operator==(Memory const&, Memory const&) = default;
  };

  static constexpr char const* name = "heeds";
  static constexpr auto parameters() {
    return parameter_list(parameter<Heeding, Heeds>(
        Heeds::name, static_cast<Heeds Heeding::*>(&detail::Slotted<Heeds>::part), Heeds::summary)...);
  }

  template <class H>
  [[nodiscard]] constexpr H& get() requires contains<H> {
    return static_cast<detail::Slotted<detail::FoundPart<H, Heeds...>>&>(*this).part;
  }
  template <class H>
  [[nodiscard]] constexpr H const& get() const requires contains<H> {
    return static_cast<detail::Slotted<detail::FoundPart<H, Heeds...>> const&>(*this).part;
  }

  /// The desired speed of a driver with `law` at `speed` [m/s]; NaN if a heed's is, which the step then reports.
  template <class Law, class View>
  [[nodiscard]] double desired_speed(Law const& law, [[maybe_unused]] View const& view,
                                     [[maybe_unused]] double speed) const {
    [[maybe_unused]] constexpr double lowest = 0.1;  // laws divide by it
    double desired = law.desired_speed;
    [[maybe_unused]] auto const lower = [&](auto const& heed) {
      if constexpr (requires {
                      { heed.desired_speed(law, view, speed) } -> std::convertible_to<double>;
                    }) {
        double const lowered = heed.desired_speed(law, view, speed);
        if (lowered < desired || std::isnan(lowered)) desired = lowered < lowest ? std::min(desired, lowest) : lowered;
      } else {
        using H = std::remove_cvref_t<decltype(heed)>;
        static_assert(
            !detail::names_desired_speed<H>(),
            "cambium::Driver<Law, Lateral, Heeds...>: a heed's desired_speed must be `template <class Law, class "
            "View> double desired_speed(Law const&, View const&, double speed) const` (see Heeding)");
      }
    };
    (lower(part<Heeds>()), ...);
    return desired;
  }

  /// How road users count that merge into the lane; without these heeds as `merging` says.
  template <class View>
  [[nodiscard]] Merging merging([[maybe_unused]] View const& view, Merging merging) const {
    [[maybe_unused]] auto const ask = [&](auto const& heed) {
      if constexpr (requires {
                      { heed.merging(view, merging) } -> std::same_as<Merging>;
                    }) {
        merging = heed.merging(view, merging);
      } else {
        using H = std::remove_cvref_t<decltype(heed)>;
        static_assert(
            !detail::names_merging<H>(),
            "cambium::Driver<Law, Lateral, Heeds...>: a heed's merging must be `template <class View> Merging "
            "merging(View const&, Merging) const` (see Heeding)");
      }
    };
    (ask(part<Heeds>()), ...);
    return merging;
  }

  /// Adds to the limits of a step of `dt` [s].
  template <class View, class Limits>
  void heed([[maybe_unused]] View const& view, [[maybe_unused]] Memory& memory, [[maybe_unused]] Limits& limits,
            [[maybe_unused]] double dt) const {
    (heed_one<Heeds>(view, memory, limits, dt), ...);
  }

  friend bool operator==(Heeding const&, Heeding const&) = default;

 private:
  template <class H>
  [[nodiscard]] H const& part() const {
    return static_cast<detail::Slotted<H> const&>(*this).part;
  }
  template <class H, class View, class Limits>
  void heed_one(View const& view, [[maybe_unused]] Memory& memory, Limits& limits, double dt) const {
    constexpr bool heeds = requires { part<H>().heed(view, limits, dt); };
    constexpr bool remembers = requires(MemoryOf<H> & own) { part<H>().heed(view, own, limits, dt); };
    static_assert(
        !requires { part<H>().heed(view, Limits(limits), dt); } &&
            !requires(MemoryOf<H> & own) { part<H>().heed(view, own, Limits(limits), dt); } &&
            !requires { part<H>().heed(view, MemoryOf<H>{}, limits, dt); },
        "cambium::Driver<Law, Lateral, Heeds...>: a heed must take the Limits, and its Memory, by reference: "
        "what it adds to a copy is lost");
    static_assert(
        !heeds || remembers || std::is_same_v<MemoryOf<H>, NoMemory>,
        "cambium::Driver<Law, Lateral, Heeds...>: a heed with a Memory must take a reference to it before the "
        "Limits: heed(view, memory, limits, dt)");
    if constexpr (heeds)
      part<H>().heed(view, limits, dt);
    else if constexpr (remembers)
      part<H>().heed(view, static_cast<detail::HeedMemory<H>&>(memory).memory, limits, dt);
    else
      static_assert(
          requires { part<H>().desired_speed(limits.law(), view, dt); },
          "cambium::Driver<Law, Lateral, Heeds...>: each heed must have a public `template <class View, class Limits> "
          "void heed(View const&, Limits&, double dt) const`, with its Memory& before the limits if it has "
          "one, or desired_speed(law, view, speed) (see Heeding)");
  }
};

}  // namespace cambium::inline v0_1
