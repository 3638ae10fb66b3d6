#include "every_kind.hpp"

namespace surfgrad::engine::test {
namespace {

using Layers = std::vector<stack::Layer>;

std::function<Layers(double)> normal_map(stack::Basis basis, stack::Tiling tiling = stack::Tiling::plain) {
  return [=](double) -> Layers {
    stack::NormalMapLayer layer = normal_layer("normals", 0, basis);
    layer.map.tile = {3, -2};
    layer.map.rotate_deg = 30;
    layer.map.tiling = tiling;
    layer.common.mask = mask_of("mask", stack::MaskChannel::g);
    layer.common.mask->tiling = tiling;
    return {layer};
  };
}

Layers derivative_map(double) {
  stack::DerivativeMapLayer layer = derivative_layer("slopes", 0, stack::Basis::derived);
  layer.map.tile = {-2, 3};
  layer.map.rotate_deg = -40;
  return {layer};
}

stack::HeightMapLayer heights(double height) {
  stack::HeightMapLayer layer = height_layer("heights", height);
  layer.map.tile = {2, -3};
  layer.map.rotate_deg = 70;
  return layer;
}

/// Heights in scene units grow with the body.
std::function<Layers(double)> scene_heights(stack::Taps taps) {
  return [=](double scale) -> Layers {
    stack::HeightMapLayer layer = heights(0.1 * scale);
    layer.taps = taps;
    return {layer};
  };
}

Layers object_heights(double) {
  stack::HeightMapLayer layer = heights(0.1);
  layer.units = stack::Units::object;
  layer.taps = stack::Taps::bicubic;
  return {layer};
}

Layers scale_free_heights(double) {
  stack::HeightMapLayer layer = heights(0.1);
  layer.mode = stack::HeightMode::scale_free;
  return {layer};
}

Layers object_normal_map(double) {
  stack::ObjectNormalMapLayer layer = object_layer("directions");
  layer.map.tile = {2, 3};
  return {layer};
}

Layers noise(double) {
  stack::NoiseLayer layer;
  layer.noise.function = stack::NoiseKind::turbulence;
  layer.noise.frequency = 1.3;
  layer.noise.power = 2;
  layer.common.scale = 0.1;
  return {layer};
}

Layers planar(double) {
  stack::PlanarLayer layer = planar_layer("heights", PlaneAxis::y, stack::Content::height);
  layer.map.tile = {0.7, -0.4};
  layer.map.rotate_deg = 25;
  layer.map.height = 0.2;
  return {layer};
}

std::function<Layers(double)> triplanar(stack::TriplanarContent content) {
  return [=](double) -> Layers {
    const bool directions = content == stack::TriplanarContent::object_normal;
    stack::TriplanarLayer layer = triplanar_layer({directions ? "directions" : "normals"}, content);
    layer.map.tile = {0.7, 0.5};
    layer.common.opacity = directions ? 0.3 : 1;
    return {layer};
  };
}

/// Large enough to hold the body, a second one over part of it, in object space.
std::function<Layers(double)> decal(stack::DecalShape shape, stack::DecalBlend second) {
  return [=](double) -> Layers {
    const bool round = shape == stack::DecalShape::sphere || shape == stack::DecalShape::capsule;
    stack::DecalLayer layer = decal_layer(round ? "cube" : "normals", shape);
    layer.space = stack::Space::object;
    layer.falloff = 0.3;
    layer.common.scale = round ? 0.1 : 0.7;
    stack::DecalInstance& first = layer.instances[0];
    first.direction = {0.4, -0.3, -1};
    first.roll_deg = 20;
    first.size = {6, 6, 6};
    first.radius = 4;
    first.length = 1.5;
    if (shape == stack::DecalShape::cone || shape == stack::DecalShape::wedge) {
      first.position = {-1.6, 1.2, 4};
      first.depth = 10;
      first.angle_deg = 80;
    }
    stack::DecalInstance other = first;
    other.position = other.position + vec3<double>{0.5, 0.3, 0.4};
    other.roll_deg = -50;
    other.blend = second;
    other.opacity = 0.6;
    layer.instances.push_back(other);
    return {layer};
  };
}

std::function<Layers(double)> parallax(stack::ParallaxMethod method) {
  return [=](double scale) -> Layers {
    stack::ParallaxLayer layer = parallax_layer("heights", 0.1 * scale);
    layer.method = method;
    layer.lod = stack::ParallaxLod::displaced;
    layer.map.tile = {2, -1};
    layer.map.rotate_deg = 20;
    layer.level = 0.3;
    // What comes after it reads every part of the point that it moved. (No tangent frame: the relief
    // shears texture coordinates, see Body.)
    stack::HeightMapLayer finer;
    finer.map.file.path = "heights";
    finer.map.tile = {3, 3};
    finer.height = 0.02 * scale;
    finer.taps = stack::Taps::bicubic;
    return {layer, finer, object_layer("directions")};
  };
}

} // namespace

std::vector<KindCase> every_kind() {
  using stack::DecalBlend;
  using stack::DecalShape;
  return {
      {.name = "normal_map", .layers = normal_map(stack::Basis::mikktspace), .vertex_tangents = true},
      {.name = "normal_map_derived", .layers = normal_map(stack::Basis::derived)},
      {.name = "normal_map_on_hex_tiles", .layers = normal_map(stack::Basis::derived, stack::Tiling::hex)},
      {.name = "derivative_map", .layers = derivative_map},
      {.name = "height_map_three_taps", .layers = scene_heights(stack::Taps::three), .one_sided = true},
      {.name = "height_map_bicubic", .layers = scene_heights(stack::Taps::bicubic)},
      {.name = "height_map_of_the_object", .layers = object_heights, .stretches = true},
      {.name = "height_map_scale_free", .layers = scale_free_heights},
      {.name = "object_normal_map", .layers = object_normal_map},
      {.name = "noise", .layers = noise, .stretches = true},
      {.name = "planar", .layers = planar, .stretches = true},
      {.name = "triplanar", .layers = triplanar(stack::TriplanarContent::normal), .stretches = true},
      {.name = "triplanar_normals", .layers = triplanar(stack::TriplanarContent::object_normal)},
      {.name = "decal_box", .layers = decal(DecalShape::box, DecalBlend::replace)},
      {.name = "decal_cone", .layers = decal(DecalShape::cone, DecalBlend::mix), .stretches = true},
      {.name = "decal_sphere", .layers = decal(DecalShape::sphere, DecalBlend::add)},
      {.name = "decal_capsule", .layers = decal(DecalShape::capsule, DecalBlend::mix)},
      {.name = "decal_wedge", .layers = decal(DecalShape::wedge, DecalBlend::add), .stretches = true},
      {.name = "parallax", .layers = parallax(stack::ParallaxMethod::occlusion), .moves = true},
      {.name = "parallax_offset", .layers = parallax(stack::ParallaxMethod::offset), .moves = true},
  };
}

} // namespace surfgrad::engine::test
