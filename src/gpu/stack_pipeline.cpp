#include "gpu/stack_pipeline.hpp"

#include "diagnostic/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstring>
#include <map>
#include <span>

namespace surfgrad::gpu {
namespace {

using shadergen::SurfaceMember;
using Role = SurfaceMember::Role;

constexpr std::uint32_t lanes = 64; // of a workgroup
constexpr std::uint32_t fragments_binding = 0;
constexpr std::uint32_t results_binding = 1;
constexpr std::uint32_t object_binding = 2;

Attribute attribute_of(Role role) {
  switch (role) {
  case Role::position:
    return Attribute::position;
  case Role::dp_dx:
    return Attribute::dp_dx;
  case Role::dp_dy:
    return Attribute::dp_dy;
  case Role::dn_dx:
    return Attribute::dn_dx;
  case Role::dn_dy:
    return Attribute::dn_dy;
  case Role::front_facing:
    return Attribute::front_facing;
  case Role::normal_is_absent:
    return Attribute::normal_is_absent;
  case Role::st:
    return Attribute::st;
  case Role::dst_dx:
    return Attribute::dst_dx;
  case Role::dst_dy:
    return Attribute::dst_dy;
  case Role::tangent:
    return Attribute::tangent;
  case Role::object_position:
    return Attribute::object_position;
  case Role::world_position:
    return Attribute::world_position;
  case Role::to_viewer:
    return Attribute::to_viewer;
  case Role::raster:
    return Attribute::raster;
  default:
    break;
  }
  return Attribute::normal;
}

std::size_t floats_in(const std::string& type) {
  if (type == "vec2") return 2;
  if (type == "vec3") return 3;
  if (type == "vec4") return 4;
  if (type == "mat3") return 9;
  if (type == "mat4") return 16;
  return 1;
}

/// A member's value out of `function`(k), k from `first` on.
std::string reading(const std::string& type, const char* function, std::size_t first) {
  const auto one = [&](std::size_t k) { return fmt::format("{}({}u)", function, first + k); };
  if (type == "bool") return one(0) + " != 0.0";
  std::string list;
  for (std::size_t k = 0; k < floats_in(type); ++k) list += (k == 0 ? "" : ", ") + one(k);
  return type == "float" ? list : type + "(" + list + ")";
}

/// The shader around the generated function: a fragment an invocation.
std::string text_of(const shadergen::Shader& shader, const MapWords& words) {
  std::string fills;
  std::size_t fragment = 0;
  std::size_t object = 0;
  for (const SurfaceMember& m : shader.surface) {
    std::size_t& first = m.of_object ? object : fragment;
    fills += fmt::format("  s.{} = {};\n", m.name,
                         reading(m.type, m.of_object ? "of_object" : "of_fragment", first));
    first += floats_in(m.type);
  }
  const std::string sunlight = shader.has_sunlight ? "r.sunlight" : "1.0";
  return "#version 450\n" + shadergen::exact_words(shader, words.blocks()) + shader.source +
         fmt::format(R"(
layout(local_size_x = {lanes}) in;
layout(std430, set = 1, binding = 0) readonly buffer FragmentBlock {{ float fragment_values[]; }};
layout(std430, set = 1, binding = 1) writeonly buffer ResultBlock {{ float results[]; }};
layout(std430, set = 1, binding = 2) readonly buffer ObjectBlock {{ float object_values[]; }};
layout(push_constant) uniform Batch {{ uint count; uint stride; }} batch;

float of_fragment(uint k) {{ return fragment_values[k * batch.stride + gl_GlobalInvocationID.x]; }}
float of_object(uint k) {{ return object_values[k]; }}
void put(uint k, float value) {{ results[k * batch.stride + gl_GlobalInvocationID.x] = value; }}

void main() {{
  if (gl_GlobalInvocationID.x >= batch.count) return;
  {type}Surface s;
{fills}  {type}Result r = {name}_normal(s);
  put(0u, r.normal.x);
  put(1u, r.normal.y);
  put(2u, r.normal.z);
  put(3u, r.base_normal.x);
  put(4u, r.base_normal.y);
  put(5u, r.base_normal.z);
  put(6u, r.degenerate ? 1.0 : 0.0);
  put(7u, {sunlight});
}}
)",
                     fmt::arg("lanes", lanes), fmt::arg("type", shader.type_name), fmt::arg("fills", fills),
                     fmt::arg("name", shader.name), fmt::arg("sunlight", sunlight));
}

/// The first limit that is too low for so many storage buffers beside so many textures, and its number; empty
/// if none is.
std::string lacks_for(const VkPhysicalDeviceLimits& limits, std::uint32_t storage_buffers,
                      std::uint32_t textures) {
  const struct {
    const char* name;
    std::uint32_t has, needs;
  } rows[] = {
      {"maxPerStageDescriptorStorageBuffers", limits.maxPerStageDescriptorStorageBuffers, storage_buffers},
      {"maxDescriptorSetStorageBuffers", limits.maxDescriptorSetStorageBuffers, storage_buffers},
      // The parameters count, too.
      {"maxPerStageResources", limits.maxPerStageResources, storage_buffers + 1 + textures},
  };
  for (const auto& row : rows)
    if (row.has < row.needs) return fmt::format("{} is {}", row.name, row.has);
  return {};
}

Sampling sampling_of(stack::Filter filter) {
  return filter == stack::Filter::nearest    ? Sampling::nearest
         : filter == stack::Filter::bilinear ? Sampling::bilinear
                                             : Sampling::trilinear;
}
Addressing addressing_of(stack::Wrap wrap) {
  return wrap == stack::Wrap::repeat   ? Addressing::repeat
         : wrap == stack::Wrap::mirror ? Addressing::mirror
                                       : Addressing::clamp;
}

void append(std::vector<float>& values, vec3<double> v) {
  for (const double each : {v.x, v.y, v.z}) values.push_back(static_cast<float>(each));
}
void append(std::vector<float>& values, vec4<double> v) {
  for (const double each : {v.x, v.y, v.z, v.w}) values.push_back(static_cast<float>(each));
}
/// Columns one after the other, as GLSL's constructors take them.
void append(std::vector<float>& values, const mat3<double>& m) {
  const mat3<double> columns = transpose(m);
  append(values, columns.x);
  append(values, columns.y);
  append(values, columns.z);
}
void append(std::vector<float>& values, const mat4<double>& m) {
  const mat4<double> columns = transpose(m);
  append(values, columns.x);
  append(values, columns.y);
  append(values, columns.z);
  append(values, columns.w);
}

} // namespace

