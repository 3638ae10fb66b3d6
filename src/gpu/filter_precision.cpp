#include "gpu/filter_precision.hpp"

#include "gpu/pipeline.hpp"
#include "image/pyramid.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>

namespace surfgrad::gpu {
namespace {

constexpr int steps = 2048; // several of the finest precision that a device has

// Two texels, 0 and 1, and a level of 1/2: what lies between, from texel to texel and from level to level.
constexpr const char* probe = R"(#version 450
layout(local_size_x = 64) in;
layout(binding = 0) uniform sampler2D map;
layout(std430, binding = 1) writeonly buffer Out { vec2 to[]; };
layout(push_constant) uniform Constants { float unit; float steps; };
void main() {
  float share = float(gl_GlobalInvocationID.x) / steps;
  float across = unit * textureLod(map, vec2(0.25 + 0.5 * share, 0.5), 0.0).x;
  float down = unit * textureLod(map, vec2(0.25, 0.5), share).x;
  to[gl_GlobalInvocationID.x] = vec2(across, 2.0 * down);
})";

} // namespace

FilterPrecision promised_precision(const VkPhysicalDeviceLimits& limits) {
  return {std::ldexp(1.0, -static_cast<int>(limits.subTexelPrecisionBits)),
          std::ldexp(1.0, -static_cast<int>(limits.mipmapPrecisionBits))};
}

FilterPrecision filter_precision(const Device& device) {
  FilterPrecision precision = promised_precision(device.limits());
  const std::vector<float> texels{0, 1};
  const image::Map map =
      image::with_pyramid(image::rows_of(texels, 2, 1), 2, 1, 1, {image::TexelFormat::unorm16, 1.0 / 65535});
  const auto format = filtered_format(map, [&](VkFormat f) { return device.filters(f); });
  if (!format) return precision;
  const Texture texture(device, map, *format);
  const auto sampler = make_sampler(device, Sampling::trilinear, Addressing::clamp, Addressing::clamp);
  const Buffer output(device, steps * 2 * sizeof(float), Residence::result);
  const ComputePipeline pipeline(
      device, compile({.text = probe, .name = "filter precision"}),
      {{0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER}, {1, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}}, 8);
  BoundResources resources(device, pipeline);
  resources.bind(0, texture, sampler.get());
  resources.bind(1, output);
  const float constants[] = {static_cast<float>(format->unit), static_cast<float>(steps)};
  device.run([&](VkCommandBuffer commands) {
    resources.dispatch(commands, steps / 64, 1, std::as_bytes(std::span(constants)));
    barrier_after_writes(commands);
  });
  std::vector<float> got(steps * 2);
  std::memcpy(got.data(), output.mapped().data(), got.size() * sizeof(float));
  for (std::size_t i = 0; i < steps; ++i) {
    const double share = static_cast<double>(i) / steps;
    precision.texel = std::max(precision.texel, std::abs(static_cast<double>(got[2 * i]) - share));
    precision.level = std::max(precision.level, std::abs(static_cast<double>(got[2 * i + 1]) - share));
  }
  return precision;
}

} // namespace surfgrad::gpu
