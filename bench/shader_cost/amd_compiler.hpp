#pragma once

#include "gpu/handle.hpp"
#include "gpu/instance.hpp"
#include "gpu/shader.hpp"

#include <map>
#include <memory>
#include <string>

namespace surfgrad::bench {

/// Mesa's RADV, the Vulkan driver for AMD's GPUs, as a compiler alone: it pretends that the machine has one.
class AmdCompiler {
 public:
  /// family  as Mesa calls it: navi21, gfx1100 ...
  /// throws  MachineError where the driver is not installed or does not know the family
  explicit AmdCompiler(const std::string& family);

  /// What it calls itself, e.g. "Mesa 22.3.6".
  [[nodiscard]] const std::string& version() const { return version_; }

  /// What the driver says of a fragment shader that is fed by surface.vert, by its own names: "Instructions",
  /// "VGPRs", "Inverse Throughput" ...
  [[nodiscard]] std::map<std::string, std::uint64_t> statistics(const gpu::Spirv& fragment) const;

 private:
  struct Destroy {
    void operator()(VkDevice device) const { vkDestroyDevice(device, nullptr); }
  };

  std::unique_ptr<gpu::Instance> instance_;
  std::string version_;
  std::unique_ptr<VkDevice_T, Destroy> device_;
  gpu::Handle<VkShaderModule> vertex_;
  gpu::Handle<VkDescriptorSetLayout> set_layout_;
  gpu::Handle<VkPipelineLayout> layout_;
  gpu::Handle<VkRenderPass> pass_;
};

} // namespace surfgrad::bench
