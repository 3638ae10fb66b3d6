#include "exported/magnified.hpp"

#include <algorithm>
#include <cmath>

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

void Fineness::apply(Sample& sample) const {
  raster::Fragment<double>& f = sample.fragment;
  // In the world, or in the object's space.
  const mat3<double>& inverse = sample.placement.inverse_linear;
  double texels = 0;
  for (const vec3<double>& dp : {f.dp_dx, f.dp_dy, inverse * f.dp_dx, inverse * f.dp_dy})
    texels = std::max(texels, texels_by_position_ * length(dp));
  for (const raster::UvFragment<double>& uv : coordinates_of(f))
    texels = std::max(texels, texels_by_st_ * std::max(length(uv.dst_dx), length(uv.dst_dy)));
  const double finer = std::exp2(std::max(std::ceil(std::log2(std::max(texels, 1e-30))), 0.0));
  const double share = 1 / finer;
  f.raster = finer * f.raster;
  for (vec3<double>* v : {&f.dp_dx, &f.dp_dy, &f.dn_dx, &f.dn_dy}) *v = share * *v;
  for (raster::UvFragment<double>& uv : coordinates_of(f))
    for (vec2<double>* v : {&uv.dst_dx, &uv.dst_dy, &uv.footprint_dx, &uv.footprint_dy}) *v = share * *v;
  if (!sample.placement.relative_from_screen) return;
  for (vec4<double>* row :
       {&sample.placement.relative_from_screen->x, &sample.placement.relative_from_screen->y,
        &sample.placement.relative_from_screen->z, &sample.placement.relative_from_screen->w})
    *row = {share * row->x, share * row->y, row->z, row->w};
}

} // namespace surfgrad::shadergen::test
