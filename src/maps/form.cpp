#include "maps/form.hpp"

#include "bake/format.hpp"
#include "diagnostic/error.hpp"
#include "image/parallel.hpp"
#include "maps/map_rows.hpp"
#include "stage/bands.hpp"

#include <surfgrad/derivative.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <vector>

namespace surfgrad::maps {
namespace {

constexpr std::string_view letters = "rgba";

bool is_constant(const image::Image& map, int channel) {
  const float first = map.at(0, 0, channel);
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x)
      if (map.at(x, y, channel) != first) return false;
  return true;
}

std::string channels_in(const image::Image& map) {
  if (map.channels <= 2 && map.has_alpha) return map.channels == 1 ? "a" : "r and a";
  return fmt::format("{}", fmt::join(letters.substr(0, static_cast<std::size_t>(map.channels)), ", "));
}

/// Those that a form names. An opacity is the last channel.
Channels channels_said(const image::Image& map, const Form& form, const std::filesystem::path& file) {
  Channels said = form.channels;
  for (int& channel : said.channel) {
    if (channel == 3 && map.has_alpha) channel = map.channels - 1;
    if (channel >= map.channels)
      throw InputError(
          {.file = file,
           .problem = fmt::format("has no channel {}", letters[static_cast<std::size_t>(channel)]),
           .remedy = "it has " + channels_in(map)});
  }
  return said;
}

/// Where the components of a map that is read lie.
Channels layout_in(const image::Image& map, const Form& form, const std::filesystem::path& file) {
  if (form.channels.count > 0) return channels_said(map, form, file);
  if (form.kind == Kind::height) return channels_of("r");
  if (map.channels < 2)
    throw InputError({.file = file,
                      .problem = "has one channel, which holds no directions",
                      .remedy = "give a map of two or three channels, or say that it holds heights"});
  const bool has_z = form.kind == Kind::normal && map.channels > 2 && !is_constant(map, 2);
  return channels_of(has_z ? "rgb" : "rg");
}

/// Where those of a map that is written lie.
Channels layout_out(const Form& form) {
  if (form.channels.count > 0) return form.channels;
  return channels_of(form.kind == Kind::height ? "r" : form.kind == Kind::normal ? "rgb" : "rg");
}

int channels_out(const Form& form, const Channels& layout) {
  return 1 +
         std::max(form.is_filled ? 2 : 0, *std::max_element(layout.channel.begin(), layout.channel.end()));
}

/// How the vectors of a form become numbers: bake's, by which every other reader of this project goes.
bake::Format format_of(const Form& form, int components, image::Depth depth) {
  bake::Options options;
  options.encoding = form.kind == Kind::derivative ? bake::Encoding::derivative
                     : components == 2             ? bake::Encoding::rg
                                                   : bake::Encoding::rgb;
  options.green = form.green;
  options.range = form.range;
  options.neutral = form.neutral;
  options.depth = depth;
  return bake::Format(options);
}

void require_finite(const image::Image& map, const std::filesystem::path& file) {
  if (image::is_integer(map.depth)) return;
  std::vector<float> row(map.index(map.width, 0));
  for (int y = map.height - 1; y >= 0; --y) {
    stage::copy_values(map, y, 1, row.data());
    const auto bad = std::find_if(row.begin(), row.end(), [](float v) { return !std::isfinite(v); });
    if (bad == row.end()) continue;
    throw InputError({.file = file,
                      .place = fmt::format("column {}, row {} from the top",
                                           (bad - row.begin()) / map.channels, map.height - 1 - y),
                      .problem = std::isnan(*bad) ? "is not a number" : "is infinite",
                      .remedy = "give finite values"});
  }
}

/// Calls body(texel of `map`, texel of the result) for all of them, in parallel by rows. Returns the sum of
/// what body returns.
template <class Body>
std::int64_t each_texel(const image::Image& map, MapRows& result, const Body& body) {
  const std::size_t from_row = map.index(0, 1);
  const auto from_step = static_cast<std::size_t>(map.channels);
  const auto to_step = static_cast<std::size_t>(result.channels());
  std::vector<std::int64_t> counts(static_cast<std::size_t>(map.height));
  image::in_parallel(counts.size(), static_cast<std::size_t>(map.width), [&](std::size_t y) {
    thread_local std::vector<float> scratch;
    thread_local std::vector<float> row;
    scratch.resize(from_row);
    row.resize(static_cast<std::size_t>(map.width) * to_step);
    const float* from = map.texels.read(y * from_row, from_row, scratch.data());
    float* to = row.data();
    for (int x = 0; x < map.width; ++x, from += from_step, to += to_step) counts[y] += body(from, to);
    result.put(static_cast<int>(y), row);
  });
  std::int64_t sum = 0;
  for (const std::int64_t count : counts) sum += count;
  return sum;
}

/// Puts components where a form has them, on white.
void put_components(const std::array<float, 3>& components, const Channels& layout, int channels,
                    float* texel) {
  std::fill_n(texel, channels, 1.0f);
  for (std::size_t i = 0; i < static_cast<std::size_t>(layout.count); ++i)
    texel[layout.channel[i]] = components[i];
}

/// The texel of a map without bumps, which is not dithered.
std::vector<float> flat_texel(const Form& form, image::Depth depth) {
  const Channels layout = layout_out(form);
  std::array<float, 3> components{form.is_depth ? 1.0f : 0.0f};
  if (form.kind != Kind::height) format_of(form, layout.count, depth).encode({0, 0, 1}, components.data());
  std::vector<float> texel(static_cast<std::size_t>(channels_out(form, layout)));
  put_components(components, layout, static_cast<int>(texel.size()), texel.data());
  return texel;
}

/// A picture of the size of another one to be written with this form.
MapRows rows_for(const image::Image& map, const Form& form, int channels, Precision precision) {
  std::optional<std::vector<float>> flat;
  if (precision.dithers) flat = flat_texel(form, precision.depth);
  return {map.width, map.height, channels, precision.depth, std::move(flat)};
}

} // namespace

