/// Buffers, textures and compute pipelines: what goes to the device comes back, in every format.

#include "diagnostic/error.hpp"
#include "gpu/pipeline.hpp"
#include "gpu/shader.hpp"
#include "image/pyramid.hpp"
#include "image/sampler.hpp"
#include "support/random.hpp"
#include "support/vulkan.hpp"
#include "support/worst.hpp"

#include <cstring>
#include <ostream>
#include <stdexcept>
#include <string>
#include <vector>

namespace surfgrad::test {
namespace {

using ::testing::HasSubstr;

using Compute = VulkanTest;

template <class T>
std::span<const std::byte> bytes_of(const std::vector<T>& values) {
  return std::as_bytes(std::span<const T>(values));
}
std::vector<float> floats_in(const gpu::Buffer& buffer) {
  std::vector<float> values(buffer.bytes() / sizeof(float));
  std::memcpy(values.data(), buffer.mapped().data(), values.size() * sizeof(float));
  return values;
}

// Else a result that nobody writes would pass for zero.
TEST_F(Compute, MemoryOfTheTestsIsNotZero) {
  const gpu::Buffer buffer(device(), 1000, gpu::Residence::result);
  for (const std::byte each : buffer.mapped()) ASSERT_EQ(each, std::byte{0x55});
}

constexpr const char* doubling = R"(#version 450
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer In { float from[]; };
layout(std430, binding = 3) writeonly buffer Out { float to[]; };
layout(push_constant) uniform Constants { uint count; float factor; };
void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i < count) to[i] = factor * from[i];
})";

TEST_F(Compute, RunsAShaderOverBuffers) {
  std::vector<float> from(1000);
  for (std::size_t i = 0; i < from.size(); ++i) from[i] = static_cast<float>(i) * 0.1f;
  const gpu::Buffer input = gpu::make_device_buffer(device(), bytes_of(from));
  const gpu::Buffer output(device(), from.size() * sizeof(float), gpu::Residence::result);
  const gpu::ComputePipeline pipeline(
      device(), gpu::compile({.text = doubling}),
      {{0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}, {3, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}}, 8);
  gpu::BoundResources resources(device(), pipeline);
  resources.bind(0, input);
  resources.bind(3, output);
  const struct {
    std::uint32_t count;
    float factor;
  } constants{1000, 2};
  device().run([&](VkCommandBuffer commands) {
    resources.dispatch(commands, 16, 1, std::as_bytes(std::span(&constants, 1)));
    gpu::barrier_after_writes(commands);
  });
  const auto to = floats_in(output);
  for (std::size_t i = 0; i < from.size(); ++i) ASSERT_EQ(to[i], 2 * from[i]) << i;
}

TEST_F(Compute, AHlslShaderRunsToo) {
  const std::vector<float> from{1, 2, 3};
  const gpu::Buffer input = gpu::make_device_buffer(device(), bytes_of(from));
  const gpu::Buffer output(device(), from.size() * sizeof(float), gpu::Residence::result);
  const gpu::ComputePipeline pipeline(
      device(),
      gpu::compile({.text = R"([[vk::binding(0)]] StructuredBuffer<float> from;
[[vk::binding(1)]] RWStructuredBuffer<float> to;
[numthreads(3, 1, 1)] void main(uint3 id : SV_DispatchThreadID) { to[id.x] = -from[id.x]; })",
                    .language = gpu::ShaderLanguage::hlsl}),
      {{0}, {1}});
  gpu::BoundResources resources(device(), pipeline);
  resources.bind(0, input);
  resources.bind(1, output);
  device().run([&](VkCommandBuffer commands) {
    resources.dispatch(commands, 1);
    gpu::barrier_after_writes(commands);
  });
  EXPECT_EQ(floats_in(output), (std::vector<float>{-1, -2, -3}));
}

TEST_F(Compute, AFaultyShaderSaysWhere) {
  try {
    (void)gpu::compile({.text = "#version 450\nvoid main() { nonsense(); }", .name = "layers.comp"});
    FAIL() << "it compiled";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("layers.comp:2"));
  }
}

