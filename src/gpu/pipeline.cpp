#include "gpu/pipeline.hpp"

#include "gpu/result.hpp"

#include <algorithm>
#include <cassert>

namespace surfgrad::gpu {

ComputePipeline::ComputePipeline(const Device& device, const Spirv& shader, std::vector<Binding> bindings,
                                 std::uint32_t constant_bytes)
    : bindings_(std::move(bindings)) {
  std::uint32_t sets = 1;
  for (const Binding& binding : bindings_) sets = std::max(sets, binding.set + 1);
  for (std::uint32_t set = 0; set < sets; ++set) {
    std::vector<VkDescriptorSetLayoutBinding> entries;
    for (const Binding& binding : bindings_)
      if (binding.set == set)
        entries.push_back(
            {binding.number, binding.type, binding.count, VK_SHADER_STAGE_COMPUTE_BIT, nullptr});
    VkDescriptorSetLayoutCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
    info.bindingCount = static_cast<std::uint32_t>(entries.size());
    info.pBindings = entries.data();
    VkDescriptorSetLayout made = VK_NULL_HANDLE;
    check(vkCreateDescriptorSetLayout(device.get(), &info, nullptr, &made), "make a pipeline");
    set_layouts_.emplace_back(device.get(), made, vkDestroyDescriptorSetLayout);
  }
  const std::vector<VkDescriptorSetLayout> layouts = set_layouts();

  const VkPushConstantRange constants{VK_SHADER_STAGE_COMPUTE_BIT, 0, constant_bytes};
  VkPipelineLayoutCreateInfo layout_info{};
  layout_info.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
  layout_info.setLayoutCount = sets;
  layout_info.pSetLayouts = layouts.data();
  layout_info.pushConstantRangeCount = constant_bytes > 0 ? 1 : 0;
  layout_info.pPushConstantRanges = &constants;
  VkPipelineLayout layout = VK_NULL_HANDLE;
  check(vkCreatePipelineLayout(device.get(), &layout_info, nullptr, &layout), "make a pipeline");
  layout_ = {device.get(), layout, vkDestroyPipelineLayout};

  VkShaderModuleCreateInfo module_info{};
  module_info.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
  module_info.codeSize = shader.size() * sizeof(std::uint32_t);
  module_info.pCode = shader.data();
  VkShaderModule made = VK_NULL_HANDLE;
  check(vkCreateShaderModule(device.get(), &module_info, nullptr, &made), "load a shader");
  const Handle<VkShaderModule> module(device.get(), made, vkDestroyShaderModule);

  VkComputePipelineCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO;
  info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
  info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
  info.stage.module = module.get();
  info.stage.pName = "main";
  info.layout = layout;
  VkPipeline pipeline = VK_NULL_HANDLE;
  check(vkCreateComputePipelines(device.get(), VK_NULL_HANDLE, 1, &info, nullptr, &pipeline),
        "compile a shader on the device");
  pipeline_ = {device.get(), pipeline, vkDestroyPipeline};
}

std::shared_ptr<const ComputePipeline>
PipelineCache::pipeline(const std::string& text,
                        const std::function<std::shared_ptr<const ComputePipeline>()>& make) {
  {
    const std::scoped_lock lock(mutex_);
    if (const auto found = made_.find(text); found != made_.end()) return found->second;
  }
  // Compiled outside the lock, perhaps twice: others need not wait.
  std::shared_ptr<const ComputePipeline> pipeline = make();
  const std::scoped_lock lock(mutex_);
  return made_.try_emplace(text, std::move(pipeline)).first->second;
}

std::vector<VkDescriptorSetLayout> ComputePipeline::set_layouts() const {
  std::vector<VkDescriptorSetLayout> layouts;
  for (const auto& layout : set_layouts_) layouts.push_back(layout.get());
  return layouts;
}

BoundResources::BoundResources(const Device& device, const ComputePipeline& pipeline)
    : device_(device.get()), pipeline_(&pipeline) {
  std::vector<VkDescriptorPoolSize> sizes;
  for (const Binding& binding : pipeline.bindings()) sizes.push_back({binding.type, binding.count});
  VkDescriptorPoolCreateInfo pool{};
  pool.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
  const std::vector<VkDescriptorSetLayout> layouts = pipeline.set_layouts();
  pool.maxSets = static_cast<std::uint32_t>(layouts.size());
  pool.poolSizeCount = static_cast<std::uint32_t>(sizes.size());
  pool.pPoolSizes = sizes.data();
  VkDescriptorPool made = VK_NULL_HANDLE;
  check(vkCreateDescriptorPool(device_, &pool, nullptr, &made), "bind resources");
  pool_ = {device_, made, vkDestroyDescriptorPool};
  VkDescriptorSetAllocateInfo allocate{};
  allocate.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
  allocate.descriptorPool = made;
  allocate.descriptorSetCount = static_cast<std::uint32_t>(layouts.size());
  allocate.pSetLayouts = layouts.data();
  sets_.resize(layouts.size());
  check(vkAllocateDescriptorSets(device_, &allocate, sets_.data()), "bind resources");
}

VkDescriptorType BoundResources::type_of(std::uint32_t binding, std::uint32_t set) const {
  const auto& bindings = pipeline_->bindings();
  const auto found = std::find_if(bindings.begin(), bindings.end(), [&](const Binding& each) {
    return each.number == binding && each.set == set;
  });
  assert(found != bindings.end());
  return found->type;
}

void BoundResources::bind(std::uint32_t binding, const Buffer& buffer, std::uint32_t set,
                          std::uint32_t element) {
  const VkDescriptorBufferInfo info{buffer.get(), 0, VK_WHOLE_SIZE};
  VkWriteDescriptorSet write{};
  write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
  write.dstSet = sets_[set];
  write.dstBinding = binding;
  write.dstArrayElement = element;
  write.descriptorCount = 1;
  write.descriptorType = type_of(binding, set);
  write.pBufferInfo = &info;
  vkUpdateDescriptorSets(device_, 1, &write, 0, nullptr);
}

void BoundResources::bind(std::uint32_t binding, VkImageView texture, VkSampler sampler,
                          std::uint32_t element) {
  const VkDescriptorImageInfo info{sampler, texture, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
  VkWriteDescriptorSet write{};
  write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
  write.dstSet = sets_[0];
  write.dstBinding = binding;
  write.dstArrayElement = element;
  write.descriptorCount = 1;
  write.descriptorType = type_of(binding, 0);
  write.pImageInfo = &info;
  vkUpdateDescriptorSets(device_, 1, &write, 0, nullptr);
}

void BoundResources::dispatch(VkCommandBuffer commands, std::uint32_t groups_x, std::uint32_t groups_y,
                              std::span<const std::byte> constants) const {
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_->get());
  vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_->layout(), 0,
                          static_cast<std::uint32_t>(sets_.size()), sets_.data(), 0, nullptr);
  if (!constants.empty())
    vkCmdPushConstants(commands, pipeline_->layout(), VK_SHADER_STAGE_COMPUTE_BIT, 0,
                       static_cast<std::uint32_t>(constants.size()), constants.data());
  vkCmdDispatch(commands, groups_x, groups_y, 1);
}

} // namespace surfgrad::gpu
