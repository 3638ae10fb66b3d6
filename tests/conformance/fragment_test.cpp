/// The functions that take derivatives across pixels, in a fragment stage: every pixel of a quad has
/// arguments of its own, so that a derivative from another row or column of the quad shows.

#include "conformance/languages.hpp"
#include "support/drawing.hpp"
#include "support/software_driver.hpp"
#include "support/worst.hpp"

#include <gtest/gtest.h>

namespace surfgrad::test {
namespace {

constexpr std::uint64_t seed = 6;
constexpr std::size_t pixels = std::size_t{fragment_width} * fragment_height;

/// One triangle over half of a viewport, whose upper left quarter is the picture: clipped, it would become
/// two, and the quads between them be cut.
constexpr const char* vertex_text = R"(#version 450
void main() {
  gl_Position = vec4(gl_VertexIndex == 1 ? 1.0 : -1.0, gl_VertexIndex == 2 ? 1.0 : -1.0, 0.0, 1.0);
}
)";

/// Random arguments for every pixel. Fine derivatives are a quad's differences on a pixel's own row and
/// column.
std::vector<ShaderInputs<float>> quads_of_inputs() {
  Random random(seed);
  std::vector<ShaderInputs<float>> cases;
  for (std::size_t i = 0; i < pixels; ++i) cases.push_back(random_shader_inputs(random));
  for (std::size_t i = 0; i < pixels; ++i) {
    const std::size_t x = i % fragment_width;
    const std::size_t row = i - x;
    const std::size_t column_of_quad = (i / fragment_width & ~std::size_t{1}) * fragment_width + x;
    const auto& left = cases[row + (x & ~std::size_t{1})];
    const auto& right = cases[row + (x | 1)];
    const auto& upper = cases[column_of_quad];
    const auto& lower = cases[column_of_quad + fragment_width];
    CoreInputs<float>& in = cases[i].core;
    in.dst_dx = right.plane - left.plane;
    in.dst_dy = lower.plane - upper.plane;
    in.frame =
        detail::frame_from_unit_normal(in.frame.normal, right.core.position - left.core.position,
                                       lower.core.position - upper.core.position, in.frame.resolve_sign);
  }
  return cases;
}

class FragmentConformance : public ::testing::TestWithParam<Language> {};
INSTANTIATE_TEST_SUITE_P(Languages, FragmentConformance, ::testing::ValuesIn(languages),
                         [](const auto& each) { return name_of(each.param); });

TEST_P(FragmentConformance, DerivativesAcrossPixelsGiveTheCoresResults) {
  choose_software_driver();
  std::vector<const Row*> some;
  for (const Row& row : fragment_rows()) some.push_back(&row);
  const gpu::Spirv fragment =
      compiled(GetParam(), gpu::ShaderStage::fragment, fragment_text(GetParam(), some));
  const gpu::Spirv vertex = compiled(Language::glsl, gpu::ShaderStage::vertex, vertex_text);
  const std::vector<ShaderInputs<float>> cases = quads_of_inputs();
  const std::span<const float> inputs(reinterpret_cast<const float*>(cases.data()),
                                      cases.size() * shader_input_count<float>);
  // A component that no shader writes stays what no function gives.
  const std::vector<float> unwritten(some.size() * pixels * row_results, 1e30f);
  std::vector<float> results(unwritten.size());
  Drawing drawing;
  (void)drawing.draw(
      {.stages = {vertex, {}, fragment},
       .size = {fragment_width, fragment_height},
       .viewport = {2 * fragment_width, 2 * fragment_height},
       .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST,
       .vertex_count = 3,
       .bound = {{.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, .contents = inputs},
                 {.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, .contents = unwritten, .results = results}}});
  for (const std::string& message : drawing.messages()) ADD_FAILURE() << message;
  std::printf("  seed %d\n", static_cast<int>(seed));
  for (std::size_t r = 0; r < some.size(); ++r) {
    const Row& row = *some[r];
    Worst worst(row.name);
    for (std::size_t i = 0; i < pixels; ++i) {
      const ShaderInputs<double> exact = convert<double>(cases[i]);
      const auto expected = row.in_double(exact);
      const auto bounds = row.device_bound(exact);
      for (std::size_t k = 0; k < expected.size(); ++k)
        // A sign that rounding decides is one or the other.
        if (bounds[k] >= undecided)
          EXPECT_EQ(std::abs(results[(r * pixels + i) * row_results + k]), 1) << row.name << ", pixel " << i;
        else
          worst.add(static_cast<double>(results[(r * pixels + i) * row_results + k]), expected[k],
                    1.001 * static_cast<double>(epsilon_v<float>) * bounds[k], static_cast<long>(i));
    }
  }
}

} // namespace
} // namespace surfgrad::test
