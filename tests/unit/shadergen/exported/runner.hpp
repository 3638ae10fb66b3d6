#pragma once

#include "exported/program.hpp"
#include "exported/textures.hpp"
#include "gpu/pipeline.hpp"

#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace surfgrad::shadergen::test {

/// The image of a file that a layer names; it lives as long as the runner.
using FindImage = std::function<const image::Image&(const std::filesystem::path&)>;

/// Runs exported functions on a device: parameters and decals as the generator says, maps as their files hold
/// them.
class Runner {
 public:
  explicit Runner(const gpu::Device& device) : device_(device), textures_(device) {}

  /// Bindings of the same program with other parameters, maps and inputs may be run on one pipeline.
  [[nodiscard]] std::shared_ptr<const gpu::ComputePipeline> pipeline(const Shader& shader,
                                                                     const gpu::Spirv& spirv) const;

  /// inputs   program.inputs floats an invocation
  /// origin   where the textures begin: what the shader was generated for
  /// returns  program.outputs floats an invocation
  [[nodiscard]] std::vector<float> run(const gpu::ComputePipeline& pipeline, const Shader& shader,
                                       const Program& program, TextureOrigin origin, const FindImage& find,
                                       std::span<const float> inputs);

 private:
  const gpu::Device& device_;
  Textures textures_;
};

} // namespace surfgrad::shadergen::test
