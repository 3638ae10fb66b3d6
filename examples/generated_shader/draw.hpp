#pragma once

// What a renderer has anyway, the same for every generated shader: uploads and binds what the code reads,
// runs it over a picture. A shader without decals, that is.

#include "gpu/pipeline.hpp"
#include "image/image.hpp"
#include "image/pyramid.hpp"
#include "shadergen/shadergen.hpp"

#include <cstring>
#include <functional>
#include <string>
#include <vector>

namespace surfgrad::examples {

inline gpu::Addressing addressing(stack::Wrap wrap) {
  return wrap == stack::Wrap::repeat   ? gpu::Addressing::repeat
         : wrap == stack::Wrap::mirror ? gpu::Addressing::mirror
                                       : gpu::Addressing::clamp;
}

/// A square picture, colour by colour.
///
/// shader    its bindings begin at 1
/// color_of  GLSL: `vec4 color_of(vec2 pixel)`, which calls the shader's function
/// image_of  the maps, of three channels
inline image::Image draw(const gpu::Device& device, const shadergen::Shader& shader,
                         const std::string& color_of, int side,
                         const std::function<image::Image(const stack::FileName&)>& image_of) {
  const std::string main = R"(
layout(local_size_x = 8, local_size_y = 8) in;
layout(std430, binding = 0) buffer Picture { vec4 pixels[]; };
void main() {
  uvec2 at = gl_GlobalInvocationID.xy;
  pixels[at.y * 8u * gl_NumWorkGroups.x + at.x] = color_of(vec2(at) + 0.5);
})";
  const auto number = [](int binding) { return static_cast<std::uint32_t>(binding); };
  std::vector<gpu::Binding> bindings{{0}};
  if (!shader.parameters.empty())
    bindings.push_back({number(shader.parameters_binding), VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER});
  for (const shadergen::TextureBinding& t : shader.textures)
    bindings.push_back({number(t.binding), VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER});
  const gpu::ComputePipeline pipeline(
      device, gpu::compile({.text = "#version 450\n" + shader.source + color_of + main}), bindings);
  gpu::BoundResources resources(device, pipeline);

  image::Image picture = image::make_image(side, side, 4);
  const gpu::Buffer pixels(device, sizeof(float) * picture.texels.size(), gpu::Residence::result);
  resources.bind(0, pixels);
  gpu::Buffer parameters;
  if (!shader.parameters.empty()) {
    parameters = gpu::make_device_buffer(device, shader.parameter_data);
    resources.bind(number(shader.parameters_binding), parameters);
  }
  std::vector<gpu::Texture> textures; // live until the commands have run
  std::vector<gpu::Handle<VkSampler>> samplers;
  for (const shadergen::TextureBinding& t : shader.textures) {
    image::Image map = image_of(t.files[0]);
    textures.emplace_back(
        device, image::with_pyramid(image::rows_of(map.texels.floats(), map.width, 3), map.width, map.height, 3));
    samplers.push_back(
        gpu::make_sampler(device, gpu::Sampling::trilinear, addressing(t.wrap_s), addressing(t.wrap_t)));
    resources.bind(number(t.binding), textures.back(), samplers.back().get());
  }
  device.run([&](VkCommandBuffer commands) {
    resources.dispatch(commands, number(side / 8), number(side / 8));
    gpu::barrier_after_writes(commands);
  });
  std::memcpy(picture.texels.floats().data(), pixels.mapped().data(), pixels.mapped().size());
  return picture;
}

} // namespace surfgrad::examples
