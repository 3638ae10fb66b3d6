#include "shader_cost/amd_compiler.hpp"

#include "diagnostic/error.hpp"
#include "gpu/result.hpp"
#include "shader_cost/shaders.hpp"

#include <fmt/format.h>
#include <vulkan/vulkan.h>

#include <cstdlib>
#include <filesystem>
#include <vector>

namespace surfgrad::bench {
namespace {

constexpr VkFormat target_format = VK_FORMAT_R16G16B16A16_SFLOAT;
constexpr const char* statistics_extension = VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME;

/// The loader must find RADV alone.
void choose_driver(const std::string& family) {
  for (const char* folder :
       {"/usr/share/vulkan/icd.d", "/usr/local/share/vulkan/icd.d", "/etc/vulkan/icd.d"}) {
    if (!std::filesystem::is_directory(folder)) continue;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      if (!entry.path().filename().string().starts_with("radeon_icd")) continue;
      setenv("VK_ICD_FILENAMES", entry.path().c_str(), 1);
      setenv("RADV_FORCE_FAMILY", family.c_str(), 1);
      setenv("XDG_RUNTIME_DIR", std::filesystem::temp_directory_path().c_str(), 0);
      // A shader out of the cache comes without statistics.
      setenv("MESA_SHADER_CACHE_DISABLE", "true", 1);
      return;
    }
  }
  throw MachineError("cannot count AMD's instructions: Mesa's RADV driver is not installed "
                     "(Debian: mesa-vulkan-drivers)");
}

VkPhysicalDevice the_device(VkInstance instance, const std::string& family) {
  std::uint32_t count = 1;
  VkPhysicalDevice physical = VK_NULL_HANDLE;
  const VkResult result = vkEnumeratePhysicalDevices(instance, &count, &physical);
  if ((result != VK_SUCCESS && result != VK_INCOMPLETE) || count == 0)
    throw MachineError(
        fmt::format("cannot count AMD's instructions: this RADV does not know \"{}\"", family));
  return physical;
}

std::string version_of(VkPhysicalDevice physical) {
  VkPhysicalDeviceDriverProperties driver{};
  driver.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES;
  VkPhysicalDeviceProperties2 properties{};
  properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
  properties.pNext = &driver;
  vkGetPhysicalDeviceProperties2(physical, &properties);
  return driver.driverInfo;
}

/// Its only queue family that matters: nothing is ever submitted.
VkDevice make_device(VkPhysicalDevice physical) {
  const float priority = 1;
  VkDeviceQueueCreateInfo queue{};
  queue.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
  queue.queueCount = 1;
  queue.pQueuePriorities = &priority;
  VkPhysicalDevicePipelineExecutablePropertiesFeaturesKHR statistics{};
  statistics.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PIPELINE_EXECUTABLE_PROPERTIES_FEATURES_KHR;
  statistics.pipelineExecutableInfo = VK_TRUE;
  VkDeviceCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
  info.pNext = &statistics;
  info.queueCreateInfoCount = 1;
  info.pQueueCreateInfos = &queue;
  info.enabledExtensionCount = 1;
  info.ppEnabledExtensionNames = &statistics_extension;
  VkDevice device = VK_NULL_HANDLE;
  gpu::check(vkCreateDevice(physical, &info, nullptr, &device), "open RADV");
  return device;
}

gpu::Handle<VkShaderModule> load(VkDevice device, const gpu::Spirv& words) {
  VkShaderModuleCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
  info.codeSize = words.size() * sizeof(std::uint32_t);
  info.pCode = words.data();
  VkShaderModule module = VK_NULL_HANDLE;
  gpu::check(vkCreateShaderModule(device, &info, nullptr, &module), "load a shader");
  return {device, module, vkDestroyShaderModule};
}

/// The bindings of surface.glsl and of decals_4.frag.
gpu::Handle<VkDescriptorSetLayout> make_set_layout(VkDevice device) {
  VkDescriptorSetLayoutBinding bindings[4]{};
  for (std::uint32_t i = 0; i < 4; ++i)
    bindings[i] = {i, i < 3 ? VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER : VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER,
                   1, VK_SHADER_STAGE_FRAGMENT_BIT, nullptr};
  VkDescriptorSetLayoutCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
  info.bindingCount = 4;
  info.pBindings = bindings;
  VkDescriptorSetLayout layout = VK_NULL_HANDLE;
  gpu::check(vkCreateDescriptorSetLayout(device, &info, nullptr, &layout), "make a pipeline");
  return {device, layout, vkDestroyDescriptorSetLayout};
}

gpu::Handle<VkPipelineLayout> make_layout(VkDevice device, VkDescriptorSetLayout set) {
  const VkPushConstantRange camera{VK_SHADER_STAGE_VERTEX_BIT, 0, 64};
  VkPipelineLayoutCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
  info.setLayoutCount = 1;
  info.pSetLayouts = &set;
  info.pushConstantRangeCount = 1;
  info.pPushConstantRanges = &camera;
  VkPipelineLayout layout = VK_NULL_HANDLE;
  gpu::check(vkCreatePipelineLayout(device, &info, nullptr, &layout), "make a pipeline");
  return {device, layout, vkDestroyPipelineLayout};
}

gpu::Handle<VkRenderPass> make_pass(VkDevice device) {
  VkAttachmentDescription target{};
  target.format = target_format;
  target.samples = VK_SAMPLE_COUNT_1_BIT;
  target.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
  target.finalLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
  const VkAttachmentReference written{0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
  VkSubpassDescription subpass{};
  subpass.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
  subpass.colorAttachmentCount = 1;
  subpass.pColorAttachments = &written;
  VkRenderPassCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO;
  info.attachmentCount = 1;
  info.pAttachments = &target;
  info.subpassCount = 1;
  info.pSubpasses = &subpass;
  VkRenderPass pass = VK_NULL_HANDLE;
  gpu::check(vkCreateRenderPass(device, &info, nullptr, &pass), "make a pipeline");
  return {device, pass, vkDestroyRenderPass};
}

/// What a mesh has: surface.vert's attributes, one after the other.
struct Attributes {
  VkVertexInputBindingDescription binding{0, 56, VK_VERTEX_INPUT_RATE_VERTEX};
  VkVertexInputAttributeDescription list[5]{{0, 0, VK_FORMAT_R32G32B32_SFLOAT, 0},
                                            {1, 0, VK_FORMAT_R32G32B32_SFLOAT, 12},
                                            {2, 0, VK_FORMAT_R32G32B32A32_SFLOAT, 24},
                                            {3, 0, VK_FORMAT_R32G32_SFLOAT, 40},
                                            {4, 0, VK_FORMAT_R32G32_SFLOAT, 48}};
};

gpu::Handle<VkPipeline> make_pipeline(VkDevice device, VkPipelineLayout layout, VkRenderPass pass,
                                      VkShaderModule vertex, VkShaderModule fragment) {
  VkPipelineShaderStageCreateInfo stages[2]{};
  stages[0].sType = stages[1].sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
  stages[0].stage = VK_SHADER_STAGE_VERTEX_BIT;
  stages[0].module = vertex;
  stages[1].stage = VK_SHADER_STAGE_FRAGMENT_BIT;
  stages[1].module = fragment;
  stages[0].pName = stages[1].pName = "main";

  const Attributes attributes;
  VkPipelineVertexInputStateCreateInfo input{};
  input.sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO;
  input.vertexBindingDescriptionCount = 1;
  input.pVertexBindingDescriptions = &attributes.binding;
  input.vertexAttributeDescriptionCount = 5;
  input.pVertexAttributeDescriptions = attributes.list;
  VkPipelineInputAssemblyStateCreateInfo assembly{};
  assembly.sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO;
  assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
  const VkViewport whole{0, 0, 1024, 1024, 0, 1};
  const VkRect2D scissor{{0, 0}, {1024, 1024}};
  VkPipelineViewportStateCreateInfo view{};
  view.sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO;
  view.viewportCount = view.scissorCount = 1;
  view.pViewports = &whole;
  view.pScissors = &scissor;
  VkPipelineRasterizationStateCreateInfo raster{};
  raster.sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO;
  raster.lineWidth = 1;
  VkPipelineMultisampleStateCreateInfo samples{};
  samples.sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO;
  samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
  VkPipelineColorBlendAttachmentState channels{};
  channels.colorWriteMask = 15;
  VkPipelineColorBlendStateCreateInfo blend{};
  blend.sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO;
  blend.attachmentCount = 1;
  blend.pAttachments = &channels;

  VkGraphicsPipelineCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO;
  info.flags = VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT_KHR;
  info.stageCount = 2;
  info.pStages = stages;
  info.pVertexInputState = &input;
  info.pInputAssemblyState = &assembly;
  info.pViewportState = &view;
  info.pRasterizationState = &raster;
  info.pMultisampleState = &samples;
  info.pColorBlendState = &blend;
  info.layout = layout;
  info.renderPass = pass;
  VkPipeline pipeline = VK_NULL_HANDLE;
  gpu::check(vkCreateGraphicsPipelines(device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline),
             "compile a shader with RADV");
  return {device, pipeline, vkDestroyPipeline};
}

template <class Function>
Function function_of(VkDevice device, const char* name) {
  const auto function = reinterpret_cast<Function>(vkGetDeviceProcAddr(device, name));
  if (function == nullptr)
    throw MachineError(fmt::format("cannot count AMD's instructions: RADV lacks {}", name));
  return function;
}

/// Which of a pipeline's parts is the fragment shader.
std::uint32_t fragment_part(VkDevice device, VkPipeline pipeline) {
  const auto list =
      function_of<PFN_vkGetPipelineExecutablePropertiesKHR>(device, "vkGetPipelineExecutablePropertiesKHR");
  VkPipelineInfoKHR info{VK_STRUCTURE_TYPE_PIPELINE_INFO_KHR, nullptr, pipeline};
  std::uint32_t count = 0;
  gpu::check(list(device, &info, &count, nullptr), "list a pipeline's shaders");
  VkPipelineExecutablePropertiesKHR empty{};
  empty.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_PROPERTIES_KHR;
  std::vector<VkPipelineExecutablePropertiesKHR> parts(count, empty);
  gpu::check(list(device, &info, &count, parts.data()), "list a pipeline's shaders");
  for (std::uint32_t i = 0; i < count; ++i)
    if (parts[i].stages == VK_SHADER_STAGE_FRAGMENT_BIT) return i;
  throw MachineError("cannot count AMD's instructions: RADV shows no fragment shader");
}

} // namespace

AmdCompiler::AmdCompiler(const std::string& family) {
  choose_driver(family);
  instance_ = std::make_unique<gpu::Instance>(false);
  VkPhysicalDevice const physical = the_device(instance_->get(), family);
  version_ = version_of(physical);
  device_.reset(make_device(physical));
  vertex_ = load(device_.get(), compiled_cost_shader("surface.vert"));
  set_layout_ = make_set_layout(device_.get());
  layout_ = make_layout(device_.get(), set_layout_.get());
  pass_ = make_pass(device_.get());
}

std::map<std::string, std::uint64_t> AmdCompiler::statistics(const gpu::Spirv& fragment) const {
  VkDevice const device = device_.get();
  const gpu::Handle<VkShaderModule> module = load(device, fragment);
  const gpu::Handle<VkPipeline> pipeline =
      make_pipeline(device, layout_.get(), pass_.get(), vertex_.get(), module.get());
  const auto list =
      function_of<PFN_vkGetPipelineExecutableStatisticsKHR>(device, "vkGetPipelineExecutableStatisticsKHR");
  VkPipelineExecutableInfoKHR info{VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_INFO_KHR, nullptr, pipeline.get(),
                                   fragment_part(device, pipeline.get())};
  std::uint32_t count = 0;
  gpu::check(list(device, &info, &count, nullptr), "read a shader's statistics");
  VkPipelineExecutableStatisticKHR empty{};
  empty.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_STATISTIC_KHR;
  std::vector<VkPipelineExecutableStatisticKHR> each(count, empty);
  gpu::check(list(device, &info, &count, each.data()), "read a shader's statistics");
  std::map<std::string, std::uint64_t> named;
  for (const VkPipelineExecutableStatisticKHR& statistic : each)
    if (statistic.format == VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_UINT64_KHR)
      named[statistic.name] = statistic.value.u64;
  return named;
}

} // namespace surfgrad::bench
