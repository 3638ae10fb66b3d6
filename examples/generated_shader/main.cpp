// A stack with a map becomes a shader and runs: a sphere of plates under fine noise, drawn by a compute
// shader that calls the generated function. Writes sphere.png: the normals as colours.

#include "draw.hpp"
#include "io/image_file.hpp"
#include "scene/demo_maps.hpp"
#include "shadergen/shadergen.hpp"

#include <cstdio>

using namespace surfgrad;

const char* const document = R"({ "surfgrad": 1, "back_faces": "same", "layers": [
  { "type": "triplanar", "map": "plates", "space": "world", "scale": 0.8 },
  { "type": "noise", "function": "turbulence", "frequency": 9, "scale": -0.01, "space": "world" } ] })";

// A pixel sees the sphere straight from the front; what the layers read of it is known exactly.
const char* const color_of_pixel = R"(
vec4 color_of(vec2 pixel) {
  vec2 p = pixel / 128.0 - 1.0;
  float z = sqrt(max(1.0 - dot(p, p), 0.0));
  StackSurface s;
  s.position = s.world_position = s.normal = vec3(p, z);
  s.dp_dx = vec3(1.0, 0.0, -p.x / max(z, 0.01)) / 128.0;
  s.dp_dy = vec3(0.0, 1.0, -p.y / max(z, 0.01)) / 128.0;
  return vec4(z > 0.0 ? 0.5 + 0.5 * stack_normal(s).normal : vec3(0.0), 1.0);
})";

int main() {
  const stack::Stack stack = stack::parse_stack(document, "sphere.json");
  const shadergen::Shader shader = shadergen::generate(
      stack.layers, {.standalone = true, .back_faces = *stack.back_faces, .first_binding = 1});

  const gpu::Device device;
  const auto map = [](const stack::FileName&) { return scene::plates_normal_map(256); };
  const image::Image picture = examples::draw(device, shader, color_of_pixel, 256, map);
  io::write_image("sphere.png", picture, image::Depth::unorm8);
  std::printf("%s drew sphere.png\n", device.info().name.c_str());
}
