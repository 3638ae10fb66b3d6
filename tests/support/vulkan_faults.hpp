#pragma once

#include <filesystem>
#include <string>

namespace surfgrad::test {

/// Puts the layer of tests/support/vulkan_faults before the driver, for what this process starts of Vulkan
/// and the processes that it starts, until the end of the scope.
class VulkanFaults {
 public:
  /// faults  words of the layer, e.g. "submit=3"
  /// counts  file that gets what a run did; none if empty
  explicit VulkanFaults(const std::string& faults, const std::filesystem::path& counts = {});
  ~VulkanFaults();
  VulkanFaults(const VulkanFaults&) = delete;
  VulkanFaults& operator=(const VulkanFaults&) = delete;
};

} // namespace surfgrad::test
