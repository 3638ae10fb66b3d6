#pragma once

#include "gpu/fragments.hpp"
#include "gpu/map_words.hpp"
#include "gpu/pipeline.hpp"
#include "shadergen/shadergen.hpp"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace surfgrad::gpu {

/// An attribute of fragments that a shader reads.
struct StackAttribute {
  Attribute attribute = Attribute::normal;
  int uv = 0;
};

/// A generated shader with `exact` access and diagnostics, and all that it reads of its stack: ready to
/// compose fragments.
class StackPipeline {
 public:
  /// maps      of the shader
  /// words     of those maps
  /// cache     of pipelines: stacks that differ in numbers and maps alone share theirs
  /// material  its name, for messages
  /// throws    MachineError where it exceeds the device's limits
  StackPipeline(const Device& device, const shadergen::Shader& shader, const std::vector<StackMap>& maps,
                const MapWords& words, PipelineCache& cache, const std::string& material);

  /// Arrays of a batch of fragments, in this order, each of floats_of its attribute.
  [[nodiscard]] const std::vector<StackAttribute>& attributes() const { return attributes_; }
  [[nodiscard]] std::size_t fragment_floats() const { return fragment_floats_; }
  /// Textures that hardware filters.
  [[nodiscard]] std::size_t sampled_count() const { return stack_textures_.size(); }
  [[nodiscard]] bool has_sunlight() const { return has_sunlight_; }
  [[nodiscard]] bool wants(Attribute attribute) const;

  /// Results of a fragment: normal, base normal, degenerate (1 or 0), sunlight. Arrays as those of fragments.
  static constexpr std::size_t result_floats = 8;

  /// What an object's placement says, in the order and layout of the shader.
  [[nodiscard]] std::vector<float> object_values(const engine::Placement& placement) const;

  /// Fragments, results and an object's values bound to the pipeline. One thread at a time uses each.
  ///
  /// The buffers must outlive it.
  [[nodiscard]] BoundResources bound(const Buffer& fragments, const Buffer& results,
                                     const Buffer& object) const;

  /// Commands: composes `count` fragments whose arrays are `stride` floats apart.
  void compose(VkCommandBuffer commands, const BoundResources& resources, std::uint32_t count,
               std::uint32_t stride) const;

 private:
  const Device& device_;
  std::vector<StackAttribute> attributes_;
  std::vector<shadergen::SurfaceMember> object_members_;
  std::size_t fragment_floats_ = 0;
  bool has_sunlight_ = false;
  struct SetZero {
    std::uint32_t binding;
    std::uint32_t element; ///< of an array
    Buffer buffer;
  };
  std::vector<SetZero> stack_buffers_;
  struct SampledMap {
    std::uint32_t binding;
    std::shared_ptr<const Texture> texture; // layers share them
    Handle<VkSampler> sampler;
  };
  std::vector<SampledMap> stack_textures_;
  void add_textures(const shadergen::Shader& shader, const std::vector<StackMap>& maps);
  std::shared_ptr<const ComputePipeline> pipeline_;
};

} // namespace surfgrad::gpu
