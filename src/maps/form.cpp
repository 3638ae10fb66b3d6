#include "maps/form.hpp"

#include "bake/format.hpp"
#include "diagnostic/error.hpp"
#include "image/parallel.hpp"
#include "stage/bands.hpp"

#include <surfgrad/derivative.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
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

/// Calls body(texel of `map`, texel of `result`) for all of them, in parallel by rows. Returns the sums over
/// the rows of what body returns.
template <class Body>
std::int64_t each_texel(const image::Image& map, image::Image& result, const Body& body) {
  const std::size_t from_row = map.index(0, 1);
  const std::size_t to_row = result.index(0, 1);
  const auto from_step = static_cast<std::size_t>(map.channels);
  const auto to_step = static_cast<std::size_t>(result.channels);
  float* const values = result.texels.floats().data();
  std::vector<std::int64_t> counts(static_cast<std::size_t>(map.height));
  image::in_parallel(counts.size(), static_cast<std::size_t>(map.width), [&](std::size_t y) {
    std::vector<float> scratch(from_row);
    const float* from = map.texels.read(y * from_row, from_row, scratch.data());
    float* to = values + y * to_row;
    for (int x = 0; x < map.width; ++x, from += from_step, to += to_step) counts[y] += body(from, to);
  });
  std::int64_t sum = 0;
  for (const std::int64_t count : counts) sum += count;
  return sum;
}

/// The same, to an image with these channels.
struct Target {
  int channels;
  image::Depth depth;
};
image::Image of_the_size_of(const image::Image& map, Target target) {
  return image::make_image(map.width, map.height, target.channels, target.depth);
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
  slopes.is_two_channels = layout.count == 2;
  const auto components = static_cast<std::size_t>(layout.count);
  slopes.map = of_the_size_of(map, {2, image::Depth::float32});
  slopes.inward = each_texel(map, slopes.map, [&](const float* from, float* to) {
    std::array<float, 3> texel{};
    for (std::size_t i = 0; i < components; ++i) texel[i] = from[layout.channel[i]];
    const vec3<double> normal = format.decode(texel.data(), integers, most);
    const vec2<double> slope = derivative_from_normal(normal);
    to[0] = static_cast<float>(form.flips_x ? -slope.x : slope.x);
    to[1] = static_cast<float>(slope.y);
    return layout.count == 3 && !(normal.z > 0);
  });
  return slopes;
}

image::Image read_heights(const image::Image& map, const Form& form, const std::filesystem::path& file) {
  const int channel = layout_in(map, form, file).channel[0];
  require_finite(map, file);
  image::Image heights = of_the_size_of(map, {1, image::Depth::float32});
  each_texel(map, heights, [&](const float* from, float* to) {
    to[0] = form.is_depth ? 1 - from[channel] : from[channel];
    return 0;
  });
  return heights;
}

Written write_slopes(const image::Image& slopes, const Form& form, image::Depth depth) {
  const Channels layout = layout_out(form);
  const bake::Format format = format_of(form, layout.count, depth);
  Written written;
  written.map = of_the_size_of(slopes, {channels_out(form, layout), depth});
  const auto channels = static_cast<std::size_t>(written.map.channels);
  const auto components = static_cast<std::size_t>(layout.count);
  written.clamped = each_texel(slopes, written.map, [&](const float* from, float* to) {
    std::array<float, 3> texel{};
    const bake::Format::Encoded encoded = format.encode(
        normal_from_derivative(vec2<float>{form.flips_x ? -from[0] : from[0], from[1]}), texel.data());
    std::fill_n(to, channels, 1.0f);
    for (std::size_t i = 0; i < components; ++i) to[layout.channel[i]] = texel[i];
    return encoded.clamped;
  });
  std::vector<float> row(slopes.index(slopes.width, 0));
  for (int y = 0; y < slopes.height; ++y) {
    stage::copy_values(slopes, y, 1, row.data());
    for (const float slope : row) written.steepest = std::max(written.steepest, double{std::abs(slope)});
  }
  return written;
}

Written write_heights(const image::Image& heights, const Form& form, image::Depth depth) {
  const Channels layout = layout_out(form);
  Written written;
  written.map = of_the_size_of(heights, {channels_out(form, layout), depth});
  const auto channels = static_cast<std::size_t>(written.map.channels);
  const bool integers = image::is_integer(depth);
  written.clamped = each_texel(heights, written.map, [&](const float* from, float* to) {
    const float height = form.is_depth ? 1 - from[0] : from[0];
    const bool outside = integers && !(height >= 0 && height <= 1);
    std::fill_n(to, channels, 1.0f);
    to[layout.channel[0]] = integers ? std::clamp(height, 0.0f, 1.0f) : height;
    return outside;
  });
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

image::Image rearranged(const image::Image& map, const Arrangement& arrangement) {
  image::Image result = of_the_size_of(map, {arrangement.channels, map.depth});
  result.has_alpha = arrangement.has_alpha;
  const auto channels = static_cast<std::size_t>(result.channels);
  each_texel(map, result, [&](const float* texel, float* made) {
    for (std::size_t c = 0; c < channels; ++c) {
      const Arrangement::Source& source = arrangement.sources[c];
      const float value = source.channel < 0 ? 1.0f : texel[source.channel];
      made[c] = source.flips ? 1 - value : value;
    }
    return 0;
  });
  return result;
}

std::vector<float> flat_texel(const Form& form, image::Depth depth) {
  image::Image one = image::make_image(1, 1, form.kind == Kind::height ? 1 : 2, image::Depth::float32);
  return (form.kind == Kind::height ? write_heights(one, form, depth) : write_slopes(one, form, depth))
      .map.texels.floats();
}

} // namespace surfgrad::maps
