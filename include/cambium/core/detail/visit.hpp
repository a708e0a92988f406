#pragma once

#include <cstddef>
#include <variant>

namespace cambium::detail {

/// As std::visit, without its table of functions and its exception: one well-predicted branch for each alternative.
template <std::size_t i = 0, class F, class... Ts>
[[nodiscard]] auto visit(F const& f, std::variant<Ts...> const& any) -> decltype(f(std::get<0>(any))) {
  if constexpr (i + 1 < sizeof...(Ts))
    if (any.index() != i) return detail::visit<i + 1>(f, any);
  return f(*std::get_if<i>(&any));
}

}  // namespace cambium::detail