// Fetches a texel of every level in turn, level after level as a map lists them.
constexpr const char* fetching = R"(#version 450
layout(local_size_x = 64) in;
layout(binding = 0) uniform sampler2D map;
layout(std430, binding = 1) writeonly buffer Out { vec4 to[]; };
layout(push_constant) uniform Constants { uint count; float unit; };
void main() {
  uint texel = gl_GlobalInvocationID.x;
  if (texel >= count) return;
  int level = 0;
  uvec2 whole = uvec2(textureSize(map, 0));
  uvec2 size = whole;
  uint first = 0u;
  while (texel - first >= size.x * size.y) {
    first += size.x * size.y;
    ++level;
    size = max(whole >> level, uvec2(1u)); // textureSize of levels that differ is wrong on Mesa 22
  }
  uint i = texel - first;
  to[texel] = unit * texelFetch(map, ivec2(i % size.x, i / size.x), level);
})";

class Fetched {
 public:
  Fetched(const gpu::Device& device, const image::Map& map, const char* shader, std::size_t count) {
    const gpu::Texture texture(device, map);
    format = texture.format();
    const auto sampler = gpu::make_sampler(
        device, device.filters(format.format) ? gpu::Sampling::trilinear : gpu::Sampling::nearest,
        gpu::Addressing::repeat, gpu::Addressing::mirror);
    const gpu::Buffer output(device, count * 4 * sizeof(float), gpu::Residence::result);
    const gpu::ComputePipeline pipeline(
        device, gpu::compile({.text = shader}),
        {{0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER}, {1, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}}, 8);
    gpu::BoundResources resources(device, pipeline);
    resources.bind(0, texture, sampler.get());
    resources.bind(1, output);
    const struct {
      std::uint32_t count;
      float unit;
    } constants{static_cast<std::uint32_t>(count), static_cast<float>(format.unit)};
    device.run([&](VkCommandBuffer commands) {
      resources.dispatch(commands, (constants.count + 63) / 64, 1, std::as_bytes(std::span(&constants, 1)));
      gpu::barrier_after_writes(commands);
    });
    values = floats_in(output);
  }
  gpu::TextureFormat format;
  std::vector<float> values;
};

/// Odd sides: levels that are not halves.
constexpr int width = 37;
constexpr int height = 21;

image::Map random_map(image::TexelFormat format, int components) {
  Random random(5);
  std::vector<float> texels(static_cast<std::size_t>(width) * height * static_cast<std::size_t>(components));
  const double low = format == image::TexelFormat::unorm16 ? 0 : -3.9;
  const double high = format == image::TexelFormat::unorm16 ? 1 : 3.9;
  for (float& texel : texels) texel = static_cast<float>(random.uniform(low, high));
  const image::TexelRows rows = image::rows_of(texels, width, components);
  image::TexelCode code{format, 1};
  if (format == image::TexelFormat::slope16) code = image::code_for_slopes(rows, width, height);
  if (format == image::TexelFormat::unorm16) code.scale = 1.0 / 65535;
  return image::with_pyramid(rows, width, height, components, code);
}

struct FormatCase {
  const char* name;
  image::TexelFormat format;
  int components;
  VkFormat expected; ///< where the device samples it, as the software driver does
};
/// How a failing test names its case.
void PrintTo(const FormatCase& row, std::ostream* out) { *out << row.name; }
class Formats : public VulkanTest, public ::testing::WithParamInterface<FormatCase> {};

INSTANTIATE_TEST_SUITE_P(
    All, Formats,
    ::testing::Values(FormatCase{"slope16", image::TexelFormat::slope16, 2, VK_FORMAT_R16G16_SNORM},
                      FormatCase{"unorm16", image::TexelFormat::unorm16, 1, VK_FORMAT_R16_UNORM},
                      FormatCase{"float1", image::TexelFormat::floats, 1, VK_FORMAT_R32_SFLOAT},
                      FormatCase{"float2", image::TexelFormat::floats, 2, VK_FORMAT_R32G32_SFLOAT},
                      FormatCase{"float3", image::TexelFormat::floats, 3, VK_FORMAT_R32G32B32A32_SFLOAT}),
    [](const auto& row) { return row.param.name; });

