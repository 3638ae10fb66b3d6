/// The shaders whose costs docs/benchmarks.md tells: whoever changes the GLSL library learns here, without
/// the benchmarks, that they no longer compile.

#include "shader_cost/shaders.hpp"

#include <gtest/gtest.h>

namespace surfgrad::test {
namespace {

TEST(ShaderCost, EveryShaderCompiles) {
  const std::vector<std::string> names = bench::cost_shader_names();
  EXPECT_GE(names.size(), 15U);
  for (const std::string& name : names)
    EXPECT_NO_THROW((void)bench::compiled_cost_shader(name + ".frag")) << name;
  EXPECT_NO_THROW((void)bench::compiled_cost_shader("surface.vert"));
}

} // namespace
} // namespace surfgrad::test
