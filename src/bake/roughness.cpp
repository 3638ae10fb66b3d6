#include "bake/roughness.hpp"

#include "bake/dither.hpp"
#include "bake/fill.hpp"
#include "bake/format.hpp"
#include "bake/padding.hpp"
#include "image/sampler.hpp"
#include "stage/bands.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace surfgrad::bake {
namespace {

/// Fills what is uncovered, and dithers.
image::Image finished(const image::Image& picture, const Options& options, const std::vector<float>& empty,
                      bool dithered) {
  image::Image result = image::make_image(picture.width, picture.height, picture.channels, options.depth);
  stage::BandSink sink = stage::into(result);
  std::optional<Dither> dither;
  if (dithered) {
    dither.emplace(picture.height, empty, sink);
    sink = [&](const image::Image& band) { dither->add(band); };
  }
  if (options.fill)
    Fill(picture.width, picture.height, empty, sink).add(picture);
  else
    Padding(picture.width, picture.height, options.padding, empty, sink).add(picture);
  return result;
}

/// A picture of a level: made(moments, x, y, where the texel's channels go) where a surface lies.
template <class Made>
image::Image picture_of(const NormalStatistics& normals, int level, int channels, const Made& made) {
  image::Image picture = image::make_image(normals.width(level), normals.height(level), channels);
  float* const texels = picture.texels.floats().data();
  tbb::parallel_for(0, picture.height, [&](int y) {
    for (int x = 0; x < picture.width; ++x) {
      float* texel = texels + picture.index(x, y);
      if (normals.covered(level, x, y))
        made(normals.moments(level, x, y), x, y, texel);
      else
        std::fill_n(texel, channels, uncovered);
    }
  });
  return picture;
}

} // namespace

BaseRoughness::BaseRoughness(const image::Image& map) {
  const int colors = map.has_alpha ? map.channels - 1 : map.channels;
  image::Image squares = image::make_image(map.width, map.height, 1, image::Depth::float32);
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x) {
      const float roughness = map.at(x, y, colors >= 3 ? 1 : 0);
      squares.at(x, y, 0) = roughness * roughness * roughness * roughness;
    }
  squared_alphas_ = image::make_channel_map(squares, 0);
}

double BaseRoughness::alpha(int x, int y, int width, int height) const {
  if (squared_alphas_.level_count == 0) return value_ * value_;
  const double texels = std::max(static_cast<double>(squared_alphas_.width()) / width,
                                 static_cast<double>(squared_alphas_.height()) / height);
  const vec2<double> st{(x + 0.5) / width, (y + 0.5) / height};
  return std::sqrt(image::sample<1, double>(squared_alphas_, st, std::log2(texels), {},
                                            image::Filter::trilinear, true)[0]);
}

double widened_alpha(double alpha, vec3<double> mean) {
  return std::sqrt(std::clamp(alpha * alpha + 1 - dot(mean, mean), alpha * alpha, 1.0));
}

Lobe widened(double alpha, const NormalMoments& m) {
  // The covariance of (n.x, n.y), seen along the mean normal: lengths along its tilt are 1/z times as long.
  const vec3<double> n = normalize_or_zero(m.mean);
  const vec2<double> tilt{n.x, n.y};
  const double stretch = n.z > 0 ? 1 / (n.z * (1 + n.z)) : 0; // (1/z - 1) / |tilt|^2
  const auto seen = [&](vec2<double> d) { return d + stretch * dot(tilt, d) * tilt; };
  const vec2<double> row_s = seen({m.square.x - m.mean.x * m.mean.x, m.product - m.mean.x * m.mean.y});
  const vec2<double> row_t = seen({m.product - m.mean.x * m.mean.y, m.square.y - m.mean.y * m.mean.y});
  const vec2<double> column_s = seen({row_s.x, row_t.x});
  const vec2<double> column_t = seen({row_s.y, row_t.y});
  // Its eigenvalues, and the direction of the larger one.
  const double middle = 0.5 * (column_s.x + column_t.y);
  const double spread = std::hypot(0.5 * (column_s.x - column_t.y), column_t.x);
  const double angle = spread > 0 ? 0.5 * std::atan2(column_t.x, 0.5 * (column_s.x - column_t.y)) : 0;
  const double share = middle > 0 ? std::min(spread / middle, 1.0) : 0; // beyond 1 only by rounding
  const double variance = std::max(1 - dot(m.mean, m.mean), 0.0);
  const auto alpha_with = [&](double part) {
    return std::min(std::sqrt(alpha * alpha + part * variance), 1.0);
  };
  return {alpha_with(1 + share), alpha_with(1 - share), {std::cos(angle), std::sin(angle)}};
}

image::Image roughness_map(const NormalStatistics& normals, int level, const BaseRoughness& base,
                           const Options& options, bool is_anisotropic) {
  const auto roughness = [&](const NormalMoments& moments, int x, int y, float* texel) {
    const double alpha = base.alpha(x, y, normals.width(level), normals.height(level));
    *texel = static_cast<float>(std::sqrt(is_anisotropic ? widened(alpha, moments).alpha_across
                                                         : widened_alpha(alpha, moments.mean)));
  };
  return finished(picture_of(normals, level, 1, roughness), options, {1.0f}, false);
}

image::Image anisotropy_map(const NormalStatistics& normals, int level, const BaseRoughness& base,
                            const Options& options) {
  const auto anisotropy = [&](const NormalMoments& moments, int x, int y, float* texel) {
    const Lobe lobe = widened(base.alpha(x, y, normals.width(level), normals.height(level)), moments);
    const double room = 1 - lobe.alpha_across;
    const double strength = room > 0 ? std::sqrt((lobe.alpha_along - lobe.alpha_across) / room) : 0;
    texel[0] = static_cast<float>(0.5 * lobe.direction.x + 0.5);
    texel[1] = static_cast<float>(0.5 * lobe.direction.y + 0.5);
    texel[2] = static_cast<float>(strength);
  };
  return finished(picture_of(normals, level, 3, anisotropy), options, {1.0f, 0.5f, 0.0f}, false);
}

image::Image normal_level(const NormalStatistics& normals, int level, const Options& options) {
  const Format format(options);
  const auto normal = [&](const NormalMoments& m, int /*x*/, int /*y*/, float* texel) {
    const vec3<double> n = normalize_or_zero(m.mean);
    format.encode({static_cast<float>(n.x), static_cast<float>(n.y), static_cast<float>(n.z)}, texel);
  };
  return finished(picture_of(normals, level, format.channels(), normal), options, format.flat(),
                  options.dither);
}

} // namespace surfgrad::bake
