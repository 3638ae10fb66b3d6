#include "lavapipe.hpp"

#include "lavapipe_render_frag.hpp"
#include "lavapipe_render_vert.hpp"
#include "vulkan_device.hpp"

#include <bit>
#include <cstring>

namespace surfgrad::bench {
namespace {

constexpr VkFormat color_format = VK_FORMAT_R8G8B8A8_UNORM;
constexpr VkFormat depth_format = VK_FORMAT_D32_SFLOAT;

/// Nearest half; slopes are neither huge nor NaN, tiny ones become zero.
std::uint16_t to_half(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  const std::uint32_t sign = (bits >> 16) & 0x8000U;
  const std::int32_t exponent = static_cast<std::int32_t>((bits >> 23) & 255U) - 127 + 15;
  if (exponent <= 0) return static_cast<std::uint16_t>(sign);
  const std::uint32_t rounded =
      (static_cast<std::uint32_t>(exponent) << 10) + (((bits >> 12) & 2047U) + 1) / 2;
  return static_cast<std::uint16_t>(sign | rounded);
}

std::vector<std::uint8_t> bytes_of(const SlopePyramid::Level& level, PeerTexels texels) {
  const std::size_t size = texels == PeerTexels::float32 ? 4 : 2;
  std::vector<std::uint8_t> bytes(level.texels.size() * 2 * size);
  if (texels == PeerTexels::float32) {
    std::memcpy(bytes.data(), level.texels.data(), bytes.size());
    return bytes;
  }
  std::uint8_t* to = bytes.data();
  for (const vec2<float>& t : level.texels)
    for (const float v : {t.x, t.y}) {
      const std::uint16_t half = to_half(v);
      std::memcpy(to, &half, 2);
      to += 2;
    }
  return bytes;
}

} // namespace

struct Lavapipe::Device : VulkanDevice {
  using VulkanDevice::VulkanDevice;

  VkCommandBuffer drawing = VK_NULL_HANDLE;
  VkPipelineLayout layout = VK_NULL_HANDLE;
  VkPipeline pipeline = VK_NULL_HANDLE;
  VkDescriptorSetLayout set_layout = VK_NULL_HANDLE;
  VkDescriptorSet set = VK_NULL_HANDLE;
  Image color, depth;
  Buffer read_back;
  int width = 0, height = 0;

  Image upload(const SlopePyramid& map, PeerTexels texels) {
    const VkFormat format = texels == PeerTexels::float32 ? VK_FORMAT_R32G32_SFLOAT : VK_FORMAT_R16G16_SFLOAT;
    const int size = map.levels[0].size;
    const Image image =
        make_image(format, size, size, static_cast<int>(map.levels.size()),
                   VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT, VK_IMAGE_ASPECT_COLOR_BIT);
    VkCommandBuffer commands = begin_commands();
    change_layout(commands, image, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_UNDEFINED,
                  VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    for (std::size_t k = 0; k < map.levels.size(); ++k) {
      const std::vector<std::uint8_t> bytes = bytes_of(map.levels[k], texels);
      const Buffer staging = make_buffer(VK_BUFFER_USAGE_TRANSFER_SRC_BIT, bytes.size(), bytes.data());
      const auto side = static_cast<std::uint32_t>(map.levels[k].size);
      VkBufferImageCopy copy{};
      copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, static_cast<std::uint32_t>(k), 0, 1};
      copy.imageExtent = {side, side, 1};
      vkCmdCopyBufferToImage(commands, staging.handle, image.handle, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1,
                             &copy);
    }
    change_layout(commands, image, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                  VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    check(vkEndCommandBuffer(commands), "vkEndCommandBuffer");
    submit(commands);
    return image;
  }

  void bind_inputs(const PeerScene& scene, PeerTexels texels) {
    VkDescriptorSetLayoutBinding bindings[4]{};
    for (std::uint32_t i = 0; i < 4; ++i)
      bindings[i] = {i, i < 3 ? VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER : VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER,
                     1, VK_SHADER_STAGE_FRAGMENT_BIT, nullptr};
    auto layout_info =
        started<VkDescriptorSetLayoutCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO);
    layout_info.bindingCount = 4;
    layout_info.pBindings = bindings;
    check(vkCreateDescriptorSetLayout(device, &layout_info, nullptr, &set_layout), "descriptor layout");
    made.push_back([this] { vkDestroyDescriptorSetLayout(device, set_layout, nullptr); });
    const VkDescriptorPoolSize sizes[2]{{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 3},
                                        {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1}};
    auto pool_info = started<VkDescriptorPoolCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO);
    pool_info.maxSets = 1;
    pool_info.poolSizeCount = 2;
    pool_info.pPoolSizes = sizes;
    VkDescriptorPool descriptors = VK_NULL_HANDLE;
    check(vkCreateDescriptorPool(device, &pool_info, nullptr, &descriptors), "vkCreateDescriptorPool");
    made.push_back([this, descriptors] { vkDestroyDescriptorPool(device, descriptors, nullptr); });
    auto set_info = started<VkDescriptorSetAllocateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO);
    set_info.descriptorPool = descriptors;
    set_info.descriptorSetCount = 1;
    set_info.pSetLayouts = &set_layout;
    check(vkAllocateDescriptorSets(device, &set_info, &set), "vkAllocateDescriptorSets");

