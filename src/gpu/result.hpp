#pragma once

#include <vulkan/vulkan_core.h>

#include <string_view>

namespace surfgrad::gpu {

/// Throws MachineError unless `result` is VK_SUCCESS: what was being done and what the device lacks.
///
/// doing  completes "cannot ...", e.g. "allocate 4 MiB on the device"
void check(VkResult result, std::string_view doing);

/// What a result means, in words: "the device was lost", "not enough memory on the device" ...
[[nodiscard]] std::string_view meaning(VkResult result);

} // namespace surfgrad::gpu
