#pragma once

#include "lavapipe.hpp"

#include <vulkan/vulkan.h>

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace surfgrad::bench {

/// An empty structure of Vulkan's that knows its type.
template <class Structure>
[[nodiscard]] Structure started(VkStructureType type) {
  Structure s{};
  s.sType = type;
  return s;
}

/// Throws NoLavapipe unless the result is success.
void check(VkResult result, const char* what);

/// A Vulkan device on the processor, one queue, and what it takes to fill it.
struct VulkanDevice {
  struct Buffer {
    VkBuffer handle = VK_NULL_HANDLE;
    void* data = nullptr; ///< stays mapped
  };
  struct Image {
    VkImage handle = VK_NULL_HANDLE;
    VkImageView view = VK_NULL_HANDLE;
  };

  /// threads  of the driver. Throws NoLavapipe.
  explicit VulkanDevice(int threads);
  ~VulkanDevice();
  VulkanDevice(const VulkanDevice&) = delete;
  VulkanDevice& operator=(const VulkanDevice&) = delete;

  /// Memory that both sides see: lavapipe knows no other.
  VkDeviceMemory allocate(const VkMemoryRequirements& needs);
  Buffer make_buffer(VkBufferUsageFlags usage, std::size_t size, const void* content = nullptr);
  Image make_image(VkFormat format, int w, int h, int levels, VkImageUsageFlags usage,
                   VkImageAspectFlags aspect);
  VkShaderModule make_shader(std::span<const std::uint32_t> code);
  VkCommandBuffer begin_commands();
  /// Runs recorded commands and waits for them.
  void submit(VkCommandBuffer commands);
  static void change_layout(VkCommandBuffer commands, const Image& image, VkImageAspectFlags aspect,
                            VkImageLayout from, VkImageLayout to);
  /// Undoes what was made, backwards.
  void destroy();

  VkInstance instance = VK_NULL_HANDLE;
  VkPhysicalDevice physical = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  VkQueue queue = VK_NULL_HANDLE;
  VkCommandPool pool = VK_NULL_HANDLE;
  VkFence fence = VK_NULL_HANDLE;
  std::vector<std::function<void()>> made;
};

} // namespace surfgrad::bench
