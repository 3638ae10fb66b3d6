#pragma once

#include <surfgrad/noise.hpp>

namespace surfgrad::gallery {

/// A hash of lattice points that repeats after `period` of them along x and y.
struct PeriodicHash {
  int period;
  [[nodiscard]] auto operator()(index_t<double> x, index_t<double> y, index_t<double> z) const {
    const auto wrapped = [this](index_t<double> i) { return ((i % period) + period) % period; };
    return lattice_hash<double>(wrapped(x), wrapped(y), z);
  }
};

/// Noise over the unit square that joins itself at its borders, `cells` of its lattice along each side.
[[nodiscard]] inline double periodic_noise(double s, double t, int cells) {
  // Planes half way between lattice layers, where the noise is liveliest.
  return perlin(vec3<double>{cells * s, cells * t, cells + 0.5}, PeriodicHash{cells}).value;
}

} // namespace surfgrad::gallery