TEST_P(Formats, EveryTexelOfEveryLevelIsTheMaps) {
  const image::Map map = random_map(GetParam().format, GetParam().components);
  ASSERT_EQ(map.format, GetParam().format);
  std::size_t count = 0;
  for (int level = 0; level < map.level_count; ++level)
    count += static_cast<std::size_t>(map.width(level)) * static_cast<std::size_t>(map.height(level));
  const Fetched fetched(device(), map, fetching, count);
  EXPECT_EQ(fetched.format.format, GetParam().expected);
  // A code comes back as a fraction of the largest code and is multiplied by that: two roundings of up
  // to 4. Floats come back as they are.
  const double bound = map.format == image::TexelFormat::floats ? 0 : 2 * 4 * 0x1p-24;
  double worst = 0;
  std::size_t texel = 0;
  for (int level = 0; level < map.level_count; ++level)
    for (int y = 0; y < map.height(level); ++y)
      for (int x = 0; x < map.width(level); ++x, ++texel)
        for (int c = 0; c < map.components; ++c) {
          const double got = static_cast<double>(fetched.values[4 * texel + static_cast<std::size_t>(c)]);
          worst = std::max(worst, std::abs(got - map.value(level, x, y, c)));
          ASSERT_LE(worst, bound) << "level " << level << ", texel " << x << ", " << y;
        }
  std::printf("  worst difference %.3g of %.3g in %zu texels\n", worst, bound, texel);
}

// A spiral of coordinates, from level to level.
constexpr const char* sampling = R"(#version 450
layout(local_size_x = 64) in;
layout(binding = 0) uniform sampler2D map;
layout(std430, binding = 1) writeonly buffer Out { vec4 to[]; };
layout(push_constant) uniform Constants { uint count; float unit; };
void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= count) return;
  vec2 st = float(i) * vec2(0.0037, -0.0041);
  to[i] = unit * textureLod(map, st, float(i % 41u) / 8.0);
})";

TEST_P(Formats, HardwareFiltersAsTheEngineDoes) {
  const image::Map map = random_map(GetParam().format, GetParam().components);
  if (!device().filters(gpu::format_on(device(), map).format))
    GTEST_SKIP() << "this device does not filter the format";
  constexpr int count = 2000;
  const Fetched fetched(device(), map, sampling, count);
  // Either sampler rounds positions of up to 280 texels, 2^-25 of themselves, a few times, where values
  // change by up to 7.8 from texel to texel. What a GPU's 8-bit weights add is no matter of the software
  // driver.
  const double bound = 3 * 280 * 0x1p-25 * 7.8;
  Worst worst(GetParam().name);
  for (int i = 0; i < count; ++i) {
    const vec2<float> st{static_cast<float>(i) * 0.0037f, static_cast<float>(i) * -0.0041f};
    const auto compare = [&]<int N>() {
      const auto expected =
          image::sample<N>(map, vec2<double>{st.x, st.y}, static_cast<double>(i % 41) / 8,
                           {image::Wrap::repeat, image::Wrap::mirror}, image::Filter::trilinear, true);
      for (std::size_t c = 0; c < N; ++c)
        worst.add(static_cast<double>(fetched.values[4 * static_cast<std::size_t>(i) + c]), expected[c],
                  bound, i);
    };
    if (map.components == 1) compare.operator()<1>();
    if (map.components == 2) compare.operator()<2>();
    if (map.components == 3) compare.operator()<3>();
  }
}

TEST_F(Compute, MapsBeyondTheDevicesLimitAreRefusedWithTheLimit) {
  const int side = static_cast<int>(device().limits().maxImageDimension2D) + 1;
  const std::vector<float> flat(static_cast<std::size_t>(side));
  const image::Map map = image::with_pyramid(image::rows_of(flat, side, 1), side, 1, 1);
  try {
    const gpu::Texture texture(device(), map);
    FAIL() << "it was made";
  } catch (const MachineError& error) {
    EXPECT_THAT(error.what(), HasSubstr("its textures have at most " + std::to_string(side - 1)));
  }
}

} // namespace
} // namespace surfgrad::test