    auto sampler_info = started<VkSamplerCreateInfo>(VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO);
    sampler_info.magFilter = sampler_info.minFilter = VK_FILTER_LINEAR;
    sampler_info.mipmapMode = VK_SAMPLER_MIPMAP_MODE_LINEAR;
    sampler_info.maxLod = VK_LOD_CLAMP_NONE;
    VkSampler sampler = VK_NULL_HANDLE;
    check(vkCreateSampler(device, &sampler_info, nullptr, &sampler), "vkCreateSampler");
    made.push_back([this, sampler] { vkDestroySampler(device, sampler, nullptr); });
    for (std::uint32_t i = 0; i < 3; ++i) {
      const Image image = upload(*scene.maps[i], texels);
      const VkDescriptorImageInfo info{sampler, image.view, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
      auto write = started<VkWriteDescriptorSet>(VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET);
      write.dstSet = set;
      write.dstBinding = i;
      write.descriptorCount = 1;
      write.descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
      write.pImageInfo = &info;
      vkUpdateDescriptorSets(device, 1, &write, 0, nullptr);
    }
    const Buffer light = make_buffer(VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, sizeof scene.light, &scene.light);
    const VkDescriptorBufferInfo info{light.handle, 0, sizeof scene.light};
    auto write = started<VkWriteDescriptorSet>(VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET);
    write.dstSet = set;
    write.dstBinding = 3;
    write.descriptorCount = 1;
    write.descriptorType = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    write.pBufferInfo = &info;
    vkUpdateDescriptorSets(device, 1, &write, 0, nullptr);
  }

  void make_pipeline();
  void record(const PeerScene& scene);
};

