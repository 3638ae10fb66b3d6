#include "image/height_map.hpp"

#include "image/pyramid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace surfgrad::image {
namespace {

std::vector<float> heights(const Image& image, int channel) {
  std::vector<float> result(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height),
                            1.0f);
  const int source = image.source_of(channel);
  for (std::size_t i = 0; source >= 0 && i < result.size(); ++i) {
    const float h = image.texels[i * static_cast<std::size_t>(image.channels) + source];
    result[i] = std::isfinite(h) ? saturated(h) : 0.0f;
  }
  return result;
}

} // namespace

Map make_height_map(const Image& image, int channel) {
  const std::vector<float> values = heights(image, channel);
  const TexelRows rows = rows_of(values, image.width, 1);
  const TexelCode code =
      is_integer(image.depth) ? code_for_scalars(rows, image.width, image.height) : TexelCode{};
  return with_pyramid(rows, image.width, image.height, 1, code);
}

Map make_height_slopes(const Image& image, int channel, Wraps wraps) {
  const std::vector<float> h = heights(image, channel);
  const int width = image.width;
  const int height = image.height;
  const auto at = [&](int x, int y) -> double {
    return h[static_cast<std::size_t>(detail::wrap_index<float>(y, height, wraps.t)) * width +
             detail::wrap_index<float>(x, width, wraps.s)];
  };
  // A mirrored neighbour of a border texel is that texel again, as with Wrap::clamp: wrap_index serves all.
  const auto slope = [](double before, double after, int size) {
    constexpr double most = saturated(std::numeric_limits<float>::max());
    return static_cast<float>(std::clamp(0.5 * size * (after - before), -most, most));
  };
  const TexelRows rows = [&](int y, float* texel) {
    for (int x = 0; x < width; ++x, texel += 2) {
      texel[0] = slope(at(x - 1, y), at(x + 1, y), width);
      texel[1] = slope(at(x, y - 1), at(x, y + 1), height);
    }
  };
  return with_pyramid(rows, width, height, 2);
}

} // namespace surfgrad::image
