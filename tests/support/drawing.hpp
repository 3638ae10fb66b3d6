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

/// Runs graphics stages into float targets and storage buffers, with the validation layer, on the device that
/// Vulkan lists first.
class Drawing {
 public:
  Drawing();
  Drawing(const Drawing&) = delete;
  Drawing& operator=(const Drawing&) = delete;

  struct Stages {
    std::span<const std::uint32_t> vertex;
    std::span<const std::uint32_t> geometry; ///< may be empty
    std::span<const std::uint32_t> fragment;
  };
  /// A buffer of the vertex and the fragment stage.
  struct Bound {
    VkDescriptorType type = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    std::span<const float> contents{};
    std::span<float> results{}; ///< what it holds afterwards is copied here
  };
  struct Picture {
    Stages stages{};
    VkExtent2D size{};
    VkExtent2D viewport{}; ///< where larger than the picture, which is its upper left part; else the picture
    VkPrimitiveTopology topology = VK_PRIMITIVE_TOPOLOGY_POINT_LIST;
    std::span<const float> vertices{}; ///< two vec3 a vertex, at locations 0 and 1; may be empty
    std::uint32_t vertex_count = 0;
    std::vector<Bound> bound{}; ///< bindings 0, 1, ... of set 0
    std::uint32_t targets = 0;  ///< locations of the fragment stage
  };

  /// returns  [target][pixel, row by row]: what the fragment stage wrote to its locations
  [[nodiscard]] std::vector<std::vector<Pixel4>> draw(const Picture& picture);

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
  [[nodiscard]] Target make_target(VkExtent2D size) const;
  [[nodiscard]] gpu::Handle<VkRenderPass> make_pass(std::uint32_t targets) const;
  [[nodiscard]] gpu::Handle<VkPipeline> make_pipeline(const Picture& picture, VkPipelineLayout layout,
                                                      VkRenderPass pass) const;
  void run(const std::function<void(VkCommandBuffer)>& record) const;

  gpu::Instance instance_{true};
  VkPhysicalDevice physical_ = VK_NULL_HANDLE;
  std::unique_ptr<VkDevice_T, Destroy> device_;
  VkQueue queue_ = VK_NULL_HANDLE;
};

} // namespace surfgrad::test