Channels channels_of(std::string_view text) {
  Channels channels;
  for (const char letter : text) {
    const std::size_t channel = letters.find(letter);
    if (channel == std::string_view::npos || channels.count == 3)
      throw std::invalid_argument("up to three of the letters r, g, b and a");
    channels.channel[static_cast<std::size_t>(channels.count++)] = static_cast<int>(channel);
  }
  return channels;
}

void require_normals(const image::Image& map, const Form& form, Inward inward,
                     const std::filesystem::path& file) {
  const Channels layout = layout_in(map, form, file);
  require_finite(map, file);
  if (form.kind != Kind::normal || layout.count < 3) return;
  // By texels on a lattice over the map: a large one is told as surely by these.
  constexpr int most_a_side = 256;
  const int step_x = (map.width + most_a_side - 1) / most_a_side;
  const int step_y = (map.height + most_a_side - 1) / most_a_side;
  int texels = 0, far_from_unit = 0, into_surface = 0;
  for (int y = 0; y < map.height; y += step_y)
    for (int x = 0; x < map.width; x += step_x) {
      const auto component = [&](std::size_t i) { return 2 * map.at(x, y, layout.channel[i]) - 1; };
      const vec3<float> v{component(0), component(1), component(2)};
      ++texels;
      far_from_unit += std::abs(length(v) - 1) < near_unit ? 0 : 1;
      into_surface += v.z > 0 ? 0 : 1;
    }
  const auto refuse = [&](int count, double most_share, const char* what, const char* remedy) {
    if (count <= most_share * texels) return;
    throw InputError(
        {.file = file,
         .problem = fmt::format("is no {}: {} % of its texels are {}",
                                inward == Inward::refused ? "tangent-space normal map" : "normal map",
                                100 * count / texels, what),
         .remedy = remedy});
  };
  refuse(far_from_unit, 1 - least_unit_share, "far from unit vectors",
         "say what it holds, or which of its channels are meant");
  if (inward == Inward::refused)
    refuse(into_surface, 0.5, "vectors that point into the surface", "is it one of an object's normals?");
}

Slopes read_slopes(const image::Image& map, const Form& form, const std::filesystem::path& file) {
  const Channels layout = layout_in(map, form, file);
  require_finite(map, file);
  const bake::Format format = format_of(form, layout.count, map.depth);
  const bool integers = image::is_integer(map.depth);
  const double most = map.depth == image::Depth::unorm8 ? 255 : 65535;
  Slopes slopes;
  const auto components = static_cast<std::size_t>(layout.count);
  MapRows rows(map.width, map.height, 2, image::Depth::float32);
  slopes.inward = each_texel(map, rows, [&](const float* from, float* to) {
    std::array<float, 3> texel{};
    for (std::size_t i = 0; i < components; ++i) texel[i] = from[layout.channel[i]];
    const vec3<double> normal = format.decode(texel.data(), integers, most);
    const vec2<double> slope = derivative_from_normal(normal);
    to[0] = static_cast<float>(form.flips_x ? -slope.x : slope.x);
    to[1] = static_cast<float>(slope.y);
    return layout.count == 3 && !(normal.z > 0);
  });
  slopes.map = rows.take();
  return slopes;
}

