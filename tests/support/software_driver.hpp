#pragma once

namespace surfgrad::test {

/// Mesa's software driver for Vulkan, exact and the same on every machine, unless VK_ICD_FILENAMES names
/// another: for this process and those that it starts. Before the first call of Vulkan.
void choose_software_driver();

} // namespace surfgrad::test
