#include "vulkan_device.hpp"

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>

namespace surfgrad::bench {
namespace {

/// The loader must find lavapipe alone, and drivers want a folder of their own.
void choose_driver(int threads) {
  setenv("LP_NUM_THREADS", std::to_string(threads).c_str(), 1);
  setenv("XDG_RUNTIME_DIR", std::filesystem::temp_directory_path().c_str(), 0);
  const std::filesystem::path folder = "/usr/share/vulkan/icd.d";
  if (!std::filesystem::is_directory(folder)) return;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().filename().string().starts_with("lvp_icd"))
      setenv("VK_ICD_FILENAMES", entry.path().c_str(), 0);
}

} // namespace

void check(VkResult result, const char* what) {
  if (result != VK_SUCCESS) throw NoLavapipe(std::string(what) + " failed: " + std::to_string(result));
}

VulkanDevice::~VulkanDevice() {
  if (device != VK_NULL_HANDLE) vkDeviceWaitIdle(device);
  destroy();
}

void VulkanDevice::destroy() {
  for (auto step = made.rbegin(); step != made.rend(); ++step) (*step)();
  made.clear();
}

VulkanDevice::VulkanDevice(int threads) {
  choose_driver(threads);
  auto application = started<VkApplicationInfo>(VK_STRUCTURE_TYPE_APPLICATION_INFO);
  application.apiVersion = VK_API_VERSION_1_3;
  auto info = started<VkInstanceCreateInfo>(VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO);
  info.pApplicationInfo = &application;
  check(vkCreateInstance(&info, nullptr, &instance), "vkCreateInstance");
  made.push_back([this] { vkDestroyInstance(instance, nullptr); });
  std::uint32_t count = 1;
  vkEnumeratePhysicalDevices(instance, &count, &physical);
  if (count == 0) throw NoLavapipe("no Vulkan device");
  VkPhysicalDeviceProperties properties;
  vkGetPhysicalDeviceProperties(physical, &properties);
  if (properties.deviceType != VK_PHYSICAL_DEVICE_TYPE_CPU) throw NoLavapipe("no Vulkan on the processor");
  const float priority = 1;
  auto queue_info = started<VkDeviceQueueCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO);
  queue_info.queueCount = 1;
  queue_info.pQueuePriorities = &priority;
  auto features =
      started<VkPhysicalDeviceVulkan13Features>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES);
  features.dynamicRendering = VK_TRUE;
  auto device_info = started<VkDeviceCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO);
  device_info.pNext = &features;
  device_info.queueCreateInfoCount = 1;
  device_info.pQueueCreateInfos = &queue_info;
  check(vkCreateDevice(physical, &device_info, nullptr, &device), "vkCreateDevice");
  made.push_back([this] { vkDestroyDevice(device, nullptr); });
  vkGetDeviceQueue(device, 0, 0, &queue);
  auto pool_info = started<VkCommandPoolCreateInfo>(VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO);
  check(vkCreateCommandPool(device, &pool_info, nullptr, &pool), "vkCreateCommandPool");
  made.push_back([this] { vkDestroyCommandPool(device, pool, nullptr); });
  auto fence_info = started<VkFenceCreateInfo>(VK_STRUCTURE_TYPE_FENCE_CREATE_INFO);
  check(vkCreateFence(device, &fence_info, nullptr, &fence), "vkCreateFence");
  made.push_back([this] { vkDestroyFence(device, fence, nullptr); });
}

VkDeviceMemory VulkanDevice::allocate(const VkMemoryRequirements& needs) {
  VkPhysicalDeviceMemoryProperties properties;
  vkGetPhysicalDeviceMemoryProperties(physical, &properties);
  constexpr VkMemoryPropertyFlags wanted =
      VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
  for (std::uint32_t type = 0; type < properties.memoryTypeCount; ++type) {
    if ((needs.memoryTypeBits >> type & 1U) == 0 ||
        (properties.memoryTypes[type].propertyFlags & wanted) != wanted)
      continue;
    auto info = started<VkMemoryAllocateInfo>(VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO);
    info.allocationSize = needs.size;
    info.memoryTypeIndex = type;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    check(vkAllocateMemory(device, &info, nullptr, &memory), "vkAllocateMemory");
    made.push_back([this, memory] { vkFreeMemory(device, memory, nullptr); });
    return memory;
  }
  throw NoLavapipe("no memory that both sides see");
}

