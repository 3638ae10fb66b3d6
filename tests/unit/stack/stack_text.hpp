#pragma once

#include "stack/stack.hpp"

#include <fmt/format.h>

#include <string>

namespace surfgrad::stack::test {

/// Every value of a stack but lines and keys, for comparison: two stacks that say the same give the
/// same text.
struct StackText {
  std::string text{};

  template <class... Values>
  void line(fmt::format_string<Values...> form, Values&&... values) {
    text += fmt::format(form, std::forward<Values>(values)...) + "\n";
  }
  static std::string tiled(const Tiled& t) {
    std::string text =
        fmt::format("tile {} {} rotate {} offset {} {} wrap {} filter {}", t.tile.x, t.tile.y, t.rotate_deg,
                    t.offset.x, t.offset.y, static_cast<int>(t.wrap), static_cast<int>(t.filter));
    if (t.filter == Filter::anisotropic) text += fmt::format(" anisotropy {}", t.anisotropy);
    if (t.tiling == Tiling::hex) text += fmt::format(" hex turn {}", t.hex_turn_deg);
    return text;
  }
  void codes(const BumpCodes& b) {
    line("{}", tiled(b));
    line("channels {} green {} range {} neutral {} height_channel {} height {}", static_cast<int>(b.channels),
         static_cast<int>(b.green), b.derivative.range, static_cast<int>(b.derivative.neutral),
         static_cast<int>(b.height_channel), b.height);
  }
  void texture(const Texture& t) { line("{} uv {} {}", t.file.path.string(), t.uv, tiled(t)); }
  void map(const Map& m) {
    texture(m);
    line("green {}", static_cast<int>(m.green));
  }
  void common(const LayerCommon& c) {
    line("scale {} opacity {} blend {}", c.scale, c.opacity, static_cast<int>(c.blend));
    mask(c);
  }
  void mask(const LayerWeight& c) {
    if (!c.mask) return;
    texture(*c.mask);
    line("channel {}", static_cast<int>(c.mask->channel));
  }
  void operator()(const NormalMapLayer& l) {
    line("normal_map basis {} channels {}", static_cast<int>(l.basis), static_cast<int>(l.map.channels));
    common(l.common);
    map(l.map);
  }
  void operator()(const DerivativeMapLayer& l) {
    line("derivative_map basis {} range {} neutral {}", static_cast<int>(l.basis), l.code.range,
         static_cast<int>(l.code.neutral));
    common(l.common);
    map(l.map);
  }
  void operator()(const HeightMapLayer& l) {
    line("height_map channel {} mode {} height {} units {} taps {} basis {}", static_cast<int>(l.channel),
         static_cast<int>(l.mode), l.height, static_cast<int>(l.units), static_cast<int>(l.taps),
         l.basis ? static_cast<int>(*l.basis) : -1);
    common(l.common);
    texture(l.map);
  }
  void operator()(const ObjectNormalMapLayer& l) {
    line("object_normal_map space {}", static_cast<int>(l.space));
    common(l.common);
    map(l.map);
  }
  void noise(const NoiseFunction& n) {
    line("noise {} {} {} octaves {} {} {} power {} frequency {} offset {} {} {}",
         static_cast<int>(n.function), static_cast<int>(n.basis), static_cast<int>(n.worley), n.octaves,
         n.lacunarity, n.gain, n.power, n.frequency, n.offset.x, n.offset.y, n.offset.z);
  }
  void operator()(const NoiseLayer& l) {
    noise(l.noise);
    line("space {} method {}", static_cast<int>(l.space), static_cast<int>(l.method));
    common(l.common);
  }
  void operator()(const PlanarLayer& l) {
    line("planar {} axis {} space {} content {}", l.file.path.string(), static_cast<int>(l.axis),
         static_cast<int>(l.space), static_cast<int>(l.map.content));
    common(l.common);
    codes(l.map);
  }
  void operator()(const TriplanarLayer& l) {
    line("triplanar sharpness {} space {} content {}", l.sharpness, static_cast<int>(l.space),
         static_cast<int>(l.map.content));
    for (const FileName& file : l.files) line("map {}", file.path.string());
    line("convention {} {} {}", static_cast<int>(l.convention.handedness),
         static_cast<int>(l.convention.origin), static_cast<int>(l.convention.planes));
    common(l.common);
    codes(l.map);
  }
  void operator()(const DecalLayer& l) {
    line("decal shape {} space {} falloff {} gradient {}", static_cast<int>(l.shape),
         static_cast<int>(l.space), l.falloff, static_cast<int>(l.gradient));
    for (const FileName& file : l.files) line("{}", file.path.string());
    const BumpMap& m = l.map;
    line("{} content {} channels {} green {}", tiled(m), static_cast<int>(m.content),
         static_cast<int>(m.channels), static_cast<int>(m.green));
    line("range {} neutral {} channel {} height {}", m.derivative.range,
         static_cast<int>(m.derivative.neutral), static_cast<int>(m.height_channel), m.height);
    line("scale {} opacity {} blend {}", l.common.scale, l.common.opacity, static_cast<int>(l.blend));
    mask(l.common);
    for (const DecalInstance& i : l.instances) {
      line("at {} {} {} direction {} {} {} roll {}", i.position.x, i.position.y, i.position.z, i.direction.x,
           i.direction.y, i.direction.z, i.roll_deg);
      if (i.transform) line("transform {}", fmt::join(*i.transform, " "));
      line("size {} {} {} angle {} depth {} radius {} length {}", i.size.x, i.size.y, i.size.z, i.angle_deg,
           i.depth, i.radius, i.length);
      line("scale {} opacity {} blend {}", i.scale.value_or(-99), i.opacity.value_or(-99),
           i.blend ? static_cast<int>(*i.blend) : -99);
    }
  }
  void operator()(const ParallaxLayer& l) {
    line("parallax channel {} method {} height {} level {} limit {} lod {} normal {} curvature {} facing {} "
         "shadow {}",
         static_cast<int>(l.channel), static_cast<int>(l.method), l.height, l.level, l.limit_offset,
         static_cast<int>(l.lod), static_cast<int>(l.normal), l.curvature, static_cast<int>(l.facing),
         l.self_shadow);
    common(l.common);
    texture(l.map);
  }
  void operator()(const ResolveLayer&) { line("resolve"); }
  void layers(const std::vector<Layer>& list) {
    for (const Layer& layer : list) std::visit(*this, layer);
  }
  void point(const char* name, const std::optional<vec3<double>>& p) {
    if (p) line("{} {} {} {}", name, p->x, p->y, p->z);
  }
};

inline std::string text_of(const Stack& stack) {
  StackText out;
  if (stack.mesh) out.line("mesh {}", stack.mesh->path.string());
  for (const double weight : stack.morph.weights) out.line("morph {}", weight);
  if (stack.displace) {
    const Displace& d = *stack.displace;
    out.noise(d.noise);
    out.line("displace height {} level {} subdivide {} edges {}", d.height, d.level, d.subdivide,
             static_cast<int>(d.edges));
    if (d.map) {
      out.texture(*d.map);
      out.line("channel {}", static_cast<int>(d.map->channel));
    }
  }
  if (stack.back_faces) out.line("back_faces {}", static_cast<int>(*stack.back_faces));
  out.line("layers {}", stack.has_layers);
  out.layers(stack.layers);
  for (const auto& [name, material] : stack.materials) {
    out.line("material {}", name);
    out.layers(material.layers);
  }
  const Camera& camera = stack.camera;
  out.line("yaw {} pitch {} zoom {} fov {}", camera.yaw_deg, camera.pitch_deg, camera.zoom, camera.fov_deg);
  out.point("position", camera.position);
  out.point("target", camera.target);
  const Lights& lights = stack.lights;
  out.point("sun", lights.sun.value_or(Sun{}).direction);
  out.line("strength {} sky {}", lights.sun.value_or(Sun{}).strength, lights.sky);
  if (lights.environment) out.line("environment {}", lights.environment->path.string());
  return out.text;
}

} // namespace surfgrad::stack::test
