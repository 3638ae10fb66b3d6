#include "maps/encode.hpp"

#include "image/dither.hpp"
#include "image/parallel.hpp"

#include <surfgrad/derivative.hpp>

#include <algorithm>
#include <optional>
#include <vector>

namespace surfgrad::maps {
namespace {

// Rows of a band: enough for all threads, some megabytes.
constexpr int band_rows = 64;

} // namespace

Written write_slopes(const image::Image& slopes, const Writing& writing, const TakeBand& take) {
  const image::NormalFormat format(writing.code);
  std::optional<image::Dithering> dithering;
  if (writing.dither && writing.code.depth == image::Depth::unorm8) dithering.emplace(format.flat());
  const bool stores_slopes = writing.code.encoding == image::NormalEncoding::derivative;
  std::vector<Written> rows(static_cast<std::size_t>(slopes.height));
  image::Image band;
  for (int top = slopes.height; top > 0; top -= band.height) {
    const int height = std::min(band_rows, top);
    if (height != band.height)
      band = image::make_image(slopes.width, height, format.channels(), writing.code.depth);
    float* const texels = band.texels.floats().data();
    image::in_parallel(
        static_cast<std::size_t>(height), static_cast<std::size_t>(slopes.width), [&](std::size_t row) {
          const int y = top - height + static_cast<int>(row);
          Written met;
          thread_local std::vector<float> scratch;
          scratch.resize(slopes.index(slopes.width, 0));
          const float* slope = slopes.texels.read(slopes.index(0, y), scratch.size(), scratch.data());
          float* const first = texels + band.index(0, static_cast<int>(row));
          float* texel = first;
          for (int x = 0; x < slopes.width; ++x, slope += 2, texel += format.channels()) {
            const vec2<float> d{slope[0], slope[1]};
            met.steepest = std::max<double>(met.steepest, max_abs(d));
            const auto encoded = stores_slopes ? format.encode_slope(d, texel)
                                               : format.encode(normal_from_derivative(d), texel);
            met.beyond_range += encoded.clamped ? 1 : 0;
          }
          if (dithering) dithering->row(first, slopes.width, y, first);
          rows[static_cast<std::size_t>(y)] = met;
        });
    take(band);
  }
  Written all;
  for (const Written& row : rows) {
    all.beyond_range += row.beyond_range;
    all.steepest = std::max(all.steepest, row.steepest);
  }
  return all;
}

} // namespace surfgrad::maps
