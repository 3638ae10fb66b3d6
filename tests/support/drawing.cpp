#include "support/drawing.hpp"

#include "gpu/result.hpp"

#include <vulkan/vulkan.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace surfgrad::test {
namespace {

constexpr VkFormat target_format = VK_FORMAT_R32G32B32A32_SFLOAT;
constexpr std::size_t pixel_floats = 4;

/// An object that a device makes from a description of its type.
template <class T, class Info, class Create, class End>
gpu::Handle<T> made(VkDevice device, const Info& info, Create create, End end) {
  T object = VK_NULL_HANDLE;
  gpu::check(create(device, &info, nullptr, &object), "make what a drawing needs");
  return {device, object, end};
}

/// An empty structure of Vulkan's that knows its type.
template <class Structure>
Structure started(VkStructureType type) {
  Structure s{};
  s.sType = type;
  return s;
}

gpu::Handle<VkShaderModule> load(VkDevice device, std::span<const std::uint32_t> words) {
  auto info = started<VkShaderModuleCreateInfo>(VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO);
  info.codeSize = words.size_bytes();
  info.pCode = words.data();
  return made<VkShaderModule>(device, info, vkCreateShaderModule, vkDestroyShaderModule);
}

} // namespace

Drawing::Drawing() {
  std::uint32_t count = 1;
  const VkResult listed = vkEnumeratePhysicalDevices(instance_.get(), &count, &physical_);
  if (listed != VK_INCOMPLETE) gpu::check(listed, "find a Vulkan device");
  // The first queue family of a software driver does everything.
  const float priority = 1;
  auto queue = started<VkDeviceQueueCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO);
  queue.queueCount = 1;
  queue.pQueuePriorities = &priority;
  VkPhysicalDeviceFeatures available;
  vkGetPhysicalDeviceFeatures(physical_, &available);
  VkPhysicalDeviceFeatures features{};
  features.geometryShader = available.geometryShader;
  features.fragmentStoresAndAtomics = available.fragmentStoresAndAtomics;
  auto info = started<VkDeviceCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO);
  info.queueCreateInfoCount = 1;
  info.pQueueCreateInfos = &queue;
  info.pEnabledFeatures = &features;
  VkDevice device = VK_NULL_HANDLE;
  gpu::check(vkCreateDevice(physical_, &info, nullptr, &device), "open a Vulkan device");
  device_.reset(device);
  vkGetDeviceQueue(device, 0, 0, &queue_);
}

gpu::Handle<VkDeviceMemory> Drawing::allocate(const VkMemoryRequirements& needs,
                                              VkMemoryPropertyFlags wanted) const {
  VkPhysicalDeviceMemoryProperties memory;
  vkGetPhysicalDeviceMemoryProperties(physical_, &memory);
  auto info = started<VkMemoryAllocateInfo>(VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO);
  info.allocationSize = needs.size;
  for (; info.memoryTypeIndex < memory.memoryTypeCount; ++info.memoryTypeIndex)
    if ((needs.memoryTypeBits >> info.memoryTypeIndex & 1U) != 0 &&
        (memory.memoryTypes[info.memoryTypeIndex].propertyFlags & wanted) == wanted)
      return made<VkDeviceMemory>(device_.get(), info, vkAllocateMemory, vkFreeMemory);
  throw std::runtime_error("the device has no memory of the kind needed");
}

Drawing::Buffer Drawing::make_buffer(VkBufferUsageFlags usage, std::size_t floats,
                                     std::span<const float> contents) const {
  auto info = started<VkBufferCreateInfo>(VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO);
  info.size = floats * sizeof(float);
  info.usage = usage;
  Buffer result;
  result.buffer = made<VkBuffer>(device_.get(), info, vkCreateBuffer, vkDestroyBuffer);
  VkMemoryRequirements needs;
  vkGetBufferMemoryRequirements(device_.get(), result.buffer.get(), &needs);
  result.memory = allocate(needs, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
  gpu::check(vkBindBufferMemory(device_.get(), result.buffer.get(), result.memory.get(), 0), "bind memory");
  void* mapped = nullptr;
  gpu::check(vkMapMemory(device_.get(), result.memory.get(), 0, VK_WHOLE_SIZE, 0, &mapped), "map memory");
  result.mapped = static_cast<float*>(mapped);
  std::copy(contents.begin(), contents.end(), result.mapped);
  return result;
}

Drawing::Target Drawing::make_target(VkExtent2D size) const {
  auto info = started<VkImageCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO);
  info.imageType = VK_IMAGE_TYPE_2D;
  info.format = target_format;
  info.extent = {size.width, size.height, 1};
  info.mipLevels = info.arrayLayers = 1;
  info.samples = VK_SAMPLE_COUNT_1_BIT;
  info.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
  Target target;
  target.image = made<VkImage>(device_.get(), info, vkCreateImage, vkDestroyImage);
  VkMemoryRequirements needs;
  vkGetImageMemoryRequirements(device_.get(), target.image.get(), &needs);
  target.memory = allocate(needs, 0);
  gpu::check(vkBindImageMemory(device_.get(), target.image.get(), target.memory.get(), 0), "bind memory");
  auto view = started<VkImageViewCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO);
  view.image = target.image.get();
  view.viewType = VK_IMAGE_VIEW_TYPE_2D;
  view.format = target_format;
  view.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
  target.view = made<VkImageView>(device_.get(), view, vkCreateImageView, vkDestroyImageView);
  return target;
}

