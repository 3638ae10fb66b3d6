#include "engine/lattice_origin.hpp"

#include <surfgrad/noise_hash.hpp>

#include <cmath>

namespace surfgrad::engine {
namespace {

/// A whole number modulo 2^32; 0 where it is none (Inf, NaN).
std::uint32_t wrapped(double whole) {
  const double rest = whole - 0x1p32 * std::floor(whole * 0x1p-32);
  return rest >= 0 && rest < 0x1p32 ? static_cast<std::uint32_t>(rest) : 0;
}

/// p less the whole number below it, 0 where there is none.
double fraction(double p, double whole) {
  const double rest = p - whole;
  return rest >= 0 && rest <= 1 ? rest : 0;
}

} // namespace

LatticeOrigin lattice_origin(const NoiseOrigin& origin, int octave, bool skewed) {
  double frequency = 1;
  for (int i = 0; i < octave; ++i) frequency *= origin.lacunarity;
  const vec3<double> p = frequency * origin.cells;
  const vec3<double> whole{std::floor(p.x), std::floor(p.y), std::floor(p.z)};
  LatticeOrigin result{0, {fraction(p.x, whole.x), fraction(p.y, whole.y), fraction(p.z, whole.z)}};
  std::uint32_t x = wrapped(whole.x), y = wrapped(whole.y), z = wrapped(whole.z);
  if (skewed) {
    // A move by whole cells is one by whole indices only where a third of their sum is whole.
    const double sum = whole.x + whole.y + whole.z;
    const double third = std::floor(sum / 3);
    const double left = sum - 3 * third;
    if (left > 0 && left < 3) {
      result.rest.z += left;
      z -= static_cast<std::uint32_t>(left);
    }
    const std::uint32_t skew = wrapped(third);
    x += skew;
    y += skew;
    z += skew;
  }
  result.start = lattice_start(x, y, z);
  return result;
}

} // namespace surfgrad::engine
