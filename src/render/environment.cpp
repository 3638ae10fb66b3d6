#include "render/environment.hpp"

#include "image/pyramid.hpp"

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
/// Texels of the source that the blur sums over, and how many of them, along a side, make one patch where
/// the lobe is flat.
constexpr int source_width = 128;
constexpr int source_height = 64;
constexpr int merged = 4;

vec3<double> direction_of(double column, double row, int width, int height) {
  const SinCos<double> azimuth = sin_cos_turns((column + 0.5) / width); // 0 towards +z, growing towards -x
  const SinCos<double> elevation = sin_cos_turns(0.5 * ((row + 0.5) / height - 0.5));
  return {-azimuth.sin * elevation.cos, elevation.sin, azimuth.cos * elevation.cos};
}

/// A piece of the sky: how much light it sends and how much of the sky it is, and the centres of gravity of
/// the two. These differ where a large piece holds a lamp.
struct Patch {
  vec3<float> light; ///< radiance times solid angle
  float solid_angle;
  vec3<float> light_from;
  vec3<float> from;
};

/// The sky twice: in small patches, and in large ones of merged * merged small ones, which lie together.
struct Sky {
  static constexpr int children = merged * merged;
  std::vector<Patch> small = std::vector<Patch>(std::size_t{source_width} * source_height);
  std::vector<Patch> large = std::vector<Patch>(small.size() / children);
};

vec3<float> as_float(vec3<double> v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}
vec3<double> as_double(vec3<float> v) { return {v.x, v.y, v.z}; }

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
  const vec3<float> direction = as_float(direction_of(x, y, source_width, source_height));
  return {as_float((solid_angle / count) * sum), static_cast<float>(solid_angle), direction, direction};
}

Patch merge(const Patch* small) {
  vec3<double> light{0, 0, 0};
  vec3<double> light_from{0, 0, 0};
  vec3<double> from{0, 0, 0};
  double brightness = 0;
  double solid_angle = 0;
  for (int k = 0; k < Sky::children; ++k) {
    const vec3<double> l = as_double(small[k].light);
    const vec3<double> d = as_double(small[k].from);
    light = light + l;
    light_from = light_from + (l.x + l.y + l.z) * d;
    brightness += l.x + l.y + l.z;
    from = from + double{small[k].solid_angle} * d;
    solid_angle += small[k].solid_angle;
  }
  return {as_float(light), static_cast<float>(solid_angle),
          as_float(reciprocal_or_zero(brightness) * light_from), as_float((1 / solid_angle) * from)};
}

Sky sky_of(const image::Image& panorama) {
  constexpr int columns = source_width / merged;
  Sky sky;
  tbb::parallel_for(0, source_height / merged, [&](int row) {
    const std::size_t first = static_cast<std::size_t>(row) * columns;
    for (int y = 0; y < merged; ++y) {
      const int v = row * merged + y;
      const auto sine_at = [](int border) {
        return sin_cos_turns(0.5 * (static_cast<double>(border) / source_height - 0.5)).sin;
      };
      const double solid_angle = 2 * pi / source_width * (sine_at(v + 1) - sine_at(v));
      for (int x = 0; x < source_width; ++x)
        sky.small[(first + x / merged) * Sky::children + y * merged + x % merged] =
            small_patch(panorama, x, v, solid_angle);
    }
    for (std::size_t i = first; i < first + columns; ++i) sky.large[i] = merge(&sky.small[i * Sky::children]);
  });
  return sky;
}

/// The cosine law: linear, so that a large patch does as well as its small ones wherever the horizon does not
/// cut it, and nearly so there.
struct Diffuse {
  [[nodiscard]] static float weight(float c) { return c > 0 ? c : 0; }
  [[nodiscard]] static bool bends(float) { return false; }
};

/// Light from l reaches the eye at the mirror direction's surface normal through the half vector:
/// cos^2(h) = (1 + dot(l, mirror)) / 2 for a view along the normal.
struct Glossy {
  float narrowing; ///< alpha^2 - 1