StackPipeline::StackPipeline(const Device& device, const shadergen::Shader& shader,
                             const std::vector<StackMap>& maps, const MapWords& words, PipelineCache& cache,
                             const std::string& material)
    : device_(device), has_sunlight_(shader.has_sunlight) {
  for (const SurfaceMember& m : shader.surface) {
    if (m.of_object) {
      object_members_.push_back(m);
      continue;
    }
    attributes_.push_back({attribute_of(m.role), m.uv});
    fragment_floats_ += floats_in(m.type);
  }
  constexpr VkDescriptorType storage = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
  constexpr VkDescriptorType uniform = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
  std::vector<Binding> bindings{
      {fragments_binding, storage, 1, 1}, {results_binding, storage, 1, 1}, {object_binding, storage, 1, 1}};
  const auto refuse = [&](const std::string& why, const char* use) {
    throw MachineError(
        fmt::format("cannot compose the material \"{}\" on \"{}\": {}; use {}, or --device cpu", material,
                    device.info().name, why, use));
  };
  const auto add = [&](int binding, VkDescriptorType type, std::span<const std::byte> bytes,
                       const char* what) {
    const VkPhysicalDeviceLimits& limits = device.limits();
    const std::uint32_t most = type == uniform ? limits.maxUniformBufferRange : limits.maxStorageBufferRange;
    const char* const limit = type == uniform ? "maxUniformBufferRange" : "maxStorageBufferRange";
    if (bytes.size() > most)
      refuse(fmt::format("{} need {} bytes in one buffer, {} is {}", what, bytes.size(), limit, most),
             "fewer layers");
    bindings.push_back({static_cast<std::uint32_t>(binding), type, 1, 0});
    stack_buffers_.push_back({static_cast<std::uint32_t>(binding), 0, make_device_buffer(device, bytes)});
  };
  using Layout = shadergen::ExactLayout;
  if (!shader.parameter_data.empty()) add(Layout::parameters, uniform, shader.parameter_data, "its numbers");
  if (shader.decal_count > 0) add(Layout::decals, storage, shader.decal_data, "its decals");
  add_textures(shader, maps);
  for (const SampledMap& each : stack_textures_)
    bindings.push_back({each.binding, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1, 0});
  if (!maps.empty()) {
    add(Layout::maps, storage, std::as_bytes(std::span(words.maps())), "its maps");
    const auto count = static_cast<std::uint32_t>(words.buffer_count());
    const auto others = static_cast<std::uint32_t>(
        std::count_if(bindings.begin(), bindings.end(), [](const Binding& b) { return b.type == storage; }));
    const auto sampled = static_cast<std::uint32_t>(stack_textures_.size());
    if (const std::string lacking = lacks_for(device.limits(), others + count, sampled); !lacking.empty())
      refuse(fmt::format("its maps need {} buffers, all in all {}, {}", count, others + count, lacking),
             "smaller maps");
    bindings.push_back({Layout::words, storage, count, 0});
    for (std::uint32_t k = 0; k < count; ++k) {
      const std::vector<std::uint32_t> some = words.words(static_cast<int>(k));
      stack_buffers_.push_back(
          {Layout::words, k, make_device_buffer(device, std::as_bytes(std::span(some)))});
    }
  }
  constexpr std::uint32_t constant_bytes = 2 * sizeof(std::uint32_t);
  const std::string text = text_of(shader, words);
  pipeline_ = cache.pipeline(text, [&] {
    return std::make_shared<const ComputePipeline>(device, compile({.text = text, .name = shader.name}),
                                                   bindings, constant_bytes);
  });
}

