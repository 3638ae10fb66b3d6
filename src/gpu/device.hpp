#pragma once

#include "gpu/handle.hpp"
#include "gpu/instance.hpp"

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace surfgrad::gpu {

/// A device as a user chooses it.
struct DeviceInfo {
  std::string name{};   ///< the driver's own
  std::string kind{};   ///< discrete, integrated, virtual, processor or other
  std::string driver{}; ///< driver and its version, as far as it tells
  std::string lacks{};  ///< why it cannot be used; empty if it can
};

/// Every Vulkan device of the machine in order of preference: usable ones first, discrete before integrated,
/// virtual and software ones; else as Vulkan lists them. Number 0 is what Device takes by default.
///
/// throws  MachineError where no driver is installed or no device is there
[[nodiscard]] std::vector<DeviceInfo> list_devices();

/// The first limit that is too low for composing a material, and its number; empty if none is.
[[nodiscard]] std::string lacks(const VkPhysicalDeviceLimits& limits);

struct DeviceOptions {
  int number = 0;        ///< of list_devices
  bool validate = false; ///< run the validation layer; for tests
};

/// A Vulkan device with one queue for computing; no window, no surface.
///
/// What a device makes (buffers, textures, pipelines) must not outlive it.
class Device {
 public:
  /// throws  MachineError where the device cannot be used: which feature it lacks
  explicit Device(const DeviceOptions& options = {});

  [[nodiscard]] const DeviceInfo& info() const { return info_; }
  [[nodiscard]] const VkPhysicalDeviceLimits& limits() const { return properties_.limits; }
  [[nodiscard]] VkDevice get() const { return device_.get(); }
  [[nodiscard]] VkPhysicalDevice physical() const { return physical_; }
  /// What a format can be used for when sampled as an image with optimal tiling.
  [[nodiscard]] VkFormatFeatureFlags format_features(VkFormat format) const;
  /// Whether hardware filters the format linearly: optional for R16G16_SNORM, R16_UNORM and R32G32_SFLOAT.
  [[nodiscard]] bool filters(VkFormat format) const;

  /// Errors and warnings of the validation layer so far; none without DeviceOptions::validate.
  [[nodiscard]] std::vector<std::string> messages() const { return instance_.messages(); }

  /// Index of a memory type among those of `allowed` that has all of `wanted`; the first that also has
  /// `liked`, if any.
  ///
  /// throws  MachineError if there is none
  [[nodiscard]] std::uint32_t memory_type(std::uint32_t allowed, VkMemoryPropertyFlags wanted,
                                          VkMemoryPropertyFlags liked = 0) const;

  /// Records commands, runs them and waits until they are done. Any number of threads at a time.
  ///
  /// throws  MachineError if the device is lost or runs out of memory
  void run(const std::function<void(VkCommandBuffer)>& record) const;

 private:
  Instance instance_;
  DeviceInfo info_;
  VkPhysicalDevice physical_ = VK_NULL_HANDLE;
  VkPhysicalDeviceProperties properties_{};
  VkPhysicalDeviceMemoryProperties memory_{};
  struct Destroy {
    void operator()(VkDevice device) const { vkDestroyDevice(device, nullptr); }
  };
  std::unique_ptr<VkDevice_T, Destroy> device_;
  VkQueue queue_ = VK_NULL_HANDLE;
  Handle<VkCommandPool> pool_;
  mutable std::mutex mutex_; // of the queue and the pool
};

} // namespace surfgrad::gpu