  [[nodiscard]] float weight(float c) const {
    const float d = 0.5f * (1 + c) * narrowing + 1;
    return (c > 0 ? c : 0) / (d * d);
  }
  /// Beyond 32 degrees lies a fifth of the lobe, and evenly lit large patches of 11 degrees, taken at their
  /// middle, are up to 5 percent off.
  [[nodiscard]] static bool bends(float c) { return c > 0.85f; }
};

/// Texels whose light is summed side by side: compilers make vectors of them.
constexpr int abreast = 8;
using Abreast = std::array<float, abreast>;

/// Weighted means of the sky around some directions.
template <class Lobe>
std::array<vec3<float>, abreast> blurred(const Sky& sky, const Lobe& lobe,
                                         const std::array<vec3<float>, abreast>& directions) {
  Abreast x, y, z;
  for (int k = 0; k < abreast; ++k) {
    x[k] = directions[k].x;
    y[k] = directions[k].y;
    z[k] = directions[k].z;
  }
  const auto cosine = [&](int k, vec3<float> d) { return x[k] * d.x + y[k] * d.y + z[k] * d.z; };
  Abreast red{}, green{}, blue{}, total{};
  const auto add = [&](const Patch p) {
    for (int k = 0; k < abreast; ++k) {
      const float w = lobe.weight(cosine(k, p.light_from));
      red[k] += w * p.light.x;
      green[k] += w * p.light.y;
      blue[k] += w * p.light.z;
      total[k] += lobe.weight(cosine(k, p.from)) * p.solid_angle;
    }
  };
  for (std::size_t i = 0; i < sky.large.size(); ++i) {
    const vec3<float> from = sky.large[i].from;
    float nearest = -1;
    for (int k = 0; k < abreast; ++k) nearest = std::max(nearest, cosine(k, from));
    if (nearest < -0.2f) continue; // wholly below the horizon: corners are 8 degrees away
    if (!lobe.bends(nearest)) {
      add(sky.large[i]);
      continue;
    }
    for (std::size_t k = i * Sky::children; k < (i + 1) * Sky::children; ++k) add(sky.small[k]);
  }
  std::array<vec3<float>, abreast> means;
  for (int k = 0; k < abreast; ++k) means[k] = (1 / total[k]) * vec3<float>{red[k], green[k], blue[k]};
  return means;
}

template <class Lobe>
image::CubeMap blurred_cube(const Sky& sky, const Lobe& lobe) {
  std::array<std::vector<float>, 6> light;
  for (std::vector<float>& face : light) face.resize(std::size_t{3} * blurred_size * blurred_size);
  static_assert(blurred_size % abreast == 0);
  tbb::parallel_for(0, 6 * blurred_size, [&](int row) {
    const int face = row / blurred_size;
    const int y = row % blurred_size;
    const auto centre = [](int i) { return (2.0 * i + 1) / blurred_size - 1; };
    float* value = &light[face][std::size_t{3} * blurred_size * y];
    for (int first = 0; first < blurred_size; first += abreast) {
      std::array<vec3<float>, abreast> directions;
      for (int k = 0; k < abreast; ++k)
        directions[k] =
            as_float(normalize_or_zero(image::cube_direction(face, {centre(first + k), centre(y)})));
      for (const vec3<float>& color : blurred(sky, lobe, directions))
        for (const float c : {color.x, color.y, color.z}) *value++ = c;
    }
  });
  std::array<image::Map, 6> faces;
  for (std::size_t i = 0; i < faces.size(); ++i)
    faces[i] = image::with_pyramid(image::rows_of(light[i], blurred_size, 3), blurred_size, blurred_size, 3);
  return image::cube_of_faces(faces);
}

} // namespace

Environment::Environment(const image::Image& panorama, double roughness) {
  const Sky sky = sky_of(panorama);
  diffuse_ = blurred_cube(sky, Diffuse{});
  // Below this the lobe would fall between the patches.
  const double alpha = std::max(roughness * roughness, 0.05);
  specular_ = blurred_cube(sky, Glossy{static_cast<float>(alpha * alpha - 1)});
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