gpu::Handle<VkRenderPass> Drawing::make_pass(std::uint32_t targets) const {
  VkAttachmentDescription cleared{};
  cleared.format = target_format;
  cleared.samples = VK_SAMPLE_COUNT_1_BIT;
  cleared.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
  cleared.stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
  cleared.stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
  cleared.finalLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
  const std::vector<VkAttachmentDescription> attachments(targets, cleared);
  std::vector<VkAttachmentReference> written;
  for (std::uint32_t i = 0; i < targets; ++i)
    written.push_back({i, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL});
  VkSubpassDescription subpass{};
  subpass.colorAttachmentCount = targets;
  subpass.pColorAttachments = written.data();
  const VkSubpassDependency before_the_copy{0,
                                            VK_SUBPASS_EXTERNAL,
                                            VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
                                            VK_PIPELINE_STAGE_TRANSFER_BIT,
                                            VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT,
                                            VK_ACCESS_TRANSFER_READ_BIT,
                                            0};
  auto info = started<VkRenderPassCreateInfo>(VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO);
  info.attachmentCount = targets;
  info.pAttachments = attachments.data();
  info.subpassCount = 1;
  info.pSubpasses = &subpass;
  info.dependencyCount = 1;
  info.pDependencies = &before_the_copy;
  return made<VkRenderPass>(device_.get(), info, vkCreateRenderPass, vkDestroyRenderPass);
}

gpu::Handle<VkPipeline> Drawing::make_pipeline(const Picture& picture, VkPipelineLayout layout,
                                               VkRenderPass pass) const {
  const std::pair<VkShaderStageFlagBits, std::span<const std::uint32_t>> stages[]{
      {VK_SHADER_STAGE_VERTEX_BIT, picture.stages.vertex},
      {VK_SHADER_STAGE_GEOMETRY_BIT, picture.stages.geometry},
      {VK_SHADER_STAGE_FRAGMENT_BIT, picture.stages.fragment}};
  std::vector<gpu::Handle<VkShaderModule>> modules;
  std::vector<VkPipelineShaderStageCreateInfo> parts;
  for (const auto& [stage, words] : stages) {
    if (words.empty()) continue;
    modules.push_back(load(device_.get(), words));
    auto part = started<VkPipelineShaderStageCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO);
    part.stage = stage;
    part.module = modules.back().get();
    part.pName = "main";
    parts.push_back(part);
  }
  const VkVertexInputBindingDescription vertex{0, 6 * sizeof(float), VK_VERTEX_INPUT_RATE_VERTEX};
  const VkVertexInputAttributeDescription attributes[]{{0, 0, VK_FORMAT_R32G32B32_SFLOAT, 0},
                                                       {1, 0, VK_FORMAT_R32G32B32_SFLOAT, 3 * sizeof(float)}};
  auto input = started<VkPipelineVertexInputStateCreateInfo>(
      VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO);
  input.vertexBindingDescriptionCount = picture.vertices.empty() ? 0 : 1;
  input.pVertexBindingDescriptions = &vertex;
  input.vertexAttributeDescriptionCount = picture.vertices.empty() ? 0 : 2;
  input.pVertexAttributeDescriptions = attributes;
  auto assembly = started<VkPipelineInputAssemblyStateCreateInfo>(
      VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO);
  assembly.topology = picture.topology;
  const auto [width, height] = picture.viewport.width > 0 ? picture.viewport : picture.size;
  const VkViewport whole{0, 0, static_cast<float>(width), static_cast<float>(height), 0, 1};
  const VkRect2D scissor{{0, 0}, picture.size};
  auto view =
      started<VkPipelineViewportStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO);
  view.viewportCount = view.scissorCount = 1;
  view.pViewports = &whole;
  view.pScissors = &scissor;
  auto raster = started<VkPipelineRasterizationStateCreateInfo>(
      VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO);
  raster.lineWidth = 1;
  auto samples =
      started<VkPipelineMultisampleStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO);
  samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
  VkPipelineColorBlendAttachmentState all{};
  all.colorWriteMask = 15;
  const std::vector<VkPipelineColorBlendAttachmentState> channels(picture.targets, all);
  auto blend =
      started<VkPipelineColorBlendStateCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO);
  blend.attachmentCount = picture.targets;
  blend.pAttachments = channels.data();
  auto info = started<VkGraphicsPipelineCreateInfo>(VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO);
  info.stageCount = static_cast<std::uint32_t>(parts.size());
  info.pStages = parts.data();
  info.pVertexInputState = &input;
  info.pInputAssemblyState = &assembly;
  info.pViewportState = &view;
  info.pRasterizationState = &raster;
  info.pMultisampleState = &samples;
  info.pColorBlendState = &blend;
  info.layout = layout;
  info.renderPass = pass;
  VkPipeline pipeline = VK_NULL_HANDLE;
  gpu::check(vkCreateGraphicsPipelines(device_.get(), VK_NULL_HANDLE, 1, &info, nullptr, &pipeline),
             "make a pipeline");
  return {device_.get(), pipeline, vkDestroyPipeline};
}

