#include "gpu/buffer.hpp"

#include "gpu/result.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

namespace surfgrad::gpu {

Buffer::Buffer(const Device& device, std::size_t bytes, Residence residence)
    : bytes_(std::max<std::size_t>(bytes, 4)) { // Vulkan has no empty buffers
  const std::string doing = fmt::format("allocate {} bytes on \"{}\"", bytes_, device.info().name);
  VkBufferCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
  info.size = bytes_;
  info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT |
               VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
  info.sharingMode = VK_SHARING_MODE_EXCLUSIVE;
  VkBuffer buffer = VK_NULL_HANDLE;
  check(vkCreateBuffer(device.get(), &info, nullptr, &buffer), doing);
  buffer_ = {device.get(), buffer, vkDestroyBuffer};

  VkMemoryRequirements needs{};
  vkGetBufferMemoryRequirements(device.get(), buffer, &needs);
  // Coherent memory needs no flushes; every device has some that is visible to the host.
  constexpr VkMemoryPropertyFlags host =
      VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
  VkMemoryAllocateInfo allocate{};
  allocate.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
  allocate.allocationSize = needs.size;
  switch (residence) {
  case Residence::device:
    allocate.memoryTypeIndex =
        device.memory_type(needs.memoryTypeBits, 0, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
    break;
  case Residence::upload:
    allocate.memoryTypeIndex = device.memory_type(needs.memoryTypeBits, host);
    break;
  case Residence::result: // reading memory that is not cached is slow
    allocate.memoryTypeIndex =
        device.memory_type(needs.memoryTypeBits, host, VK_MEMORY_PROPERTY_HOST_CACHED_BIT);
    break;
  }
  VkDeviceMemory memory = VK_NULL_HANDLE;
  check(vkAllocateMemory(device.get(), &allocate, nullptr, &memory), doing);
  memory_ = {device.get(), memory, vkFreeMemory};
  check(vkBindBufferMemory(device.get(), buffer, memory, 0), doing);
  if (residence == Residence::device) return;
  void* mapped = nullptr;
  check(vkMapMemory(device.get(), memory, 0, VK_WHOLE_SIZE, 0, &mapped), doing);
  mapped_ = static_cast<std::byte*>(mapped);
}

Buffer make_device_buffer(const Device& device, std::span<const std::byte> contents) {
  const Buffer staging(device, contents.size(), Residence::upload);
  if (!contents.empty()) std::memcpy(staging.mapped().data(), contents.data(), contents.size());
  Buffer buffer(device, contents.size(), Residence::device);
  device.run([&](VkCommandBuffer commands) {
    const VkBufferCopy all{0, 0, staging.bytes()};
    vkCmdCopyBuffer(commands, staging.get(), buffer.get(), 1, &all);
    barrier_after_writes(commands);
  });
  return buffer;
}

void barrier_after_writes(VkCommandBuffer commands) {
  VkMemoryBarrier barrier{};
  barrier.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
  barrier.srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT;
  barrier.dstAccessMask = VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT |
                          VK_ACCESS_UNIFORM_READ_BIT | VK_ACCESS_TRANSFER_READ_BIT |
                          VK_ACCESS_TRANSFER_WRITE_BIT | VK_ACCESS_HOST_READ_BIT;
  vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT,
                       VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT |
                           VK_PIPELINE_STAGE_HOST_BIT,
                       0, 1, &barrier, 0, nullptr, 0, nullptr);
}

} // namespace surfgrad::gpu
