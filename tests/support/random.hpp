#pragma once

/// Random numbers for tests: the same on every machine, from a seed that failures print.

#include <cmath>
#include <cstdint>
#include <surfgrad/vec.hpp>

namespace surfgrad::test {

class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  /// SplitMix64: passes the usual batteries, one addition a step, any seed is good.
  std::uint64_t bits() {
    std::uint64_t z = (state_ += 0x9E3779B97F4A7C15u);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return z ^ (z >> 31);
  }
  /// In [low, high).
  double uniform(double low = -1, double high = 1) {
    return low + (high - low) * static_cast<double>(bits() >> 11) * 0x1p-53;
  }
  /// Every power of ten between low and high equally likely; positive.
  double magnitude(double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); }
  double sign() { return (bits() & 1u) != 0 ? 1.0 : -1.0; }
  int integer(int count) { return static_cast<int>(bits() % static_cast<std::uint64_t>(count)); }

  vec2<double> vector2(double low = -1, double high = 1) {
    const double x = uniform(low, high);
    return {x, uniform(low, high)};
  }
  vec3<double> vector3(double low = -1, double high = 1) {
    const double x = uniform(low, high);
    const double y = uniform(low, high);
    return {x, y, uniform(low, high)};
  }
  /// Uniform on the sphere.
  vec3<double> unit_vector() {
    const double z = uniform();
    const double angle = uniform(-3.14159265358979324, 3.14159265358979324);
    const double r = std::sqrt(1 - z * z);
    return {r * std::cos(angle), r * std::sin(angle), z};
  }
  /// A proper rotation.
  mat3<double> rotation() {
    const vec3<double> a = unit_vector();
    const vec3<double> b = normalize_or_zero(cross(a, unit_vector()));
    return {a, b, cross(a, b)};
  }
  mat3<double> matrix3(double low = -1, double high = 1) {
    const vec3<double> x = vector3(low, high);
    const vec3<double> y = vector3(low, high);
    return {x, y, vector3(low, high)};
  }

 private:
  std::uint64_t state_;
};

} // namespace surfgrad::test
