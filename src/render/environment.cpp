#include "render/environment.hpp"

#include <surfgrad/trigonometry.hpp>

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <vector>

namespace surfgrad::render {
namespace {

constexpr double pi = std::numbers::pi;
/// Texels along a face of the blurred cubes, 3 degrees each: the cosine bends little within them, and the
/// lobe of the roughness that a bumped surface shows is 19 degrees wide.
constexpr int blurred_size = 32;
/// Texels of the source that the blur sums over, and how many of them side by side make one where the lobe
/// is flat.
constexpr int source_width = 128;
constexpr int source_height = 64;
constexpr int merged = 4;

vec3<double> direction_of(double column, double row, int width, int height) {
  const SinCos<double> azimuth = sin_cos_turns((column + 0.5) / width); // 0 towards +z, growing towards -x
  const SinCos<double> elevation = sin_cos_turns(0.5 * ((row + 0.5) / height - 0.5));
  return {-azimuth.sin * elevation.cos, elevation.sin, azimuth.cos * elevation.cos};
}

/// A piece of the sky.
struct Patch {
  vec3<double> direction{0, 0, 0};
  vec3<double> light{0, 0, 0}; ///< radiance times solid angle
  double solid_angle = 0;
};

/// The sky twice: in small patches, and in large ones of merged * merged small ones, which lie together.
struct Sky {
  static constexpr int children = merged * merged;
  std::vector<Patch> small = std::vector<Patch>(std::size_t{source_width} * source_height);
  std::vector<Patch> large = std::vector<Patch>(small.size() / children);
};

vec3<double> texel_rgb(const image::Image& image, int x, int y) {
  const bool grey = image.channels < 3;
  // A half-float panorama may hold Inf around the sun; one such texel must not blank the picture.
  const auto finite = [](float v) { return std::isnan(v) ? 0.0 : std::clamp<double>(v, 0.0, 65504.0); };
  return {finite(image.at(x, y, 0)), finite(image.at(x, y, grey ? 0 : 1)),
          finite(image.at(x, y, grey ? 0 : 2))};
}

/// A small patch is the mean of the texels inside it, or the texel around its lower left corner where
/// texels are larger.
Patch small_patch(const image::Image& panorama, int x, int y, double solid_angle) {
  const auto from = [](int i, int n, int size) {
    return static_cast<int>(static_cast<long long>(i) * size / n);
  };
  const int u_begin = from(x, source_width, panorama.width);
  const int v_begin = from(y, source_height, panorama.height);
  const int u_end = std::max(from(x + 1, source_width, panorama.width), u_begin + 1);
  const int v_end = std::max(from(y + 1, source_height, panorama.height), v_begin + 1);
  vec3<double> sum{0, 0, 0};
  for (int v = v_begin; v < v_end; ++v)
    for (int u = u_begin; u < u_end; ++u) sum = sum + texel_rgb(panorama, u, v);
  const double count = static_cast<double>(u_end - u_begin) * (v_end - v_begin);
  return {direction_of(x, y, source_width, source_height), (solid_angle / count) * sum, solid_angle};
}

Sky sky_of(const image::Image& panorama) {
  constexpr int columns = source_width / merged;
  Sky sky;
  tbb::parallel_for(0, source_height / merged, [&](int row) {
    for (int y = row * merged; y < (row + 1) * merged; ++y) {
      const auto sine_at = [](int border) {
        return sin_cos_turns(0.5 * (static_cast<double>(border) / source_height - 0.5)).sin;
      };
      const double solid_angle = 2 * pi / source_width * (sine_at(y + 1) - sine_at(y));
      for (int x = 0; x < source_width; ++x) {
        const Patch patch = small_patch(panorama, x, y, solid_angle);
        const std::size_t parent = static_cast<std::size_t>(row) * columns + x / merged;
        sky.small[parent * Sky::children + (y % merged) * merged + x % merged] = patch;
        Patch& large = sky.large[parent];
        large.direction = large.direction + patch.solid_angle * patch.direction;
        large.light = large.light + patch.light;
        large.solid_angle += patch.solid_angle;
      }
    }
    for (std::size_t i = 0; i < columns; ++i) {
      vec3<double>& direction = sky.large[static_cast<std::size_t>(row) * columns + i].direction;
      direction = normalize_or_zero(direction);
    }
  });
  return sky;
}

/// The cosine law.
struct Diffuse {
  [[nodiscard]] double weight(double c) const { return std::max(c, 0.0); }
  /// Linear over a large patch but for one that the horizon may cut: its corners are 8 degrees away.
  [[nodiscard]] bool bends(double c) const { return std::abs(c) < 0.14; }
};

/// Light from l reaches the eye at the mirror direction's surface normal through the half vector:
/// cos^2(h) = (1 + dot(l, mirror)) / 2 for a view along the normal.
struct Glossy {
  double alpha;

