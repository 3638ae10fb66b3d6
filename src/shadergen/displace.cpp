#include "shadergen/displace.hpp"

#include "shadergen/heights.hpp"
#include "shadergen/noise_function.hpp"

namespace surfgrad::shadergen {
namespace {

constexpr const char* result = "// A vertex where the relief has moved it.\n"
                               "struct StackVertex {\n"
                               "  vec3 position;\n"
                               "  vec3 normal; // unit\n"
                               "};\n\n";

std::string of_noise(Generator& g, const stack::Displace& displace, const std::string& height,
                     const std::string& level) {
  return fmt::format("// A vertex displaced along its normal, in the object's space. Noise, planar and "
                     "triplanar layers take the\n"
                     "// position from before.\n"
                     "StackVertex stack_displaced(vec3 position, vec3 normal) {{\n"
                     "  vec3 n = surfgrad_normalize_or_zero(normal);\n"
                     "  SurfgradNoise noise = {}(position, 0.0);\n"
                     "  vec3 surfgrad = {} * surfgrad_from_volume_gradient(n, noise.gradient);\n"
                     "  StackVertex v;\n"
                     "  v.position = position + ({} * (noise.value - {})) * n;\n"
                     "  v.normal = surfgrad_normalize_or_zero(n - surfgrad);\n"
                     "  return v;\n"
                     "}}\n",
                     noise_function(g, displace.noise, "noise"), height, height, level);
}

std::string of_map(Generator& g, const stack::Displace& displace, const std::string& height,
                   const std::string& level) {
  TextureBinding binding = binding_of(MapKind::heights, *displace.map);
  binding.channel = displace.map->channel;
  const MapUse map(g, *displace.map, std::move(binding), "map");
  return fmt::format(
      "// A vertex displaced along its normal, in the object's space. dp_ds and dp_dt are the derivatives of "
      "the\n"
      "// position by the texture coordinate of UV set {}: of a mesh, constant over a triangle.\n"
      "StackVertex stack_displaced(vec3 position, vec3 normal, vec2 st, vec3 dp_ds, vec3 dp_dt) {{\n"
      "  vec3 n = surfgrad_normalize_or_zero(normal);\n"
      "  vec3 smooth_height = {}({});\n"
      "  vec2 dh = {} * ({});\n"
      "  vec3 surfgrad = surfgrad_from_parametric_derivative(n, dp_ds, dp_dt, dh);\n"
      "  StackVertex v;\n"
      "  v.position = position + ({} * (smooth_height.z - {})) * n;\n"
      "  v.normal = surfgrad_normalize_or_zero(n - surfgrad);\n"
      "  return v;\n"
      "}}\n",
      displace.map->uv, smooth_function(map, g), map.map_coordinate("st"), height,
      map.by_coordinate("smooth_height.xy"), height, level);
}

} // namespace

std::string vertex_stage(Generator& g, const stack::Displace& displace) {
  g.begin_part("displace");
  const std::string height =
      g.parameter("height", "object units by which a value of 1 moves", displace.height);
  const std::string level = g.parameter("level", "the value that stays on the mesh", displace.level);
  return result + (displace.map ? of_map(g, displace, height, level) : of_noise(g, displace, height, level));
}

} // namespace surfgrad::shadergen