void Lavapipe::Device::make_pipeline() {
  const VkPushConstantRange constants{VK_SHADER_STAGE_VERTEX_BIT, 0, 64};
  auto layout_info = started<VkPipelineLayoutCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO);
  layout_info.setLayoutCount = 1;
  layout_info.pSetLayouts = &set_layout;
  layout_info.pushConstantRangeCount = 1;
  layout_info.pPushConstantRanges = &constants;
  check(vkCreatePipelineLayout(device, &layout_info, nullptr, &layout), "vkCreatePipelineLayout");
  made.push_back([this] { vkDestroyPipelineLayout(device, layout, nullptr); });

  const auto stage =
      started<VkPipelineShaderStageCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO);
  VkPipelineShaderStageCreateInfo stages[2]{stage, stage};
  stages[0].stage = VK_SHADER_STAGE_VERTEX_BIT;
  stages[0].module = make_shader(lavapipe_render_vert);
  stages[1].stage = VK_SHADER_STAGE_FRAGMENT_BIT;
  stages[1].module = make_shader(lavapipe_render_frag);
  stages[0].pName = stages[1].pName = "main";

  const VkVertexInputBindingDescription binding{0, sizeof(PeerVertex), VK_VERTEX_INPUT_RATE_VERTEX};
  VkVertexInputAttributeDescription attributes[5];
  for (std::uint32_t i = 0; i < 5; ++i)
    attributes[i] = {i, 0, i < 2 ? VK_FORMAT_R32G32B32_SFLOAT : VK_FORMAT_R32G32_SFLOAT,
                     i < 2 ? 12 * i : 24 + 8 * (i - 2)};
  auto input = started<VkPipelineVertexInputStateCreateInfo>(
      VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO);
  input.vertexBindingDescriptionCount = 1;
  input.pVertexBindingDescriptions = &binding;
  input.vertexAttributeDescriptionCount = 5;
  input.pVertexAttributeDescriptions = attributes;
  auto assembly = started<VkPipelineInputAssemblyStateCreateInfo>(
      VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO);
  assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
  const VkViewport viewport{0, 0, static_cast<float>(width), static_cast<float>(height), 0, 1};
  const VkRect2D scissor{{0, 0}, {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)}};
  auto view =
      started<VkPipelineViewportStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO);
  view.viewportCount = view.scissorCount = 1;
  view.pViewports = &viewport;
  view.pScissors = &scissor;
  auto raster = started<VkPipelineRasterizationStateCreateInfo>(
      VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO);
  raster.cullMode = VK_CULL_MODE_BACK_BIT;
  raster.frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE;
  raster.lineWidth = 1;
  auto samples =
      started<VkPipelineMultisampleStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO);
  samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
  auto depth_test = started<VkPipelineDepthStencilStateCreateInfo>(
      VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO);
  depth_test.depthTestEnable = depth_test.depthWriteEnable = VK_TRUE;
  depth_test.depthCompareOp = VK_COMPARE_OP_LESS;
  VkPipelineColorBlendAttachmentState channels{};
  channels.colorWriteMask = 15;
  auto blend =
      started<VkPipelineColorBlendStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO);
  blend.attachmentCount = 1;
  blend.pAttachments = &channels;
  auto rendering = started<VkPipelineRenderingCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO);
  rendering.colorAttachmentCount = 1;
  rendering.pColorAttachmentFormats = &color_format;
  rendering.depthAttachmentFormat = depth_format;

  auto info = started<VkGraphicsPipelineCreateInfo>(VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO);
  info.pNext = &rendering;
  info.stageCount = 2;
  info.pStages = stages;
  info.pVertexInputState = &input;
  info.pInputAssemblyState = &assembly;
  info.pViewportState = &view;
  info.pRasterizationState = &raster;
  info.pMultisampleState = &samples;
  info.pDepthStencilState = &depth_test;
  info.pColorBlendState = &blend;
  info.layout = layout;
  check(vkCreateGraphicsPipelines(device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline),
        "vkCreateGraphicsPipelines");
  made.push_back([this] { vkDestroyPipeline(device, pipeline, nullptr); });
}

