#include "exported/textures.hpp"

#include "gpu/result.hpp"
#include "image/pyramid.hpp"

#include <bit>
#include <cstring>
#include <stdexcept>
#include <vector>

namespace surfgrad::shadergen::test {
namespace {

/// Red, green and blue of the file, all mip levels. No stack of these tests reads opacity.
image::Map codes_of(const image::Image& image, bool from_top) {
  const auto rows = [&](int y, float* texel) {
    for (int x = 0; x < image.width; ++x)
      for (int channel = 0; channel < 3; ++channel)
        *texel++ = image.at(x, from_top ? image.height - 1 - y : y, image.source_of(channel));
  };
  return image::with_pyramid(rows, image.width, image.height, 3);
}

VkImageMemoryBarrier barrier_of(VkImage image, std::uint32_t levels, VkImageLayout from, VkImageLayout to) {
  VkImageMemoryBarrier barrier{};
  barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER;
  barrier.srcAccessMask = to == VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL ? 0 : VK_ACCESS_TRANSFER_WRITE_BIT;
  barrier.dstAccessMask =
      to == VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL ? VK_ACCESS_TRANSFER_WRITE_BIT : VK_ACCESS_SHADER_READ_BIT;
  barrier.oldLayout = from;
  barrier.newLayout = to;
  barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.image = image;
  barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, levels, 0, 6};
  return barrier;
}

/// Faces one after the other, each from its top row on: where cube maps begin in every API.
std::vector<float> faces_of(const image::Image& strip) {
  const int side = strip.height;
  if (strip.width != 6 * side || strip.channels < 3 || (side & (side - 1)) != 0)
    throw std::logic_error("this test takes cube maps as strips of six faces, a power of two wide");
  std::vector<float> texels;
  texels.reserve(static_cast<std::size_t>(24 * side * side));
  for (int face = 0; face < 6; ++face)
    for (int y = side - 1; y >= 0; --y)
      for (int x = 0; x < side; ++x) {
        for (int c = 0; c < 3; ++c) texels.push_back(strip.at(face * side + x, y, c));
        texels.push_back(0);
      }
  return texels;
}

/// The next mip level: of six faces `side` texels wide the means of 2x2.
std::vector<float> halved(const std::vector<float>& faces, std::size_t side) {
  std::vector<float> means;
  means.reserve(faces.size() / 4);
  for (std::size_t y = 0; y < 6 * side; y += 2) // a face has an even number of rows
    for (std::size_t x = 0; x < side; x += 2)
      for (std::size_t c = 0; c < 4; ++c) {
        const auto at = [&](std::size_t i, std::size_t j) { return faces[4 * ((y + j) * side + x + i) + c]; };
        means.push_back(0.25f * (at(0, 0) + at(1, 0) + at(0, 1) + at(1, 1)));
      }
  return means;
}

gpu::Addressing addressing_of(stack::Wrap wrap) {
  switch (wrap) {
  case stack::Wrap::mirror:
    return gpu::Addressing::mirror;
  case stack::Wrap::clamp:
    return gpu::Addressing::clamp;
  case stack::Wrap::repeat:
    break;
  }
  return gpu::Addressing::repeat;
}

} // namespace

CubeTexture::CubeTexture(const gpu::Device& device, const image::Image& strip) {
  const auto side = static_cast<std::uint32_t>(strip.height);
  const auto levels = static_cast<std::uint32_t>(std::bit_width(side));
  VkImageCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
  info.flags = VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT;
  info.imageType = VK_IMAGE_TYPE_2D;
  info.format = VK_FORMAT_R32G32B32A32_SFLOAT;
  info.extent = {side, side, 1};
  info.mipLevels = levels;
  info.arrayLayers = 6;
  info.samples = VK_SAMPLE_COUNT_1_BIT;
  info.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  VkImage image = VK_NULL_HANDLE;
  gpu::check(vkCreateImage(device.get(), &info, nullptr, &image), "make a cube map");
  image_ = {device.get(), image, vkDestroyImage};
  VkMemoryRequirements needs{};
  vkGetImageMemoryRequirements(device.get(), image, &needs);
  VkMemoryAllocateInfo allocate{};
  allocate.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
  allocate.allocationSize = needs.size;
  allocate.memoryTypeIndex = device.memory_type(needs.memoryTypeBits, 0);
  VkDeviceMemory memory = VK_NULL_HANDLE;
  gpu::check(vkAllocateMemory(device.get(), &allocate, nullptr, &memory), "make a cube map");
  memory_ = {device.get(), memory, vkFreeMemory};
  gpu::check(vkBindImageMemory(device.get(), image, memory, 0), "make a cube map");
  VkImageViewCreateInfo view_info{};
  view_info.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
  view_info.image = image;
  view_info.viewType = VK_IMAGE_VIEW_TYPE_CUBE;
  view_info.format = info.format;
  view_info.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, levels, 0, 6};
  VkImageView view = VK_NULL_HANDLE;
  gpu::check(vkCreateImageView(device.get(), &view_info, nullptr, &view), "make a cube map");
  view_ = {device.get(), view, vkDestroyImageView};

  std::vector<float> texels = faces_of(strip);
  std::vector<float> all;
  std::vector<VkBufferImageCopy> copies;
  for (std::uint32_t level = 0; level < levels; ++level) {
    const std::uint32_t size = side >> level;
    if (level > 0) texels = halved(texels, 2 * size);
    VkBufferImageCopy copy{};
    copy.bufferOffset = all.size() * sizeof(float);
    copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, level, 0, 6};
    copy.imageExtent = {size, size, 1};
    copies.push_back(copy);
    all.insert(all.end(), texels.begin(), texels.end());
  }
  const gpu::Buffer staging(device, all.size() * sizeof(float), gpu::Residence::upload);
  std::memcpy(staging.mapped().data(), all.data(), all.size() * sizeof(float));
  device.run([&](VkCommandBuffer commands) {
    const auto before =
        barrier_of(image, levels, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 0,
                         nullptr, 0, nullptr, 1, &before);
    vkCmdCopyBufferToImage(commands, staging.get(), image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, levels,
                           copies.data());
    const auto after = barrier_of(image, levels, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                                  VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, 0, 0,
                         nullptr, 0, nullptr, 1, &after);
  });
}

VkImageView Textures::view_of(const image::Image& image, bool is_cube, bool from_top) {
  if (is_cube) return cubes_.try_emplace(&image, device_, image).first->second.view();
  const auto [found, is_new] = flat_.try_emplace({&image, from_top});
  if (is_new) found->second = gpu::Texture(device_, codes_of(image, from_top));
  return found->second.view();
}

VkSampler Textures::sampler_of(const TextureBinding& binding) {
  const gpu::Sampling sampling = binding.filter == stack::Filter::nearest    ? gpu::Sampling::nearest
                                 : binding.filter == stack::Filter::bilinear ? gpu::Sampling::bilinear
                                                                             : gpu::Sampling::trilinear;
  const gpu::Addressing s = addressing_of(binding.wrap_s), t = addressing_of(binding.wrap_t);
  const auto [found, is_new] = samplers_.try_emplace({sampling, s, t});
  if (is_new) found->second = gpu::make_sampler(device_, sampling, s, t);
  return found->second.get();
}

} // namespace surfgrad::shadergen::test
