/// A Vulkan layer between a program and the driver that makes a device fail, or be less than it is.
///
/// SURFGRAD_VULKAN_FAULTS says how, in words with a space between:
///
///   submit=N         the N-th submission of the process and all after it find the device lost
///   wait=N           the same of waits for what was submitted
///   allocate=N       the N-th allocation of memory finds too little of it
///   no-compute       no queue computes
///   vulkan-1.0       the driver knows no later version
///   NAME             the feature NAME of VkPhysicalDeviceFeatures is absent, see `features`
///   NAME=N           the limit NAME of VkPhysicalDeviceLimits is N, see `limits`
///   fill             memory holds 0x55 bytes once it is mapped, not the zeros that drivers give
///
/// SURFGRAD_VULKAN_COUNTS names a file that gets what a run did, as a device is destroyed: "uploads"
/// (submissions before the first dispatch was recorded), "submissions", "waits" and "allocations", a line
/// each.

#include <vulkan/vk_layer.h>
#include <vulkan/vulkan.h>

#include <atomic>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

namespace {

/// The rest of the word `NAME=REST` among the faults; empty rest for NAME alone.
std::optional<std::string_view> fault(std::string_view name) {
  const char* const words = std::getenv("SURFGRAD_VULKAN_FAULTS");
  for (std::string_view rest = words != nullptr ? words : ""; !rest.empty();) {
    const std::string_view word = rest.substr(0, rest.find(' '));
    rest.remove_prefix(word.size() < rest.size() ? word.size() + 1 : rest.size());
    if (word == name) return "";
    if (word.starts_with(name) && word[name.size()] == '=') return word.substr(name.size() + 1);
  }
  return {};
}

std::uint32_t number_of(std::string_view text) {
  std::uint32_t number = 0;
  std::from_chars(text.data(), text.data() + text.size(), number);
  return number;
}

/// Counts what happens and says whether it is the time that a fault names.
class Counter {
 public:
  explicit Counter(const char* fault_name) : fault_(fault_name) {}
  bool is_the_one() {
    const std::uint32_t now = ++count_;
    const auto which = fault(fault_);
    return which && number_of(*which) == now;
  }
  [[nodiscard]] std::uint32_t count() const { return count_; }

