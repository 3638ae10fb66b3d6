#include "maps/decode.hpp"

#include "diagnostic/error.hpp"
#include "image/normal_format.hpp"
#include "image/parallel.hpp"
#include "image/slope_row.hpp"

#include <surfgrad/derivative.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace surfgrad::maps {
namespace {

using image::Image;

[[noreturn]] void refuse(const Reading& reading, std::string problem, std::string remedy) {
  throw InputError({.file = reading.name, .problem = std::move(problem), .remedy = std::move(remedy)});
}

/// The values of a row, wherever the image keeps them.
const float* row_of(const Image& map, int y, std::vector<float>& scratch) {
  scratch.resize(map.index(map.width, 0));
  return map.texels.read(map.index(0, y), scratch.size(), scratch.data());
}

void refuse_what_is_no_number(const Image& map, const Reading& reading) {
  if (image::is_integer(map.depth)) return;
  std::vector<std::int64_t> bad(static_cast<std::size_t>(map.height));
  image::in_parallel(bad.size(), static_cast<std::size_t>(map.width), [&](std::size_t y) {
    thread_local std::vector<float> scratch;
    const float* const row = row_of(map, static_cast<int>(y), scratch);
    bad[y] = std::count_if(row, row + scratch.size(), [](float v) { return !std::isfinite(v); });
  });
  const auto first = std::find_if(bad.rbegin(), bad.rend(), [](std::int64_t n) { return n > 0; });
  if (first == bad.rend()) return;
  refuse(reading,
         fmt::format("{} values are infinite or no numbers, the first of them in row {} from the top",
                     std::accumulate(bad.begin(), bad.end(), std::int64_t{0}), first - bad.rbegin()),
         "mend them where the map was made");
}

int colors_of(const Image& map) { return map.has_alpha ? map.channels - 1 : map.channels; }

void require_colors(const Image& map, const Reading& reading, int least, const char* what) {
  if (colors_of(map) >= least) return;
  refuse(reading,
         fmt::format("has {} channel{} of colour, and {} needs {}", colors_of(map),
                     colors_of(map) == 1 ? "" : "s", what, least),
         "say what it holds with --from, or which channels are meant with --swizzle");
}

/// What a row of vectors is like.
struct Oddities {
  std::int64_t inward = 0;
  std::int64_t not_unit = 0;
};

Oddities oddities_of(const float* row, int width, int channels) {
  // Filtered and 8-bit vectors are a little short; a colour is anything.
  constexpr float shortest = 0.5f, longest = 1.5f;
  Oddities found;
  for (int x = 0; x < width; ++x, row += channels) {
    const vec3<float> m{2 * row[0] - 1, 2 * row[1] - 1, 2 * row[2] - 1};
    const float squared = dot(m, m);
    found.inward += m.z > 0 ? 0 : 1;
    found.not_unit += squared >= shortest * shortest && squared <= longest * longest ? 0 : 1;
  }
  return found;
}

void refuse_what_is_no_normal_map(const Image& map, const Reading& reading,
                                  const std::vector<Oddities>& rows) {
  Oddities all;
  for (const Oddities& row : rows) {
    all.inward += row.inward;
    all.not_unit += row.not_unit;
  }
  const double texels = static_cast<double>(map.width) * map.height;
  const auto percent = [&](std::int64_t count) { return 100 * static_cast<double>(count) / texels; };
  if (percent(all.not_unit) > 50)
    refuse(reading,
           fmt::format("{:.0f} % of its texels are far from unit vectors: it is no normal map",
                       percent(all.not_unit)),
           "say what it holds with --from");
  if (percent(all.inward) > 50)
    refuse(reading,
           fmt::format("{:.0f} % of its texels point into the surface: it is no tangent-space normal map",
                       percent(all.inward)),
           "give --from object and the mesh, if its normals are those of an object");
}

ReadSlopes read_normals(const Image& map, const Reading& reading) {
  require_colors(map, reading, reading.channels == image::NormalChannels::xyz ? 3 : 2, "a normal map");
  const bool two = image::believed_channels(map, reading.channels) == image::NormalChannels::xy;
  ReadSlopes result{image::make_image(map.width, map.height, 2, image::Depth::float32)};
  float* const slopes = result.slopes.texels.floats().data();
  std::vector<Oddities> odd(static_cast<std::size_t>(map.height));
  image::in_parallel(odd.size(), static_cast<std::size_t>(map.width), [&](std::size_t row) {
    const int y = static_cast<int>(row);
    thread_local std::vector<float> scratch;
    const float* const texels = row_of(map, y, scratch);
    if (!two) odd[row] = oddities_of(texels, map.width, map.channels);
    image::slope_row({texels,
                      map.width,
                      map.channels,
                      {two, reading.green_up},
                      false,
                      slopes + result.slopes.index(0, y)});
  });
  if (!two) refuse_what_is_no_normal_map(map, reading, odd);
  for (const Oddities& row : odd) result.inward_texels += row.inward;
  return result;
}

ReadSlopes read_derivatives(const Image& map, const Reading& reading) {
  require_colors(map, reading, 2, "a derivative map");
  const double most = !image::is_integer(map.depth) ? 0 : map.depth == image::Depth::unorm8 ? 255 : 65535;
  ReadSlopes result{image::make_image(map.width, map.height, 2, image::Depth::float32)};
  float* const slopes = result.slopes.texels.floats().data();
  image::in_parallel(static_cast<std::size_t>(map.height), static_cast<std::size_t>(map.width),
                     [&](std::size_t row) {
                       const int y = static_cast<int>(row);
                       thread_local std::vector<float> scratch;
                       const float* texel = row_of(map, y, scratch);
                       float* slope = slopes + result.slopes.index(0, y);
                       for (int x = 0; x < map.width; ++x, texel += map.channels, slope += 2) {
                         const auto value = [&](int c) {
                           return image::slope_of_value(texel[c], most, reading.range, reading.neutral);
                         };
                         vec2<double> d{value(0), value(1)};
                         d = (max_slope / std::max<double>(max_slope, max_abs(d))) * d;
                         slope[0] = static_cast<float>(d.x);
                         slope[1] = static_cast<float>(reading.green_up ? d.y : -d.y);
                       }
                     });
  return result;
}

} // namespace