  [[nodiscard]] double weight(double c) const {
    const double cos2 = 0.5 * (1 + c);
    const double d = cos2 * (alpha * alpha - 1) + 1;
    return std::max(c, 0.0) / (d * d);
  }
  /// Beyond 45 degrees lies a tenth of the lobe, and taking it at the middle of a large patch of 11
  /// degrees is 5 percent off: the lobe falls as the fourth power of the angle.
  [[nodiscard]] bool bends(double c) const { return c > 0.7; }
};

/// Weighted mean of the sky around a direction.
template <class Lobe>
vec3<double> blurred(const Sky& sky, const Lobe& lobe, vec3<double> direction) {
  vec3<double> sum{0, 0, 0};
  double total = 0;
  const auto add = [&](const Patch& p, double c) {
    const double w = lobe.weight(c);
    sum = sum + w * p.light;
    total += w * p.solid_angle;
  };
  for (std::size_t i = 0; i < sky.large.size(); ++i) {
    const double c = dot(direction, sky.large[i].direction);
    if (!lobe.bends(c)) {
      if (c > 0) add(sky.large[i], c);
      continue;
    }
    const Patch* small = &sky.small[i * Sky::children];
    for (int k = 0; k < Sky::children; ++k) add(small[k], dot(direction, small[k].direction));
  }
  return (1 / total) * sum;
}

template <class Lobe>
image::CubeMap blurred_cube(const Sky& sky, const Lobe& lobe) {
  constexpr int size = blurred_size;
  const auto side = static_cast<std::uint32_t>(size);
  std::array<image::Map, 6> faces;
  for (image::Map& face : faces) {
    face = {.components = 3, .level_count = 1, .level_table = {side, side, 0}};
    face.words.resize(std::size_t{3} * side * side);
  }
  tbb::parallel_for(0, 6 * size, [&](int row) {
    const int face = row / size;
    const int y = row % size;
    std::uint32_t* word = &faces[face].words[std::size_t{3} * side * y];
    const auto centre = [](int i) { return (2.0 * i + 1) / blurred_size - 1; };
    for (int x = 0; x < size; ++x) {
      const vec3<double> direction = normalize_or_zero(image::cube_direction(face, {centre(x), centre(y)}));
      const vec3<double> light = blurred(sky, lobe, direction);
      for (const double c : {light.x, light.y, light.z})
        *word++ = std::bit_cast<std::uint32_t>(static_cast<float>(c));
    }
  });
  return image::cube_of_faces(faces);
}

} // namespace

Environment::Environment(const image::Image& panorama, double roughness) {
  const Sky sky = sky_of(panorama);
  diffuse_ = blurred_cube(sky, Diffuse{});
  // Below this the lobe would fall between the patches.
  const double alpha = std::max(roughness * roughness, 0.05);
  specular_ = blurred_cube(sky, Glossy{alpha});
}

image::Image built_in_sky() {
  image::Image sky = image::make_image(source_width, source_height, 3, image::Depth::float32);
  for (int y = 0; y < sky.height; ++y)
    for (int x = 0; x < sky.width; ++x) {
      const double up = direction_of(x, y, sky.width, sky.height).y;
      const vec3<double> zenith{0.32, 0.42, 0.62};
      const vec3<double> horizon{0.62, 0.60, 0.58};
      const vec3<double> ground{0.11, 0.10, 0.09};
      const double above = std::clamp(up, 0.0, 1.0);
      const double below = std::clamp(-6 * up, 0.0, 1.0); // the horizon glows a little under itself
      const vec3<double> sky_color = (1 - std::sqrt(above)) * horizon + std::sqrt(above) * zenith;
      const vec3<double> c = (1 - below) * sky_color + below * ground;
      sky.at(x, y, 0) = static_cast<float>(c.x);
      sky.at(x, y, 1) = static_cast<float>(c.y);
      sky.at(x, y, 2) = static_cast<float>(c.z);
    }
  return sky;
}

} // namespace surfgrad::render
