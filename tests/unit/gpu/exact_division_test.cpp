/// The lattice of a height field on a device whose quotients are off by an ulp, as Vulkan allows (2.5 of
/// them).

#include "gpu/pipeline.hpp"
#include "gpu/shader.hpp"
#include "support/vulkan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <sstream>
#include <vector>

namespace surfgrad::test {
namespace {

using ExactDivision = VulkanTest;

std::string between(const std::string& text, const char* first, const char* last) {
  const std::size_t begin = text.find(first);
  const std::size_t end = text.find(last);
  if (begin == std::string::npos || end == std::string::npos || end < begin) return {};
  return text.substr(begin, end - begin);
}

/// The sampler's functions of one axis, each quotient `ulps` units in the last place from the device's.
std::string axis_functions(int ulps) {
  std::ifstream file(SURFGRAD_SOURCE_DIR "/src/shadergen/exact.glsl");
  std::stringstream all;
  all << file.rdbuf();
  const std::string text = all.str();
  std::string code = between(text, "uint stack_index(", "vec2 stack_map_size(") +
                     between(text, "struct StackRayAxis", "struct StackRay {") +
                     between(text, "struct StackSpan", "float stack_within(");
  int quotients = 0;
  for (const std::string quotient : {"a / b", "i / period", "cell / period", "inside / size"})
    for (std::size_t at = 0; (at = code.find("floor(" + quotient + ")", at)) != std::string::npos;
         ++quotients) {
      const std::string wrong = "floor(wrong(" + quotient + "))";
      code.replace(at, quotient.size() + 7, wrong);
      at += wrong.size();
    }
  EXPECT_GT(quotients, 0) << "no quotient was found";
  // The quotient 0 is exact on any device.
  return fmt::format(
             "float wrong(float q) {{ return q == 0.0 ? q : intBitsToFloat(floatBitsToInt(q) + {}); }}\n",
             ulps) +
         code;
}

TEST_F(ExactDivision, IsNotNeededToFindTexelsAndNodes) {
  constexpr int reach = 600;
  for (const int wrap : {0, 1, 2})
    for (const int count : {1, 3, 7, 41, 64, 97})
      for (const int ulps : {-2, -1, 0, 1, 2}) {
        const std::string text = fmt::format(R"(#version 450
layout(local_size_x = 64) in;
layout(std430, binding = 0) writeonly buffer Out {{ float to[]; }};
{}
void main() {{
  uint k = gl_GlobalInvocationID.x;
  if (k >= {}u) return;
  float i = float(int(k) - {});
  StackRayAxis axis = StackRayAxis(0.0, 1.0, 1.0, {}.0, {});
  StackSpan span = stack_span_of(axis, i, 2.0);
  to[4u * k] = stack_texel_at(axis, i);
  to[4u * k + 1u] = span.low;
  to[4u * k + 2u] = span.high;
  to[4u * k + 3u] = span.node;
}})",
                                             axis_functions(ulps), 2 * reach + 1, reach, count, wrap);
        const gpu::Buffer output(device(), (2 * reach + 1) * 16, gpu::Residence::result);
        std::memset(output.mapped().data(), 0x55, output.mapped().size());
        const gpu::ComputePipeline pipeline(device(), gpu::compile({.text = text}), {{0}});
        gpu::BoundResources resources(device(), pipeline);
        resources.bind(0, output);
        device().run([&](VkCommandBuffer commands) {
          resources.dispatch(commands, (2 * reach + 64) / 64);
          gpu::barrier_after_writes(commands);
        });
        std::vector<float> got(4 * (2 * reach + 1));
        std::memcpy(got.data(), output.mapped().data(), 4 * got.size());
        for (int i = -reach; i <= reach; ++i) {
          // Whole numbers, so that the truth needs no quotient of floats.
          const int period = wrap == 1 ? 2 * count : count;
          const int offset = (i % period + period) % period;
          const int shown = wrap == 2        ? std::min(std::max(i, 0), count - 1)
                            : offset < count ? offset
                                             : period - 1 - offset;
          const float* at = &got[static_cast<std::size_t>(4 * (i + reach))];
          ASSERT_EQ(at[0], static_cast<float>(shown))
              << "texel " << i << " of " << count << ", wrap " << wrap << ", " << ulps << " ulp";
          ASSERT_GE(at[3], 0) << i << " of " << count << ", wrap " << wrap << ", " << ulps << " ulp";
          ASSERT_LE(at[3], static_cast<float>((count - 1) / 2)) << i << " of " << count;
          if (wrap == 2) continue; // all beyond a border is one cell
          ASSERT_LE(at[1], static_cast<float>(i)) << i << " of " << count << ", wrap " << wrap;
          ASSERT_LT(static_cast<float>(i), at[2]) << i << " of " << count << ", wrap " << wrap;
        }
      }
}

} // namespace
} // namespace surfgrad::test