void StackPipeline::add_textures(const shadergen::Shader& shader, const std::vector<StackMap>& maps) {
  std::map<const image::Map*, std::shared_ptr<const Texture>> textures;
  for (const shadergen::TextureBinding& t : shader.textures) {
    if (!t.sampled) continue;
    const StackMap& map = maps[static_cast<std::size_t>(t.binding)];
    std::shared_ptr<const Texture>& texture = textures[map.sampled];
    if (!texture) texture = std::make_shared<const Texture>(device_, *map.sampled, map.format);
    stack_textures_.push_back(
        {static_cast<std::uint32_t>(shadergen::ExactLayout::textures + t.binding), texture,
         make_sampler(device_, sampling_of(t.filter), addressing_of(t.wrap_s), addressing_of(t.wrap_t))});
  }
}

bool StackPipeline::wants(Attribute attribute) const {
  return std::any_of(attributes_.begin(), attributes_.end(),
                     [&](const StackAttribute& each) { return each.attribute == attribute; });
}

std::vector<float> StackPipeline::object_values(const engine::Placement& placement) const {
  std::vector<float> values;
  const mat4<double>& m = placement.world_from_object;
  for (const SurfaceMember& member : object_members_) {
    switch (member.role) {
    case Role::world_from_object:
      append(values, placement.linear);
      break;
    case Role::object_from_world:
      append(values, placement.inverse_linear);
      break;
    case Role::object_origin:
      append(values, vec3<double>{m.x.w, m.y.w, m.z.w} - placement.origin);
      break;
    case Role::world_origin:
      append(values, placement.origin);
      break;
    case Role::to_sun:
      append(values, placement.to_sun);
      break;
    case Role::relative_from_screen:
      append(values, placement.relative_from_screen.value_or(mat4<double>{}));
      break;
    default:
      assert(false);
    }
  }
  if (values.empty()) values.push_back(0); // a buffer is never empty
  return values;
}

BoundResources StackPipeline::bound(const Buffer& fragments, const Buffer& results,
                                    const Buffer& object) const {
  BoundResources resources(device_, *pipeline_);
  for (const SetZero& each : stack_buffers_) resources.bind(each.binding, each.buffer, 0, each.element);
  for (const auto& [binding, texture, sampler] : stack_textures_)
    resources.bind(binding, *texture, sampler.get());
  resources.bind(fragments_binding, fragments, 1);
  resources.bind(results_binding, results, 1);
  resources.bind(object_binding, object, 1);
  return resources;
}

void StackPipeline::compose(VkCommandBuffer commands, const BoundResources& resources, std::uint32_t count,
                            std::uint32_t stride) const {
  const std::uint32_t constants[] = {count, stride};
  resources.dispatch(commands, (count + lanes - 1) / lanes, 1, std::as_bytes(std::span(constants)));
  barrier_after_writes(commands);
}

} // namespace surfgrad::gpu
