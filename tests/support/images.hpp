#pragma once

/// Pictures for tests, as a file would give them.

#include "image/image.hpp"
#include "support/random.hpp"

#include <cmath>
#include <limits>
#include <vector>

namespace surfgrad::test {

inline double most_code(image::Depth depth) { return depth == image::Depth::unorm8 ? 255 : 65535; }

/// All values of a picture, for matchers.
inline std::vector<float> values_of(const image::Image& image) {
  return image::Texels(image.texels).floats();
}

/// Whether the three values that begin with the i-th are the same.
inline bool same_texel(const image::Image& a, const image::Image& b, std::size_t i) {
  return a.texels[i] == b.texels[i] && a.texels[i + 1] == b.texels[i + 1] &&
         a.texels[i + 2] == b.texels[i + 2];
}

/// A value in [0, 1] as an integer file of this depth stores and a reader returns it.
inline float stored(double value, image::Depth depth) {
  const double most = most_code(depth);
  return static_cast<float>(std::floor(std::min(std::max(value, 0.0), 1.0) * most + 0.5) / most);
}

/// Independent random texels in [0, 1].
inline image::Image random_image(Random& random, int width, int height, int channels,
                                 image::Depth depth = image::Depth::unorm16) {
  image::Image result = image::make_image(width, height, channels, depth);
  for (float& t : result.texels.floats()) t = stored(random.uniform(0, 1), depth);
  return result;
}

/// A normal map of random directions up to about `steepest` in slope, vectors of unit length.
inline image::Image random_normal_map(Random& random, int width, int height, double steepest = 1,
                                      image::Depth depth = image::Depth::unorm16) {
  image::Image result = image::make_image(width, height, 3, depth);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const vec3<double> n = normalize_or_zero(
          vec3<double>{random.uniform(-steepest, steepest), random.uniform(-steepest, steepest), 1});
      result.at(x, y, 0) = stored(0.5 * n.x + 0.5, depth);
      result.at(x, y, 1) = stored(0.5 * n.y + 0.5, depth);
      result.at(x, y, 2) = stored(0.5 * n.z + 0.5, depth);
    }
  return result;
}

/// One value everywhere.
inline image::Image constant_image(int width, int height, vec3<double> value) {
  image::Image result = image::make_image(width, height, 3, image::Depth::float32);
  for (std::size_t i = 0; i < result.texels.size(); i += 3) {
    result.texels[i] = static_cast<float>(value.x);
    result.texels[i + 1] = static_cast<float>(value.y);
    result.texels[i + 2] = static_cast<float>(value.z);
  }
  return result;
}

} // namespace surfgrad::test