ReadSlopes read_slopes(const Image& map, const Reading& reading) {
  refuse_what_is_no_number(map, reading);
  ReadSlopes result =
      reading.holds == Holds::derivative ? read_derivatives(map, reading) : read_normals(map, reading);
  if (reading.flip_x) {
    std::vector<float>& slopes = result.slopes.texels.floats();
    for (std::size_t i = 0; i < slopes.size(); i += 2) slopes[i] = -slopes[i];
  }
  return result;
}

Image read_heights(const Image& map, const Reading& reading) {
  refuse_what_is_no_number(map, reading);
  const int source = map.source_of(reading.height_channel);
  Image heights = image::make_image(map.width, map.height, 1, map.depth);
  float* const to = heights.texels.floats().data();
  image::in_parallel(static_cast<std::size_t>(map.height), static_cast<std::size_t>(map.width),
                     [&](std::size_t row) {
                       const int y = static_cast<int>(row);
                       thread_local std::vector<float> scratch;
                       const float* const texels = row_of(map, y, scratch);
                       float* const heights_row = to + heights.index(0, y);
                       for (int x = 0; x < map.width; ++x) {
                         const float h = source < 0 ? 1.0f : texels[x * map.channels + source];
                         heights_row[x] = reading.depth ? 1 - h : h;
                       }
                     });
  return heights;
}

vec2<double> mean_slope(const Image& slopes) {
  // Row by row, so that the sum of a large map stays exact enough.
  std::vector<vec2<double>> rows(static_cast<std::size_t>(slopes.height));
  image::in_parallel(rows.size(), static_cast<std::size_t>(slopes.width), [&](std::size_t row) {
    thread_local std::vector<float> scratch;
    const float* slope = row_of(slopes, static_cast<int>(row), scratch);
    vec2<double> sum{0, 0};
    for (int x = 0; x < slopes.width; ++x, slope += 2) sum = sum + vec2<double>{slope[0], slope[1]};
    rows[row] = sum;
  });
  const vec2<double> sum = std::accumulate(rows.begin(), rows.end(), vec2<double>{0, 0});
  return (1 / (static_cast<double>(slopes.width) * slopes.height)) * sum;
}

void remove_mean_slope(Image& slopes) {
  const vec2<double> mean = mean_slope(slopes);
  std::vector<float>& values = slopes.texels.floats();
  for (std::size_t i = 0; i < values.size(); i += 2) {
    values[i] = static_cast<float>(values[i] - mean.x);
    values[i + 1] = static_cast<float>(values[i + 1] - mean.y);
  }
}

} // namespace surfgrad::maps
