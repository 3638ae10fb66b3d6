#include "gpu/device.hpp"

#include "diagnostic/error.hpp"
#include "gpu/result.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace surfgrad::gpu {
namespace {

/// A device that Vulkan lists.
struct Candidate {
  VkPhysicalDevice physical = VK_NULL_HANDLE;
  VkPhysicalDeviceType type = VK_PHYSICAL_DEVICE_TYPE_OTHER;
  std::uint32_t queue_family = 0; ///< that computes
  DeviceInfo info{};
};

const char* kind_of(VkPhysicalDeviceType type) {
  switch (type) {
  case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
    return "discrete";
  case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
    return "integrated";
  case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
    return "virtual";
  case VK_PHYSICAL_DEVICE_TYPE_CPU:
    return "processor";
  default:
    return "other";
  }
}

/// Less is better.
int rank(const Candidate& candidate) {
  const int unusable = candidate.info.lacks.empty() ? 0 : 8;
  switch (candidate.type) {
  case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
    return unusable;
  case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
    return unusable + 1;
  case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
    return unusable + 2;
  case VK_PHYSICAL_DEVICE_TYPE_CPU:
    return unusable + 3;
  default:
    return unusable + 4;
  }
}

/// A queue family that computes and has no graphics runs beside a desktop's drawing; any other will do.
std::optional<std::uint32_t> computing_family(VkPhysicalDevice physical) {
  std::uint32_t count = 0;
  vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families.data());
  std::optional<std::uint32_t> found;
  for (std::uint32_t i = 0; i < count; ++i) {
    if ((families[i].queueFlags & VK_QUEUE_COMPUTE_BIT) == 0) continue;
    if ((families[i].queueFlags & VK_QUEUE_GRAPHICS_BIT) == 0) return i;
    if (!found) found = i;
  }
  return found;
}

Candidate described(VkPhysicalDevice physical) {
  Candidate candidate{.physical = physical};
  VkPhysicalDeviceProperties properties{};
  vkGetPhysicalDeviceProperties(physical, &properties);
  candidate.type = properties.deviceType;
  candidate.info.name = properties.deviceName;
  candidate.info.kind = kind_of(properties.deviceType);
  const std::uint32_t api = properties.apiVersion;
  candidate.info.driver = fmt::format("Vulkan {}.{}.{}", VK_API_VERSION_MAJOR(api), VK_API_VERSION_MINOR(api),
                                      VK_API_VERSION_PATCH(api));
  if (api < VK_API_VERSION_1_1)
    candidate.info.lacks = "Vulkan 1.1";
  else if (const auto family = computing_family(physical))
    candidate.queue_family = *family;
  else
    candidate.info.lacks = "a queue that computes";
  if (candidate.info.lacks.empty()) candidate.info.lacks = lacks(properties.limits);
  VkPhysicalDeviceFeatures features{};
  vkGetPhysicalDeviceFeatures(physical, &features);
  if (candidate.info.lacks.empty() && features.robustBufferAccess == VK_FALSE)
    candidate.info.lacks = "the feature robustBufferAccess";
  return candidate;
}

} // namespace

std::string lacks(const VkPhysicalDeviceLimits& limits) {
  // Of the pipelines that compose a material: fragments, results, values of the object; words, maps and
  // decals of the stack; its parameters. The rest every device has.
  const struct {
    const char* name;
    std::uint32_t has, needs;
  } rows[] = {
      {"maxPerStageDescriptorStorageBuffers", limits.maxPerStageDescriptorStorageBuffers, 6},
      {"maxDescriptorSetStorageBuffers", limits.maxDescriptorSetStorageBuffers, 6},
      {"maxPerStageDescriptorUniformBuffers", limits.maxPerStageDescriptorUniformBuffers, 1},
      {"maxPerStageResources", limits.maxPerStageResources, 7},
      {"maxBoundDescriptorSets", limits.maxBoundDescriptorSets, 2},
      {"maxComputeWorkGroupInvocations", limits.maxComputeWorkGroupInvocations, 64},
      {"maxComputeWorkGroupSize[0]", limits.maxComputeWorkGroupSize[0], 64},
      {"maxPushConstantsSize", limits.maxPushConstantsSize, 8},
  };
  for (const auto& row : rows)
    if (row.has < row.needs) return fmt::format("{} of {} or more: it has {}", row.name, row.needs, row.has);
  return {};
}

namespace {

std::vector<Candidate> candidates(const Instance& instance) {
  std::uint32_t count = 0;
  check(vkEnumeratePhysicalDevices(instance.get(), &count, nullptr), "list Vulkan's devices");
  std::vector<VkPhysicalDevice> devices(count);
  check(vkEnumeratePhysicalDevices(instance.get(), &count, devices.data()), "list Vulkan's devices");
  std::vector<Candidate> result;
  for (std::uint32_t i = 0; i < count; ++i) result.push_back(described(devices[i]));
  if (result.empty()) throw MachineError("cannot find a Vulkan device: no driver has one");
  std::stable_sort(result.begin(), result.end(),
                   [](const Candidate& a, const Candidate& b) { return rank(a) < rank(b); });
  return result;
}

} // namespace

