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
  void texture(const Texture& t) {
    line("{} uv {} tile {} {} rotate {} offset {} {} wrap {} filter {}", t.file.path.string(), t.uv, t.tile.x,
         t.tile.y, t.rotate_deg, t.offset.x, t.offset.y, static_cast<int>(t.wrap),
         static_cast<int>(t.filter));
  }
  void map(const Map& m) {
    texture(m);
    line("green {}", static_cast<int>(m.green));
  }
  void common(const LayerCommon& c) {
    line("scale {} opacity {} blend {}", c.scale, c.opacity, static_cast<int>(c.blend));
    if (!c.mask) return;
    texture(*c.mask);
    line("channel {}", static_cast<int>(c.mask->channel));
  }
  void operator()(const NormalMapLayer& l) {
    line("normal_map basis {} channels {}", static_cast<int>(l.basis), static_cast<int>(l.map.channels));
    common(l.common);
    map(l.map);
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