VulkanDevice::Buffer VulkanDevice::make_buffer(VkBufferUsageFlags usage, std::size_t size,
                                               const void* content) {
  auto info = started<VkBufferCreateInfo>(VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO);
  info.size = size;
  info.usage = usage;
  Buffer buffer;
  check(vkCreateBuffer(device, &info, nullptr, &buffer.handle), "vkCreateBuffer");
  made.push_back([this, handle = buffer.handle] { vkDestroyBuffer(device, handle, nullptr); });
  VkMemoryRequirements needs;
  vkGetBufferMemoryRequirements(device, buffer.handle, &needs);
  VkDeviceMemory memory = allocate(needs);
  vkBindBufferMemory(device, buffer.handle, memory, 0);
  check(vkMapMemory(device, memory, 0, VK_WHOLE_SIZE, 0, &buffer.data), "vkMapMemory");
  if (content != nullptr) std::memcpy(buffer.data, content, size);
  return buffer;
}

VulkanDevice::Image VulkanDevice::make_image(VkFormat format, int w, int h, int levels,
                                             VkImageUsageFlags usage, VkImageAspectFlags aspect) {
  auto info = started<VkImageCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO);
  info.imageType = VK_IMAGE_TYPE_2D;
  info.format = format;
  info.extent = {static_cast<std::uint32_t>(w), static_cast<std::uint32_t>(h), 1};
  info.mipLevels = static_cast<std::uint32_t>(levels);
  info.arrayLayers = 1;
  info.samples = VK_SAMPLE_COUNT_1_BIT;
  info.tiling = VK_IMAGE_TILING_OPTIMAL;
  info.usage = usage;
  Image image;
  check(vkCreateImage(device, &info, nullptr, &image.handle), "vkCreateImage");
  made.push_back([this, handle = image.handle] { vkDestroyImage(device, handle, nullptr); });
  VkMemoryRequirements needs;
  vkGetImageMemoryRequirements(device, image.handle, &needs);
  vkBindImageMemory(device, image.handle, allocate(needs), 0);
  auto view = started<VkImageViewCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO);
  view.image = image.handle;
  view.viewType = VK_IMAGE_VIEW_TYPE_2D;
  view.format = format;
  view.subresourceRange = {aspect, 0, static_cast<std::uint32_t>(levels), 0, 1};
  check(vkCreateImageView(device, &view, nullptr, &image.view), "vkCreateImageView");
  made.push_back([this, handle = image.view] { vkDestroyImageView(device, handle, nullptr); });
  return image;
}

VkCommandBuffer VulkanDevice::begin_commands() {
  auto info = started<VkCommandBufferAllocateInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO);
  info.commandPool = pool;
  info.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
  info.commandBufferCount = 1;
  VkCommandBuffer commands = VK_NULL_HANDLE;
  check(vkAllocateCommandBuffers(device, &info, &commands), "vkAllocateCommandBuffers");
  auto begin = started<VkCommandBufferBeginInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO);
  check(vkBeginCommandBuffer(commands, &begin), "vkBeginCommandBuffer");
  return commands;
}

void VulkanDevice::submit(VkCommandBuffer commands) {
  auto info = started<VkSubmitInfo>(VK_STRUCTURE_TYPE_SUBMIT_INFO);
  info.commandBufferCount = 1;
  info.pCommandBuffers = &commands;
  check(vkQueueSubmit(queue, 1, &info, fence), "vkQueueSubmit");
  check(vkWaitForFences(device, 1, &fence, VK_TRUE, UINT64_MAX), "vkWaitForFences");
  vkResetFences(device, 1, &fence);
}

void VulkanDevice::change_layout(VkCommandBuffer commands, const Image& image, VkImageAspectFlags aspect,
                                 VkImageLayout from, VkImageLayout to) {
  auto barrier = started<VkImageMemoryBarrier>(VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER);
  barrier.srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT | VK_ACCESS_MEMORY_READ_BIT;
  barrier.dstAccessMask = VK_ACCESS_MEMORY_WRITE_BIT | VK_ACCESS_MEMORY_READ_BIT;
  barrier.oldLayout = from;
  barrier.newLayout = to;
  barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.image = image.handle;
  barrier.subresourceRange = {aspect, 0, VK_REMAINING_MIP_LEVELS, 0, 1};
  vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0,
                       nullptr, 0, nullptr, 1, &barrier);
}

VkShaderModule VulkanDevice::make_shader(std::span<const std::uint32_t> code) {
  auto info = started<VkShaderModuleCreateInfo>(VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO);
  info.codeSize = code.size_bytes();
  info.pCode = code.data();
  VkShaderModule shader = VK_NULL_HANDLE;
  check(vkCreateShaderModule(device, &info, nullptr, &shader), "vkCreateShaderModule");
  made.push_back([this, shader] { vkDestroyShaderModule(device, shader, nullptr); });
  return shader;
}

} // namespace surfgrad::bench
