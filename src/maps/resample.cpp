#include "maps/resample.hpp"

#include "maps/lines.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace surfgrad::maps {
namespace {

struct Tap {
  std::size_t texel;
  double weight;
};

/// The old texel of an index that may lie outside.
std::size_t inside(long long k, std::size_t n, Border border) {
  const auto length = static_cast<long long>(n);
  if (border == Border::repeat) return static_cast<std::size_t>(((k % length) + length) % length);
  return static_cast<std::size_t>(std::clamp(k, 0LL, length - 1));
}

/// What each new texel of a line is made of.
std::vector<std::vector<Tap>> taps(std::size_t from, std::size_t to, Border border) {
  const double ratio = static_cast<double>(from) / static_cast<double>(to);
  std::vector<std::vector<Tap>> result(to);
  for (std::size_t k = 0; k < to; ++k) {
    const auto add = [&](long long texel, double weight) {
      if (weight > 0) result[k].push_back({inside(texel, from, border), weight});
    };
    if (ratio >= 1) {
      const double begin = static_cast<double>(k) * ratio;
      const double end = begin + ratio;
      for (auto texel = static_cast<long long>(begin); static_cast<double>(texel) < end; ++texel) {
        const double left = std::max(begin, static_cast<double>(texel));
        const double right = std::min(end, static_cast<double>(texel) + 1);
        add(texel, (right - left) / ratio);
      }
    } else {
      const double centre = (static_cast<double>(k) + 0.5) * ratio - 0.5;
      const double low = std::floor(centre);
      add(static_cast<long long>(low), 1 - (centre - low));
      add(static_cast<long long>(low) + 1, centre - low);
    }
  }
  return result;
}

image::Image along(image::Image picture, Axis axis, int length, Border border) {
  const int width = axis == Axis::s ? length : picture.width;
  const int height = axis == Axis::s ? picture.height : length;
  if (width == picture.width && height == picture.height) return picture;
  image::Image result = image::make_image(width, height, picture.channels, picture.depth);
  const auto channels = static_cast<std::size_t>(picture.channels);
  const Lines from = lines_of(picture.width, picture.height, axis, channels);
  const Lines to = lines_of(width, height, axis, channels);
  const std::vector<std::vector<Tap>> all = taps(from.length, to.length, border);
  const float* const old = picture.texels.floats().data();
  float* const made = result.texels.floats().data();
  for (std::size_t c = 0; c < channels; ++c)
    for_blocks_of_lines(from, [&](std::size_t first, std::size_t count) {
      LineBlock<double> block(from.length);
      LineBlock<double> means(to.length);
      load(from, old + c, first, count, block);
      for (std::size_t k = 0; k < to.length; ++k)
        for (const Tap& tap : all[k])
          for (std::size_t l = 0; l < lanes; ++l) means[k][l] += tap.weight * block[tap.texel][l];
      store(to, means, first, count, made + c);
    });
  return result;
}

} // namespace

image::Image resampled(image::Image picture, int width, int height, Border border) {
  return along(along(std::move(picture), Axis::s, width, border), Axis::t, height, border);
}

} // namespace surfgrad::maps
