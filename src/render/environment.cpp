#include "render/environment.hpp"

#include <surfgrad/trigonometry.hpp>

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace surfgrad::render {
namespace {

constexpr double pi = std::numbers::pi;
/// Texels of the blurred panoramas: a lobe of the roughness that a bumped surface shows is wider.
constexpr int blurred_width = 64;
constexpr int blurred_height = 32;
/// Texels of the source that the blur sums over.
constexpr int source_width = 128;
constexpr int source_height = 64;

vec3<double> direction_of(double column, double row, int width, int height) {
  const SinCos<double> azimuth = sin_cos_turns((column + 0.5) / width); // 0 towards +z, growing towards -x
  const SinCos<double> elevation = sin_cos_turns(0.5 * ((row + 0.5) / height - 0.5));
  return {-azimuth.sin * elevation.cos, elevation.sin, azimuth.cos * elevation.cos};
}

struct Patch {
  vec3<double> direction;
  vec3<double> radiance;
  double solid_angle;
};

vec3<double> texel_rgb(const image::Image& image, int x, int y) {
  const bool grey = image.channels < 3;
  // A half-float panorama may hold Inf around the sun; one such texel must not blank the picture.
  const auto finite = [](float v) { return std::isnan(v) ? 0.0 : std::clamp<double>(v, 0.0, 65504.0); };
  return {finite(image.at(x, y, 0)), finite(image.at(x, y, grey ? 0 : 1)),
          finite(image.at(x, y, grey ? 0 : 2))};
}

/// The panorama as a few thousand patches of sky, each the mean of the texels inside it, or the texel
/// around its lower left corner where texels are larger.
std::vector<Patch> patches_of(const image::Image& panorama) {
  constexpr int width = source_width;
  constexpr int height = source_height;
  std::vector<Patch> patches;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto from = [](int i, int n, int size) {
        return static_cast<int>(static_cast<long long>(i) * size / n);
      };
      const int u_begin = from(x, width, panorama.width);
      const int v_begin = from(y, height, panorama.height);
      const int u_end = std::max(from(x + 1, width, panorama.width), u_begin + 1);
      const int v_end = std::max(from(y + 1, height, panorama.height), v_begin + 1);
      vec3<double> sum{0, 0, 0};
      for (int v = v_begin; v < v_end; ++v)
        for (int u = u_begin; u < u_end; ++u) sum = sum + texel_rgb(panorama, u, v);
      const double count = static_cast<double>(u_end - u_begin) * (v_end - v_begin);
      const auto sine_at = [](int row) {
        return sin_cos_turns(0.5 * (static_cast<double>(row) / height - 0.5)).sin;
      };
      patches.push_back({direction_of(x, y, width, height), (1.0 / count) * sum,
                         2 * pi / width * (sine_at(y + 1) - sine_at(y))});
    }
  return patches;
}

/// Weighted mean of the patches around every direction; the weight is a function of the cosine.
template <class Weight>
image::Image blurred(const std::vector<Patch>& patches, const Weight& weight) {
  image::Image result = image::make_image(blurred_width, blurred_height, 3, image::Depth::float32);
  tbb::parallel_for(0, blurred_height, [&](int y) {
    for (int x = 0; x < blurred_width; ++x) {
      const vec3<double> d = direction_of(x, y, blurred_width, blurred_height);
      vec3<double> sum{0, 0, 0};
      double total = 0;
      for (const Patch& p : patches) {
        const double w = weight(dot(d, p.direction)) * p.solid_angle;
        sum = sum + w * p.radiance;
        total += w;
      }
      result.at(x, y, 0) = static_cast<float>(sum.x / total);
      result.at(x, y, 1) = static_cast<float>(sum.y / total);
      result.at(x, y, 2) = static_cast<float>(sum.z / total);
    }
  });
  return result;
}

} // namespace

Environment::Environment(const image::Image& panorama, double roughness) {
  const std::vector<Patch> patches = patches_of(panorama);
  diffuse_ = blurred(patches, [](double c) { return std::max(c, 0.0); });
  // Below this the lobe would fall between the patches.
  const double alpha = std::max(roughness * roughness, 0.05);
  specular_ = blurred(patches, [alpha](double c) {
    if (c <= 0) return 0.0;
    // Light from l reaches the eye at the mirror direction's surface normal through the half vector:
    // cos^2(h) = (1 + dot(l, mirror)) / 2 for a view along the normal.
    const double cos2 = 0.5 * (1 + c);
    const double d = cos2 * (alpha * alpha - 1) + 1;
    return alpha * alpha / (d * d) * c;
  });
}

vec3<double> Environment::look_up(const image::Image& panorama, vec3<double> direction) {
  const double azimuth = std::atan2(-direction.x, direction.z);
  const double elevation = std::asin(std::clamp(direction.y, -1.0, 1.0));
  const double turns = azimuth / (2 * pi);
  const double x = (turns - std::floor(turns)) * panorama.width - 0.5;
  const double y = std::clamp((elevation / pi + 0.5) * panorama.height - 0.5, 0.0, panorama.height - 1.0);
  // to_index sends NaN to a texel too.
  const int x0 = to_index(std::floor(x));
  const int y0 = std::min(to_index(y), panorama.height - 1);
  const int y1 = std::min(y0 + 1, panorama.height - 1);
  const double fx = x - x0;
  const double fy = y - y0;
  const auto column = [&](int i) { return (i + panorama.width) % panorama.width; };
  const vec3<double> low =
      (1 - fx) * texel_rgb(panorama, column(x0), y0) + fx * texel_rgb(panorama, column(x0 + 1), y0);
  const vec3<double> high =
      (1 - fx) * texel_rgb(panorama, column(x0), y1) + fx * texel_rgb(panorama, column(x0 + 1), y1);
  return (1 - fy) * low + fy * high;
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
