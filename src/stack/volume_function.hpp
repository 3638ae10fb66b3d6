#pragma once

#include <surfgrad/noise.hpp>

#include <concepts>
#include <functional>
#include <type_traits>
#include <utility>

namespace surfgrad::stack {

/// A function of space that a program brings along: any C++ function object, with or without its own
/// gradient. Runs in double, from several threads at once: it must not change what it holds.
class VolumeFunction {
 public:
  /// f  vec3<double> -> Noise<double>: the value and its gradient by the position
  template <class F>
  requires std::convertible_to<std::invoke_result_t<const F&, vec3<double>>, Noise<double>>
  explicit VolumeFunction(F f) : evaluate_(std::move(f)) {}

  /// f     vec3<double> -> double: the value alone. The gradient takes 6 more evaluations.
  /// step  distance of those to each side, in units of the position. The error falls with its square
  ///       while it resolves the finest detail of f; below about 1e-5 of that detail's size rounding
  ///       takes over.
  template <class F>
  requires std::convertible_to < std::invoke_result_t<const F&, vec3<double>>,
  double > VolumeFunction(F f, double step)
      : evaluate_([f = std::move(f), step](vec3<double> p) {
          return Noise<double>{f(p), gradient_by_differences(f, p, step)};
        }) {}

  [[nodiscard]] Noise<double> operator()(vec3<double> p) const { return evaluate_(p); }

 private:
  std::function<Noise<double>(vec3<double>)> evaluate_;
};

} // namespace surfgrad::stack
