#pragma once

/// Dual numbers over double: a value with its exact partial derivatives, by forward differentiation.

#include <array>
#include <cmath>
#include <surfgrad/scalar.hpp>

namespace surfgrad::test {

template <int N>
struct Dual {
  double value = 0;
  std::array<double, N> partial{};

  constexpr Dual() = default;
  explicit constexpr Dual(double v) : value(v) {}
  /// The variable with the given index, at v.
  static constexpr Dual variable(double v, int index) {
    Dual d(v);
    d.partial[index] = 1;
    return d;
  }
};

namespace detail {

/// f(a) where f has the value `v` and the derivative `slope` at a.
template <int N>
[[nodiscard]] constexpr Dual<N> chain(const Dual<N>& a, double v, double slope) {
  Dual<N> r(v);
  for (int i = 0; i < N; ++i) r.partial[i] = slope * a.partial[i];
  return r;
}

} // namespace detail

template <int N>
constexpr Dual<N> operator+(const Dual<N>& a, const Dual<N>& b) {
  Dual<N> r(a.value + b.value);
  for (int i = 0; i < N; ++i) r.partial[i] = a.partial[i] + b.partial[i];
  return r;
}
template <int N>
constexpr Dual<N> operator-(const Dual<N>& a) {
  return detail::chain(a, -a.value, -1.0);
}
template <int N>
constexpr Dual<N> operator-(const Dual<N>& a, const Dual<N>& b) {
  return a + -b;
}
template <int N>
constexpr Dual<N> operator*(const Dual<N>& a, const Dual<N>& b) {
  Dual<N> r(a.value * b.value);
  for (int i = 0; i < N; ++i) r.partial[i] = a.partial[i] * b.value + a.value * b.partial[i];
  return r;
}
template <int N>
constexpr Dual<N> operator/(const Dual<N>& a, const Dual<N>& b) {
  const double v = a.value / b.value;
  Dual<N> r(v);
  for (int i = 0; i < N; ++i) r.partial[i] = (a.partial[i] - v * b.partial[i]) / b.value;
  return r;
}
template <int N>
constexpr bool operator<(const Dual<N>& a, const Dual<N>& b) {
  return a.value < b.value;
}
template <int N>
constexpr bool operator==(const Dual<N>& a, const Dual<N>& b) {
  return a.value == b.value;
}

template <int N>
[[nodiscard]] Dual<N> sqrt(const Dual<N>& a) {
  const double root = std::sqrt(a.value);
  return detail::chain(a, root, 0.5 / root);
}
template <int N>
[[nodiscard]] Dual<N> sin(const Dual<N>& a) {
  return detail::chain(a, std::sin(a.value), std::cos(a.value));
}
template <int N>
[[nodiscard]] Dual<N> cos(const Dual<N>& a) {
  return detail::chain(a, std::cos(a.value), -std::sin(a.value));
}
template <int N>
[[nodiscard]] Dual<N> atan2(const Dual<N>& y, const Dual<N>& x) {
  const double square = x.value * x.value + y.value * y.value;
  Dual<N> r(std::atan2(y.value, x.value));
  for (int i = 0; i < N; ++i) r.partial[i] = (x.value * y.partial[i] - y.value * x.partial[i]) / square;
  return r;
}
template <int N>
[[nodiscard]] constexpr Dual<N> abs(const Dual<N>& a) {
  return a.value < 0 ? -a : a;
}
template <int N>
[[nodiscard]] constexpr Dual<N> min(const Dual<N>& a, const Dual<N>& b) {
  return a < b ? a : b;
}
template <int N>
[[nodiscard]] constexpr Dual<N> max(const Dual<N>& a, const Dual<N>& b) {
  return b < a ? a : b;
}

} // namespace surfgrad::test

namespace surfgrad {

template <int N>
struct lanes_of<test::Dual<N>> {
  using value = double;
  using mask = bool;
};

static_assert(Scalar<test::Dual<2>> && Scalar<test::Dual<3>>);

} // namespace surfgrad
