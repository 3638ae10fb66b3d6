#include "scene/demo_maps.hpp"
#include "scene/map_functions.hpp"

#include <algorithm>
#include <cmath>

namespace surfgrad::scene {

image::Image plates_normal_map(int size) {
  constexpr int rows = 4; // plates along t; half as many along s, every other row shifted
  return normal_map_of(size, [](double s, double t) {
    const double row = std::floor(t * rows);
    const double shift = fraction(row / 2) < 0.25 ? 0.0 : 0.5;
    const double u = std::abs(fraction(s * (rows / 2) + shift) - 0.5) * 2; // 0 in the middle, 1 at the joint
    const double v = std::abs(fraction(t * rows) - 0.5) * 2;
    const double edge = std::min((1 - u) * 2, 1 - v); // distance from the joint in plate heights
    const double plate = smooth(0.0, 0.22, edge);
    const double du = (u - 0.78) * 2;
    const double rivet = smooth(0.16, 0.06, std::sqrt(du * du + v * v)); // one near each short end
    return (0.055 * plate + 0.03 * rivet) / 2;
  });
}

image::Image weave_normal_map(int size) {
  constexpr int threads = 8;
  return normal_map_of(size, [](double s, double t) {
    const double u = s * threads;
    const double v = t * threads;
    const bool warp_above = fraction((std::floor(u) + std::floor(v)) / 2) < 0.25;
    // The thread on top arches along its length and is round across it.
    const double across = warp_above ? arch(u) : arch(v);
    const double along = warp_above ? arch(v) : arch(u);
    return 0.02 * std::sqrt(across + 0.02) * (0.45 + 0.55 * along);
  });
}

image::Image stripes_mask(int size) {
  image::Image mask = image::make_image(size, size, 1, image::Depth::unorm8);
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const double s = (x + 0.5) / size;
      const double from_middle = std::abs(fraction(2 * s) - 0.5);
      mask.at(x, y, 0) = static_cast<float>(std::floor(smooth(0.36, 0.40, from_middle) * 255 + 0.5) / 255);
    }
  return mask;
}

} // namespace surfgrad::scene
