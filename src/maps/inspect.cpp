#include "maps/inspect.hpp"

#include "maps/lost_detail.hpp"
#include "maps/resample.hpp"
#include "stage/bands.hpp"

#include <surfgrad/derivative.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace surfgrad::maps {
namespace {

// Bounds were set by maps whose conventions are known: normal maps have 0.7 to 1 of their vectors near unit
// length (atlases the less for their backgrounds), colours up to 0.66, and those lie about the diagonal.
constexpr double object_unit_share = 0.9; // nothing else tells object-space maps from colours
constexpr double least_mean_z = 0.4;
constexpr double most_mean_sideways = 0.35;
constexpr double most_inward_share = 0.25;

// Agreement of curls where a convention is known: 0.44 to 0.99 in magnitude; where it is not, up to 0.22.
constexpr double likely_agreement = 0.32;
constexpr double certain_agreement = 0.6;
constexpr double least_certainty = 6; // standard errors: parts of a map are not independent of each other

constexpr int parts = 8;

/// Values of one channel.
std::vector<float> channel_of(const image::Image& map, int channel) {
  std::vector<float> values;
  values.reserve(map.texels.size() / static_cast<std::size_t>(map.channels));
  std::vector<float> row(map.index(map.width, 0));
  for (int y = 0; y < map.height; ++y) {
    stage::copy_values(map, y, 1, row.data());
    for (std::size_t i = static_cast<std::size_t>(channel); i < row.size();
         i += static_cast<std::size_t>(map.channels))
      values.push_back(row[i]);
  }
  return values;
}

void look_at_channels(const image::Image& map, Inspection& result) {
  // What 8 bits become in 16: each code times 257, or, less exactly, times 256.
  bool are_multiples[] = {true, true};
  for (int c = 0; c < map.channels; ++c) {
    const std::vector<float> values = channel_of(map, c);
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    if (*low == *high) {
      result.constant_channels.push_back(c);
      continue;
    }
    for (const float value : values) {
      const long code = std::lround(65535.0 * value);
      are_multiples[0] = are_multiples[0] && code % 257 == 0;
      are_multiples[1] = are_multiples[1] && code % 256 == 0;
    }
  }
  const bool is_constant = result.constant_channels.size() == static_cast<std::size_t>(map.channels);
  result.is_banded =
      map.depth == image::Depth::unorm16 && !is_constant && (are_multiples[0] || are_multiples[1]);
}

void look_at_vectors(const image::Image& map, Inspection& result) {
  double lengths = 0;
  double squares = 0;
  vec3<double> sum{0, 0, 0};
  std::int64_t unit = 0;
  std::int64_t unit_inward = 0;
  std::vector<float> row(map.index(map.width, 0));
  for (int y = 0; y < map.height; ++y) {
    stage::copy_values(map, y, 1, row.data());
    for (int x = 0; x < map.width; ++x) {
      const float* texel = row.data() + map.index(x, 0);
      const vec3<double> v{2.0 * texel[0] - 1, 2.0 * texel[1] - 1, 2.0 * texel[2] - 1};
      const double l = length(v);
      lengths += l;
      squares += (l - 1) * (l - 1);
      result.inward += v.z <= 0;
      if (std::abs(l - 1) >= near_unit) continue;
      ++unit;
      unit_inward += v.z <= 0;
      sum = sum + v;
    }
  }
  const double count = double{1.0 * map.width} * map.height;
  result.mean_length = lengths / count;
  result.length_deviation = std::sqrt(squares / count);
  result.unit_share = static_cast<double>(unit) / count;
  const vec3<double> mean = unit > 0 ? (1 / static_cast<double>(unit)) * sum : sum;
  const bool is_about_z = mean.z > least_mean_z && std::hypot(mean.x, mean.y) < most_mean_sideways &&
                          static_cast<double>(unit_inward) < most_inward_share * static_cast<double>(unit);
  result.look = result.unit_share >= least_unit_share && is_about_z ? Look::tangent_normals
                : result.unit_share >= object_unit_share            ? Look::other_normals
                                                                    : Look::no_normals;
  result.look_confidence = result.unit_share >= object_unit_share || result.look == Look::no_normals
                               ? Confidence::certain
                               : Confidence::likely;
}

/// Slopes that the steepest do not outweigh.
image::Image tamed(image::Image slopes) {
  constexpr float most = 2; // 63 degrees
  std::vector<float>& values = slopes.texels.floats();
  for (std::size_t i = 0; i < values.size(); i += 2) {
    const float steepest = max_abs(vec2<float>{values[i], values[i + 1]});
    if (steepest <= most) continue;
    values[i] *= most / steepest;
    values[i + 1] *= most / steepest;
  }
  return slopes;
}

/// How well the derivatives of both slopes along the other axis agree: see GreenFinding.
GreenFinding curl_of(const image::Image& slopes) {
  std::vector<double> products(parts * parts);
  std::vector<double> squares(parts * parts);
  for (int y = 1; y + 1 < slopes.height; ++y)
    for (int x = 1; x + 1 < slopes.width; ++x) {
      const double a = double{slopes.at(x, y + 1, 0)} - slopes.at(x, y - 1, 0);
      const double b = double{slopes.at(x + 1, y, 1)} - slopes.at(x - 1, y, 1);
      const auto part =
          static_cast<std::size_t>(y * parts / slopes.height * parts + x * parts / slopes.width);
      products[part] += 2 * a * b;
      squares[part] += a * a + b * b;
    }
  double product = 0;
  double square = 0;
  for (std::size_t i = 0; i < products.size(); ++i) {
    product += products[i];
    square += squares[i];
  }
  GreenFinding result;
  if (!(square > 0)) return result;
  result.agreement = product / square;
  double variance = 0;
  for (std::size_t i = 0; i < products.size(); ++i) {
    const double residual = products[i] - result.agreement * squares[i];
    variance += residual * residual;
  }
  const double error = std::sqrt(variance) / square;
  // Parts that agree to the last digit have no error to measure by.
  result.certainty = std::abs(result.agreement) / std::max(error, 1e-9);
  return result;
}

/// Means of two by two texels.
image::Image halved(image::Image slopes) {
  const int width = std::max(1, slopes.width / 2);
  const int height = std::max(1, slopes.height / 2);
  return resampled(std::move(slopes), width, height, Border::repeat);
}

GreenFinding find_green(image::Image slopes) {
  constexpr int levels = 3;
  constexpr int least_side = 24; // three texels a part
  GreenFinding best;
  for (int level = 0; level < levels; ++level) {
    if (std::min(slopes.width, slopes.height) < least_side) break;
    const GreenFinding found = curl_of(slopes);
    if (std::abs(found.agreement) > std::abs(best.agreement)) best = found;
    slopes = halved(std::move(slopes));
  }
  if (best.certainty >= least_certainty && std::abs(best.agreement) >= likely_agreement)
    best.confidence =
        std::abs(best.agreement) >= certain_agreement ? Confidence::certain : Confidence::likely;
  best.green = best.agreement < 0 ? stack::Green::down : stack::Green::up;
  return best;
}

void look_at_slopes(const image::Image& slopes, Inspection& result) {
  const double count = double{1.0 * slopes.width} * slopes.height;
  double square = 0;
  for (int y = 0; y < slopes.height; ++y)
    for (int x = 0; x < slopes.width; ++x) {
      const vec2<float> d{slopes.at(x, y, 0), slopes.at(x, y, 1)};
      result.tilt = result.tilt + vec2<double>{d.x, d.y};
      result.steepest = std::max(result.steepest, double{max_abs(d)});
      square += double{d.x} * d.x + double{d.y} * d.y;
    }
  result.tilt = (1 / count) * result.tilt;
  result.root_mean_slope = std::sqrt(square / count);
  image::Image normals = unit_normals(slopes);
  const bake::BaseRoughness mirror(0);
  while (normals.width > 1 || normals.height > 1) {
    normals = resampled(std::move(normals), std::max(1, normals.width / 2), std::max(1, normals.height / 2),
                        Border::repeat);
    const image::Image roughness = roughness_of_means(normals, mirror);
    double sum = 0;
    for (std::size_t i = 0; i < roughness.texels.size(); ++i) sum += roughness.texels[i];
    result.hidden_roughness.push_back(sum / static_cast<double>(roughness.texels.size()));
  }
}

/// Mean square of the steps from each column (or row) to the one `ahead` of it.
std::vector<double> steps(const image::Image& map, bool along_s, int ahead) {
  const int length = along_s ? map.width : map.height;
  const int across = along_s ? map.height : map.width;
  std::vector<double> result(static_cast<std::size_t>(length));
  for (int k = 0; k < length; ++k) {
    double sum = 0;
    const int next = (k + ahead) % length;
    for (int j = 0; j < across; ++j)
      for (int c = 0; c < map.channels; ++c) {
        const double step = along_s ? double{map.at(next, j, c)} - map.at(k, j, c)
                                    : double{map.at(j, next, c)} - map.at(j, k, c);
        sum += step * step;
      }
    result[static_cast<std::size_t>(k)] = sum / across;
  }
  return result;
}

Tiling find_tiling(const image::Image& map, bool along_s) {
  Tiling result;
  const int length = along_s ? map.width : map.height;
  if (length < 8) return result; // too short to know what a usual step is
  std::vector<double> near = steps(map, along_s, 1);
  const double seam = near.back();
  near.pop_back();
  // As far apart as no pattern repeats that fits the map a whole number of times: by the golden section.
  std::vector<double> far = steps(map, along_s, static_cast<int>(0.382 * length));
  const double largest = *std::max_element(near.begin(), near.end());
  const auto middle_of = [](std::vector<double>& values) {
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                     values.end());
    return values[values.size() / 2];
  };
  if (!(largest > 0)) return result; // the same all along
  result.seam = std::sqrt(seam / largest);
  result.repeats = seam <= largest;
  // Noise without neighbourhood meets itself anywhere.
  const double likeness = middle_of(near) / middle_of(far);
  if (likeness > 0.5) return result;
  const bool is_plain = result.repeats ? likeness < 0.2 : result.seam > 1.5;
  result.confidence = is_plain ? Confidence::certain : Confidence::likely;
  return result;
}

