#pragma once

#include <cstddef>
#include <type_traits>
#include <variant>

#include "cambium/core/described.hpp"

namespace cambium::inline v0_1 {

/// The memory of a model that keeps nothing between steps; takes no space in a frame.
struct NoMemory {
  static constexpr char const* name = "no_memory";
  static constexpr auto parameters() { return parameter_list(); }

  friend bool operator==(NoMemory, NoMemory) = default;
};

namespace detail {
template <class... Ts>
inline constexpr bool all_different = true;
template <class T, class... Ts>
inline constexpr bool all_different<T, Ts...> = (!std::is_same_v<T, Ts> && ...) && all_different<Ts...>;

template <class... Ts>
void take_variant(std::variant<Ts...> const&);
/// Whether `T` is a `std::variant` or derived from one, like `OneOf`.
template <class T>
concept Variant = requires(T const& any) {
  detail::take_variant(any);
};

/// Whether a file can hold the model.
template <class Model>
concept DescribedModel = Described<Model> || Variant<Model>;
}  // namespace detail

/// A value of one of `Models`, which are all different: the model that an agent has, of those that its world admits. It
/// is a `std::variant` with a faster `visit` for the step path; `std::get_if`, `std::holds_alternative` and
/// `std::visit` accept it. Trivially copyable if all models are.
template <class... Models>
struct OneOf : std::variant<Models...> {
  using std::variant<Models...>::variant;

  static constexpr std::size_t size = sizeof...(Models);

  /// Whether `M` is one of them.
  template <class M>
  static constexpr bool contains = (std::is_same_v<M, Models> || ...);

  /// The index of `M` among them; `size` if it is not one of them.
  template <class M>
  static constexpr std::size_t place = [] {
    bool const same[] = {std::is_same_v<M, Models>..., true};
    std::size_t i = 0;
    while (!same[i]) ++i;
    return i;
  }();

  /// Calls `f(model)` or, if `f` accepts it, `f(model, index)` with the index as a `std::integral_constant`. Like
  /// `std::visit`, but without function table and exception: one well-predicted branch per model.
  template <class F>
  [[nodiscard]] constexpr decltype(auto) visit(F const& f) const {
    return visit_from<0>(f);
  }

 private:
  template <std::size_t i, class F>
  [[nodiscard]] constexpr decltype(auto) visit_from(F const& f) const {
    if constexpr (i + 1 < size)
      if (this->index() != i) return visit_from<i + 1>(f);
    auto const& model = *std::get_if<i>(static_cast<std::variant<Models...> const*>(this));
    if constexpr (requires { f(model, std::integral_constant<std::size_t, i>{}); })
      return f(model, std::integral_constant<std::size_t, i>{});
    else
      return f(model);
  }
};

}  // namespace cambium::inline v0_1
