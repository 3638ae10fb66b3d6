#include "support/vulkan_faults.hpp"

#include <cstdlib>

namespace surfgrad::test {

VulkanFaults::VulkanFaults(const std::string& faults, const std::filesystem::path& counts) {
  setenv("VK_ADD_LAYER_PATH", SURFGRAD_VULKAN_LAYERS, 1);
  setenv("VK_INSTANCE_LAYERS", "VK_LAYER_SURFGRAD_faults", 1);
  setenv("SURFGRAD_VULKAN_FAULTS", faults.c_str(), 1);
  if (!counts.empty()) setenv("SURFGRAD_VULKAN_COUNTS", counts.c_str(), 1);
}

VulkanFaults::~VulkanFaults() {
  for (const char* name :
       {"VK_ADD_LAYER_PATH", "VK_INSTANCE_LAYERS", "SURFGRAD_VULKAN_FAULTS", "SURFGRAD_VULKAN_COUNTS"})
    unsetenv(name);
}

} // namespace surfgrad::test
