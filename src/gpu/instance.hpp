#pragma once

#include <vulkan/vulkan_core.h>

#include <mutex>
#include <string>
#include <vector>

namespace surfgrad::gpu {

/// Vulkan itself: what devices are found through.
class Instance {
 public:
  /// validate  run the validation layer and keep what it says; MachineError where it is not installed
  /// throws    MachineError where no driver is installed
  explicit Instance(bool validate);
  ~Instance();
  Instance(const Instance&) = delete;
  Instance& operator=(const Instance&) = delete;

  [[nodiscard]] VkInstance get() const { return instance_; }
  /// Errors and warnings of the validation layer so far, one text each.
  [[nodiscard]] std::vector<std::string> messages() const;

 private:
  static VKAPI_ATTR VkBool32 VKAPI_CALL keep_message(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                                     VkDebugUtilsMessageTypeFlagsEXT types,
                                                     const VkDebugUtilsMessengerCallbackDataEXT* data,
                                                     void* instance);

  VkInstance instance_ = VK_NULL_HANDLE;
  VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
  mutable std::mutex mutex_;
  std::vector<std::string> messages_;
};

} // namespace surfgrad::gpu