 private:
  const char* fault_;
  std::atomic<std::uint32_t> count_{0};
};

Counter submissions("submit");
Counter waits("wait");
Counter allocations("allocate");
std::atomic<std::uint32_t> uploads{0};
std::atomic<bool> dispatched{false};
std::atomic<bool> lost{false}; // and stays so

// What comes next in the chain, looked up while the chain is built: the loader answers later questions with
// its first layer. Found by the word that Vulkan's handles begin with: one an instance, with its physical
// devices, and one a device, with its queues and command buffers.

struct NextOfInstance {
  PFN_vkGetInstanceProcAddr get = nullptr;
  PFN_vkDestroyInstance destroy = nullptr;
  PFN_vkCreateDevice create_device = nullptr;
  PFN_vkGetPhysicalDeviceProperties properties = nullptr;
  PFN_vkGetPhysicalDeviceFeatures features = nullptr;
  PFN_vkGetPhysicalDeviceQueueFamilyProperties families = nullptr;
};

struct NextOfDevice {
  PFN_vkGetDeviceProcAddr get = nullptr;
  PFN_vkDestroyDevice destroy = nullptr;
  PFN_vkQueueSubmit submit = nullptr;
  PFN_vkWaitForFences wait = nullptr;
  PFN_vkAllocateMemory allocate = nullptr;
  PFN_vkMapMemory map = nullptr;
  PFN_vkCmdDispatch dispatch = nullptr;
};

std::mutex mutex;
std::map<void*, NextOfInstance> instances;
std::map<void*, NextOfDevice> devices;
std::map<VkDeviceMemory, VkDeviceSize> sizes; // of memory; a handle that comes again gets its new size

void* key_of(void* handle) {
  void* key = nullptr;
  std::memcpy(&key, handle, sizeof key);
  return key;
}

NextOfInstance next_of_instance(void* handle) {
  const std::scoped_lock lock(mutex);
  return instances.at(key_of(handle));
}

NextOfDevice next_of_device(void* handle) {
  const std::scoped_lock lock(mutex);
  return devices.at(key_of(handle));
}

/// The loader's link to the next layer, taken from the chain for that one to find its own.
template <class Info>
auto take_link(const void* chain, VkStructureType type) {
  auto* info = static_cast<Info*>(const_cast<void*>(chain));
  while (info->sType != type || info->function != VK_LAYER_LINK_INFO)
    info = static_cast<Info*>(const_cast<void*>(info->pNext));
  auto* const link = info->u.pLayerInfo;
  info->u.pLayerInfo = link->pNext;
  return link;
}

VKAPI_ATTR VkResult VKAPI_CALL create_instance(const VkInstanceCreateInfo* info,
                                               const VkAllocationCallbacks* allocator, VkInstance* instance) {
  auto* const link =
      take_link<VkLayerInstanceCreateInfo>(info->pNext, VK_STRUCTURE_TYPE_LOADER_INSTANCE_CREATE_INFO);
  const PFN_vkGetInstanceProcAddr get = link->pfnNextGetInstanceProcAddr;
  const auto create = reinterpret_cast<PFN_vkCreateInstance>(get(VK_NULL_HANDLE, "vkCreateInstance"));
  const VkResult result = create(info, allocator, instance);
  if (result != VK_SUCCESS) return result;
  NextOfInstance next{.get = get};
  const auto find = [&](auto& function, const char* name) {
    function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(get(*instance, name));
  };
  find(next.destroy, "vkDestroyInstance");
  find(next.create_device, "vkCreateDevice");
  find(next.properties, "vkGetPhysicalDeviceProperties");
  find(next.features, "vkGetPhysicalDeviceFeatures");
  find(next.families, "vkGetPhysicalDeviceQueueFamilyProperties");
  const std::scoped_lock lock(mutex);
  instances[key_of(*instance)] = next;
  return result;
}

VKAPI_ATTR void VKAPI_CALL destroy_instance(VkInstance instance, const VkAllocationCallbacks* allocator) {
  const auto next = next_of_instance(instance).destroy;
  {
    const std::scoped_lock lock(mutex);
    instances.erase(key_of(instance));
  }
  next(instance, allocator);
}

VKAPI_ATTR VkResult VKAPI_CALL create_device(VkPhysicalDevice physical, const VkDeviceCreateInfo* info,
                                             const VkAllocationCallbacks* allocator, VkDevice* device) {
  auto* const link =
      take_link<VkLayerDeviceCreateInfo>(info->pNext, VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO);
  const PFN_vkGetDeviceProcAddr get = link->pfnNextGetDeviceProcAddr;
  const auto create = next_of_instance(physical).create_device;
  const VkResult result = create(physical, info, allocator, device);
  if (result != VK_SUCCESS) return result;
  NextOfDevice next{.get = get};
  const auto find = [&](auto& function, const char* name) {
    function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(get(*device, name));
  };
  find(next.destroy, "vkDestroyDevice");
  find(next.submit, "vkQueueSubmit");
  find(next.wait, "vkWaitForFences");
  find(next.allocate, "vkAllocateMemory");
  find(next.map, "vkMapMemory");
  find(next.dispatch, "vkCmdDispatch");
  const std::scoped_lock lock(mutex);
  devices[key_of(*device)] = next;
  return result;
}

VKAPI_ATTR void VKAPI_CALL destroy_device(VkDevice device, const VkAllocationCallbacks* allocator) {
  const auto next = next_of_device(device).destroy;
  {
    const std::scoped_lock lock(mutex);
    devices.erase(key_of(device));
  }
  next(device, allocator);
  const char* const file = std::getenv("SURFGRAD_VULKAN_COUNTS");
  if (file == nullptr) return;
  std::ofstream(file) << "uploads " << uploads << "\nsubmissions " << submissions.count() << "\nwaits "
                      << waits.count() << "\nallocations " << allocations.count() << "\n";
}

const struct {
  const char* name;
  std::uint32_t VkPhysicalDeviceLimits::*member;
} limits[] = {
    {"maxStorageBufferRange", &VkPhysicalDeviceLimits::maxStorageBufferRange},
    {"maxUniformBufferRange", &VkPhysicalDeviceLimits::maxUniformBufferRange},
    {"maxPerStageDescriptorStorageBuffers", &VkPhysicalDeviceLimits::maxPerStageDescriptorStorageBuffers},
    {"maxPerStageResources", &VkPhysicalDeviceLimits::maxPerStageResources},
};

const struct {
  const char* name;
  VkBool32 VkPhysicalDeviceFeatures::*member;
} features[] = {
    {"robustBufferAccess", &VkPhysicalDeviceFeatures::robustBufferAccess},
};

VKAPI_ATTR void VKAPI_CALL get_properties(VkPhysicalDevice physical, VkPhysicalDeviceProperties* properties) {
  next_of_instance(physical).properties(physical, properties);
  for (const auto& each : limits)
    if (const auto less = fault(each.name)) properties->limits.*each.member = number_of(*less);
  if (const auto less = fault("maxComputeWorkGroupCount"))
    properties->limits.maxComputeWorkGroupCount[0] = number_of(*less);
  if (fault("vulkan-1.0")) properties->apiVersion = VK_API_VERSION_1_0;
}

VKAPI_ATTR void VKAPI_CALL get_features(VkPhysicalDevice physical, VkPhysicalDeviceFeatures* all) {
  next_of_instance(physical).features(physical, all);
  for (const auto& each : features)
    if (fault(each.name)) all->*each.member = VK_FALSE;
}

VKAPI_ATTR void VKAPI_CALL get_queue_families(VkPhysicalDevice physical, std::uint32_t* count,
                                              VkQueueFamilyProperties* families) {
  next_of_instance(physical).families(physical, count, families);
  if (families == nullptr || !fault("no-compute")) return;
  for (std::uint32_t i = 0; i < *count; ++i)
    families[i].queueFlags &= ~static_cast<VkQueueFlags>(VK_QUEUE_COMPUTE_BIT);
}

VKAPI_ATTR VkResult VKAPI_CALL queue_submit(VkQueue queue, std::uint32_t count, const VkSubmitInfo* submits,
                                            VkFence fence) {
  if (submissions.is_the_one()) lost = true;
  if (!dispatched) ++uploads;
  if (lost) return VK_ERROR_DEVICE_LOST;
  return next_of_device(queue).submit(queue, count, submits, fence);
}

VKAPI_ATTR VkResult VKAPI_CALL wait_for_fences(VkDevice device, std::uint32_t count, const VkFence* fences,
                                               VkBool32 all, std::uint64_t timeout) {
  // The driver's device still works on what was submitted before.
  const VkResult result = next_of_device(device).wait(device, count, fences, all, timeout);
  if (waits.is_the_one()) lost = true;
  return lost ? VK_ERROR_DEVICE_LOST : result;
}

VKAPI_ATTR VkResult VKAPI_CALL allocate_memory(VkDevice device, const VkMemoryAllocateInfo* info,
                                               const VkAllocationCallbacks* allocator,
                                               VkDeviceMemory* memory) {
  if (allocations.is_the_one()) return VK_ERROR_OUT_OF_DEVICE_MEMORY;
  const VkResult result = next_of_device(device).allocate(device, info, allocator, memory);
  if (result != VK_SUCCESS) return result;
  const std::scoped_lock lock(mutex);
  sizes[*memory] = info->allocationSize;
  return result;
}

VKAPI_ATTR VkResult VKAPI_CALL map_memory(VkDevice device, VkDeviceMemory memory, VkDeviceSize offset,
                                          VkDeviceSize size, VkMemoryMapFlags flags, void** data) {
  const VkResult result = next_of_device(device).map(device, memory, offset, size, flags, data);
  if (result != VK_SUCCESS || !fault("fill")) return result;
  const std::scoped_lock lock(mutex);
  std::memset(*data, 0x55, size == VK_WHOLE_SIZE ? sizes.at(memory) - offset : size);
  return result;
}

VKAPI_ATTR void VKAPI_CALL dispatch(VkCommandBuffer commands, std::uint32_t x, std::uint32_t y,
                                    std::uint32_t z) {
  dispatched = true;
  next_of_device(commands).dispatch(commands, x, y, z);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_instance_function(VkInstance instance, const char* name);
VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_device_function(VkDevice device, const char* name);

template <class Function>
PFN_vkVoidFunction plain(Function function) {
  return reinterpret_cast<PFN_vkVoidFunction>(function);
}

struct Own {
  const char* name;
  PFN_vkVoidFunction function;
};

const Own own_of_instances[] = {
    {"vkGetInstanceProcAddr", plain(get_instance_function)},
    {"vkCreateInstance", plain(create_instance)},
    {"vkDestroyInstance", plain(destroy_instance)},
    {"vkCreateDevice", plain(create_device)},
    {"vkGetPhysicalDeviceProperties", plain(get_properties)},
    {"vkGetPhysicalDeviceFeatures", plain(get_features)},
    {"vkGetPhysicalDeviceQueueFamilyProperties", plain(get_queue_families)},
};

const Own own_of_devices[] = {
    {"vkGetDeviceProcAddr", plain(get_device_function)},
    {"vkDestroyDevice", plain(destroy_device)},
    {"vkQueueSubmit", plain(queue_submit)},
    {"vkWaitForFences", plain(wait_for_fences)},
    {"vkAllocateMemory", plain(allocate_memory)},
    {"vkMapMemory", plain(map_memory)},
    {"vkCmdDispatch", plain(dispatch)},
};

template <std::size_t N>
PFN_vkVoidFunction own(const Own (&table)[N], std::string_view name) {
  for (const Own& each : table)
    if (each.name == name) return each.function;
  return nullptr;
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_instance_function(VkInstance instance, const char* name) {
  if (const auto function = own(own_of_instances, name)) return function;
  if (const auto function = own(own_of_devices, name)) return function;
  if (instance == VK_NULL_HANDLE) return nullptr;
  const std::scoped_lock lock(mutex);
  return instances.at(key_of(instance)).get(instance, name);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_device_function(VkDevice device, const char* name) {
  if (const auto function = own(own_of_devices, name)) return function;
  const std::scoped_lock lock(mutex);
  return devices.at(key_of(device)).get(device, name);
}

} // namespace

extern "C" VK_LAYER_EXPORT VKAPI_ATTR VkResult VKAPI_CALL
vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface* interface) {
  interface->loaderLayerInterfaceVersion = 2;
  interface->pfnGetInstanceProcAddr = get_instance_function;
  interface->pfnGetDeviceProcAddr = get_device_function;
  interface->pfnGetPhysicalDeviceProcAddr = nullptr;
  return VK_SUCCESS;
}
