#include "maps/blend.hpp"

#include "image/parallel.hpp"
#include "image/pyramid.hpp"
#include "image/sampler.hpp"

#include <surfgrad/derivative.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace surfgrad::maps {
namespace {

using Slope = vec2<double>;
using Normal = vec3<double>;

double overlaid(double base, double detail) {
  return base < 0.5 ? 2 * base * detail : 1 - 2 * (1 - base) * (1 - detail);
}

/// A normal, of any length, of two unit ones.
Normal blend_normals(Normal a, Normal b, Method method) {
  switch (method) {
  case Method::linear:
    return a + b;
  case Method::overlay: {
    const auto channel = [](double x, double y) { return 2 * overlaid(0.5 * x + 0.5, 0.5 * y + 0.5) - 1; };
    return {channel(a.x, b.x), channel(a.y, b.y), channel(a.z, b.z)};
  }
  case Method::partial_derivative:
    return {a.x * b.z + b.x * a.z, a.y * b.z + b.y * a.z, a.z * b.z};
  case Method::whiteout:
    return {a.x + b.x, a.y + b.y, a.z * b.z};
  case Method::udn:
    return {a.x + b.x, a.y + b.y, a.z};
  case Method::rnm: {
    // The shortest turn from +z to the base, applied to the detail.
    const Normal t{a.x, a.y, a.z + 1};
    const Normal u{-b.x, -b.y, b.z};
    return (dot(t, u) / t.z) * t - u;
  }
  case Method::surface_gradient:
    break;
  }
  return a;
}

Slope blend(Slope base, Slope detail, Method method) {
  if (method == Method::surface_gradient) {
    const Slope sum = base + detail;
    const double steepest = max_abs(sum);
    return steepest > max_slope ? (max_slope / steepest) * sum : sum;
  }
  return derivative_from_normal(
      blend_normals(normal_from_derivative(base), normal_from_derivative(detail), method));
}

/// A detail at the texel centres of a base.
class Laid {
 public:
  Laid(const Detail& detail, int width, int height)
      : detail_(&detail), width_(width), height_(height),
        is_as_it_is_(detail.tile.x == 1 && detail.tile.y == 1 && detail.rotate_deg == 0 &&
                     detail.offset.x == 0 && detail.offset.y == 0 && detail.slopes.width == width &&
                     detail.slopes.height == height) {
    if (is_as_it_is_) return;
    const auto rows = [&](int y, float* texels) {
      const std::size_t count = detail.slopes.index(detail.slopes.width, 0);
      const float* from = detail.slopes.texels.read(detail.slopes.index(0, y), count, texels);
      if (from != texels) std::copy_n(from, count, texels);
    };
    map_ = image::with_pyramid(rows, detail.slopes.width, detail.slopes.height, 2);
    const double radians = detail.rotate_deg * std::numbers::pi / 180;
    cos_ = std::cos(radians);
    sin_ = std::sin(radians);
    lod_ = std::log2(std::max(std::abs(detail.tile.x) * detail.slopes.width / width,
                              std::abs(detail.tile.y) * detail.slopes.height / height));
  }

  [[nodiscard]] Slope at(int x, int y) const {
    if (is_as_it_is_) return {detail_->slopes.at(x, y, 0), detail_->slopes.at(x, y, 1)};
    const Slope tiled{detail_->tile.x * (x + 0.5) / width_, detail_->tile.y * (y + 0.5) / height_};
    const Slope st{cos_ * tiled.x - sin_ * tiled.y + detail_->offset.x,
                   sin_ * tiled.x + cos_ * tiled.y + detail_->offset.y};
    const auto d = image::sample<2, double>(map_, st, lod_, {}, image::Filter::trilinear, true);
    // The transposed turn; of the tiling the sign alone.
    return {std::copysign(1.0, detail_->tile.x) * (cos_ * d[0] + sin_ * d[1]),
            std::copysign(1.0, detail_->tile.y) * (cos_ * d[1] - sin_ * d[0])};
  }

 private:
  const Detail* detail_;
  int width_;
  int height_;
  bool is_as_it_is_;
  image::Map map_{};
  double cos_ = 1;
  double sin_ = 0;
  double lod_ = 0;
};

} // namespace

image::Image blended(image::Image base, const std::vector<Detail>& details, Method method) {
  float* const slopes = base.texels.floats().data();
  for (const Detail& detail : details) {
    const Laid laid(detail, base.width, base.height);
    image::in_parallel(
        static_cast<std::size_t>(base.height), static_cast<std::size_t>(base.width), [&](std::size_t row) {
          const int y = static_cast<int>(row);
          for (int x = 0; x < base.width; ++x) {
            float* const slope = slopes + base.index(x, y);
            const double weight =
                detail.mask.texels.empty() ? detail.weight : detail.weight * detail.mask.at(x, y, 0);
            const Slope sum = blend({slope[0], slope[1]}, weight * laid.at(x, y), method);
            slope[0] = static_cast<float>(sum.x);
            slope[1] = static_cast<float>(sum.y);
          }
        });
  }
  return base;
}

} // namespace surfgrad::maps
