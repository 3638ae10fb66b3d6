#include "exported/magnified.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace surfgrad::shadergen::test {
namespace {

double larger_side(const scene::Scene& scene, const stack::FileName& file) {
  const image::Image& image = scene.image(file.path);
  return std::max(image.width, image.height);
}

double larger_tile(const stack::Tiled& use) { return std::max(std::abs(use.tile.x), std::abs(use.tile.y)); }

/// Most by which a shape's texture coordinate changes on a unit of length: a box's, a cone's near its apex,
/// and so on, are a quarter of a unit wide at least where the gallery's surfaces cross them.
constexpr double most_change_in_decal = 4;

} // namespace

Fineness::Fineness(const std::vector<stack::Layer>& layers, const scene::Scene& scene) {
  const auto on_st = [&](const stack::Texture& use) {
    texels_by_st_ = std::max(texels_by_st_, larger_tile(use) * larger_side(scene, use.file));
  };
  const auto projected = [&](const stack::FileName& file, double by_length) {
    texels_by_position_ = std::max(texels_by_position_, by_length * larger_side(scene, file));
  };
  for (const stack::Layer& layer : layers)
    std::visit(
        [&](const auto& l) {
          using Kind = std::decay_t<decltype(l)>;
          if constexpr (requires { l.common.mask; })
            if (l.common.mask) on_st(*l.common.mask);
          if constexpr (requires { l.map.uv; }) on_st(l.map);
          if constexpr (std::is_same_v<Kind, stack::PlanarLayer>) projected(l.file, larger_tile(l.map));
          if constexpr (std::is_same_v<Kind, stack::TriplanarLayer>)
            for (const stack::FileName& file : l.files) projected(file, larger_tile(l.map));
          if constexpr (std::is_same_v<Kind, stack::DecalLayer>)
            for (const stack::FileName& file : l.files)
              projected(file, most_change_in_decal * larger_tile(l.map));
        },
        layer);
}

double Fineness::times(const Sample& sample) const {
  const raster::Fragment<double>& f = sample.fragment;
  // In the world, or in the object's space.
  const mat3<double>& inverse = sample.placement.inverse_linear;
  double texels = 1;
  for (const vec3<double>& dp : {f.dp_dx, f.dp_dy, inverse * f.dp_dx, inverse * f.dp_dy})
    texels = std::max(texels, texels_by_position_ * length(dp));
  for (const raster::UvFragment<double>& uv : std::span(f.uvs).first(static_cast<std::size_t>(f.slots)))
    texels = std::max(texels, texels_by_st_ * std::max(length(uv.dst_dx), length(uv.dst_dy)));
  return std::exp2(std::ceil(std::log2(texels)));
}

} // namespace surfgrad::shadergen::test
