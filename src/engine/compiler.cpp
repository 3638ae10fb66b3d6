#include "engine/compiler.hpp"

#include <surfgrad/trigonometry.hpp>

namespace surfgrad::engine {
namespace {

image::Filter filter_of(stack::Filter filter) {
  switch (filter) {
  case stack::Filter::nearest:
    return image::Filter::nearest;
  case stack::Filter::bilinear:
    return image::Filter::bilinear;
  case stack::Filter::trilinear:
  case stack::Filter::anisotropic:
  case stack::Filter::normal:
    break;
  }
  return image::Filter::trilinear;
}

/// Cosine and sine; exact for whole quarter turns, so that a map turned by 90 degrees stays on its
/// texel grid.
vec2<double> rotation_of(double degrees) {
  const double turn = std::remainder(degrees, 360.0); // exact, within half a turn
  const SinCos<double> r = sin_cos_turns(turn / 360);
  return {r.cos, r.sin};
}

} // namespace

TiledMap Compiler::tiled(const stack::Tiled& use, std::shared_ptr<const image::Map> map) const {
  return {std::move(map),
          use.tile,
          rotation_of(use.rotate_deg),
          use.offset,
          {wrap_of(use.wrap), wrap_of(use.wrap_t.value_or(use.wrap))},
          filter_of(use.filter),
          // A tile turns by at most hex_turn_deg either way.
          use.tiling == stack::Tiling::hex ? std::optional(use.hex_turn_deg / 180) : std::nullopt,
          use.filter == stack::Filter::anisotropic ? use.anisotropy : 1};
}

Texture Compiler::texture(const stack::Texture& use, std::shared_ptr<const image::Map> map) const {
  int slot = 0;
  for (std::size_t i = 0; i < slots_.size(); ++i)
    if (slots_[i].uv_set == use.uv) slot = static_cast<int>(i);
  return {tiled(use, std::move(map)), slot};
}

BumpMap Compiler::bump_map(const stack::BumpCodes& use, stack::Content content,
                           const stack::FileName& file) const {
  switch (content) {
  case stack::Content::derivative:
    return {tiled(use, maps_.derivatives(file, use.derivative, use.green))};
  case stack::Content::height: {
    const image::Wraps wraps{wrap_of(use.wrap), wrap_of(use.wrap_t.value_or(use.wrap))};
    return {tiled(use, maps_.height_slopes(file, use.height_channel, wraps)), true, use.height};
  }
  case stack::Content::normal:
    break;
  }
  return {tiled(use, maps_.slopes(file, use.channels, use.green, use.filter))};
}

vec2<double> Compiler::rotation(double degrees) { return rotation_of(degrees); }

Influence Compiler::influence(const stack::LayerCommon& common) const {
  return {common.scale, common.opacity, common.blend == stack::Blend::mix, mask(common)};
}

std::optional<Texture> Compiler::mask(const stack::LayerWeight& common) const {
  if (!common.mask) return std::nullopt;
  return texture(*common.mask, maps_.weights(common.mask->file, common.mask->channel));
}

} // namespace surfgrad::engine
