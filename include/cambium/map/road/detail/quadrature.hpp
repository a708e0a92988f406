#pragma once

#include <array>
#include <cstddef>

namespace cambium::inline v0_1::map::detail {

/// A Gauss-Legendre rule on [-1, 1]: abscissas and weights of its positive half.
template <std::size_t N>
struct HalfRule {
  std::array<double, N> node;
  std::array<double, N> weight;
};
inline constexpr HalfRule<10> gauss_20{
    {0.0765265211334973338, 0.2277858511416450781, 0.3737060887154195607, 0.5108670019508270980, 0.6360536807265150254,
     0.7463319064601507926, 0.8391169718222188234, 0.9122344282513259059, 0.9639719272779137912, 0.9931285991850949248},
    {0.1527533871307258507, 0.1491729864726037467, 0.1420961093183820513, 0.1316886384491766269, 0.1181945319615184174,
     0.1019301198172404351, 0.0832767415767047487, 0.0626720483341090636, 0.0406014298003869413,
     0.0176140071391521183}};
inline constexpr HalfRule<3> gauss_6{{0.2386191860831969086, 0.6612093864662645137, 0.9324695142031520278},
                                     {0.4679139345726910473, 0.3607615730481386076, 0.1713244923791703450}};

/// Integral of `f` from `begin` to `end` by one panel of `rule`.
template <std::size_t N, class F>
[[nodiscard]] double integrate(HalfRule<N> const& rule, double begin, double end, F const& f) {
  double const middle = 0.5 * (begin + end), half = 0.5 * (end - begin);
  double sum = 0.0;
  for (std::size_t i = 0; i < N; ++i)
    sum += rule.weight[i] * (f(middle - half * rule.node[i]) + f(middle + half * rule.node[i]));
  return half * sum;
}

}  // namespace cambium::inline v0_1::map::detail
