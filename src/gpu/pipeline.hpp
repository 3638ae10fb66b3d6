#pragma once

#include "gpu/buffer.hpp"
#include "gpu/shader.hpp"
#include "gpu/texture.hpp"

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

namespace surfgrad::gpu {

/// What a shader calls set = `set`, binding = `number`.
struct Binding {
  std::uint32_t number = 0;
  VkDescriptorType type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
  std::uint32_t count = 1; ///< of an array
  std::uint32_t set = 0;
};

/// A compute shader, ready to run.
class ComputePipeline {
 public:
  /// constant_bytes  size of the shader's push constants; 0 without
  /// throws          MachineError where the driver does not take the shader
  ComputePipeline(const Device& device, const Spirv& shader, std::vector<Binding> bindings,
                  std::uint32_t constant_bytes = 0);

  [[nodiscard]] VkPipeline get() const { return pipeline_.get(); }
  [[nodiscard]] VkPipelineLayout layout() const { return layout_.get(); }
  [[nodiscard]] std::vector<VkDescriptorSetLayout> set_layouts() const;
  [[nodiscard]] const std::vector<Binding>& bindings() const { return bindings_; }

 private:
  std::vector<Binding> bindings_;
  std::vector<Handle<VkDescriptorSetLayout>> set_layouts_;
  Handle<VkPipelineLayout> layout_;
  Handle<VkPipeline> pipeline_;
};

/// Pipelines that were compiled, by the text of their shaders. Any number of threads.
class PipelineCache {
 public:
  /// The pipeline of this text, made when it is first asked for.
  [[nodiscard]] std::shared_ptr<const ComputePipeline>
  pipeline(const std::string& text, const std::function<std::shared_ptr<const ComputePipeline>()>& make);

 private:
  std::mutex mutex_;
  std::map<std::string, std::shared_ptr<const ComputePipeline>> made_;
};

/// What a pipeline's bindings hold. All must be bound before a dispatch; what is bound must live through it.
class BoundResources {
 public:
  BoundResources(const Device& device, const ComputePipeline& pipeline);

  void bind(std::uint32_t binding, const Buffer& buffer, std::uint32_t set = 0, std::uint32_t element = 0);
  /// A combined image and sampler of set 0.
  void bind(std::uint32_t binding, const Texture& texture, VkSampler sampler, std::uint32_t element = 0) {
    bind(binding, texture.view(), sampler, element);
  }
  void bind(std::uint32_t binding, VkImageView texture, VkSampler sampler, std::uint32_t element = 0);

  /// Commands: runs the pipeline over `groups` workgroups.
  ///
  /// constants  as many bytes as the pipeline's push constants
  void dispatch(VkCommandBuffer commands, std::uint32_t groups_x, std::uint32_t groups_y = 1,
                std::span<const std::byte> constants = {}) const;

 private:
  [[nodiscard]] VkDescriptorType type_of(std::uint32_t binding, std::uint32_t set) const;

  VkDevice device_;
  const ComputePipeline* pipeline_;
  Handle<VkDescriptorPool> pool_;
  std::vector<VkDescriptorSet> sets_; // freed with the pool
};

} // namespace surfgrad::gpu
