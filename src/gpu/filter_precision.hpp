#pragma once

#include "gpu/device.hpp"
#include "gpu/filter_error.hpp"

namespace surfgrad::gpu {

/// What the limits promise: coordinates and levels of detail are snapped to multiples of 2^-bits of a texel
/// and of a level (subTexelPrecisionBits, mipmapPrecisionBits), to which side is not said.
[[nodiscard]] FilterPrecision promised_precision(const VkPhysicalDeviceLimits& limits);

/// What is promised or, where a driver does worse, what it does: Mesa's software driver blends levels within
/// half of their distance only, unless it is told not to. Measured on a small texture.
[[nodiscard]] FilterPrecision filter_precision(const Device& device);

} // namespace surfgrad::gpu
