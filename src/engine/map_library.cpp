#include "engine/map_library.hpp"

#include "diagnostic/error.hpp"

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

} // namespace

void MapLibrary::require_channels(const image::Image& image, int least, const stack::Map& use,
                                  const char* what) const {
  // Opacity is no part of a vector: it does not count.
  const int channels = image.channels - (image.has_alpha ? 1 : 0);
  if (channels >= least) return;
  const std::string namer = document_.filename().string() + ":" + std::to_string(use.file.line) + ": ";
  throw InputError(
      {.file = use.file.path,
       .place = use.file.line > 0 ? "(named by " + namer + use.file.key + ")" : use.file.key,
       .problem = "has " + std::to_string(channels) + (channels == 1 ? " channel" : " channels"),
       .remedy = what + std::string(least == 3 ? " of x, y and z needs three" : " needs two or three")});
}

std::shared_ptr<const image::Map> MapLibrary::slopes(const stack::TangentMap& use) {
  const bool green_up = use.green == stack::Green::up;
  auto& map = maps_["slopes " + std::to_string(static_cast<int>(use.channels)) +
                    (green_up ? " up " : " down ") + use.file.path.string()];
  if (!map) {
    const image::Image& image = find_(use.file.path);
    require_channels(image, use.channels == stack::Channels::xyz ? 3 : 2, use, "a normal map");
    image::SlopeMap slopes = image::make_slope_map(image, channels_of(use.channels), green_up);
    if (slopes.inward_texels > 0)
      inward_.push_back({use.file.path, slopes.inward_texels, std::int64_t{image.width} * image.height});
    map = std::make_shared<image::Map>(std::move(slopes.map));
  }
  return map;
}

std::shared_ptr<const image::Map> MapLibrary::directions(const stack::Map& use) {
  const bool green_up = use.green == stack::Green::up;
  auto& map = maps_[std::string("directions") + (green_up ? " up " : " down ") + use.file.path.string()];
  if (!map) {
    const image::Image& image = find_(use.file.path);
    require_channels(image, 3, use, "an object-space normal map");
    map = std::make_shared<image::Map>(image::make_direction_map(image, green_up));
  }
  return map;
}

std::shared_ptr<const image::Map> MapLibrary::channel(const stack::Mask& use) {
  const int channel = static_cast<int>(use.channel);
  auto& map = maps_["channel " + std::to_string(channel) + " " + use.file.path.string()];
  if (!map) map = std::make_shared<image::Map>(image::make_channel_map(find_(use.file.path), channel));
  return map;
}

} // namespace surfgrad::engine
