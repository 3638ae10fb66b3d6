#include "engine/program.hpp"

#include "diagnostic/error.hpp"

#include <surfgrad/trigonometry.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <type_traits>

namespace surfgrad::engine {
namespace {

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

image::Filter filter_of(stack::Filter filter) {
  switch (filter) {
  case stack::Filter::nearest:
    return image::Filter::nearest;
  case stack::Filter::bilinear:
    return image::Filter::bilinear;
  case stack::Filter::trilinear:
    break;
  }
  return image::Filter::trilinear;
}

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

/// Cosine and sine; exact for whole quarter turns, so that a map turned by 90 degrees stays on its
/// texel grid.
vec2<double> rotation_of(double degrees) {
  const double turn = std::remainder(degrees, 360.0); // exact, within half a turn
  const SinCos<double> r = sin_cos_turns(turn / 360);
  return {r.cos, r.sin};
}

int slot_of(int uv, const std::vector<raster::UvSlot>& slots) {
  for (std::size_t i = 0; i < slots.size(); ++i)
    if (slots[i].uv_set == uv) return static_cast<int>(i);
  return 0; // unreachable: collect_uv_slots listed every set
}

Texture texture_of(const stack::Texture& use, std::shared_ptr<const image::Map> map,
                   const std::vector<raster::UvSlot>& slots) {
  return {std::move(map),
          slot_of(use.uv, slots),
          use.tile,
          rotation_of(use.rotate_deg),
          use.offset,
          {wrap_of(use.wrap), wrap_of(use.wrap_t.value_or(use.wrap))},
          filter_of(use.filter)};
}

Influence influence_of(const stack::LayerCommon& common, const std::vector<raster::UvSlot>& slots,
                       MapLibrary& maps) {
  Influence influence{common.scale, common.opacity, common.blend == stack::Blend::mix, std::nullopt};
  if (common.mask) influence.mask = texture_of(*common.mask, maps.channel(*common.mask), slots);
  return influence;
}

void add_slot(const stack::Texture& use, bool tangents, std::vector<raster::UvSlot>& slots) {
  const auto found =
      std::find_if(slots.begin(), slots.end(), [&](const raster::UvSlot& s) { return s.uv_set == use.uv; });
  if (found != slots.end()) {
    found->tangents = found->tangents || tangents;
    return;
  }
  if (static_cast<int>(slots.size()) == raster::max_uv_slots)
    throw InputError(
        {.file = use.file.path,
         .line = use.uv_line,
         .place = use.file.key,
         .problem = "the scene uses more than " + std::to_string(raster::max_uv_slots) + " UV sets",
         .remedy = "use fewer at once"});
  slots.push_back({use.uv, tangents});
}

} // namespace

void collect_uv_slots(const std::vector<stack::Layer>& layers, std::vector<raster::UvSlot>& slots) {
  for (const stack::Layer& layer : layers)
    std::visit(
        [&](const auto& l) {
          using L = std::decay_t<decltype(l)>;
          if constexpr (!std::is_same_v<L, stack::ResolveLayer>) {
            bool tangents = false;
            if constexpr (std::is_same_v<L, stack::NormalMapLayer>)
              tangents = l.basis == stack::Basis::mikktspace;
            add_slot(l.map, tangents, slots);
            if (l.common.mask) add_slot(*l.common.mask, false, slots);
          }
        },
        layer);
}

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

Program compile(const std::vector<stack::Layer>& layers, const std::vector<raster::UvSlot>& slots,
                MapLibrary& maps) {
  Program program;
  for (const stack::Layer& layer : layers)
    std::visit(
        [&](const auto& l) {
          using L = std::decay_t<decltype(l)>;
          if constexpr (std::is_same_v<L, stack::NormalMapLayer>) {
            program.layers.emplace_back(NormalMap{influence_of(l.common, slots, maps),
                                                  texture_of(l.map, maps.slopes(l.map), slots),
                                                  l.basis == stack::Basis::derived});
          } else if constexpr (std::is_same_v<L, stack::ObjectNormalMapLayer>) {
            program.layers.emplace_back(ObjectNormalMap{influence_of(l.common, slots, maps),
                                                        texture_of(l.map, maps.directions(l.map), slots),
                                                        l.space == stack::Space::world});
          } else {
            program.layers.emplace_back(Resolve{});
          }
        },
        layer);
  return program;
}

} // namespace surfgrad::engine
