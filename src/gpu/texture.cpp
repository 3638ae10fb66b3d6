#include "gpu/texture.hpp"

#include "diagnostic/error.hpp"
#include "gpu/result.hpp"

#include <fmt/format.h>

#include <bit>
#include <cstring>
#include <vector>

namespace surfgrad::gpu {
namespace {

using image::Map;
using image::TexelFormat;

constexpr double largest_snorm = 32767;
constexpr double largest_unorm = 65535;

bool is_sampled(const Device& device, VkFormat format) {
  constexpr VkFormatFeatureFlags needed =
      VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT | VK_FORMAT_FEATURE_TRANSFER_DST_BIT;
  return (device.format_features(format) & needed) == needed;
}

std::optional<TextureFormat> format_of_codes(const Map& map) {
  switch (map.format) {
  case TexelFormat::slope16:
    return TextureFormat{VK_FORMAT_R16G16_SNORM, 2, largest_snorm * map.scale};
  case TexelFormat::unorm16:
    return TextureFormat{VK_FORMAT_R16_UNORM, 1, largest_unorm * map.scale};
  case TexelFormat::floats:
    break;
  }
  return std::nullopt;
}

/// Every device samples these.
TextureFormat format_of_floats(const Map& map) {
  switch (map.components) {
  case 1:
    return {VK_FORMAT_R32_SFLOAT, 1, 1};
  case 2:
    return {VK_FORMAT_R32G32_SFLOAT, 2, 1};
  default:
    return {VK_FORMAT_R32G32B32A32_SFLOAT, 4, 1};
  }
}

std::size_t bytes_of_texel(const TextureFormat& format) {
  switch (format.format) {
  case VK_FORMAT_R16_UNORM:
    return 2;
  case VK_FORMAT_R16G16_SNORM:
    return 4;
  default:
    return 4 * static_cast<std::size_t>(format.components);
  }
}

template <class T>
std::byte* append(std::byte* to, T value) {
  std::memcpy(to, &value, sizeof(value));
  return to + sizeof(value);
}

/// A level's texels without the copies at its borders.
std::byte* write_level(const Map& map, int level, const TextureFormat& format, std::byte* to) {
  for (int y = 0; y < map.height(level); ++y)
    for (int x = 0; x < map.width(level); ++x) {
      const std::uint32_t word = map.words[map.word(level, x, y)];
      switch (format.format) {
      case VK_FORMAT_R16_UNORM:
        to = append(to, static_cast<std::uint16_t>(word & 0xffffu));
        break;
      case VK_FORMAT_R16G16_SNORM:
        to = append(to, word);
        break;
      default:
        for (int c = 0; c < format.components; ++c)
          to = append(to, c < map.components ? static_cast<float>(map.value(level, x, y, c)) : 0.0f);
      }
    }
  return to;
}

void transition(VkCommandBuffer commands, VkImage image, std::uint32_t levels, bool for_sampling) {
  VkImageMemoryBarrier barrier{};
  barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER;
  barrier.srcAccessMask = for_sampling ? VK_ACCESS_TRANSFER_WRITE_BIT : 0;
  barrier.dstAccessMask = for_sampling ? VK_ACCESS_SHADER_READ_BIT : VK_ACCESS_TRANSFER_WRITE_BIT;
  barrier.oldLayout = for_sampling ? VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL : VK_IMAGE_LAYOUT_UNDEFINED;
  barrier.newLayout =
      for_sampling ? VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL : VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
  barrier.srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.image = image;
  barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, levels, 0, 1};
  vkCmdPipelineBarrier(commands,
                       for_sampling ? VK_PIPELINE_STAGE_TRANSFER_BIT : VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT,
                       for_sampling ? VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT : VK_PIPELINE_STAGE_TRANSFER_BIT,
                       0, 0, nullptr, 0, nullptr, 1, &barrier);
}

VkSamplerAddressMode address_mode(Addressing addressing) {
  switch (addressing) {
  case Addressing::repeat:
    return VK_SAMPLER_ADDRESS_MODE_REPEAT;
  case Addressing::mirror:
    return VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT;
  case Addressing::clamp:
    break;
  }
  return VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
}

} // namespace

TextureFormat format_on(const Device& device, const Map& map) {
  const std::optional<TextureFormat> codes = format_of_codes(map);
  return codes && is_sampled(device, codes->format) ? *codes : format_of_floats(map);
}

std::optional<TextureFormat> filtered_format(const Map& map, const std::function<bool(VkFormat)>& filters) {
  for (const auto& format : {format_of_codes(map), std::optional(format_of_floats(map))})
    if (format && filters(format->format)) return format;
  return std::nullopt;
}

