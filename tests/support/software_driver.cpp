#include "support/software_driver.hpp"

#include <dlfcn.h>

#include <cstdlib>
#include <initializer_list>

/// LeakSanitizer: what the driver and its compiler never free is not ours.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libvulkan_lvp.so\nleak:libLLVM\nleak:libVkLayer_khronos_validation.so\n";
}

namespace surfgrad::test {

void choose_software_driver() {
  setenv("VK_ICD_FILENAMES", SURFGRAD_SOFTWARE_VULKAN, 0);
  // By default it filters textures with 8-bit weights and chooses levels for groups of pixels.
  setenv("GALLIVM_PERF", "no_brilinear,no_rho_approx,no_quad_lod,no_aos_sampling", 0);
  setenv("XDG_RUNTIME_DIR", "/tmp", 0); // else Mesa complains, though nothing is put there
  // Kept in memory after the last device, so that the suppressions above find their names.
  for (const char* library : {"libvulkan_lvp.so", "libVkLayer_khronos_validation.so"})
    static_cast<void>(dlopen(library, RTLD_NOW | RTLD_NODELETE));
}

} // namespace surfgrad::test
