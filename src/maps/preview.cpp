#include "maps/preview.hpp"

#include "maps/resample.hpp"

#include <surfgrad/derivative.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace surfgrad::maps {
namespace {

/// The display value of a linear one.
double displayed(double linear) { return std::pow(std::clamp(linear, 0.0, 1.0), 1 / 2.2); }

/// Grey plaster with a little gloss, under a lamp to the upper left and the sky.
double lit(vec3<double> n) {
  const vec3<double> lamp = normalize_or_zero(vec3<double>{-0.5, 0.6, 0.6});
  const vec3<double> half = normalize_or_zero(lamp + vec3<double>{0, 0, 1});
  constexpr double gloss = 40;
  const double sky = 0.12 * (0.5 + 0.5 * n.z);
  return sky + 0.6 * std::max(0.0, dot(n, lamp)) + 0.35 * std::pow(std::max(0.0, dot(n, half)), gloss);
}

void draw_plate(const image::Image& slopes, image::Image& picture) {
  // The longer side fills the half, the other is centred.
  const double scale = double{1.0 * preview_side} / std::max(slopes.width, slopes.height);
  const int width = std::max(1, static_cast<int>(std::lround(scale * slopes.width)));
  const int height = std::max(1, static_cast<int>(std::lround(scale * slopes.height)));
  const image::Image small = resampled(slopes, width, height, Border::repeat);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const vec3<double> n = normal_from_derivative(vec2<double>{small.at(x, y, 0), small.at(x, y, 1)});
      for (int c = 0; c < 3; ++c)
        picture.at((preview_side - width) / 2 + x, (preview_side - height) / 2 + y, c) =
            static_cast<float>(displayed(lit(n)));
    }
}

double range_of(const image::Image& slopes) {
  std::vector<float> steepest;
  for (std::size_t i = 0; i < slopes.texels.size(); i += 2)
    steepest.push_back(std::max(std::abs(slopes.texels[i]), std::abs(slopes.texels[i + 1])));
  const auto high =
      steepest.begin() + static_cast<std::ptrdiff_t>(0.999 * static_cast<double>(steepest.size() - 1));
  std::nth_element(steepest.begin(), high, steepest.end());
  constexpr double least = 1.0 / 64; // below it a histogram shows the codes of 8 bits
  return std::max(least, std::exp2(std::ceil(std::log2(std::max(double{*high}, least)))));
}

void draw_histogram(const image::Image& slopes, double range, image::Image& picture) {
  constexpr int cells = preview_side / 4;
  std::vector<double> counts(static_cast<std::size_t>(cells) * cells);
  for (std::size_t i = 0; i < slopes.texels.size(); i += 2) {
    const auto cell = [&](float slope) {
      return static_cast<std::size_t>(std::clamp((0.5 + 0.5 * slope / range) * cells, 0.0, cells - 1.0));
    };
    ++counts[cell(slopes.texels[i + 1]) * cells + cell(slopes.texels[i])];
  }
  const double most = std::log1p(*std::max_element(counts.begin(), counts.end()));
  for (int y = 0; y < preview_side; ++y)
    for (int x = 0; x < preview_side; ++x) {
      const double count = counts[static_cast<std::size_t>(y / 4) * cells + static_cast<std::size_t>(x / 4)];
      const double share = std::log1p(count) / most;
      const bool is_axis = x == preview_side / 2 || y == preview_side / 2;
      // From black over orange to white.
      const double color[] = {1.6 * share, 1.6 * share - 0.35, 2.2 * share - 1.2};
      for (int c = 0; c < 3; ++c)
        picture.at(preview_side + x, y, c) =
            static_cast<float>(std::max(is_axis ? 0.25 : 0.06, std::clamp(color[c], 0.0, 1.0)));
    }
}

} // namespace

Preview preview(const image::Image& slopes) {
  Preview result;
  result.picture = image::make_image(2 * preview_side, preview_side, 3, image::Depth::unorm8);
  result.range = range_of(slopes);
  draw_plate(slopes, result.picture);
  draw_histogram(slopes, result.range, result.picture);
  return result;
}

} // namespace surfgrad::maps
