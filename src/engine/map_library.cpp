#include "engine/map_library.hpp"

#include "diagnostic/error.hpp"
#include "image/height_map.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <string>

namespace surfgrad::engine {
namespace {

image::NormalChannels channels_of(stack::Channels channels) {
  switch (channels) {
  case stack::Channels::xyz:
    return image::NormalChannels::xyz;
  case stack::Channels::xy:
    return image::NormalChannels::xy;
  case stack::Channels::automatic:
    break;
  }
  return image::NormalChannels::automatic;
}

std::string word_of(stack::Green green) { return green == stack::Green::up ? "up" : "down"; }

template <class Enum>
std::string number_of(Enum word) {
  return std::to_string(static_cast<int>(word));
}

} // namespace

image::Wrap wrap_of(stack::Wrap wrap) {
  switch (wrap) {
  case stack::Wrap::mirror:
    return image::Wrap::mirror;
  case stack::Wrap::clamp:
    return image::Wrap::clamp;
  case stack::Wrap::repeat:
    break;
  }
  return image::Wrap::repeat;
}

template <class Make>
std::shared_ptr<const image::Map> MapLibrary::made_once(const std::string& kind, const stack::FileName& file,
                                                        int components, const Make& make) {
  auto& map = maps_[kind + " " + file.path.string()];
  if (map) return map;
  const image::Image& image = find_(file.path);
  require_size(image, image::map_most_texels, components, file);
  map = std::make_shared<const image::Map>(make(image));
  return map;
}

image::RowsRead MapLibrary::giving_back(const std::filesystem::path& file) const {
  image::Image* const image = expendable_ ? expendable_(file) : nullptr;
  if (image == nullptr) return {};
  return [image](int first, int end) {
    image->texels.give_back(image->index(0, first), image->index(0, end) - image->index(0, first));
  };
}

std::string MapLibrary::named_by(const stack::FileName& file) const {
  if (file.line == 0) return file.key;
  return "(named by " + document_.filename().string() + ":" + std::to_string(file.line) + ": " + file.key +
         ")";
}

void MapLibrary::require_size(const image::Image& image, int most_texels, int components,
                              const stack::FileName& file) const {
  const auto refuse = [&](const std::string& remedy) {
    throw InputError({.file = file.path,
                      .place = named_by(file),
                      .problem = "is " + std::to_string(image.width) + "x" + std::to_string(image.height),
                      .remedy = remedy});
  };
  if (std::max(image.width, image.height) > most_texels)
    refuse("expected at most " + std::to_string(most_texels) + " texels a side");
  constexpr std::int64_t most_words = std::numeric_limits<std::int32_t>::max() - words_read_ahead;
  if (image::words_of_map(image.width, image.height, components) > most_words)
    refuse("with its mip levels that is more than " + std::to_string(most_words) + " numbers");
}

void MapLibrary::require_channels(const image::Image& image, int least, const stack::FileName& file,
                                  const char* what) const {
  // Opacity is no part of a vector: it does not count.
  const int channels = image.channels - (image.has_alpha ? 1 : 0);
  if (channels >= least) return;
  throw InputError(
      {.file = file.path,
       .place = named_by(file),
       .problem = "has " + std::to_string(channels) + (channels == 1 ? " channel" : " channels"),
       .remedy = what + std::string(least == 3 ? " of x, y and z needs three" : " needs two or three")});
}

void MapLibrary::require_channel(const image::Image& image, stack::MaskChannel channel,
                                 const stack::FileName& file) const {
  // Red, green and blue of a grey file are its grey; opacity that it lacks would be 1 everywhere.
  if (image.source_of(static_cast<int>(channel)) >= 0) return;
  throw InputError({.file = file.path,
                    .place = named_by(file),
                    .problem = "has no alpha channel",
                    .remedy = "expected \"channel\": r, g or b, or a file with opacity"});
}

std::shared_ptr<const image::Map> MapLibrary::slopes(const stack::FileName& file, stack::Channels channels,
                                                     stack::Green green, stack::Filter filter) {
  const bool encoded = filter == stack::Filter::normal;
  const std::string kind = (encoded ? "normals " : "slopes ") + number_of(channels) + word_of(green);
  return made_once(kind, file, encoded ? 3 : 2, [&](const image::Image& image) {
    require_channels(image, channels == stack::Channels::xyz ? 3 : 2, file, "a normal map");
    const bool green_up = green == stack::Green::up;
    image::SlopeMap map =
        encoded ? image::make_encoded_map(image, channels_of(channels), green_up)
                : image::make_slope_map(image, channels_of(channels), green_up, giving_back(file.path));
    const bool told = std::any_of(inward_.begin(), inward_.end(),
                                  [&](const InwardTexels& known) { return known.file == file.path; });
    if (map.inward_texels > 0 && !told)
      inward_.push_back({file.path, map.inward_texels, std::int64_t{image.width} * image.height});
    return std::move(map.map);
  });
}

std::shared_ptr<const image::Map>
MapLibrary::derivatives(const stack::FileName& file, const stack::DerivativeCode& code, stack::Green green) {
  const auto range_bits = std::to_string(std::bit_cast<std::uint64_t>(code.range));
  return made_once("derivatives " + range_bits + number_of(code.neutral) + word_of(green), file, 2,
                   [&](const image::Image& image) {
                     require_channels(image, 2, file, "a derivative map");
                     return image::make_derivative_map(image, code.range, green == stack::Green::up,
                                                       code.neutral == stack::NeutralCode::whole
                                                           ? image::NeutralCode::whole
                                                           : image::NeutralCode::between,
                                                       giving_back(file.path));
                   });
}

std::shared_ptr<const image::Map> MapLibrary::heights(const stack::FileName& file,
                                                      stack::MaskChannel channel) {
  return made_once("heights " + number_of(channel), file, 1, [&](const image::Image& image) {
    require_channel(image, channel, file);
    return image::make_height_map(image, static_cast<int>(channel));
  });
}

std::shared_ptr<const image::Map> MapLibrary::height_slopes(const stack::FileName& file,
                                                            stack::MaskChannel channel, image::Wraps wraps) {
  return made_once("height slopes " + number_of(channel) + number_of(wraps.s) + number_of(wraps.t), file, 2,
                   [&](const image::Image& image) {
                     require_channel(image, channel, file);
                     return image::make_height_slopes(image, static_cast<int>(channel), wraps);
                   });
}

std::shared_ptr<const image::Map> MapLibrary::directions(const stack::FileName& file, stack::Green green) {
  return made_once("directions " + word_of(green), file, 3, [&](const image::Image& image) {
    require_channels(image, 3, file, "an object-space normal map");
    return image::make_direction_map(image, green == stack::Green::up);
  });
}

std::shared_ptr<const image::CubeMap> MapLibrary::cube(const std::vector<stack::FileName>& files) {
  std::vector<std::filesystem::path> paths;
  for (const stack::FileName& file : files) paths.push_back(file.path);
  auto& cube = cubes_[paths];
  if (cube) return cube;
  std::array<const image::Image*, 6> faces{};
  for (std::size_t i = 0; i < files.size(); ++i) faces.at(i) = &find_(files[i].path);
  auto made = files.size() == 1 ? image::make_cube_map(*faces[0]) : image::make_cube_map(faces);
  if (const auto* fault = std::get_if<image::CubeFault>(&made)) {
    const stack::FileName& file = files[static_cast<std::size_t>(std::max(fault->face, 0))];
    throw InputError(
        {.file = file.path, .place = named_by(file), .problem = fault->problem, .remedy = fault->remedy});
  }
  cube = std::make_shared<const image::CubeMap>(std::move(std::get<image::CubeMap>(made)));
  return cube;
}

std::shared_ptr<const image::Map> MapLibrary::weights(const stack::FileName& file,
                                                      stack::MaskChannel channel) {
  return made_once("weights " + number_of(channel), file, 1, [&](const image::Image& image) {
    require_channel(image, channel, file);
    return image::make_channel_map(image, static_cast<int>(channel));
  });
}

std::shared_ptr<const image::TwoSidedField> MapLibrary::relief(const stack::FileName& file,
                                                               stack::MaskChannel channel) {
  auto& relief = reliefs_[number_of(channel) + " " + file.path.string()];
  if (relief) return relief;
  const image::Image& image = find_(file.path);
  require_channel(image, channel, file);
  require_size(image, image::height_field_most_texels, 1, file);
  relief = std::make_shared<const image::TwoSidedField>(
      image::make_two_sided_field(image::make_channel_map(image, static_cast<int>(channel))));
  return relief;
}

} // namespace surfgrad::engine