Texture::Texture(const Device& device, const Map& map, const TextureFormat& format) : format_(format) {
  const auto width = static_cast<std::uint32_t>(map.width());
  const auto height = static_cast<std::uint32_t>(map.height());
  const auto levels = static_cast<std::uint32_t>(map.level_count);
  if (const std::uint32_t most = device.limits().maxImageDimension2D; width > most || height > most)
    throw MachineError(
        fmt::format("cannot use a map of {} x {} texels on \"{}\": its textures have at most {}", width,
                    height, device.info().name, most));
  const std::string doing =
      fmt::format("make a texture of {} x {} texels on \"{}\"", width, height, device.info().name);
  VkImageCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
  info.imageType = VK_IMAGE_TYPE_2D;
  info.format = format_.format;
  info.extent = {width, height, 1};
  info.mipLevels = levels;
  info.arrayLayers = 1;
  info.samples = VK_SAMPLE_COUNT_1_BIT;
  info.tiling = VK_IMAGE_TILING_OPTIMAL;
  info.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  info.sharingMode = VK_SHARING_MODE_EXCLUSIVE;
  info.initialLayout = VK_IMAGE_LAYOUT_UNDEFINED;
  VkImage image = VK_NULL_HANDLE;
  check(vkCreateImage(device.get(), &info, nullptr, &image), doing);
  image_ = {device.get(), image, vkDestroyImage};

  VkMemoryRequirements needs{};
  vkGetImageMemoryRequirements(device.get(), image, &needs);
  VkMemoryAllocateInfo allocate{};
  allocate.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
  allocate.allocationSize = needs.size;
  allocate.memoryTypeIndex = device.memory_type(needs.memoryTypeBits, 0, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
  VkDeviceMemory memory = VK_NULL_HANDLE;
  check(vkAllocateMemory(device.get(), &allocate, nullptr, &memory), doing);
  memory_ = {device.get(), memory, vkFreeMemory};
  check(vkBindImageMemory(device.get(), image, memory, 0), doing);

  VkImageViewCreateInfo view{};
  view.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
  view.image = image;
  view.viewType = VK_IMAGE_VIEW_TYPE_2D;
  view.format = format_.format;
  view.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, levels, 0, 1};
  VkImageView made = VK_NULL_HANDLE;
  check(vkCreateImageView(device.get(), &view, nullptr, &made), doing);
  view_ = {device.get(), made, vkDestroyImageView};

  // Copies begin at multiples of four bytes and of a texel.
  std::size_t bytes = 0;
  std::vector<VkBufferImageCopy> copies;
  for (int level = 0; level < map.level_count; ++level) {
    VkBufferImageCopy copy{};
    copy.bufferOffset = bytes;
    copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, static_cast<std::uint32_t>(level), 0, 1};
    copy.imageExtent = {static_cast<std::uint32_t>(map.width(level)),
                        static_cast<std::uint32_t>(map.height(level)), 1};
    copies.push_back(copy);
    const std::size_t texels =
        static_cast<std::size_t>(map.width(level)) * static_cast<std::size_t>(map.height(level));
    bytes = (bytes + texels * bytes_of_texel(format_) + 15) / 16 * 16;
  }
  const Buffer staging(device, bytes, Residence::upload);
  for (int level = 0; level < map.level_count; ++level)
    write_level(map, level, format_,
                staging.mapped().data() + copies[static_cast<std::size_t>(level)].bufferOffset);
  device.run([&](VkCommandBuffer commands) {
    transition(commands, image, levels, false);
    vkCmdCopyBufferToImage(commands, staging.get(), image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, levels,
                           copies.data());
    transition(commands, image, levels, true);
  });
}

Handle<VkSampler> make_sampler(const Device& device, Sampling sampling, Addressing s, Addressing t) {
  const VkFilter filter = sampling == Sampling::nearest ? VK_FILTER_NEAREST : VK_FILTER_LINEAR;
  VkSamplerCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO;
  info.magFilter = filter;
  info.minFilter = filter;
  info.mipmapMode =
      sampling == Sampling::trilinear ? VK_SAMPLER_MIPMAP_MODE_LINEAR : VK_SAMPLER_MIPMAP_MODE_NEAREST;
  info.addressModeU = address_mode(s);
  info.addressModeV = address_mode(t);
  info.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
  info.maxAnisotropy = 1;
  // Only trilinear filters look below level 0.
  info.maxLod = sampling == Sampling::trilinear ? VK_LOD_CLAMP_NONE : 0.0f;
  VkSampler sampler = VK_NULL_HANDLE;
  check(vkCreateSampler(device.get(), &info, nullptr, &sampler), "make a sampler");
  return {device.get(), sampler, vkDestroySampler};
}

} // namespace surfgrad::gpu