void Lavapipe::Device::record(const PeerScene& scene) {
  const Buffer vertices = make_buffer(VK_BUFFER_USAGE_VERTEX_BUFFER_BIT,
                                      scene.vertices.size() * sizeof(PeerVertex), scene.vertices.data());
  const Buffer indices =
      make_buffer(VK_BUFFER_USAGE_INDEX_BUFFER_BIT, scene.indices.size() * 4, scene.indices.data());
  color = make_image(color_format, width, height, 1,
                     VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
                     VK_IMAGE_ASPECT_COLOR_BIT);
  depth = make_image(depth_format, width, height, 1, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT,
                     VK_IMAGE_ASPECT_DEPTH_BIT);
  read_back = make_buffer(VK_BUFFER_USAGE_TRANSFER_DST_BIT, std::size_t{4} * width * height);

  drawing = begin_commands();
  change_layout(drawing, color, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_UNDEFINED,
                VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
  change_layout(drawing, depth, VK_IMAGE_ASPECT_DEPTH_BIT, VK_IMAGE_LAYOUT_UNDEFINED,
                VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL);
  auto target = started<VkRenderingAttachmentInfo>(VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO);
  target.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
  VkRenderingAttachmentInfo targets[2]{target, target};
  targets[0].imageView = color.view;
  targets[0].imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
  targets[0].storeOp = VK_ATTACHMENT_STORE_OP_STORE;
  targets[1].imageView = depth.view;
  targets[1].imageLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
  targets[1].storeOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
  targets[1].clearValue.depthStencil = {1, 0};
  auto rendering = started<VkRenderingInfo>(VK_STRUCTURE_TYPE_RENDERING_INFO);
  rendering.renderArea.extent = {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)};
  rendering.layerCount = 1;
  rendering.colorAttachmentCount = 1;
  rendering.pColorAttachments = &targets[0];
  rendering.pDepthAttachment = &targets[1];
  vkCmdBeginRendering(drawing, &rendering);
  vkCmdBindPipeline(drawing, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
  vkCmdBindDescriptorSets(drawing, VK_PIPELINE_BIND_POINT_GRAPHICS, layout, 0, 1, &set, 0, nullptr);
  vkCmdPushConstants(drawing, layout, VK_SHADER_STAGE_VERTEX_BIT, 0, 64, scene.clip_from_relative.data());
  const VkDeviceSize offset = 0;
  vkCmdBindVertexBuffers(drawing, 0, 1, &vertices.handle, &offset);
  vkCmdBindIndexBuffer(drawing, indices.handle, 0, VK_INDEX_TYPE_UINT32);
  vkCmdDrawIndexed(drawing, static_cast<std::uint32_t>(scene.indices.size()), 1, 0, 0, 0);
  vkCmdEndRendering(drawing);
  check(vkEndCommandBuffer(drawing), "vkEndCommandBuffer");
}

Lavapipe::Lavapipe(const PeerScene& scene, PeerTexels texels, int threads)
    : device_(std::make_unique<Device>(threads)) {
  device_->width = scene.width;
  device_->height = scene.height;
  device_->bind_inputs(scene, texels);
  device_->make_pipeline();
  device_->record(scene);
}

Lavapipe::~Lavapipe() = default;

void Lavapipe::draw() { device_->submit(device_->drawing); }

std::vector<std::uint8_t> Lavapipe::picture() {
  VkCommandBuffer commands = device_->begin_commands();
  Device::change_layout(commands, device_->color, VK_IMAGE_ASPECT_COLOR_BIT,
                        VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
  VkBufferImageCopy copy{};
  copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
  copy.imageExtent = {static_cast<std::uint32_t>(device_->width), static_cast<std::uint32_t>(device_->height),
                      1};
  vkCmdCopyImageToBuffer(commands, device_->color.handle, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                         device_->read_back.handle, 1, &copy);
  check(vkEndCommandBuffer(commands), "vkEndCommandBuffer");
  device_->submit(commands);
  std::vector<std::uint8_t> bytes(std::size_t{4} * device_->width * device_->height);
  std::memcpy(bytes.data(), device_->read_back.data, bytes.size());
  return bytes;
}

std::string Lavapipe::driver() const {
  auto driver =
      started<VkPhysicalDeviceDriverProperties>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES);
  auto properties = started<VkPhysicalDeviceProperties2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2);
  properties.pNext = &driver;
  vkGetPhysicalDeviceProperties2(device_->physical, &properties);
  return std::string(driver.driverName) + " " + driver.driverInfo + ", " + properties.properties.deviceName;
}

} // namespace surfgrad::bench
