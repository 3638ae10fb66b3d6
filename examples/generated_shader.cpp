// A stack becomes a shader and runs: a sphere under two passes of noise, drawn by a compute shader that calls
// the generated function. Writes sphere.ppm: the normals as colours.

#include "gpu/pipeline.hpp"
#include "gpu/shader.hpp"
#include "shadergen/shadergen.hpp"

#include <algorithm>
#include <cstdio>
#include <fstream>

using namespace surfgrad;

const char* const document = R"({ "surfgrad": 1, "back_faces": "same", "layers": [
  { "type": "noise", "function": "turbulence", "frequency": 3, "scale": -0.15, "space": "world" },
  { "type": "resolve" },
  { "type": "noise", "function": "simplex", "frequency": 25, "scale": 0.01, "space": "world" } ] })";

// A pixel sees the sphere straight from the front; what the layers read of it is known exactly.
const char* const program = R"(
layout(local_size_x = 8, local_size_y = 8) in;
layout(std430, binding = 1) buffer Picture { vec4 pixels[]; };
void main() {
  vec2 p = (vec2(gl_GlobalInvocationID.x, 255u - gl_GlobalInvocationID.y) + 0.5) / 128.0 - 1.0;
  float z = sqrt(max(1.0 - dot(p, p), 0.0));
  StackSurface s;
  s.position = s.world_position = s.normal = vec3(p, z);
  s.dp_dx = vec3(1.0, 0.0, -p.x / max(z, 0.01)) / 128.0;
  s.dp_dy = vec3(0.0, 1.0, -p.y / max(z, 0.01)) / 128.0;
  pixels[gl_GlobalInvocationID.y * 256u + gl_GlobalInvocationID.x] =
      vec4(z > 0.0 ? stack_normal(s).normal : vec3(0.0), 1.0);
})";

int main() {
  const stack::Stack stack = stack::parse_stack(document, "noise.json");
  const shadergen::Shader shader =
      shadergen::generate(stack.layers, {.standalone = true, .back_faces = *stack.back_faces});

  const gpu::Device device;
  const gpu::ComputePipeline pipeline(device,
                                      gpu::compile({.text = "#version 450\n" + shader.source + program}),
                                      {{0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER}, {1}});
  const gpu::Buffer parameters = gpu::make_device_buffer(device, shader.parameter_data);
  const gpu::Buffer picture(device, 256 * 256 * 16, gpu::Residence::result);
  gpu::BoundResources resources(device, pipeline);
  resources.bind(0, parameters);
  resources.bind(1, picture);
  device.run([&](VkCommandBuffer commands) {
    resources.dispatch(commands, 32, 32);
    gpu::barrier_after_writes(commands);
  });

  std::ofstream file("sphere.ppm", std::ios::binary);
  file << "P6 256 256 255\n";
  const float* normals = reinterpret_cast<const float*>(picture.mapped().data());
  for (int i = 0; i < 256 * 256; ++i)
    for (int c = 0; c < 3; ++c)
      file.put(static_cast<char>(255 * std::clamp(0.5F * normals[4 * i + c] + 0.5F, 0.0F, 1.0F)));
  std::printf("%s drew sphere.ppm\n", device.info().name.c_str());
}