/// In halves, in which less of the noise of both files is left.
AgainstHeights compare(image::Image slopes, const image::Image& heights) {
  const image::Image made = halved(slopes_of_heights(
      resampled(heights, slopes.width, slopes.height, Border::repeat), Kernel::central, Border::repeat, 1));
  slopes = halved(std::move(slopes));
  AgainstHeights result;
  double covariance[2] = {};
  double variance[2][2] = {};
  for (int c = 0; c < 2; ++c) {
    const std::vector<float> a = channel_of(made, c);
    const std::vector<float> b = channel_of(slopes, c);
    double sums[2] = {};
    for (std::size_t i = 0; i < a.size(); ++i) {
      sums[0] += a[i];
      sums[1] += b[i];
    }
    const double count = static_cast<double>(a.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
      const double d[] = {a[i] - sums[0] / count, b[i] - sums[1] / count};
      covariance[c] += d[0] * d[1];
      for (int k = 0; k < 2; ++k) variance[c][k] += d[k] * d[k];
    }
    const double scale = std::sqrt(variance[c][0] * variance[c][1]);
    (c == 0 ? result.correlation.x : result.correlation.y) = scale > 0 ? covariance[c] / scale : 0;
  }
  result.is_inverted = result.correlation.x < 0;
  const bool t_inverted = result.correlation.y < 0;
  result.green = result.is_inverted == t_inverted ? stack::Green::up : stack::Green::down;
  const double all = variance[0][0] + variance[1][0];
  result.scale = all > 0 ? (std::abs(covariance[0]) + std::abs(covariance[1])) / all : 0;
  const double weaker = std::min(std::abs(result.correlation.x), std::abs(result.correlation.y));
  result.confidence = weaker > 0.7   ? Confidence::certain
                      : weaker > 0.3 ? Confidence::likely
                                     : Confidence::cannot_tell;
  return result;
}

} // namespace

Inspection inspect(const image::Image& map, const image::Image* heights, const std::filesystem::path& file) {
  Inspection result;
  look_at_channels(map, result);
  result.along_s = find_tiling(map, true);
  result.along_t = find_tiling(map, false);
  const int colors = map.has_alpha ? map.channels - 1 : map.channels;
  if (colors == 1) {
    (void)read_heights(map, {.kind = Kind::height}, file); // throws for what is not finite
    result.look = Look::heights;
    return result;
  }
  if (colors >= 3) {
    look_at_vectors(map, result);
  } else {
    result.look = Look::tangent_normals; // what else would have two
    result.look_confidence = Confidence::likely;
  }
  const Slopes slopes = read_slopes(map, {}, file);
  if (result.look != Look::tangent_normals) return result;
  result.green = find_green(tamed(slopes.map));
  const bool is_down =
      result.green.confidence == Confidence::certain && result.green.green == stack::Green::down;
  look_at_slopes(slopes.map, result);
  if (is_down) result.tilt.y = -result.tilt.y;
  if (heights != nullptr) result.heights = compare(tamed(slopes.map), *heights);
  return result;
}

} // namespace surfgrad::maps
