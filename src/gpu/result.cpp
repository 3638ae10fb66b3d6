#include "gpu/result.hpp"

#include "diagnostic/error.hpp"

#include <fmt/format.h>

namespace surfgrad::gpu {

std::string_view meaning(VkResult result) {
  switch (result) {
  case VK_SUCCESS:
    return "done";
  case VK_NOT_READY:
    return "not ready";
  case VK_TIMEOUT:
    return "it took too long";
  case VK_INCOMPLETE:
    return "the list was cut short";
  case VK_ERROR_OUT_OF_HOST_MEMORY:
    return "not enough memory";
  case VK_ERROR_OUT_OF_DEVICE_MEMORY:
    return "not enough memory on the device";
  case VK_ERROR_INITIALIZATION_FAILED:
    return "the driver could not be initialised";
  case VK_ERROR_DEVICE_LOST:
    return "the device was lost";
  case VK_ERROR_MEMORY_MAP_FAILED:
    return "the device's memory cannot be mapped";
  case VK_ERROR_LAYER_NOT_PRESENT:
    return "a layer is not installed";
  case VK_ERROR_EXTENSION_NOT_PRESENT:
    return "the driver lacks an extension";
  case VK_ERROR_FEATURE_NOT_PRESENT:
    return "the driver lacks a feature";
  case VK_ERROR_INCOMPATIBLE_DRIVER:
    return "no Vulkan driver is installed";
  case VK_ERROR_TOO_MANY_OBJECTS:
    return "too many objects on the device";
  case VK_ERROR_FORMAT_NOT_SUPPORTED:
    return "the device lacks the format";
  case VK_ERROR_FRAGMENTED_POOL:
  case VK_ERROR_FRAGMENTATION:
    return "the device's memory is fragmented";
  case VK_ERROR_OUT_OF_POOL_MEMORY:
    return "not enough descriptors on the device";
  default:
    return "the driver failed";
  }
}

void check(VkResult result, std::string_view doing) {
  if (result == VK_SUCCESS) return;
  throw MachineError(
      fmt::format("cannot {}: {} (VkResult {})", doing, meaning(result), static_cast<int>(result)));
}

} // namespace surfgrad::gpu