image::Image read_heights(const image::Image& map, const Form& form, const std::filesystem::path& file) {
  const int channel = layout_in(map, form, file).channel[0];
  require_finite(map, file);
  MapRows heights(map.width, map.height, 1, image::Depth::float32);
  each_texel(map, heights, [&](const float* from, float* to) {
    to[0] = form.is_depth ? 1 - from[channel] : from[channel];
    return 0;
  });
  return heights.take();
}

Written write_slopes(const image::Image& slopes, const Form& form, Precision precision) {
  const Channels layout = layout_out(form);
  const bake::Format format = format_of(form, layout.count, precision.depth);
  const int channels = channels_out(form, layout);
  MapRows rows = rows_for(slopes, form, channels, precision);
  Written written;
  written.clamped = each_texel(slopes, rows, [&](const float* from, float* to) {
    std::array<float, 3> components{};
    const bake::Format::Encoded encoded = format.encode(
        normal_from_derivative(vec2<float>{form.flips_x ? -from[0] : from[0], from[1]}), components.data());
    put_components(components, layout, channels, to);
    return encoded.clamped;
  });
  written.map = rows.take();
  std::vector<float> row(slopes.index(slopes.width, 0));
  for (int y = 0; y < slopes.height; ++y) {
    stage::copy_values(slopes, y, 1, row.data());
    for (const float slope : row) written.steepest = std::max(written.steepest, double{std::abs(slope)});
  }
  return written;
}

Written write_heights(const image::Image& heights, const Form& form, Precision precision) {
  const Channels layout = layout_out(form);
  const int channels = channels_out(form, layout);
  const bool integers = image::is_integer(precision.depth);
  MapRows rows = rows_for(heights, form, channels, precision);
  Written written;
  written.clamped = each_texel(heights, rows, [&](const float* from, float* to) {
    const float height = form.is_depth ? 1 - from[0] : from[0];
    const bool outside = integers && !(height >= 0 && height <= 1);
    put_components({integers ? std::clamp(height, 0.0f, 1.0f) : height, 0, 0}, layout, channels, to);
    return outside;
  });
  written.map = rows.take();
  return written;
}

Arrangement arrangement_of(const image::Image& map, const Form& from, const Form& to,
                           const std::filesystem::path& file) {
  Arrangement result;
  const auto in_order = [](int count) {
    return channels_of(letters.substr(0, static_cast<std::size_t>(count)));
  };
  const Channels in = from.kind == Kind::normal && from.channels.count == 0
                          ? in_order(std::min(map.channels, 3))
                          : layout_in(map, from, file);
  const Channels out = layout_out(to);
  if (from.kind != to.kind || in.count != out.count) return result;
  require_normals(map, from, Inward::allowed, file);
  result.is_only_that = true;
  result.channels = channels_out(to, out);
  const bool flips[] = {from.kind == Kind::height ? from.is_depth != to.is_depth : from.flips_x != to.flips_x,
                        from.green != to.green, false};
  for (int i = 0; i < out.count; ++i) {
    const auto component = static_cast<std::size_t>(i);
    result.sources[static_cast<std::size_t>(out.channel[component])] = {in.channel[component], flips[i]};
  }
  result.has_alpha =
      from.kind == Kind::normal && from.channels.count == 0 && to.channels.count == 0 && map.channels == 4;
  if (result.has_alpha) {
    result.sources[3] = {3, false};
    result.channels = 4;
  }
  return result;
}

image::Image rearranged(const image::Image& map, const Arrangement& arrangement, const Form& to,
                        Precision precision) {
  MapRows rows = rows_for(map, to, arrangement.channels, precision);
  const auto channels = static_cast<std::size_t>(arrangement.channels);
  each_texel(map, rows, [&](const float* texel, float* made) {
    for (std::size_t c = 0; c < channels; ++c) {
      const Arrangement::Source& source = arrangement.sources[c];
      const float value = source.channel < 0 ? 1.0f : texel[source.channel];
      made[c] = source.flips ? 1 - value : value;
    }
    return 0;
  });
  image::Image result = rows.take();
  result.has_alpha = arrangement.has_alpha;
  return result;
}

} // namespace surfgrad::maps
