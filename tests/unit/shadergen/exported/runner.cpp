#include "exported/runner.hpp"

#include <cstring>
#include <map>

namespace surfgrad::shadergen::test {
namespace {

struct Numbers {
  std::uint32_t parameters, decals;
  std::map<std::uint32_t, const TextureBinding*> textures{}; ///< textures and samplers alike
};

/// A combined descriptor serves as either half, too.
Numbers numbers_of(const Shader& shader) {
  const bool hlsl = shader.language == Language::hlsl;
  const auto shifted = [&](int number, int by) {
    return static_cast<std::uint32_t>(number + (hlsl ? by : 0));
  };
  Numbers numbers{static_cast<std::uint32_t>(shader.parameters_binding),
                  shifted(shader.decals_binding, hlsl_texture_shift)};
  for (const TextureBinding& t : shader.textures) {
    numbers.textures.emplace(shifted(t.binding, hlsl_texture_shift), &t);
    if (!t.sampler.empty()) numbers.textures.emplace(shifted(t.sampler_binding, hlsl_sampler_shift), &t);
  }
  return numbers;
}

/// Godot's parameters are constants of the text.
bool has_parameter_block(const Shader& shader) {
  return !shader.parameters.empty() && shader.language != Language::godot;
}

} // namespace

std::shared_ptr<const gpu::ComputePipeline> Runner::pipeline(const Shader& shader,
                                                             const gpu::Spirv& spirv) const {
  const Numbers numbers = numbers_of(shader);
  std::vector<gpu::Binding> bindings{{Program::input_binding}, {Program::output_binding}};
  if (has_parameter_block(shader))
    bindings.push_back({numbers.parameters, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER});
  if (shader.decal_count > 0)
    bindings.push_back({numbers.decals, shader.decals_in_block ? VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER
                                                               : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER});
  for (const auto& [number, texture] : numbers.textures)
    bindings.push_back({number, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER});
  return std::make_shared<const gpu::ComputePipeline>(device_, spirv, bindings);
}

std::vector<float> Runner::run(const gpu::ComputePipeline& pipeline, const Shader& shader,
                               const Program& program, TextureOrigin origin, const FindImage& find,
                               std::span<const float> inputs) {
  const Numbers numbers = numbers_of(shader);
  const std::size_t count = inputs.size() / static_cast<std::size_t>(program.inputs);
  const std::size_t groups = (count + Program::group - 1) / Program::group;
  std::vector<float> padded(inputs.begin(), inputs.end());
  padded.resize(groups * Program::group * static_cast<std::size_t>(program.inputs));
  const gpu::Buffer input = gpu::make_device_buffer(device_, std::as_bytes(std::span(padded)));
  const gpu::Buffer output(
      device_, groups * Program::group * static_cast<std::size_t>(program.outputs) * sizeof(float),
      gpu::Residence::result);
  // No normal: a shader that writes nothing is seen.
  std::memset(output.mapped().data(), 0x55, output.mapped().size());
  gpu::BoundResources resources(device_, pipeline);
  resources.bind(Program::input_binding, input);
  resources.bind(Program::output_binding, output);
  gpu::Buffer parameters, decals;
  if (has_parameter_block(shader)) {
    parameters = gpu::make_device_buffer(device_, shader.parameter_data);
    resources.bind(numbers.parameters, parameters);
  }
  if (shader.decal_count > 0) {
    decals = gpu::make_device_buffer(device_, shader.decal_data);
    resources.bind(numbers.decals, decals);
  }
  for (const auto& [number, texture] : numbers.textures)
    resources.bind(number,
                   textures_.view_of(find(texture->files[0].path), texture->kind == MapKind::cube,
                                     origin == TextureOrigin::upper_left),
                   textures_.sampler_of(*texture));
  device_.run([&](VkCommandBuffer commands) {
    resources.dispatch(commands, static_cast<std::uint32_t>(groups));
    gpu::barrier_after_writes(commands);
  });
  std::vector<float> out(count * static_cast<std::size_t>(program.outputs));
  std::memcpy(out.data(), output.mapped().data(), out.size() * sizeof(float));
  return out;
}

} // namespace surfgrad::shadergen::test