std::vector<DeviceInfo> list_devices() {
  const Instance instance(false);
  std::vector<DeviceInfo> infos;
  for (const Candidate& candidate : candidates(instance)) infos.push_back(candidate.info);
  return infos;
}

Device::Device(const DeviceOptions& options) : instance_(options.validate) {
  const std::vector<Candidate> found = candidates(instance_);
  if (options.number < 0 || static_cast<std::size_t>(options.number) >= found.size())
    throw MachineError(fmt::format("cannot use Vulkan device {}: this machine's are 0 to {}", options.number,
                                   found.size() - 1));
  const Candidate& chosen = found[static_cast<std::size_t>(options.number)];
  if (!chosen.info.lacks.empty())
    throw MachineError(
        fmt::format("cannot use the Vulkan device \"{}\": it lacks {}", chosen.info.name, chosen.info.lacks));
  physical_ = chosen.physical;
  info_ = chosen.info;
  vkGetPhysicalDeviceProperties(physical_, &properties_);
  vkGetPhysicalDeviceMemoryProperties(physical_, &memory_);

  const float priority = 1;
  VkDeviceQueueCreateInfo queue{};
  queue.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
  queue.queueFamilyIndex = chosen.queue_family;
  queue.queueCount = 1;
  queue.pQueuePriorities = &priority;
  // A shader's fault must not read another program's memory.
  VkPhysicalDeviceFeatures features{};
  features.robustBufferAccess = VK_TRUE;
  VkDeviceCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
  info.pEnabledFeatures = &features;
  info.queueCreateInfoCount = 1;
  info.pQueueCreateInfos = &queue;
  VkDevice device = VK_NULL_HANDLE;
  check(vkCreateDevice(physical_, &info, nullptr, &device),
        fmt::format("open the Vulkan device \"{}\"", info_.name));
  device_.reset(device);
  vkGetDeviceQueue(device, chosen.queue_family, 0, &queue_);
  VkCommandPoolCreateInfo pool{};
  pool.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
  pool.flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT;
  pool.queueFamilyIndex = chosen.queue_family;
  VkCommandPool commands = VK_NULL_HANDLE;
  check(vkCreateCommandPool(device, &pool, nullptr, &commands), "make a command pool");
  pool_ = {device, commands, vkDestroyCommandPool};
}

VkFormatFeatureFlags Device::format_features(VkFormat format) const {
  VkFormatProperties properties{};
  vkGetPhysicalDeviceFormatProperties(physical_, format, &properties);
  return properties.optimalTilingFeatures;
}

bool Device::filters(VkFormat format) const {
  return (format_features(format) & VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT) != 0;
}

std::uint32_t Device::memory_type(std::uint32_t allowed, VkMemoryPropertyFlags wanted,
                                  VkMemoryPropertyFlags liked) const {
  for (const VkMemoryPropertyFlags flags : {wanted | liked, wanted})
    for (std::uint32_t i = 0; i < memory_.memoryTypeCount; ++i)
      if ((allowed >> i & 1) != 0 && (memory_.memoryTypes[i].propertyFlags & flags) == flags) return i;
  throw MachineError(
      fmt::format("cannot use the Vulkan device \"{}\": it lacks memory of the kind needed", info_.name));
}

void Device::run(const std::function<void(VkCommandBuffer)>& record) const {
  VkDevice const device = device_.get();
  const std::string doing = fmt::format("run commands on \"{}\"", info_.name);
  VkFenceCreateInfo fence_info{};
  fence_info.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO;
  VkFence made = VK_NULL_HANDLE;
  check(vkCreateFence(device, &fence_info, nullptr, &made), doing);
  const Handle<VkFence> fence(device, made, vkDestroyFence);

  std::unique_lock lock(mutex_);
  VkCommandBufferAllocateInfo allocate{};
  allocate.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
  allocate.commandPool = pool_.get();
  allocate.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
  allocate.commandBufferCount = 1;
  VkCommandBuffer commands = VK_NULL_HANDLE;
  check(vkAllocateCommandBuffers(device, &allocate, &commands), doing);
  // Freed on every way out, under the lock; the commands are done by then, or the device is lost.
  struct Free {
    const Device& device;
    std::unique_lock<std::mutex>& lock;
    VkCommandBuffer commands;
    ~Free() {
      if (!lock.owns_lock()) lock.lock();
      vkFreeCommandBuffers(device.get(), device.pool_.get(), 1, &commands);
    }
  } const free{*this, lock, commands};

  VkCommandBufferBeginInfo begin{};
  begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
  begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  check(vkBeginCommandBuffer(commands, &begin), doing);
  record(commands);
  check(vkEndCommandBuffer(commands), doing);

  VkSubmitInfo submit{};
  submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
  submit.commandBufferCount = 1;
  submit.pCommandBuffers = &commands;
  check(vkQueueSubmit(queue_, 1, &submit, made), doing);
  lock.unlock(); // others submit while these run
  const VkResult waited = vkWaitForFences(device, 1, &made, VK_TRUE, UINT64_MAX);
  // For want of memory it may fail while the commands still run.
  if (waited != VK_SUCCESS) vkDeviceWaitIdle(device);
  check(waited, doing);
}

} // namespace surfgrad::gpu