void Drawing::run(const std::function<void(VkCommandBuffer)>& record) const {
  const auto pool = made<VkCommandPool>(
      device_.get(), started<VkCommandPoolCreateInfo>(VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO),
      vkCreateCommandPool, vkDestroyCommandPool);
  auto allocate = started<VkCommandBufferAllocateInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO);
  allocate.commandPool = pool.get();
  allocate.commandBufferCount = 1;
  VkCommandBuffer commands = VK_NULL_HANDLE;
  gpu::check(vkAllocateCommandBuffers(device_.get(), &allocate, &commands), "draw");
  const auto begin = started<VkCommandBufferBeginInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO);
  gpu::check(vkBeginCommandBuffer(commands, &begin), "draw");
  record(commands);
  gpu::check(vkEndCommandBuffer(commands), "draw");
  auto submit = started<VkSubmitInfo>(VK_STRUCTURE_TYPE_SUBMIT_INFO);
  submit.commandBufferCount = 1;
  submit.pCommandBuffers = &commands;
  gpu::check(vkQueueSubmit(queue_, 1, &submit, VK_NULL_HANDLE), "draw");
  gpu::check(vkQueueWaitIdle(queue_), "draw");
}

std::vector<std::vector<Pixel4>> Drawing::draw(const Picture& picture) {
  VkDevice const device = device_.get();
  std::vector<VkDescriptorSetLayoutBinding> bindings;
  std::vector<VkDescriptorPoolSize> pool_sizes;
  for (const Bound& each : picture.bound) {
    bindings.push_back({static_cast<std::uint32_t>(bindings.size()), each.type, 1,
                        VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, nullptr});
    pool_sizes.push_back({each.type, 1});
  }
  auto set_info =
      started<VkDescriptorSetLayoutCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO);
  set_info.bindingCount = static_cast<std::uint32_t>(bindings.size());
  set_info.pBindings = bindings.data();
  const auto set_layout = made<VkDescriptorSetLayout>(device, set_info, vkCreateDescriptorSetLayout,
                                                      vkDestroyDescriptorSetLayout);
  VkDescriptorSetLayout const set_layouts[]{set_layout.get()};
  auto layout_info = started<VkPipelineLayoutCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO);
  layout_info.setLayoutCount = 1;
  layout_info.pSetLayouts = set_layouts;
  const auto layout =
      made<VkPipelineLayout>(device, layout_info, vkCreatePipelineLayout, vkDestroyPipelineLayout);
  const auto pass = make_pass(picture.targets);
  const auto pipeline = make_pipeline(picture, layout.get(), pass.get());

  auto pool_info = started<VkDescriptorPoolCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO);
  pool_info.maxSets = 1;
  pool_info.poolSizeCount = static_cast<std::uint32_t>(pool_sizes.size());
  pool_info.pPoolSizes = pool_sizes.data();
  const auto pool =
      made<VkDescriptorPool>(device, pool_info, vkCreateDescriptorPool, vkDestroyDescriptorPool);
  auto allocate = started<VkDescriptorSetAllocateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO);
  allocate.descriptorPool = pool.get();
  allocate.descriptorSetCount = 1;
  allocate.pSetLayouts = set_layouts;
  VkDescriptorSet set = VK_NULL_HANDLE;
  gpu::check(vkAllocateDescriptorSets(device, &allocate, &set), "bind a buffer");
  std::vector<Buffer> buffers;
  for (std::uint32_t i = 0; i < picture.bound.size(); ++i) {
    const Bound& each = picture.bound[i];
    buffers.push_back(make_buffer(each.type == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER
                                      ? VK_BUFFER_USAGE_STORAGE_BUFFER_BIT
                                      : VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT,
                                  each.contents.size(), each.contents));
    const VkDescriptorBufferInfo whole{buffers.back().buffer.get(), 0, VK_WHOLE_SIZE};
    auto write = started<VkWriteDescriptorSet>(VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET);
    write.dstSet = set;
    write.dstBinding = i;
    write.descriptorCount = 1;
    write.descriptorType = each.type;
    write.pBufferInfo = &whole;
    vkUpdateDescriptorSets(device, 1, &write, 0, nullptr);
  }

  std::vector<Target> images;
  std::vector<VkImageView> views;
  for (std::uint32_t i = 0; i < picture.targets; ++i) {
    images.push_back(make_target(picture.size));
    views.push_back(images.back().view.get());
  }
  auto frame_info = started<VkFramebufferCreateInfo>(VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO);
  frame_info.renderPass = pass.get();
  frame_info.attachmentCount = picture.targets;
  frame_info.pAttachments = views.data();
  frame_info.width = picture.size.width;
  frame_info.height = picture.size.height;
  frame_info.layers = 1;
  const auto frame = made<VkFramebuffer>(device, frame_info, vkCreateFramebuffer, vkDestroyFramebuffer);
  const std::size_t pixels = std::size_t{picture.size.width} * picture.size.height;
  const std::size_t image = pixels * pixel_floats;
  Buffer vertex_buffer;
  if (!picture.vertices.empty())
    vertex_buffer = make_buffer(VK_BUFFER_USAGE_VERTEX_BUFFER_BIT, picture.vertices.size(), picture.vertices);
  Buffer result;
  if (picture.targets > 0) result = make_buffer(VK_BUFFER_USAGE_TRANSFER_DST_BIT, picture.targets * image);

  run([&](VkCommandBuffer commands) {
    const std::vector<VkClearValue> nothing(picture.targets);
    auto begin = started<VkRenderPassBeginInfo>(VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO);
    begin.renderPass = pass.get();
    begin.framebuffer = frame.get();
    begin.renderArea = {{0, 0}, picture.size};
    begin.clearValueCount = picture.targets;
    begin.pClearValues = nothing.data();
    vkCmdBeginRenderPass(commands, &begin, VK_SUBPASS_CONTENTS_INLINE);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline.get());
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout.get(), 0, 1, &set, 0, nullptr);
    if (!picture.vertices.empty()) {
      VkBuffer const vertices[]{vertex_buffer.buffer.get()};
      constexpr VkDeviceSize start = 0;
      vkCmdBindVertexBuffers(commands, 0, 1, vertices, &start);
    }
    vkCmdDraw(commands, picture.vertex_count, 1, 0, 0);
    vkCmdEndRenderPass(commands);
    for (std::uint32_t i = 0; i < picture.targets; ++i) {
      const VkBufferImageCopy copy{i * image * sizeof(float),
                                   0,
                                   0,
                                   {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                   {0, 0, 0},
                                   {picture.size.width, picture.size.height, 1}};
      vkCmdCopyImageToBuffer(commands, images[i].image.get(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                             result.buffer.get(), 1, &copy);
    }
    auto barrier = started<VkMemoryBarrier>(VK_STRUCTURE_TYPE_MEMORY_BARRIER);
    barrier.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT | VK_ACCESS_SHADER_WRITE_BIT;
    barrier.dstAccessMask = VK_ACCESS_HOST_READ_BIT;
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT | VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT,
                         VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &barrier, 0, nullptr, 0, nullptr);
  });
  for (std::size_t i = 0; i < buffers.size(); ++i)
    std::copy_n(buffers[i].mapped, picture.bound[i].results.size(), picture.bound[i].results.begin());
  std::vector<std::vector<Pixel4>> drawn(picture.targets, std::vector<Pixel4>(pixels));
  for (std::uint32_t i = 0; i < picture.targets; ++i)
    for (std::size_t p = 0; p < pixels; ++p)
      std::copy_n(result.mapped + i * image + p * pixel_floats, pixel_floats, drawn[i][p].begin());
  return drawn;
}

} // namespace surfgrad::test
