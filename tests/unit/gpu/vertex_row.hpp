#pragma once

#include "gpu/handle.hpp"
#include "gpu/instance.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace surfgrad::test {

using Pixel4 = std::array<float, 4>;

/// Runs graphics stages over a row of pixels, a vertex a pixel, into float targets, with the validation
/// layer.
class VertexRow {
 public:
  static constexpr std::uint32_t pixels = 4096; ///< the widest target that every device has

  VertexRow();
  VertexRow(const VertexRow&) = delete;
  VertexRow& operator=(const VertexRow&) = delete;

  struct Stages {
    std::span<const std::uint32_t> vertex;
    std::span<const std::uint32_t> geometry; ///< puts vertex i, a point, on pixel i
    std::span<const std::uint32_t> fragment;
  };

  /// vertices  two vec3 a vertex, at locations 0 and 1; as many vertices as pixels
  /// uniforms  binding 0 of the vertex and the fragment stage
  /// returns   [target][pixel]: what the fragment stage wrote to its first `targets` locations
  [[nodiscard]] std::vector<std::vector<Pixel4>> draw(const Stages& stages, std::span<const float> vertices,
                                                      std::span<const float> uniforms, std::uint32_t targets);

  /// What the validation layer said so far.
  [[nodiscard]] std::vector<std::string> messages() const { return instance_.messages(); }

 private:
  struct Destroy {
    void operator()(VkDevice device) const { vkDestroyDevice(device, nullptr); }
  };
  struct Buffer {
    gpu::Handle<VkDeviceMemory> memory;
    gpu::Handle<VkBuffer> buffer;
    float* mapped = nullptr;
  };
  struct Target {
    gpu::Handle<VkDeviceMemory> memory;
    gpu::Handle<VkImage> image;
    gpu::Handle<VkImageView> view;
  };

  [[nodiscard]] gpu::Handle<VkDeviceMemory> allocate(const VkMemoryRequirements& needs,
                                                     VkMemoryPropertyFlags wanted) const;
  [[nodiscard]] Buffer make_buffer(VkBufferUsageFlags usage, std::size_t floats,
                                   std::span<const float> contents = {}) const;
  [[nodiscard]] Target make_target() const;
  [[nodiscard]] gpu::Handle<VkRenderPass> make_pass(std::uint32_t targets) const;
  [[nodiscard]] gpu::Handle<VkPipeline> make_pipeline(const Stages& stages, VkPipelineLayout layout,
                                                      VkRenderPass pass, std::uint32_t targets) const;
  void run(const std::function<void(VkCommandBuffer)>& record) const;

  gpu::Instance instance_{true};
  VkPhysicalDevice physical_ = VK_NULL_HANDLE;
  std::unique_ptr<VkDevice_T, Destroy> device_;
  VkQueue queue_ = VK_NULL_HANDLE;
};

} // namespace surfgrad::test
